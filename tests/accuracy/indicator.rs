//! The energy norm of the recovered stress error against that of the exact one, on an elastic thick
//! cylinder.

use crate::support;
use brinell::analytical::{Plane, ThickCylinder};
use brinell::mesh::Shape;
use brinell::model::Model;
use brinell::scene::{Kind, Scene};
/// Most nodes of a plane element.
const MAX_NODES: usize = 8;

const PRESSURE: f64 = 10.0;

fn plane_tube(shape: &str, n: usize) -> Scene {
    let mut scene = support::load(
        "thick_cylinder",
        &[
            &format!("mesh.parts.0.element={shape}"),
            &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
            &format!("program.targets=[{{ load_factor = {PRESSURE:.1} }}]"),
        ],
    );
    scene.reference.clear();
    scene
}

/// The same tube as a body of revolution, between two planes.
fn revolved(shape: &str, n: usize) -> Scene {
    support::parse(&format!(
        r#"
title = "tube"
kind = "axisymmetric"
[[mesh.parts]]
body = "tube"
element = "{shape}"
block = {{ x = [100.0, 200.0], y = [0.0, 100.0], elements = [{n}, {n}] }}
[materials.steel]
youngs_modulus = 210000.0
poissons_ratio = 0.3
[bodies.tube]
material = "steel"
[[support]]
on = "tube.bottom"
fix = ["y"]
[[support]]
on = "tube.top"
fix = ["y"]
[[load]]
on = "tube.left"
pressure = {PRESSURE:.1}
[program]
targets = [{{ load_factor = 1.0 }}]
"#
    ))
}

/// Cells along a side of a quadratic element in which the exact error is integrated by the midpoint
/// rule.
const CELLS: usize = 8;

/// Points at which the stress of an element is compared with the exact one: position, weight,
/// computed stress. Linear elements at their Gauss points; quadratic ones all over, where the
/// stress is the polynomial through the Gauss points.
fn points(model: &Model, e: usize, displacement: &[f64]) -> Vec<([f64; 2], f64, [f64; 4])> {
    let elastic = model.materials[0].lame();
    let (shape, x) = (model.mesh.shapes[e], model.mesh.element_coordinates(e));
    let nodes = model.mesh.nodes(e);
    let mut local = [[0.0; 2]; MAX_NODES];
    for (pair, &n) in local.iter_mut().zip(nodes) {
        pair.copy_from_slice(&displacement[2 * n as usize..][..2]);
    }
    let at = model.gradients(&brinell::element::Kernel::plane(model.kind), e);
    let ([px, py], strains) = (at.positions(&x), at.strains(&local));
    let gauss: Vec<_> = (at.weights().iter().enumerate())
        .map(|(g, weight)| {
            let strain = strains.each_ref().map(|lanes| lanes[g]);
            ([px[g], py[g]], *weight, elastic.times(&strain))
        })
        .collect();
    if shape.n_nodes() == shape.n_corners() {
        return gauss;
    }
    let mut out = Vec::new();
    for i in 0..CELLS {
        for j in 0..CELLS {
            let unit = [i, j].map(|k| (k as f64 + 0.5) / CELLS as f64);
            // The unit square onto the reference element; the triangle by Duffy's map.
            let (at, area, shares) = if shape.n_corners() == 4 {
                let at = unit.map(|u| 2.0 * u - 1.0);
                let [a, b] = at.map(|v| v * 3f64.sqrt());
                let n = [
                    (1.0 - a) * (1.0 - b),
                    (1.0 + a) * (1.0 - b),
                    (1.0 + a) * (1.0 + b),
                    (1.0 - a) * (1.0 + b),
                ];
                (at, 4.0, n.map(|n| n / 4.0).to_vec())
            } else {
                let at = [unit[0] * (1.0 - unit[1]), unit[1]];
                let [b, c] = at.map(|v| 2.0 * v - 1.0 / 3.0);
                (at, 1.0 - unit[1], vec![1.0 - b - c, b, c])
            };
            let [a, b] = at;
            let functions = shape.functions([a, b, 0.0]);
            let (values, gradients) = (functions.values, functions.gradients);
            let sum = |f: &dyn Fn(usize) -> f64| (0..shape.n_nodes()).map(f).sum::<f64>();
            let position = [sum(&|k| values[k] * x[k][0]), sum(&|k| values[k] * x[k][1])];
            let jacobian: [[f64; 2]; 2] = std::array::from_fn(|a| {
                std::array::from_fn(|d| sum(&|k| gradients[k][a] * x[k][d]))
            });
            let determinant = jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0];
            let stress =
                std::array::from_fn(|c| shares.iter().zip(&gauss).map(|(n, g)| n * g.2[c]).sum());
            let round = match model.kind {
                Kind::Axisymmetric => 2.0 * std::f64::consts::PI * position[0],
                _ => 1.0,
            };
            out.push((
                position,
                area * determinant * round / (CELLS * CELLS) as f64,
                stress,
            ));
        }
    }
    out
}

/// `||sigma_h - sigma||` over `||sigma_h||` in the energy norm.
fn exact_error(scene: &Scene, displacement: &[f64]) -> f64 {
    let model = Model::new(scene).unwrap();
    let (e, nu) = (
        model.materials[0].youngs_modulus,
        model.materials[0].poissons_ratio,
    );
    let exact = ThickCylinder::new(100.0, 200.0, e, nu, Plane::Strain).unwrap();
    let energy = |s: &[f64; 4]| {
        let trace = s[0] + s[1] + s[2];
        let square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 2.0 * s[3] * s[3];
        ((1.0 + nu) * square - nu * trace * trace) / e
    };
    let (mut error, mut whole) = (0.0, 0.0);
    for element in 0..model.mesh.n_elements() {
        for ([x, y], weight, computed) in points(&model, element, displacement) {
            let expected = match model.kind {
                Kind::Axisymmetric => {
                    let [radial, hoop, axial] = exact.stress(x, PRESSURE, 0.0);
                    [radial, axial, hoop, 0.0]
                }
                _ => {
                    let (c, s) = (x / x.hypot(y), y / x.hypot(y));
                    let [radial, hoop, axial] = exact.stress(x.hypot(y), PRESSURE, 0.0);
                    [
                        radial * c * c + hoop * s * s,
                        radial * s * s + hoop * c * c,
                        axial,
                        (radial - hoop) * s * c,
                    ]
                }
            };
            let difference: [f64; 4] = std::array::from_fn(|i| computed[i] - expected[i]);
            error += weight * energy(&difference);
            whole += weight * energy(&computed);
        }
    }
    (error / whole).sqrt()
}

/// Estimate over exact error.
fn effectivity(scene: &Scene) -> (f64, f64) {
    let results = support::run(scene);
    let state = &results.states[0];
    let fields = state.fields.as_ref().unwrap();
    let estimate = state.energy_error.unwrap();
    let sum: f64 = fields.error.iter().map(|e| e * e).sum();
    support::close("sum of squares", sum.sqrt(), estimate, estimate, 1e-12);
    (
        estimate,
        estimate / exact_error(scene, &fields.displacement),
    )
}

/// The recovered stress of these elements is more exact than the computed one: the estimate goes to
/// the exact error. What is left of the difference is the recovered stress's own error, of an order
/// more on meshes without kinks: in proportion to the element size.
#[test]
fn the_estimate_goes_to_the_exact_error() {
    let kinds: [fn(&str, usize) -> Scene; 2] = [plane_tube, revolved];
    for (kind, scene) in kinds.into_iter().enumerate() {
        for shape in ["quad4", "quad8", "tri3", "tri6"] {
            let found = [8, 16, 32].map(|n| effectivity(&scene(shape, n)).1);
            println!("{kind} {shape} {found:?}");
            let [_, coarse, fine] = found.map(|e| (e - 1.0).abs());
            assert!(fine <= 0.1, "{kind} {shape} {found:?}");
            assert!(fine <= coarse + 0.01, "{kind} {shape} {found:?}");
        }
    }
}

#[test]
fn the_estimate_is_close_to_the_exact_error_and_falls_with_its_order() {
    for (shape, order) in [
        (Shape::Quad4, 1),
        (Shape::Quad8, 2),
        (Shape::Tri3, 1),
        (Shape::Tri6, 2),
    ] {
        let name = format!("{shape:?}").to_lowercase();
        let mut estimates = Vec::new();
        // With 4 elements over 90 degrees a quadratic fit over three of them is no match for
        // stresses that turn twice as far.
        for n in [8, 16, 32] {
            let scene = plane_tube(&name, n);
            let (estimate, effectivity) = effectivity(&scene);
            println!("{name} {n}: estimate {estimate:.2e}, effectivity {effectivity:.2}");
            assert!(
                (0.5..=2.0).contains(&effectivity),
                "{name} {n}: {effectivity}"
            );
            estimates.push(estimate);
        }
        let observed = (estimates[1] / estimates[2]).log2();
        // Theory: the degree; the last halving shows it to a fifth.
        assert!(
            (observed - f64::from(order)).abs() < 0.2,
            "{name}: order {observed}"
        );
    }
}
