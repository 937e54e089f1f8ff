//! The size of a plastic zone is counted in Gauss points: two meshes may agree by accident, and no
//! stated error is finer than a layer of points.

use crate::accuracy::estimate::estimated;
use crate::support::random::Random;
use crate::support::{either, load};
use brinell::accuracy::Extent;
use brinell::analytical::ThickSphere;
use std::f64::consts::PI;

/// A thick sphere, whose front is known (R. Hill, The Mathematical Theory of Plasticity, chapter
/// V): at two loads on meshes of 5 to 12 elements across the wall. All points at one radius yield
/// at once, so that the size goes in steps of a layer of points. The loads are given: their errors
/// are none, and none is stated.
#[test]
fn no_error_of_a_plastic_zone_is_finer_than_a_layer_of_points() {
    let exact = ThickSphere::new(100.0, 200.0, 2.1e5, 0.3, 240.0).unwrap();
    for seed in 0..either(6, 60) {
        let random = &mut Random::new(seed);
        let n = 5 + random.below(8);
        let element = random.one_of(&["quad4", "quad8", "tri6"]);
        let pressures = [random.within(170.0, 240.0), random.within(250.0, 310.0)];
        let targets = pressures.map(|p| format!("{{ load_factor = {p:?} }}"));
        let scene = load(
            "thick_sphere",
            &[
                &format!("mesh.parts.0.ring.elements=[{n},{n}]"),
                &format!("mesh.parts.0.element={element}"),
                &format!("program.targets=[{}]", targets.join(", ")),
                "reference=[]",
            ],
        );
        let (results, accuracy) = estimated(&scene, Extent::Program);
        for (state, pressure) in results.states.iter().zip(pressures) {
            let row = |key: &str| {
                let path = format!("states.{}.{key}", state.name);
                let mut rows = accuracy.quantities.iter();
                rows.find(|row| row.quantity == path)
            };
            let stated = row("plastic_zone_size").unwrap().error.unwrap();
            let front = exact.plastic_front(pressure).unwrap();
            // Half a sphere.
            let size = 2.0 / 3.0 * PI * (front.powi(3) - 1e6);
            let off = (state.plastic_zone_size - size).abs();
            let why = format!("{seed} {element} {n} {pressure}: {stated} {off}");
            assert!(stated >= off, "{why}");
            // Two layers in an element, three points in a triangle; the wall is 100 thick.
            let layer = 2.0 * PI * front * front * 100.0 / n as f64;
            assert!(stated > 0.2 * layer, "{why} {layer}");
            assert!(row("load").is_none() && row("approach").is_some());
        }
        assert!(
            accuracy
                .quantities
                .iter()
                .any(|row| row.quantity == "yield.load")
        );
    }
}
