//! Numbers far apart: stiffness, shape, and gaps that are negative.

use crate::support::{self, close, healthy, largest, parse, run, run_file, state};
use brinell::ErrorKind;
use brinell::linalg::Backend;
use brinell::results::{Results, Status};

/// A penalty scaled with the stiffer body swamps the softer one, and an absolute pivot tolerance
/// drops it. A condensed stiffness in which the rigid motion of the stiff body has drowned in its
/// round-off carries part of the load: 1e-12 times the ratio. Here equilibrium does not know the
/// ratio: the bound is n eps = 1e-11 times the few digits that a graded mesh costs. The limit of a
/// rigid cylinder is approached in proportion to the ratio: p(e) = p(0) + e p' + O(e^2).
#[test]
fn a_stiffness_ratio_up_to_1e10_is_the_rigid_limit() {
    let forces = |modulus: &str| {
        let set = format!("materials.hard.youngs_modulus={modulus}");
        let results: Results = run_file("hard/stiffness_ratio", &[&set]);
        healthy(&results);
        let s = &results.states[0];
        close("force", s.contact_force, 500.0, 500.0, 1e-10);
        assert!(s.quality.equilibrium <= 1e-10, "{modulus}: {:?}", s.quality);
        s.pairs.iter().map(|p| p.force).collect::<Vec<_>>()
    };
    for modulus in ["2.1e5", "2.1e6", "2.1e7", "2.1e8", "2.1e15"] {
        forces(modulus);
    }
    let [coarse, fine, rigid] = ["2.1e9", "2.1e11", "2.1e13"].map(forces);
    let off = |v: &[f64]| largest(v.iter().zip(&rigid).map(|(a, b)| a - b));
    let expected = (1e-6 - 1e-8) / (1e-4 - 1e-8);
    // The term of second order is 1e-4 of that of first order; round-off 1e-12 against a difference
    // of 1e-6.
    close("rate", off(&fine) / off(&coarse), expected, expected, 1e-3);
}

/// Three bodies in a row, two of them floating, each stiffness in each place: the stiffer surface
/// may be the first or the second one of a contact, and what floats may be the stiffest, the
/// softest or in between. Each contact carries the whole load.
#[test]
fn stiffness_ratios_in_a_row_of_bodies_do_not_cost_equilibrium() {
    let moduli = [1.0, 1e8, 1e4];
    for order in [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ] {
        for swap in [false, true] {
            let results = run(&parse(&row_of_blocks(order.map(|i| moduli[i]), swap)));
            healthy(&results);
            let s = &results.states[0];
            for contact in 0..2 {
                let of_contact = s.pairs.iter().filter(|p| p.contact == contact);
                let sum: f64 = of_contact.map(|p| p.force).sum();
                close(&format!("{order:?} {swap} force"), sum, 20.0, 20.0, 1e-11);
            }
            assert!(s.quality.equilibrium <= 1e-11, "{order:?}: {:?}", s.quality);
        }
    }
}

/// Blocks of 2 by 1 on top of each other with gaps of 1e-3, 10 MPa on the top one; `swap` exchanges
/// the surfaces of both contacts.
fn row_of_blocks(moduli: [f64; 3], swap: bool) -> String {
    let mut text = String::from("kind = \"plane_strain\"\n");
    for (i, modulus) in moduli.iter().enumerate() {
        let (low, elements) = (1.001 * i as f64, [6, 3 + i]);
        text += &format!(
            "[[mesh.parts]]\nbody = \"b{i}\"\nblock = {{ x = [0.0, 2.0], y = [{low}, {}], elements \
             = [{}, {}] }}\n[materials.m{i}]\nyoungs_modulus = {modulus:e}\npoissons_ratio = \
             0.3\n[bodies.b{i}]\nmaterial = \"m{i}\"\n[[support]]\non = \"b{i}.left\"\nfix = \
             [\"x\"]\n",
            low + 1.0,
            elements[0],
            elements[1],
        );
    }
    for i in 0..2 {
        let (up, down) = (format!("b{}.bottom", i + 1), format!("b{i}.top"));
        let (first, second) = if swap { (down, up) } else { (up, down) };
        text += &format!("[[contact]]\nfirst = \"{first}\"\nsecond = \"{second}\"\n");
    }
    text + "[[support]]\non = \"b0.bottom\"\nfix = [\"y\"]\n[[load]]\non = \"b2.top\"\npressure = \
            10.0\n[program]\ntargets = [{ load_factor = 1.0 }]\n"
}

/// Coordinates over nine orders of magnitude, areas over eighteen: absolute tolerances for "the
/// same place", "touching" or "no force" fit at most one end. Closed form (Lame), for pin and plate
/// alike and one 1e4 times as stiff; the bound is that of the mesh, quadratic elements an eighth of
/// a right angle wide, whose pressure is of order h^2 (0.04) times a small constant. The fit is
/// uniform to round-off.
#[test]
fn bodies_a_millionth_and_a_thousand_long_in_one_scene() {
    let e = 210_000.0;
    for [pin, plate] in [[e, e], [e, 1e4 * e], [1e4 * e, e]] {
        let moduli = [
            format!("materials.pin.youngs_modulus={pin:?}"),
            format!("materials.plate.youngs_modulus={plate:?}"),
        ];
        let overrides = [&moduli[0], &moduli[1], "analysis.condition=true"];
        let results = run_file("hard/body_sizes", &overrides);
        assert!(results.inaccurate.is_empty(), "{:?}", results.inaccurate);
        let s = state(&results, "fitted");
        let exact = 1e-3 / ((5.0 / 3.0 - 0.3) / pin + 1.3 / plate);
        for p in &s.pairs {
            assert_eq!(p.status, brinell::results::Status::Closed);
            close("pressure", p.pressure, exact, exact, 0.01);
        }
        let q = &s.quality;
        assert!(q.equilibrium <= 1e-10 && q.adhesion <= 1e-10, "{q:?}");
        assert!(q.componentwise_error.unwrap() <= 1e-12, "{q:?}");
    }
}

/// The condition of the stiffness grows with the square of the aspect, 1e10: iterative solvers
/// stall and pivots look like zero. Uniform pressure is in the space of the elements: what is left
/// is round-off times that condition.
#[test]
fn slivers_pass_the_patch_test_to_round_off() {
    let results = run_file("hard/slivers", &[]);
    healthy(&results);
    for p in &results.states[0].pairs {
        assert_eq!(p.status, Status::Closed);
        close("pressure", p.pressure, 10.0, 10.0, f64::EPSILON * 1e10);
    }
}

/// Elements 1e6 times as wide as high, the condition grows to 1e12 and beyond: the solution is what
/// it was, the figures say what was lost, and both stay within what condition times round-off
/// allows.
#[test]
fn slivers_of_aspect_1e6_report_the_loss_of_accuracy() {
    let height = 0.002;
    let lower = format!("mesh.parts.0.block.y=[0.0,{height}]");
    let upper = format!("mesh.parts.1.block.y=[{height},{}]", 2.0 * height);
    let [flat, flatter] =
        [vec![], vec![lower.as_str(), upper.as_str()]].map(|set| run_file("hard/slivers", &set));
    for p in &flatter.states[0].pairs {
        close("pressure", p.pressure, 10.0, 10.0, f64::EPSILON * 1e12);
    }
    // The aspect is 10 times as large, stiffnesses along and across differ by its square.
    let grown = flatter.condition / flat.condition;
    assert!((30.0..300.0).contains(&grown), "{grown}");
    assert!(flatter.inaccurate.is_empty(), "{:?}", flatter.inaccurate);
    let q = flatter.states[0].quality;
    assert!(q.equilibrium <= f64::EPSILON * flatter.condition, "{q:?}");
}

/// A negative gap at no load: codes that start from "not penetrating" fail at once, others apply it
/// in one step and bounce. Tension q on the rim takes just q off the pressure, for the elements
/// too; the fit comes back.
#[test]
fn interference_is_lost_under_tension_and_comes_back() {
    let results = run_file("hard/interference", &[]);
    healthy(&results);
    let fitted = state(&results, "fitted");
    // Lame, 78.75 MPa; linear elements of 1/16 of the quarter circle: (pi/2/16)^2 = 1 %.
    close("fit", fitted.max_pressure, 78.75, 78.75, 0.01);
    for (a, b) in fitted.pairs.iter().zip(&state(&results, "looser").pairs) {
        close("looser", b.pressure, a.pressure - 40.0, 78.75, 0.01);
    }
    let loose = state(&results, "loose");
    assert!(
        loose
            .pairs
            .iter()
            .all(|p| p.status == Status::Open && p.gap > 0.0)
    );
    crate::support::same_contact(
        "fitted again",
        fitted,
        state(&results, "fitted again"),
        1e-10,
    );
}

/// A row of elements of the shape hex20 deforms in ways that no Gauss point sees: what is missing
/// there is no support against a rigid motion, and is not called that. Two elements across have no
/// such way.
#[test]
fn modes_without_energy_are_named() {
    let row = |n: usize| {
        let text = format!(
            "kind = \"solid\"\nbodies.b.material = \"m\"\n\
             mesh.parts = [{{ body = \"b\", element = \"hex20\", brick = {{ x = [0, 10], \
             y = [0, 1], z = [0, 1], elements = [10, {n}, {n}] }} }}]\n\
             support = [{{ on = \"b.left\", fix = [\"x\", \"y\", \"z\"] }}]\n\
             load = [{{ on = \"b.right\", traction = [0.0, 0.0, 1.0] }}]\n\
             [materials.m]\nyoungs_modulus = 200000.0\npoissons_ratio = 0.3\n\
             [program]\ntargets = [{{ load_factor = 1.0 }}]\n"
        );
        support::try_run(&parse(&text), Backend::default())
    };
    let error = row(1).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unheld);
    assert!(
        error
            .message()
            .contains("of the shape hex20 have deformations without stiffness"),
        "{error}"
    );
    // Bernoulli's beam; shear adds (h/L)^2 = 1 %.
    let bent = row(2).unwrap();
    let fields = bent.states[0].fields.as_ref().unwrap();
    close(
        "tip",
        largest(fields.displacement.iter().copied()),
        0.02,
        0.02,
        0.02,
    );
}
