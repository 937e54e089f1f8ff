//! The order in which a scene lists its loads.

use crate::support::{close, load, run};

/// A load that is a millionth of the other, on the other body and before or after it: the approach
/// is that of the press, to a millionth, in either order.
#[test]
fn the_approach_does_not_follow_the_load_that_stands_first() {
    let approach = |loads: &str| {
        let scene = load("contact_patch", &[&format!("load={loads}")]);
        run(&scene).states[0].approach
    };
    let press = "{ name = \"press\", on = \"upper.top\", pressure = 10.0 }";
    let touch = "{ name = \"touch\", on = \"lower.right\", pressure = 1e-5 }";
    let alone = approach(&format!("[{press}]"));
    assert!(alone > 0.0);
    let [first, last] = [format!("[{press}, {touch}]"), format!("[{touch}, {press}]")]
        .map(|loads| approach(&loads));
    close("order", first, last, alone, 1e-13);
    close("one load more", first, alone, alone, 1e-5);
}

/// A press in two parts is one press; two halves of a vice come together by what both move.
#[test]
fn the_approach_is_the_work_of_all_loads() {
    let on_top = |pressures: &[f64]| {
        let entries = pressures.iter().enumerate();
        let entries: Vec<String> = entries
            .map(|(i, p)| format!("{{ name = \"part {i}\", on = \"upper.top\", pressure = {p} }}"))
            .collect();
        let scene = load("contact_patch", &[&format!("load=[{}]", entries.join(","))]);
        run(&scene).states[0].approach
    };
    let whole = on_top(&[10.0]);
    close("in parts", on_top(&[1.0, 9.0]), whole, whole, 1e-13);
    let vice = |on: &str| {
        let scene = load(
            "contact_patch",
            &[
                "support=[{on=\"lower.left\",fix=[\"x\"]},{on=\"upper.left\",fix=[\"x\"]},\
                 {on=\"lower.bottom\",fix=[\"y\"]}]",
                &format!("load=[{on}]"),
            ],
        );
        run(&scene).states[0].approach
    };
    let sides = [
        "{name=\"a\",on=\"upper.right\",pressure=10.0}",
        "{name=\"b\",on=\"lower.right\",pressure=10.0}",
    ];
    // The blocks slide on each other: each side moves on its own.
    let [a, b] = sides.map(|side| {
        vice(&format!(
            "{side},{{name=\"hold\",on=\"upper.top\",pressure=1e-9}}"
        ))
    });
    let both = vice(&format!(
        "{},{},{{name=\"hold\",on=\"upper.top\",pressure=1e-9}}",
        sides[0], sides[1]
    ));
    close("both", both, a + b, both, 1e-6);
}
