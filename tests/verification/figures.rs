//! What is read off states and history, on bodies in uniaxial stress: every figure has a formula.
//!
//! Source: equilibrium and Hooke's law, plane stress without lateral restraint.

use crate::support::{parse, run, run_text};
use crate::verification::close;
use brinell::model::Model;

const E: f64 = 210_000.0;

/// Columns of blocks of width `w` and height 1, each on top of one another: `(x, w)` of each
/// column.
fn columns(columns: &[(f64, f64)], yields: bool) -> String {
    let mut text = String::from("kind = \"plane_stress\"\n");
    for (i, (x, w)) in columns.iter().enumerate() {
        for (body, y) in [("lower", 0.0), ("upper", 1.0)] {
            text += &format!(
                "[[mesh.parts]]\nbody = \"{body}{i}\"\n\
                 block = {{ x = [{x:?}, {:?}], y = [{y:?}, {:?}], elements = [4, 2] }}\n",
                x + w,
                y + 1.0
            );
        }
    }
    text += &format!(
        "[materials.steel]\nyoungs_modulus = {E:?}\npoissons_ratio = 0.3\n{}",
        if yields {
            "yield_stress = 100.0\nplastic_modulus = 20000.0\n"
        } else {
            ""
        }
    );
    for i in 0..columns.len() {
        for body in ["lower", "upper"] {
            text += &format!(
                "[bodies.{body}{i}]\nmaterial = \"steel\"\n\
                 [[support]]\non = \"{body}{i}.left\"\nfix = [\"x\"]\n"
            );
        }
        text += &format!("[[support]]\non = \"lower{i}.bottom\"\nfix = [\"y\"]\n");
    }
    text
}

fn contact(i: usize) -> String {
    format!("[[contact]]\nfirst = \"upper{i}.bottom\"\nsecond = \"lower{i}.top\"\n")
}

fn press(i: usize, pressure: f64) -> String {
    format!("[[load]]\nname = \"press{i}\"\non = \"upper{i}.top\"\npressure = {pressure:?}\n")
}

fn program(load_factor: f64) -> String {
    format!("[program]\ntargets = [{{ name = \"end\", load_factor = {load_factor:?} }}]\n")
}

/// Half a model: the forces of state and history are those of the whole, 2 x 10 x 2.
#[test]
fn forces_of_history_and_state_are_those_of_the_whole() {
    let text = format!(
        "symmetry = 2\n{}{}{}{}",
        columns(&[(0.0, 2.0)], false),
        contact(0),
        press(0, 10.0),
        program(1.0)
    );
    let results = run_text(&text);
    close(results.states[0].contact_force, 40.0, 1e-10);
    close(results.history.last().unwrap().contact_force, 40.0, 1e-10);
}

/// Two contacts: 10 over a width of 4 carries more than 30 over 1. Half width and pole pressure are
/// those of the patch that carries most, whichever contact comes first; the largest pressure is
/// that of all.
#[test]
fn the_largest_patch_is_the_one_that_carries_most() {
    let [wide, narrow] = [(0.0, 4.0, 10.0), (10.0, 1.0, 30.0)];
    for order in [[wide, narrow], [narrow, wide]] {
        let mut text = columns(&order.map(|(x, w, _)| (x, w)), false);
        for (i, (_, _, pressure)) in order.into_iter().enumerate() {
            text += &(contact(i) + &press(i, pressure));
        }
        let state = &run_text(&(text + &program(1.0))).states[0];
        // The left sides are held as planes of symmetry are: the width is half of the whole's.
        close(state.half_width, 4.0, 1e-10);
        close(state.pole_pressure, 10.0, 1e-10);
        close(state.max_pressure, 30.0, 1e-10);
    }
}

/// An interference of twice what the blocks take elastically: it comes on as a load does, so first
/// yield is met on the way at the yield stress, and the end is that of the hardening law, `d = 2 h
/// (s / E + (s - s_y) / H)`.
#[test]
fn interference_comes_on_step_by_step() {
    let (yield_stress, hardening) = (100.0, 20_000.0);
    let interference = 4.0 * yield_stress / E;
    let text = format!(
        "{}{}interference = {interference:?}\n[[support]]\non = \"upper0.top\"\nfix = [\"y\"]\n{}",
        columns(&[(0.0, 1.0)], true),
        contact(0),
        program(0.0)
    );
    let results = run_text(&text);
    let first = results.first_yield.expect("yields");
    // First yield is an event of the elastic path, found to `analysis.gamma` at worst.
    close(first.max_pressure, yield_stress, 1e-6);
    let end = (0.5 * interference + yield_stress / hardening) / (1.0 / E + 1.0 / hardening);
    close(results.states[0].max_pressure, end, 1e-6);
    // Both blocks flow, in both halves of what the model is the half of.
    let doubled = run_text(&format!("symmetry = 2\n{text}"));
    close(doubled.states[0].plastic_zone_size, 2.0 * 2.0, 1e-12);
}

/// A block that is pulled with a negative factor is pressed: sizes of loads have no sign, whatever
/// their factors.
#[test]
fn the_size_of_a_load_has_no_sign() {
    let block = "kind = \"plane_stress\"\n\
        [[mesh.parts]]\nbody = \"b\"\n\
        block = { x = [0.0, 3.0], y = [0.0, 2.0], elements = [2, 2] }\n\
        [materials.steel]\nyoungs_modulus = 210000.0\npoissons_ratio = 0.3\n\
        [bodies.b]\nmaterial = \"steel\"\n[[support]]\non = \"b.left\"\nfix = [\"x\"]\n\
        [[support]]\non = \"b.bottom\"\nfix = [\"y\"]\n";
    for factor in [2.0, -2.0] {
        let pressed = format!(
            "{block}[[load]]\non = \"b.top\"\npressure = 10.0\n{}",
            program(factor)
        );
        close(run_text(&pressed).states[0].load, 20.0, 1e-12);
        // The reaction along the displacement: E d / h over the width, which pulls what it moves.
        let moved = format!(
            "{block}[[load]]\non = \"b.top\"\ndisplacement = {{ y = 0.001 }}\n{}",
            program(factor)
        );
        let force = E * (2.0 * 0.001) / 2.0 * 3.0;
        close(run_text(&moved).states[0].load, force, 1e-10);
    }
}

/// The approach is the mean over the loaded surface, by length: on a graded mesh the trapezoidal
/// rule of the nodes' displacements.
#[test]
fn the_approach_is_a_mean_by_length() {
    let text = format!(
        "kind = \"plane_stress\"\n[[mesh.parts]]\nbody = \"b\"\n\
         block = {{ x = [0.0, 4.0], y = [0.0, 1.0], elements = [6, 3], bias = [5.0, 1.0], \
         pieces = [{{ name = \"foot\", side = \"bottom\", from = 0.0, to = 1.0 }}] }}\n\
         [materials.steel]\nyoungs_modulus = {E:?}\npoissons_ratio = 0.3\n\
         [bodies.b]\nmaterial = \"steel\"\n[[support]]\non = \"b.left\"\nfix = [\"x\"]\n\
         [[support]]\non = \"b.foot\"\nfix = [\"y\"]\n\
         [[load]]\non = \"b.top\"\npressure = 10.0\n{}",
        program(1.0)
    );
    let scene = parse(&text);
    let state = &run(&scene).states[0];
    let mesh = Model::new(&scene).unwrap().continuum.mesh;
    let fields = state.fields.as_ref().unwrap();
    let top = (0..mesh.n_nodes()).filter(|&n| mesh.point(n)[1] == 1.0);
    let mut top: Vec<[f64; 2]> = top
        .map(|n| [mesh.point(n)[0], -fields.displacement[2 * n + 1]])
        .collect();
    top.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let area = |w: &[[f64; 2]]| 0.5 * (w[1][0] - w[0][0]) * (w[0][1] + w[1][1]);
    let mean = top.windows(2).map(area).sum::<f64>() / 4.0;
    let plain = top.iter().map(|p| p[1]).sum::<f64>() / top.len() as f64;
    assert!((mean - plain).abs() > 0.01 * mean.abs());
    close(state.approach, mean, 1e-12);
}

/// A contact normal that is not at right angles with an inclined support is turned until it is:
/// contact and support then hold different freedoms.
#[test]
fn contact_normals_are_turned_into_inclined_supports() {
    let angle = 10.0f64;
    let text = format!(
        "{}{}{}{}",
        columns(&[(0.0, 1.0)], false).replace("\nfix = ", "\nangle = 10.0\nfix = "),
        contact(0),
        press(0, 10.0),
        program(1.0)
    );
    let model = Model::new(&parse(&text)).unwrap();
    let turned = [-angle.to_radians().sin(), angle.to_radians().cos()];
    let mut corners = 0;
    for pair in &model.pairs {
        let at_left = model.mesh.point(pair.slave)[0] == 0.0;
        corners += usize::from(at_left);
        let expected = if at_left { turned } else { [0.0, 1.0] };
        for d in 0..2 {
            assert!(
                (pair.normal[d] - expected[d]).abs() <= 4.0 * f64::EPSILON,
                "{pair:?}"
            );
        }
    }
    assert_eq!(corners, 1);
}
