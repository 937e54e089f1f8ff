//! Where a contact in the plane ends: between its last closed pair, half of whose share may be
//! free, and its first open one.

use crate::support::random::Random;
use crate::support::{either, parse, try_run};
use brinell::linalg::Backend;
use brinell::results::Status;

/// Elastic, and plastic far beyond first yield; every kind and shape.
#[test]
fn a_half_width_ends_between_closed_and_open_pairs() {
    for seed in 0..either(8, 200) {
        let random = &mut Random::new(seed);
        let kind = random.one_of(&["plane_strain", "plane_stress", "axisymmetric"]);
        let element = random.one_of(&["quad4", "quad8", "tri6"]);
        let resolution = 3 + random.below(4);
        let most = match kind {
            "axisymmetric" => random.within(2.0, 60.0),
            _ => random.within(1.5, 4.0),
        };
        let text = format!(
            r#"kind = "{kind}"
materials.steel = {{ youngs_modulus = 2.1e5, poissons_ratio = 0.3, yield_stress = 500.0 }}
bodies = {{ cylinder = {{ material = "steel", plastic = false }}, half_plane.material = "steel" }}
contact = [{{ first = "cylinder.contact", second = "half_plane.contact" }}]
support = [
  {{ on = "cylinder.symmetry", fix = ["x"] }}, {{ on = "half_plane.symmetry", fix = ["x"] }},
  {{ on = "half_plane.bottom", fix = ["y"] }},
]
load = [{{ on = "cylinder.top", plane_force = {{ direction = "y", total = -1.0 }} }}]
program = {{ unit = "yield", targets = [{{ load_factor = 0.5 }}, {{ load_factor = {most:?} }}] }}
[mesh.cylinder_on_half_plane]
radius = 10.0
resolution = {resolution}
far_size = 60.0
element = "{element}"
"#
        );
        let results = try_run(&parse(&text), Backend::default());
        for state in &results.unwrap_or_else(|e| panic!("{e}\n{text}")).states {
            let of = |status: Status| {
                let pairs = state.pairs.iter().filter(move |pair| pair.status == status);
                pairs.map(|pair| pair.position[0])
            };
            let last = of(Status::Closed).fold(0.0, f64::max);
            let first = of(Status::Open)
                .filter(|x| *x > last)
                .fold(f64::INFINITY, f64::min);
            let width = state.half_width;
            let low = last - 0.5 * (first - last);
            // The arc is a little longer than its projection.
            let longer = 1.0 + first * first / 100.0;
            assert!(
                width >= low && width <= first * longer,
                "{seed} {}: {last} {width} {first}\n{text}",
                state.name
            );
        }
    }
}
