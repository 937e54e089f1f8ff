//! A factor with changed values in the zone equals the condensation of the changed matrix.

use super::{DenseCondensed, Way, ways};
use crate::linalg::tests::matrices::{Grid, Support};
use crate::linalg::tests::{Numbers, distance, norm};
use crate::linalg::{ChangedFactor, Condensed, Partition, SymmetricCsc, ZonePart};

/// A block held at its foot: contact in the middle of the top, with the zone below.
fn block() -> (Grid<2>, Partition) {
    let grid = Grid::<2>::new([8, 8], Support::Bottom);
    let contact = grid.freedoms(1..2, |[x, y]| y == 8 && (2..=5).contains(&x));
    let mut zone = grid.freedoms(0..2, |[x, y]| y > 3 && (1..=7).contains(&x));
    zone.retain(|freedom| !contact.contains(freedom));
    let partition = Partition {
        n: grid.n,
        zone,
        contact,
    };
    (grid, partition)
}

/// Subtracts the difference of two matrices, which lies on zone and contact, entry by entry.
fn take_off(
    changed: &mut dyn ChangedFactor,
    [matrix, other]: [&SymmetricCsc; 2],
    zone: &[usize],
    contact: &[usize],
) {
    let place = |freedom: i64| {
        let mut all = zone.iter().chain(contact);
        let found = all.position(|&other| other == freedom as usize);
        found.expect("a zone or contact freedom") as u32
    };
    for ((&a, (i, j)), (&b, _)) in matrix.iter().zip(other.iter()) {
        let d = a - b;
        match (d == 0.0, i == j) {
            (true, _) => {}
            (_, true) => changed.take_off(&[place(i)], &[d]),
            _ => changed.take_off(&[place(i), place(j)], &[0.0, d, d, 0.0]),
        }
    }
}

#[test]
fn a_changed_factor_is_that_of_the_changed_matrix() {
    let (grid, partition) = block();
    // A hundredth of the stiffness is left in one part of the zone, a third in another.
    let soft = |[x, y]: [usize; 2]| match (y >= 5 && (3..=5).contains(&x), x < 5) {
        (true, true) => 0.01,
        (true, false) => 0.3,
        _ => 1.0,
    };
    let (stiff, soft) = (grid.stiffness(|_| 1.0), grid.stiffness(soft));
    // All freedoms of the elements that change, and further ones below and next to them.
    let wanted = grid.freedoms(0..2, |[x, y]| y > 4 && (2..=6).contains(&x));
    for Way { name, condense, .. } in ways() {
        for shift in [vec![], vec![2.0; partition.contact.len()]] {
            for chosen in [false, true] {
                let mut condensed = condense(&stiff, &partition, &shift).expect(name);
                let mut zone = partition.zone.clone();
                if chosen {
                    let wanted = wanted.iter().copied();
                    let wanted: Vec<_> = wanted
                        .filter(|f| partition.zone.binary_search(f).is_ok())
                        .collect();
                    zone = condensed.choose_zone(&wanted).unwrap().expect(name);
                }
                let mut changed = condensed.changed().expect(name);
                let others = Partition {
                    zone: zone.clone(),
                    ..partition.clone()
                };
                // A previous matrix leaves no trace.
                changed.begin();
                changed.take_off(&[0], &[1e3]);
                assert!(!changed.factor(), "{name}");
                changed.begin();
                take_off(&mut *changed, [&stiff, &soft], &zone, &partition.contact);
                assert!(changed.factor(), "{name}");
                let dense = DenseCondensed::new(&soft, &others, &shift).unwrap();
                assert_alike(&*changed, &dense, &others, name);
            }
        }
    }
}

fn assert_alike(
    changed: &dyn ChangedFactor,
    dense: &dyn Condensed,
    partition: &Partition,
    name: &str,
) {
    // Round-off times the condition, which is that of the softest layer relative to the block.
    let tolerance = 1e-10;
    let [a, b] = [changed.contact_stiffness(), dense.contact_stiffness()].map(|c| c.dense());
    assert!((&a - &b).norm() <= tolerance * b.norm(), "{name}");
    let mut numbers = Numbers::new(19);
    let load = numbers.vector(partition.zone.len());
    let contact = numbers.vector(partition.contact.len());
    let (mut a, mut b) = ((load.clone(), contact.clone()), (load, contact.clone()));
    changed.eliminate_zone(&mut a.0, &mut a.1);
    dense.eliminate_zone(&mut b.0, &mut b.1);
    assert!(distance(&a.1, &b.1) <= tolerance * norm(&b.1), "{name}");
    changed.recover_part(&ZonePart::default(), &mut a.0, &contact);
    dense.recover_zone(&mut b.0, &contact);
    assert!(distance(&a.0, &b.0) <= tolerance * norm(&b.0), "{name}");
    let [factor, solve] = changed.flops();
    assert!(factor > solve && solve > 0.0);
}
