//! Refusals of materials and bodies.

use super::*;

/// Gives the steel a tensile test in place of its hardening law.
fn tested(scene: &mut Scene, yield_stress: Option<f64>, test: &[[f64; 2]]) {
    let steel = scene.materials.get_mut("steel").unwrap();
    steel.plastic_modulus = None;
    steel.yield_stress = yield_stress;
    steel.tensile_test = Some(test.to_vec());
}

/// Gives the steel rows over temperature, and its bodies a temperature.
fn heated(scene: &mut Scene, rows: &[MaterialRow]) {
    let steel = scene.materials.get_mut("steel").unwrap();
    steel.over_temperature = rows.to_vec();
    for body in scene.bodies.values_mut() {
        body.temperature = Some(50.0);
    }
}

fn row(temperature: f64, youngs_modulus: f64) -> MaterialRow {
    MaterialRow {
        temperature,
        youngs_modulus: Some(youngs_modulus),
        ..MaterialRow::default()
    }
}

#[test]
fn rows_over_temperature() {
    refused(
        good,
        &[
            (
                |s| heated(s, &[row(20.0, 2e5), row(20.0, 1e5)]),
                "materials.steel.over_temperature.1.temperature: 20 must be greater than 20 of",
            ),
            (
                |s| heated(s, &[row(20.0, 2e5), row(90.0, -1.0)]),
                "materials.steel.over_temperature.1.youngs_modulus: -1 must be greater than zero",
            ),
            (
                |s| {
                    let nothing = MaterialRow {
                        temperature: 90.0,
                        ..MaterialRow::default()
                    };
                    heated(s, &[row(20.0, 2e5), nothing]);
                },
                "materials.steel.over_temperature.1: gives only a temperature",
            ),
            (
                |s| {
                    let both = MaterialRow {
                        hardening_table: Some(vec![[0.0, 100.0]]),
                        ..row(90.0, 2e5)
                    };
                    heated(s, &[row(20.0, 2e5), both]);
                },
                "over_temperature.0: 2 of hardening laws given (plastic_modulus, hardening_table)",
            ),
            (
                |s| {
                    heated(s, &[row(20.0, 2e5), row(90.0, 1e5)]);
                    s.bodies.get_mut("cylinder").unwrap().temperature = None;
                },
                "bodies.cylinder: the material \"steel\" depends on the temperature; give \
                 bodies.cylinder.temperature",
            ),
            (
                |s| heated(s, &[row(f64::NAN, 2e5)]),
                "materials.steel.over_temperature.0.temperature: NaN is not",
            ),
        ],
    );
}

macro_rules! steel {
    ($scene:ident) => {
        $scene.materials.get_mut("steel").unwrap()
    };
}

#[test]
fn elastic_constants_and_moduli() {
    refused(
        good,
        &[
            (
                |s| steel!(s).youngs_modulus = 0.0,
                "materials.steel.youngs_modulus: 0 must be",
            ),
            (
                |s| steel!(s).youngs_modulus = f64::NAN,
                "materials.steel.youngs_modulus: NaN is not",
            ),
            (
                |s| steel!(s).poissons_ratio = 0.5,
                "poissons_ratio: 0.5 must lie",
            ),
            (
                |s| steel!(s).poissons_ratio = -1.0,
                "poissons_ratio: -1 must lie",
            ),
            (
                |s| steel!(s).yield_stress = Some(-5.0),
                "yield_stress: -5 must be",
            ),
            (
                |s| steel!(s).yield_stress = None,
                "plastic_modulus: needs a yield_stress",
            ),
            (
                |s| steel!(s).plastic_modulus = Some(-1.0),
                "plastic_modulus: -1 must be at least 0",
            ),
            (
                |s| steel!(s).tangent_modulus = Some(1.0),
                "keep exactly one",
            ),
            (
                |s| {
                    steel!(s).plastic_modulus = None;
                    steel!(s).tangent_modulus = Some(210000.0);
                },
                "tangent_modulus: 210000 must be at least 0 and less than Young's modulus",
            ),
        ],
    );
}

#[test]
fn hardening_tables() {
    refused(
        good,
        &[
            (
                |s| {
                    steel!(s).plastic_modulus = None;
                    steel!(s).hardening_table = Some(vec![]);
                },
                "hardening_table: is empty",
            ),
            (
                |s| {
                    steel!(s).plastic_modulus = None;
                    steel!(s).hardening_table = Some(vec![[0.0, 499.0]]);
                },
                "hardening_table.0: [0, 499] must be [0, 500]",
            ),
            (
                |s| {
                    steel!(s).plastic_modulus = None;
                    steel!(s).hardening_table =
                        Some(vec![[0.0, 500.0], [0.1, 600.0], [0.1, 700.0]]);
                },
                "hardening_table.2: plastic strain 0.1 must be greater",
            ),
            (
                |s| {
                    steel!(s).plastic_modulus = None;
                    steel!(s).hardening_table = Some(vec![[0.0, 500.0], [0.1, 400.0]]);
                },
                "hardening_table.1: yield stress 400 is less than 500",
            ),
            (
                |s| {
                    steel!(s).plastic_modulus = None;
                    steel!(s).yield_stress = None;
                    steel!(s).hardening_table = Some(vec![[0.001, 500.0], [0.1, 600.0]]);
                },
                "hardening_table.0: plastic strain 0.001 must be 0",
            ),
        ],
    );
}

#[test]
fn tensile_tests() {
    refused(
        good,
        &[
            (
                |s| tested(s, None, &[[0.001, 300.0]]),
                "tensile_test: no row lies beyond yield",
            ),
            (
                |s| tested(s, None, &[[0.001, 210.0], [0.001, 220.0]]),
                "tensile_test.1: [0.001, 220]: strains must grow",
            ),
            (
                |s| tested(s, None, &[]),
                "tensile_test: no row lies beyond yield",
            ),
            (
                |s| tested(s, None, &[[0.0, 0.0], [0.001, 180.0], [0.01, 400.0]]),
                "tensile_test.1: [0.001, 180] lies below the line of Young's modulus (210000)",
            ),
            (
                |s| {
                    tested(
                        s,
                        Some(300.0),
                        &[[0.001, 180.0], [0.01, 400.0], [0.02, 390.0]],
                    )
                },
                "tensile_test.2: true stress 397.8 is less than 404 before it: beyond the largest",
            ),
            (
                |s| tested(s, Some(300.0), &[[0.1, 200.0], [1.0, 400.0]]),
                "tensile_test.0: [0.1, 200] lies before yield, on a line of 0.010 times Young's \
                 modulus (210000): are the strains in per cent?",
            ),
            (
                |s| tested(s, None, &[[0.001, 300.0], [0.01, 400.0]]),
                "tensile_test.0: [0.001, 300] lies before yield, on a line of 1.429 times",
            ),
            (
                |s| tested(s, Some(300.0), &[[0.01, 400.0], [0.0101, 500.0]]),
                "tensile_test.1: plastic strain 0.00764",
            ),
        ],
    );
}

#[test]
fn bodies() {
    refused(
        good,
        &[
            (
                |s| s.bodies.get_mut("cylinder").unwrap().material = "wood".into(),
                "bodies.cylinder.material: there is no material \"wood\"; known materials: steel",
            ),
            (
                |s| {
                    steel!(s).yield_stress = None;
                    s.bodies.get_mut("cylinder").unwrap().plastic = Plastic::Yes;
                },
                "bodies.cylinder.plastic: true, but the material \"steel\" has no yield stress",
            ),
            (|s| s.bodies.clear(), "the mesh has a body `cylinder`"),
            (
                |s| {
                    let body = s.bodies["cylinder"].clone();
                    s.bodies.insert("ball".into(), body);
                },
                "bodies.ball: the mesh has no such body, only cylinder, half_plane",
            ),
        ],
    );
}
