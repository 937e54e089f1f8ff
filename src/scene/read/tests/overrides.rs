//! Overrides by tables and by lists, and overrides that remove a key.

use super::load_with;
use crate::scene::Unit;

/// Keys that an override does not name keep their values: a table given for `program` does not turn
/// multiples of the yield load into loads.
#[test]
fn an_override_by_a_table_is_merged_with_it() {
    let unit = "program.unit=yield";
    let scene = load_with(&[
        unit,
        "program={ steps = 7, targets = [{ name = \"a\", load_factor = 3 }] }",
        "materials={ steel = { yield_stress = 400 } }",
        "load.press={ pressure = 5.0 }",
        "mesh.parts.0={ block = { elements = [4, 4] } }",
    ])
    .unwrap();
    assert_eq!(scene.program.unit, Unit::Yield);
    assert_eq!((scene.program.steps, scene.program.targets.len()), (7, 1));
    assert_eq!(scene.materials["steel"].yield_stress, Some(400.0));
    assert_eq!(scene.materials["steel"].youngs_modulus, 210000.0);
    assert_eq!(scene.load[0].name, "press");
    assert_eq!(scene.load[0].pressure, Some(5.0.into()));
    let part = &scene.mesh.parts.as_ref().unwrap()[0];
    assert_eq!(part.block.as_ref().unwrap().elements, [4, 4]);
    assert_eq!(part.body, "block");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    // A value from an override has the override as its place, all other values a place in the file.
    let wrong = "materials={ steel = { yield_stress = -1 } }";
    let error = load_with(&[wrong]).unwrap_err();
    let expected = format!("--set {wrong}: materials.steel.yield_stress: -1 must be greater");
    assert!(error.message().contains(&expected), "{error}");
}

#[test]
fn an_override_without_a_value_removes_the_key() {
    let scene = load_with(&[
        "materials.steel.plastic_modulus=7",
        "materials.steel.plastic_modulus=",
        "materials.steel.yield_stress = ",
        "kind=",
    ]);
    let error = scene.unwrap_err();
    assert!(
        error.message().contains("the key `kind` is missing"),
        "{error}"
    );
    let scene = load_with(&["materials.steel.yield_stress = "]).unwrap();
    assert_eq!(scene.materials["steel"].yield_stress, None);
}

/// A list replaces the old list: keys that all old entries had and no new entry has are reported.
#[test]
fn keys_that_a_new_list_loses_are_told() {
    let lost = |text: &str| load_with(&[text]).unwrap().warnings;
    assert_eq!(
        lost("load=[{ on = \"block.top\", pressure = 3 }]"),
        ["--set load=[...] replaces the list; its entries no longer have `name`"]
    );
    assert!(lost("load=[{ on = \"block.top\", pressure = 3, name = \"a\" }]").is_empty());
    assert!(lost("load.0.pressure=3").is_empty());
    assert!(lost("load.0.history=[[0, 0], [1, 2]]").is_empty());
}
