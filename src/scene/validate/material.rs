//! Validation of materials and bodies.

use super::problems::{LARGEST, Problems};
use crate::number::exact;
use crate::scene::spelling::closest;
use crate::scene::{Body, Material, Plastic, Scene, beyond_yield, materials};
use crate::space::Space;

/// Ratios of a tensile test's initial modulus to Young's modulus beyond which the test cannot
/// belong to the material: extensometers show moduli to some per cent (ISO 6892-1:2019, annex G),
/// rows close to yield have left the elastic line, strains in per cent are a factor of 100 off.
const STIFFER: f64 = 1.2;
const SOFTER: f64 = 0.1;

pub(super) fn check(problems: &mut Problems, scene: &Scene) {
    for (name, material) in &scene.materials {
        let key = format!("materials.{name}");
        let n_before = problems.number();
        check_material(problems, &key, material);
        if problems.number() == n_before {
            check_over_temperature(problems, &format!("{key}.over_temperature"), material);
        }
    }
    problems.require(
        !scene.bodies.is_empty(),
        "bodies",
        "is empty; name each body of the mesh with its material",
    );
    for (name, body) in &scene.bodies {
        check_yield_by_depth(problems, name, body, scene);
        check_initial_state(problems, &format!("bodies.{name}"), body, scene.kind);
        match scene.material_of(name) {
            None => {
                let known: Vec<&str> = scene.materials.keys().map(String::as_str).collect();
                let listed = materials().iter().map(|(name, _)| name.as_str());
                let all: Vec<&str> = known.iter().copied().chain(listed).collect();
                let meant = match closest(&body.material, &all) {
                    Some(close) => format!(", did you mean \"{close}\"? Known"),
                    None => "; known".to_string(),
                };
                let wrong = format!("there is no material \"{}\"", body.material);
                problems.problem(
                    format!("bodies.{name}.material"),
                    format!(
                        "{wrong}{meant} materials: {}; `brinell materials` lists more",
                        known.join(", ")
                    ),
                );
            }
            Some(material) => {
                problems.require(
                    body.plastic != Plastic::Yes || material.first_yield_stress().is_some(),
                    format!("bodies.{name}.plastic"),
                    format!(
                        "true, but the material \"{0}\" has no yield stress; \
                         give materials.{0}.yield_stress",
                        body.material
                    ),
                );
                problems.require(
                    body.temperature.is_some() || material.over_temperature.is_empty(),
                    format!("bodies.{name}"),
                    format!(
                        "the material \"{}\" depends on the temperature; give \
                         bodies.{name}.temperature",
                        body.material
                    ),
                );
            }
        }
    }
}

/// Checks rows of properties by temperature, and the material at the temperature of each row.
fn check_over_temperature(problems: &mut Problems, key: &str, material: &Material) {
    let rows = &material.over_temperature;
    for (index, row) in rows.iter().enumerate() {
        let key = format!("{key}.{index}");
        if let Some(before) = index.checked_sub(1).map(|before| &rows[before]) {
            let temperatures = [before.temperature, row.temperature];
            problems.grows(&format!("{key}.temperature"), "", temperatures);
        }
        problems.require(
            !row.is_empty(),
            key.as_str(),
            "gives only a temperature; add the properties at this temperature",
        );
        check_material(problems, &key, &material.at(row.temperature));
    }
}

fn check_yield_by_depth(problems: &mut Problems, name: &str, body: &Body, scene: &Scene) {
    let key = format!("bodies.{name}");
    let Some(rows) = &body.yield_by_depth else {
        let asked = [&body.initial_stress, &body.initial_plastic_strain];
        problems.require(
            body.depth_from.is_none() || asked.iter().any(|rows| rows.is_some()),
            format!("{key}.depth_from"),
            "without yield_by_depth, initial_stress or initial_plastic_strain there are no \
             depths that could count from it",
        );
        return;
    };
    let key = format!("{key}.yield_by_depth");
    let material = scene.material_of(name);
    problems.require(
        material.is_none_or(|material| material.first_yield_stress().is_some()),
        key.as_str(),
        format!(
            "the material \"{0}\" has no yield stress; give materials.{0}.yield_stress, from \
             which its hardening counts",
            body.material
        ),
    );
    problems.require(
        !rows.is_empty(),
        key.as_str(),
        "is empty; give rows of [depth, yield stress]",
    );
    for (index, [depth, yield_stress]) in rows.iter().enumerate() {
        let key = format!("{key}.{index}");
        let before = index.checked_sub(1).map(|before| rows[before][0]);
        check_depth(problems, &key, *depth, before);
        problems.stress(key, *yield_stress);
    }
}

/// Checks a depth, which must exceed the depth of the row before.
fn check_depth(problems: &mut Problems, key: &str, depth: f64, before: Option<f64>) {
    problems.require(
        depth >= 0.0,
        key,
        format!("depth {} must be at least 0", exact(depth)),
    );
    if let Some(before) = before {
        problems.grows(key, "depth ", [before, depth]);
    }
}

/// Checks initial stresses and plastic strains: rows of a depth and the components of a tensor.
fn check_initial_state(problems: &mut Problems, key: &str, body: &Body, kind: Space) {
    for (name, rows) in body.brought_along() {
        let key = format!("{key}.{name}");
        let (lengths, form) = match kind {
            Space::Solid => ([4, 7], "[depth, xx, yy, zz] or with xy, yz, zx after them"),
            _ => ([4, 5], "[depth, xx, yy, zz] or with xy after them"),
        };
        problems.require(
            !rows.is_empty(),
            key.as_str(),
            format!("is empty; give rows of {form}"),
        );
        let mut before = None;
        for (index, row) in rows.iter().enumerate() {
            let key = format!("{key}.{index}");
            if !lengths.contains(&row.len()) {
                problems.problem(
                    key,
                    format!("has {} numbers; give rows of {form}", row.len()),
                );
                continue;
            }
            check_depth(problems, &key, row[0], before);
            before = Some(row[0]);
            problems.require(
                row[1..].iter().all(|value| value.abs() <= LARGEST),
                key.as_str(),
                format!("a component is beyond {LARGEST:e}: it would overflow"),
            );
            problems.require(
                name != "initial_stress" || kind != Space::PlaneStress || row[3] == 0.0,
                key,
                format!("zz {} must be 0 in plane stress", exact(row[3])),
            );
        }
    }
}

fn check_material(problems: &mut Problems, key: &str, material: &Material) {
    problems.stress(format!("{key}.youngs_modulus"), material.youngs_modulus);
    let nu = material.poissons_ratio;
    problems.must(
        nu > -1.0 && nu < 0.5,
        format!("{key}.poissons_ratio"),
        nu,
        "lie between -1 and 0.5, ends excluded",
    );
    if let Some(density) = material.density {
        problems.must(
            density > 0.0,
            format!("{key}.density"),
            density,
            "be greater than 0",
        );
    }
    let hardening = [
        ("plastic_modulus", material.plastic_modulus.is_some()),
        ("tangent_modulus", material.tangent_modulus.is_some()),
        ("hardening_table", material.hardening_table.is_some()),
        ("tensile_test", material.tensile_test.is_some()),
    ];
    let given: Vec<&str> = hardening.iter().filter(|h| h.1).map(|h| h.0).collect();
    if given.len() > 1 {
        problems.exactly_one(key, "hardening laws", &hardening);
    }
    check_kinematic_hardening(problems, key, material);
    let linear = material.kinematic_modulus.map(|_| "kinematic_modulus");
    let kinematic = linear.or(material.back_stresses.as_ref().map(|_| "back_stresses"));
    if let Some(yield_stress) = material.yield_stress {
        problems.stress(format!("{key}.yield_stress"), yield_stress);
    }
    if let Some(table) = &material.hardening_table {
        check_hardening_table(
            problems,
            &format!("{key}.hardening_table"),
            table,
            material.yield_stress,
        );
        return;
    }
    if let Some(test) = &material.tensile_test {
        check_tensile_test(problems, &format!("{key}.tensile_test"), test, material);
        return;
    }
    if material.yield_stress.is_none() {
        if let Some(law) = given.first().copied().or(kinematic) {
            problems.problem(
                format!("{key}.{law}"),
                "needs a yield_stress beside it; without one the material is elastic",
            );
        }
        return;
    }
    check_linear_hardening(problems, key, material);
}

fn check_kinematic_hardening(problems: &mut Problems, key: &str, material: &Material) {
    if let Some(modulus) = material.kinematic_modulus {
        let key = format!("{key}.kinematic_modulus");
        problems.at_least(key.as_str(), modulus, 0.0);
        problems.slope(key, "the modulus", modulus);
    }
    if let Some(rows) = &material.back_stresses {
        check_back_stresses(problems, &format!("{key}.back_stresses"), rows);
    }
}

/// Checks linear isotropic hardening, by the slope against plastic or against total strain.
fn check_linear_hardening(problems: &mut Problems, key: &str, material: &Material) {
    if let Some(modulus) = material.plastic_modulus {
        let key = format!("{key}.plastic_modulus");
        problems.at_least(key.as_str(), modulus, 0.0);
        problems.slope(key, "the slope", modulus);
    }
    if let Some(tangent) = material.tangent_modulus {
        problems.require(
            tangent >= 0.0 && tangent < material.youngs_modulus,
            format!("{key}.tangent_modulus"),
            format!(
                "{} must be at least 0 and less than Young's modulus ({})",
                exact(tangent),
                exact(material.youngs_modulus)
            ),
        );
        let slope = material.youngs_modulus * tangent / (material.youngs_modulus - tangent);
        if tangent >= 0.0 && tangent < material.youngs_modulus {
            problems.slope(
                format!("{key}.tangent_modulus"),
                "the slope against plastic strain",
                slope,
            );
        }
    }
}

fn check_back_stresses(problems: &mut Problems, key: &str, rows: &[[f64; 2]]) {
    problems.require(
        !rows.is_empty(),
        key,
        "is empty; give rows of [modulus C, rate gamma]",
    );
    for (index, [modulus, rate]) in rows.iter().enumerate() {
        let key = format!("{key}.{index}");
        problems.require(
            *modulus >= 0.0 && *rate >= 0.0,
            key.as_str(),
            format!(
                "[{}, {}]: modulus C and rate gamma must be at least 0",
                exact(*modulus),
                exact(*rate)
            ),
        );
        problems.require(
            *modulus != 0.0 || *rate == 0.0,
            key.as_str(),
            format!(
                "[0, {}] is a rate gamma without a modulus C: there is nothing that could fade",
                exact(*rate)
            ),
        );
        problems.slope(key.as_str(), "the modulus", *modulus);
        problems.slope(key, "the rate", *rate);
    }
}

fn check_hardening_table(
    problems: &mut Problems,
    key: &str,
    table: &[[f64; 2]],
    yield_stress: Option<f64>,
) {
    let Some(&[strain, stress]) = table.first() else {
        problems.problem(key, "is empty; give rows of [plastic strain, yield stress]");
        return;
    };
    let first = format!("{key}.0");
    match yield_stress {
        Some(yield_stress) => problems.require(
            strain == 0.0 && stress == yield_stress,
            first,
            format!(
                "[{}, {}] must be [0, {}]: plastic strain 0, yield_stress (which may be left \
                 out)",
                exact(strain),
                exact(stress),
                exact(yield_stress)
            ),
        ),
        None => {
            problems.require(
                strain == 0.0,
                first.as_str(),
                format!(
                    "plastic strain {} must be 0: there it yields",
                    exact(strain)
                ),
            );
            problems.stress(first, stress);
        }
    }
    for (index, pair) in table.windows(2).enumerate() {
        let ([strain0, stress0], [strain1, stress1]) = (pair[0], pair[1]);
        let key = format!("{key}.{}", index + 1);
        problems.grows(&key, "plastic strain ", [strain0, strain1]);
        problems.require(
            stress1 >= stress0,
            key.as_str(),
            format!(
                "yield stress {} is less than {} of the row before: softening has no unique \
                 solution",
                exact(stress1),
                exact(stress0)
            ),
        );
        problems.slope_between(&key, [pair[0], pair[1]]);
    }
}

/// Checks a tensile test in rows of engineering strain and stress, and the hardening curve that
/// it gives.
fn check_tensile_test(problems: &mut Problems, key: &str, test: &[[f64; 2]], material: &Material) {
    for (index, &[strain, stress]) in test.iter().enumerate() {
        let before = index
            .checked_sub(1)
            .map_or(f64::NEG_INFINITY, |i| test[i][0]);
        problems.require(
            strain >= 0.0 && stress >= 0.0 && strain > before,
            format!("{key}.{index}"),
            format!(
                "[{}, {}]: strains must grow from row to row, strains and stresses be at \
                 least 0",
                exact(strain),
                exact(stress)
            ),
        );
    }
    let rows = beyond_yield(test, material.youngs_modulus, material.yield_stress);
    let n_elastic = rows.first().map_or(test.len(), |first| first.row);
    check_elastic_line(problems, key, &test[..n_elastic], material.youngs_modulus);
    let Some(first) = rows.first() else {
        problems.problem(
            key,
            "no row lies beyond yield; give rows of [engineering strain, engineering stress] \
             up to the largest load",
        );
        return;
    };
    let curve = material.hardening_curve().unwrap_or_default();
    // A row at zero strain measures no point of the elastic line.
    let begins = material.yield_stress.or_else(|| Some(curve.first()?[1]));
    if !begins.is_some_and(|stress| stress > 0.0) {
        problems.problem(
            format!("{key}.{}", first.row),
            format!(
                "[{}, {}] lies below the line of Young's modulus ({}) and no row before it \
                 on it: where does the material yield? Give a yield_stress, from which on \
                 rows count, or correct the strains",
                exact(test[first.row][0]),
                exact(test[first.row][1]),
                exact(material.youngs_modulus)
            ),
        );
        return;
    }
    for (pair, row) in curve.windows(2).zip(&rows) {
        check_rising(problems, &format!("{key}.{}", row.row), pair);
    }
}

/// Compares the last row before yield, which shows the modulus best, with Young's modulus.
fn check_elastic_line(problems: &mut Problems, key: &str, rows: &[[f64; 2]], youngs_modulus: f64) {
    let Some(&[strain, stress]) = rows.last().filter(|row| row[0] > 0.0) else {
        return;
    };
    let ratio = stress / strain / youngs_modulus;
    let (cause, holds) = match ratio > 1.0 {
        true => (
            "is Young's modulus in the unit of the stresses?",
            ratio < STIFFER,
        ),
        false => ("are the strains in per cent?", ratio > SOFTER),
    };
    problems.require(
        holds,
        format!("{key}.{}", rows.len() - 1),
        format!(
            "[{}, {}] lies before yield, on a line of {ratio:.3} times Young's modulus ({}): \
             {cause}",
            exact(strain),
            exact(stress),
            exact(youngs_modulus)
        ),
    );
}

/// Checks that a curve of true stress over plastic strain rises from one point to the next.
fn check_rising(problems: &mut Problems, key: &str, pair: &[[f64; 2]]) {
    let ([strain0, stress0], [strain1, stress1]) = (pair[0], pair[1]);
    problems.require(
        stress1 >= stress0,
        key,
        format!(
            "true stress {} is less than {} before it: beyond the largest load the bar necks, \
             leave these rows out",
            exact(stress1),
            exact(stress0)
        ),
    );
    problems.require(
        strain1 > strain0,
        key,
        format!(
            "plastic strain {} is not greater than {} before it: the stress grows as on the \
             line of Young's modulus, or faster",
            exact(strain1),
            exact(strain0)
        ),
    );
    problems.slope_between(key, [pair[0], pair[1]]);
}
