//! One element under back stresses that fade: cycles of tension in every kind of model, ratchetting
//! at its rate, and tension with shear in turns.
//!
//! Sources: P. J. Armstrong and C. O. Frederick (1966), doi:10.3184/096034007X207589, integrated
//! exactly in one dimension; code_aster, test SSNP14 (V6.03.014), modelling A: a plate under
//! traction and shear with linear kinematic hardening, values of astest/ssnp14a.comm.

use crate::support::{run_model, run_text};
use crate::verification::close;
use brinell::linalg::Backend;
use brinell::mesh::Shape;
use brinell::model::ModelBuilder;
use brinell::scene::Kind;

const E: f64 = 200_000.0;
const Y: f64 = 200.0;
/// Isotropic, then rows of modulus and rate.
const H: f64 = 5000.0;
const BACK: [[f64; 2]; 3] = [[60_000.0, 300.0], [20_000.0, 0.0], [30_000.0, 1500.0]];

/// A bar of isotropic hardening `H` and any back stresses.
struct Bar<'l> {
    isotropic: f64,
    laws: &'l [[f64; 2]],
    plastic: f64,
    equivalent: f64,
    back: Vec<f64>,
}

impl<'l> Bar<'l> {
    fn new(isotropic: f64, laws: &'l [[f64; 2]]) -> Self {
        Bar {
            isotropic,
            laws,
            plastic: 0.0,
            equivalent: 0.0,
            back: vec![0.0; laws.len()],
        }
    }

    /// Back stresses after plastic strain `flow` in one direction: the exact integral.
    fn back_after(&self, flow: f64) -> Vec<f64> {
        let each = self.back.iter().zip(self.laws);
        each.map(|(back, [modulus, rate])| {
            if *rate == 0.0 {
                return back + modulus * flow;
            }
            let end = flow.signum() * modulus / rate;
            end + (back - end) * (-rate * flow.abs()).exp()
        })
        .collect()
    }

    /// Flows until `excess` of the stress after a plastic strain vanishes.
    fn flow(&mut self, sign: f64, excess: impl Fn(f64, f64) -> f64) -> f64 {
        let stress = |flow: f64| {
            let size = Y + self.isotropic * (self.equivalent + flow.abs());
            sign * size + self.back_after(flow).iter().sum::<f64>()
        };
        let (mut low, mut high) = (0.0, 0.2);
        if sign * excess(0.0, stress(sign * f64::MIN_POSITIVE)) >= 0.0 {
            return self.plastic;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            match sign * excess(sign * middle, stress(sign * middle)) < 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        let flow = sign * 0.5 * (low + high);
        self.back = self.back_after(flow);
        self.plastic += flow;
        self.equivalent += flow.abs();
        self.plastic
    }

    /// Stress at a total strain.
    fn strain_to(&mut self, strain: f64) -> f64 {
        let before = self.plastic;
        for sign in [1.0, -1.0] {
            let excess = |flow: f64, stress: f64| stress - E * (strain - before - flow);
            if self.flow(sign, excess) != before {
                break;
            }
        }
        E * (strain - self.plastic)
    }
}

/// One element in each kind of model, pulled along its last axis.
const KINDS: [(&str, &str); 3] = [
    ("plane_stress", PLANE),
    ("axisymmetric", PLANE),
    ("solid", SOLID),
];
const PLANE: &str = r#"
mesh.parts = [{ body = "bar", block = { x = [0.0, 1.0], y = [0.0, 1.0], elements = [1, 1] } }]
support = [{ on = "bar.left", fix = ["x"] }, { on = "bar.bottom", fix = ["y"] }]
"#;
const SOLID: &str = r#"
support = [
    { on = "bar.left", fix = ["x"] },
    { on = "bar.front", fix = ["y"] },
    { on = "bar.bottom", fix = ["z"] },
]
[[mesh.parts]]
body = "bar"
[mesh.parts.brick]
x = [0.0, 1.0]
y = [0.0, 1.0]
z = [0.0, 1.0]
elements = [1, 1, 1]
"#;

fn targets(factors: &[f64]) -> String {
    let each = factors.iter().map(|s| format!("{{load_factor={s:?}}}"));
    each.collect::<Vec<_>>().join(",")
}

/// Reversed straining, a target at each turn: one increment each, as exact as many.
#[test]
fn cycles_follow_the_exact_integral() {
    let strains = [0.0008, 0.006, -0.004, 0.008, 0.0045, -0.01, 0.01];
    for (kind, geometry) in KINDS {
        for laws in [&BACK[..1], &BACK[..]] {
            let axis = if kind == "solid" { "z" } else { "y" };
            let text = format!(
                r#"
kind = "{kind}"
load = [{{ on = "bar.top", displacement = {{ {axis} = 1.0 }} }}]
{geometry}
[materials.metal]
youngs_modulus = {E:?}
poissons_ratio = 0.3
yield_stress = {Y:?}
plastic_modulus = {H:?}
back_stresses = {laws:?}
[bodies.bar]
material = "metal"
[program]
targets = [{}]
"#,
                targets(&strains)
            );
            let results = run_text(&text);
            let mut bar = Bar::new(H, laws);
            for (state, strain) in results.states.iter().zip(strains) {
                let exact = bar.strain_to(strain);
                let stress = &state.fields.as_ref().unwrap().stress;
                let axial = stress[if kind == "solid" { 2 } else { 1 }];
                // Equilibrium is found to 1e-10 of the force.
                assert!(
                    (axial - exact).abs() <= 1e-8 * Y,
                    "{kind} {}: {axial} {exact}",
                    state.name
                );
                assert!(stress[0].abs() <= 1e-8 * Y);
                let equivalent = state.max_equivalent_plastic_strain;
                assert!((equivalent - bar.equivalent).abs() <= 1e-12, "{equivalent}");
            }
            assert!(bar.equivalent > 0.04);
        }
    }
}

/// Stress between two ends about a mean stress: in each cycle the strain grows by
/// `1/gamma log(((C/gamma)^2 - (low + Y)^2)/((C/gamma)^2 - (high - Y)^2))`.
#[test]
fn ratchetting_has_its_rate() {
    let ([c, gamma], high, low) = ([60_000.0, 300.0], 360.0, -280.0);
    let limit: f64 = c / gamma;
    let open = |stress: f64| limit * limit - stress * stress;
    let rate = (open(low + Y) / open(high - Y)).ln() / gamma;
    for (kind, geometry) in KINDS {
        let traction = if kind == "solid" {
            "[0.0, 0.0, 1.0]"
        } else {
            "[0.0, 1.0]"
        };
        let text = format!(
            r#"
kind = "{kind}"
load = [{{ on = "bar.top", traction = {traction} }}]
{geometry}
[materials.metal]
youngs_modulus = {E:?}
poissons_ratio = 0.3
yield_stress = {Y:?}
back_stresses = [[{c:?}, {gamma:?}]]
[bodies.bar]
material = "metal"
[program]
targets = [{}]
"#,
            targets(&[high, low].repeat(6))
        );
        let results = run_text(&text);
        let strain = |state: &brinell::results::State| {
            let u = &state.fields.as_ref().unwrap().displacement;
            u.iter().fold(f64::NEG_INFINITY, |m, u| m.max(*u))
        };
        let highs: Vec<f64> = results.states.iter().step_by(2).map(strain).collect();
        for pair in highs.windows(2).skip(1) {
            close(pair[1] - pair[0], rate, 1e-6);
        }
    }
}

/// A unit square or cube under traction along x and shear; histories of both.
fn plate(kind: Kind, material: &str, [sigma, tau]: [&str; 2], steps: usize) -> Vec<[f64; 2]> {
    let solid = kind == Kind::Solid;
    let mut builder = ModelBuilder::new(kind);
    let corners: &[[f64; 2]] = &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    // Nodes of a side of the square, on both faces of the cube.
    let side = |nodes: [usize; 2]| -> Vec<usize> {
        let behind = nodes.map(|n| n + 4);
        nodes
            .into_iter()
            .chain(behind.into_iter().filter(|_| solid))
            .collect()
    };
    let faces: &[f64] = if solid { &[0.0, 1.0] } else { &[0.0] };
    let coordinates: Vec<f64> = (faces.iter())
        .flat_map(|z| corners.iter().flat_map(move |[x, y]| [*x, *y, *z]))
        .enumerate()
        .filter(|(i, _)| solid || i % 3 < 2)
        .map(|(_, x)| x)
        .collect();
    let shape = if solid { Shape::Hex8 } else { Shape::Quad4 };
    let nodes: Vec<usize> = (0..coordinates.len() / if solid { 3 } else { 2 }).collect();
    builder.nodes(&coordinates).unwrap();
    builder.elements(shape, "plate", &nodes).unwrap();
    for (name, nodes) in [
        ("left", [0, 3]),
        ("right", [1, 2]),
        ("top", [2, 3]),
        ("bottom", [0, 1]),
    ] {
        builder.surface_of_nodes(name, &side(nodes)).unwrap();
    }
    builder
        .node_set("corner", &side([0, 0])[..if solid { 3 } else { 1 }])
        .unwrap();
    builder.node_set("origin", &[0]).unwrap();
    let (z, front) = if solid {
        (
            ", 0.0",
            r#"{ on = "origin", fix = ["z"] }, { on = "front", fix = ["z"] },"#,
        )
    } else {
        ("", "")
    };
    if solid {
        builder.surface_of_nodes("front", &[0, 1, 2, 3]).unwrap();
    }
    let text = format!(
        r#"
load = [
    {{ on = "right", traction = [1.0, 0.0{z}], history = {sigma} }},
    {{ on = "right", traction = [0.0, 1.0{z}], history = {tau} }},
    {{ on = "left", traction = [0.0, -1.0{z}], history = {tau} }},
    {{ on = "top", traction = [1.0, 0.0{z}], history = {tau} }},
    {{ on = "bottom", traction = [-1.0, 0.0{z}], history = {tau} }},
]
support = [{front} {{ on = "left", fix = ["x"] }}, {{ on = "corner", fix = ["y"] }}]
[materials.metal]
youngs_modulus = 195000.0
poissons_ratio = 0.3
yield_stress = 181.0
{material}
[bodies.plate]
material = "metal"
[program]
stepping = "steps"
steps = {steps}
targets = [{{ load_factor = 1.0 }}, {{ load_factor = 2.0 }}, {{ load_factor = 3.0 }}]
"#
    );
    builder.tables(&text).unwrap();
    let results = run_model(builder.build().unwrap(), Backend::default());
    let dimension = if solid { 3 } else { 2 };
    let strains = results.states.iter().map(|state| {
        let u = &state.fields.as_ref().unwrap().displacement;
        // Node (1, 0): nothing turns as the left side stays upright.
        [u[dimension], 0.5 * u[dimension + 1]]
    });
    strains.collect()
}

const SIGMA: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 151.2], [2.0, 257.2], [3.0, 259.3]];
const TAU: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 93.1], [2.0, 33.1], [3.0, 0.0]];

#[test]
fn ssnp14_with_linear_kinematic_hardening() {
    let modulus = 195_000.0 * 1930.0 / (195_000.0 - 1930.0);
    // Strains xx and xy at the three ends, thirty increments between them as there.
    let published = [
        [0.014829713606886, 0.013601401082429],
        [0.040661299997639, 0.019780067836272],
        [0.044151267768728, 0.019085331590312],
    ];
    let histories = [format!("{SIGMA:?}"), format!("{TAU:?}")];
    let histories = histories.each_ref().map(String::as_str);
    let halves = format!(
        "back_stresses = [[{0:?}, 0.0], [{0:?}, 0.0]]",
        0.5 * modulus
    );
    for material in [format!("kinematic_modulus = {modulus:?}"), halves.clone()] {
        let strains = plate(Kind::PlaneStress, &material, histories, 30);
        for (found, published) in strains.iter().flatten().zip(published.iter().flatten()) {
            close(*found, *published, 1e-6);
        }
    }
    // In space flow is followed along the strain path of each increment: thirty come nearer to the
    // law than what is published.
    let exact = under_stress(0.0, &[[modulus, 0.0]], 100_000);
    let solid = plate(Kind::Solid, &halves, histories, 30);
    for (k, exact) in exact.iter().enumerate().skip(1) {
        let off = |strains: &[f64; 2]| (strains[0] - exact[0]).hypot(strains[1] - exact[1]);
        let (found, implicit) = (off(&solid[k]), off(&published[k]));
        assert!(found < 0.5 * implicit, "{k}: {found} {implicit}");
    }
}

/// The same path with back stresses that fade, against the law integrated in small explicit steps
/// of the stress: an error of first order, which extrapolates away.
#[test]
fn tension_and_shear_in_turns_follow_the_law() {
    let laws = [[30_000.0, 150.0], [5000.0, 20.0]];
    let isotropic = 800.0;
    let exact = under_stress(isotropic, &laws, 100_000);
    let material = format!("plastic_modulus = {isotropic:?}\nback_stresses = {laws:?}");
    let histories = [format!("{SIGMA:?}"), format!("{TAU:?}")];
    let histories = histories.each_ref().map(String::as_str);
    let plane = [30, 60, 120].map(|n| plate(Kind::PlaneStress, &material, histories, n));
    for (k, exact) in exact.iter().enumerate().skip(1) {
        for i in 0..2 {
            let [coarse, middle, fine] = [0, 1, 2].map(|n| plane[n][k][i] - exact[i]);
            // The shear strain hardly depends on the steps at the last end.
            let size = exact[0].hypot(exact[1]);
            assert!(fine.abs() < 2e-3 * size, "{k} {i}: {fine} of {size}");
            if middle.abs() > 1e-4 * size {
                assert!(
                    (coarse / middle - 2.0).abs() < 0.2,
                    "{coarse} {middle} {fine}"
                );
                assert!(
                    (middle / fine - 2.0).abs() < 0.2,
                    "{coarse} {middle} {fine}"
                );
            }
            assert!(
                (2.0 * fine - middle).abs() < 2e-4 * size,
                "{middle} {fine} of {size}"
            );
        }
    }
    // In space flow is followed along the strain path of each increment: of second order.
    let [coarse, fine] = [30, 60].map(|n| plate(Kind::Solid, &material, histories, n));
    for (k, exact) in exact.iter().enumerate().skip(1) {
        let size = exact[0].hypot(exact[1]);
        for i in 0..2 {
            let [coarse, fine] = [&coarse, &fine].map(|found| (found[k][i] - exact[i]).abs());
            assert!(coarse < 4e-4 * size, "{k} {i}: {coarse} of {size}");
            assert!(fine < 1.5e-4 * size, "{k} {i}: {fine} of {size}");
        }
    }
}

/// Strains xx and xy at the ends of the path: Prandtl and Reuss under given stresses.
fn under_stress(isotropic: f64, laws: &[[f64; 2]], steps: usize) -> Vec<[f64; 2]> {
    let (e, g, y) = (195_000.0, 195_000.0 / 2.6, 181.0);
    // Components xx, yy = zz, xy of deviators.
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + 2.0 * a[1] * b[1] + 2.0 * a[2] * b[2];
    let mut back = vec![[0.0; 3]; laws.len()];
    let (mut plastic, mut equivalent) = ([0.0; 3], 0.0);
    let mut ends = Vec::new();
    for (s, t) in SIGMA.windows(2).zip(TAU.windows(2)) {
        let at = |i: usize| {
            let share = i as f64 / steps as f64;
            let mix = |pair: &[[f64; 2]]| pair[0][1] + share * (pair[1][1] - pair[0][1]);
            let (sigma, tau) = (mix(s), mix(t));
            [2.0 / 3.0 * sigma, -sigma / 3.0, tau]
        };
        for i in 0..steps {
            let (from, to) = (at(i), at(i + 1));
            let of_back = |k: usize| back.iter().map(|a| a[k]).sum::<f64>();
            let xi: [f64; 3] = std::array::from_fn(|k| from[k] - of_back(k));
            let q = (1.5 * dot(xi, xi)).sqrt();
            let drive = 1.5 * dot(xi, std::array::from_fn(|k| to[k] - from[k])) / q;
            if q.is_nan() || q < y + isotropic * equivalent || drive <= 0.0 {
                continue;
            }
            let mut stiffness = isotropic;
            for (a, [modulus, rate]) in back.iter().zip(laws) {
                stiffness += modulus - 1.5 * rate * dot(xi, *a) / q;
            }
            let d = drive / stiffness;
            equivalent += d;
            for k in 0..3 {
                let flow = 1.5 * d * xi[k] / q;
                plastic[k] += flow;
                for (a, [modulus, rate]) in back.iter_mut().zip(laws) {
                    a[k] += 2.0 / 3.0 * modulus * flow - rate * a[k] * d;
                }
            }
        }
        ends.push([s[1][1] / e + plastic[0], t[1][1] / (2.0 * g) + plastic[2]]);
    }
    ends
}
