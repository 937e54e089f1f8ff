//! The claim of the estimate: how often the true error lies below the stated one, and how far the
//! two are apart. The page data/accuracy/claims.md has all families
//! (`cargo run --release --example claims`); here those that take seconds, without the
//! finest mesh of each unless the run is to be thorough.

use crate::support::either;
use crate::support::families::{Claim, claims_of, judging_exactly};

/// Share of the errors of loads and pressures, and of the others, that lie below the stated ones.
const COVERED: [f64; 2] = [0.95, 0.9];
/// A true error is at most this many times the stated one.
const WORST: f64 = 3.0;

#[test]
fn true_errors_lie_below_the_stated_ones_on_families_that_judge() {
    let folder = tempfile::tempdir().unwrap();
    let mut families = judging_exactly(folder.path());
    for family in &mut families {
        let finest = family.meshes.len() - 1;
        family.meshes.truncate(either(finest, finest + 1));
    }
    let claims = claims_of(&families);
    let is_load = |claim: &&Claim| ["load", "max_pressure", "approach"].contains(&claim.key());
    let (loads, others): (Vec<&Claim>, Vec<&Claim>) = claims.iter().partition(is_load);
    for (group, wanted) in [(loads, COVERED[0]), (others, COVERED[1])] {
        let beyond: Vec<&&Claim> = group.iter().filter(|c| c.truth > c.stated).collect();
        println!("{} of {}: {beyond:#?}", beyond.len(), group.len());
        assert!(group.len() > 30);
        let covered = 1.0 - beyond.len() as f64 / group.len() as f64;
        assert!(covered >= wanted, "{covered}");
        assert!(
            beyond.iter().all(|c| c.truth <= WORST * c.stated),
            "{beyond:#?}"
        );
    }
}
