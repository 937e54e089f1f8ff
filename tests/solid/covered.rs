//! Of a face that the other body covers in part, that part is the contact's: whichever body has the
//! slaves, and however its faces lie.

use crate::support::random::Random;
use crate::support::{either, parse, try_run};
use brinell::linalg::Backend;
use brinell::results::{State, Status};

/// A soft punch on a stiff base that is larger all round, pressed evenly: the one state, by one
/// or the other side's slaves.
fn pressed(random: &mut Random, kind: &str) -> ([f64; 2], [State; 2]) {
    let [a, b] = [1.0, 1.0].map(|low| random.within(low, 4.0));
    let more: [f64; 4] = std::array::from_fn(|_| random.within(0.05, 2.0));
    // No face of the base is smaller than those of the punch: slaves on a softer body with larger
    // faces would have pressures that differ from place to place, and part.
    let n = [0, 1].map(|_| 3 + random.below(5));
    let of_base = n.map(|n| 2 + random.below(n - 1));
    let (shape, element, load, held) = match kind {
        "solid" => (
            ["brick", "brick"],
            random.one_of(&["hex8", "hex20"]),
            "z",
            ["[\"x\", \"y\"]", "[\"x\", \"y\", \"z\"]"],
        ),
        _ => (
            ["block", "block"],
            random.one_of(&["quad4", "quad8"]),
            "y",
            ["[\"x\"]", "[\"x\", \"y\"]"],
        ),
    };
    let space =
        |[x0, x1]: [f64; 2], [y0, y1]: [f64; 2], [low, high]: [f64; 2], n: &[usize]| match kind {
            "solid" => format!(
                "{{ x = [{x0:?}, {x1:?}], y = [{y0:?}, {y1:?}], z = [{low:?}, {high:?}], \
                 elements = [{}, {}, 1] }}",
                n[0], n[1]
            ),
            _ => format!(
                "{{ x = [{x0:?}, {x1:?}], y = [{low:?}, {high:?}], elements = [{}, 1] }}",
                n[0]
            ),
        };
    let [x, y] = [[-more[0], a + more[1]], [-more[2], b + more[3]]];
    let punch = space([0.0, a], [0.0, b], [0.0, 1.0], &n);
    let base = space(x, y, [-1.0, 0.0], &of_base);
    let states = ["first", "second"].map(|slave| {
        let text = format!(
            "kind = \"{kind}\"\n\
             support = [{{ on = \"punch.top\", fix = {} }}, {{ on = \"base.bottom\", fix = {} }}]\n\
             load = [{{ on = \"punch.top\", displacement = {{ {load} = -0.01 }} }}]\n\
             [[contact]]\nfirst = \"punch.bottom\"\nsecond = \"base.top\"\nslave = \"{slave}\"\n\
             [[mesh.parts]]\nbody = \"punch\"\nelement = \"{element}\"\n{} = {punch}\n\
             [[mesh.parts]]\nbody = \"base\"\nelement = \"{element}\"\n{} = {base}\n\
             [materials]\nsoft = {{ youngs_modulus = 1000.0, poissons_ratio = 0.0 }}\n\
             hard = {{ youngs_modulus = 1e8, poissons_ratio = 0.0 }}\n\
             [bodies]\npunch.material = \"soft\"\nbase.material = \"hard\"\n\
             [program]\ntargets = [{{ load_factor = 1.0 }}]\n",
            held[0], held[1], shape[0], shape[1],
        );
        let results = try_run(&parse(&text), Backend::default());
        let mut results = results.unwrap_or_else(|e| panic!("{e}\n{text}"));
        results.states.remove(0)
    });
    ([a, b], states)
}

/// The base yields by a part in 1e5; figures of the patch are of its geometry alone.
#[test]
fn a_patch_is_what_both_bodies_cover() {
    let (n, mut read) = (either(20, 300), 0);
    for seed in 0..n {
        let random = &mut Random::new(seed);
        let ([a, b], states) = pressed(random, "solid");
        // The ellipse with the second moments of a rectangle: a^2/4 = side^2/12.
        let half = [a.max(b), a.min(b)].map(|side| side / 3f64.sqrt());
        for (state, slave) in states.iter().zip(["first", "second"]) {
            let open = state
                .pairs
                .iter()
                .filter(|p| p.status == Status::Open)
                .count();
            // Pressures of slaves that are stiffer than their masters waver; some may be open.
            if open > 0 {
                continue;
            }
            read += 1;
            assert_eq!(state.patches.len(), 1, "{seed} {slave}");
            let patch = &state.patches[0];
            let close = |found: f64, expected: f64| {
                let off = (found - expected).abs() / expected;
                assert!(off < 1e-9, "{seed} {slave}: {found} {expected}");
            };
            close(patch.area, a * b);
            close(patch.area * patch.mean_pressure, patch.force);
            close(patch.semi_axes[0], half[0]);
            close(patch.semi_axes[1], half[1]);
            close(patch.centroid[0], 0.5 * a);
            close(patch.centroid[1], 0.5 * b);
        }
    }
    assert!(read > 3 * n / 2, "{read} of {}", 2 * n);
}

#[test]
fn a_half_width_ends_where_either_body_does() {
    let (n, mut read) = (either(20, 300), 0);
    for seed in 0..n {
        let random = &mut Random::new(seed);
        let kind = random.one_of(&["plane_strain", "plane_stress"]);
        let ([a, _], states) = pressed(random, kind);
        for (state, slave) in states.iter().zip(["first", "second"]) {
            if state.pairs.iter().any(|pair| pair.status == Status::Open) {
                continue;
            }
            read += 1;
            let off = (state.half_width - 0.5 * a).abs() / a;
            assert!(
                off < 1e-9,
                "{seed} {slave}: {} {}",
                state.half_width,
                0.5 * a
            );
        }
    }
    assert!(read > 3 * n / 2, "{read} of {}", 2 * n);
}
