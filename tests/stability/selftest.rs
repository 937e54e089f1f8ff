//! `brinell selftest` passes here, and the page that it writes is the one in the repository.

use brinell::progress::{Observer, Silent};
use brinell::selftest;

#[test]
fn every_family_passes_and_the_page_names_it() {
    let rows = selftest::run(&mut Silent);
    for row in &rows {
        assert!(row.passed(), "{row:?}");
        assert!(row.cases > 0, "{row:?}");
    }
    // Figures differ from machine to machine, families and bounds do not.
    let page = include_str!("../../data/stability.md");
    for line in selftest::page(&rows).lines().filter(|l| l.starts_with('|')) {
        let cell = |line: &str, i: usize| line.split('|').nth(i).map(str::to_owned);
        let same = |kept: &str| {
            [1, 2, 3, 5, 6]
                .iter()
                .all(|&i| cell(kept, i) == cell(line, i))
        };
        assert!(
            page.lines().any(same),
            "data/stability.md has no row for {line}: brinell selftest --markdown -q > \
             data/stability.md"
        );
    }
}

/// A figure that is not a number must not pass, nor one beyond its bound.
#[test]
fn a_bad_figure_fails() {
    struct Stopped;
    impl Observer for Stopped {
        fn stop_requested(&self) -> bool {
            true
        }
    }
    assert_eq!(selftest::run(&mut Stopped), []);
    let row = selftest::Row {
        family: "",
        figure: "",
        cases: 1,
        worst: 0.0,
        bound: 1e-10,
        source: "",
        failure: None,
    };
    assert!(row.passed());
    for worst in [f64::NAN, f64::INFINITY, 2e-10] {
        assert!(
            !selftest::Row {
                worst,
                ..row.clone()
            }
            .passed()
        );
    }
    let failure = Some("did not run".to_string());
    assert!(!selftest::Row { failure, ..row }.passed());
}
