//! Warnings about entries of a scene that are probably mistakes.

use super::Model;
use super::symmetry::{Conditions, cuts};
use crate::number::{exact, percent, significant};
use crate::scene::Scene;

/// Strains at yield, from lead to elastomers: M. F. Ashby, *Materials Selection in Mechanical
/// Design*, 4th ed. (2011), chart of strength over modulus, with a margin of a decade on either
/// side.
const YIELD_STRAINS: [f64; 2] = [1e-6, 1.0];
/// Logarithmic plastic strain that no test exceeds: a bar drawn to seven times its length.
const LARGEST_STRAIN: f64 = 2.0;

/// Number of elements up to which planes of symmetry are searched for: each facet of a held surface
/// is compared with all planes found so far.
const MOST_ELEMENTS: usize = 100_000;

/// Warnings about materials whose values are in contradictory units.
pub(super) fn of_materials(scene: &Scene) -> Vec<String> {
    let mut out = Vec::new();
    for (name, material) in &scene.materials {
        let curve = material.hardening_curve().unwrap_or_default();
        let yields = material.yield_stress.or_else(|| Some(curve.first()?[1]));
        let strain = yields.map(|stress| stress / material.youngs_modulus);
        if let (Some(stress), Some(strain)) = (yields, strain)
            && !(YIELD_STRAINS[0]..YIELD_STRAINS[1]).contains(&strain)
        {
            out.push(format!(
                "materials.{name}: it yields at {}, {} of youngs_modulus ({}): are both in the \
                 same unit?",
                exact(stress),
                significant(strain, 4),
                exact(material.youngs_modulus)
            ));
        }
        let last = curve.last().map_or(0.0, |row| row[0]);
        if last > LARGEST_STRAIN {
            out.push(format!(
                "materials.{name}: plastic strains up to {}: are they in per cent?",
                exact(last)
            ));
        }
    }
    out
}

/// Warnings about bodies whose temperature lies beyond the rows of their material.
pub(super) fn of_temperatures(scene: &Scene) -> impl Iterator<Item = String> + '_ {
    scene.bodies.iter().filter_map(|(name, body)| {
        let temperature = body.temperature?;
        let [lowest, highest] = scene.materials.get(&body.material)?.temperatures()?;
        let is_within = (lowest..=highest).contains(&temperature);
        (!is_within).then(|| {
            format!(
                "bodies.{name}.temperature: {} is beyond the rows of {}, {} to {}: its \
                 properties are those of the nearest row",
                exact(temperature),
                body.material,
                exact(lowest),
                exact(highest)
            )
        })
    })
}

/// Warning about a declared symmetry that the model does not have.
pub(super) fn of_symmetry(model: &Model) -> Option<String> {
    let n = model.mesh.n_elements();
    if model.scene.symmetry < 2 || n > MOST_ELEMENTS {
        return None;
    }
    let all: Vec<usize> = (0..n).collect();
    let is_whole = cuts(model, &Conditions::of(model), &all).is_empty();
    is_whole.then(|| {
        format!(
            "symmetry = {}: forces are reported for a whole of which the mesh is a part, but no \
             flat side of the mesh is held along its normal as a plane of symmetry is; leave it \
             out if the mesh is the whole",
            model.scene.symmetry
        )
    })
}

/// Warnings about settings of the load program that have no effect, or that no target completes.
pub(super) fn of_program(model: &Model) -> Vec<String> {
    let scene = &model.scene;
    let mut out = Vec::new();
    let factors = scene
        .program
        .targets
        .iter()
        .map(|target| target.load_factor);
    // A target of another kind may be met at any load factor.
    let factors: Option<Vec<f64>> = factors.collect();
    let largest = factors.map(|factors| factors.into_iter().fold(0.0, f64::max));
    let beyond = |end: f64| largest.filter(|largest| *largest < end);
    if let Some(end) = scene.program.interference_until {
        let key = "program.interference_until";
        if !model.pairs.iter().any(|pair| pair.interference != 0.0) {
            out.push(format!(
                "{key}: no contact has an interference: this changes nothing"
            ));
        } else if let Some(largest) = beyond(end) {
            out.push(format!(
                "{key}: {} is beyond the largest target, {}: at most {} of the interference is \
                 applied",
                exact(end),
                exact(largest),
                percent(largest / end)
            ));
        }
    }
    for (key, span) in scene.spans() {
        let Some([end, free]) = span.until else {
            continue;
        };
        if let Some(largest) = beyond(free) {
            out.push(format!(
                "{key}.until: {} is beyond the largest target, {}: {} of the forces that held \
                 until {} still act in the end",
                exact(free),
                exact(largest),
                percent((free - largest) / (free - end)),
                exact(end)
            ));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
kind = "plane_strain"
SYMMETRY
mesh.parts = [
    { body = "a", element = "quad4", block = { x = [0, 2], y = [0, 1], elements = [2, 1] } },
]
materials.s = { youngs_modulus = 210e3, poissons_ratio = 0.3, CURVE }
bodies.a.material = "s"
support = [{ on = "a.bottom", fix = ["y"] }, HELD]
load = [{ on = "a.top", pressure = 1.0 }]
program.targets = [{ load_factor = 1.0 }]
"#;

    fn warnings(of: [(&str, &str); 3]) -> Vec<String> {
        let text = of
            .iter()
            .fold(SCENE.to_string(), |text, (from, to)| text.replace(from, to));
        let scene = Scene::parse(&text, "test").expect("scene");
        let model = Model::new(&scene).expect("model");
        let warnings = model.warnings.into_iter();
        warnings
            .filter(|text| !text.contains("nothing holds"))
            .collect()
    }

    #[test]
    fn units_that_contradict_each_other_are_named() {
        let of = |curve: &'static str| warnings([("CURVE", curve), ("SYMMETRY", ""), ("HELD", "")]);
        for sound in [
            "yield_stress = 300.0, plastic_modulus = 1000.0",
            "hardening_table = [[0.0, 300.0], [1.0, 600.0]]",
            // Values of lead and of a rubber.
            "yield_stress = 2.0",
            "yield_stress = 5e4",
        ] {
            assert_eq!(of(sound), [""; 0], "{sound}");
        }
        let units = |yields: &str| {
            format!(
                "materials.s: it yields at {yields} of youngs_modulus (210000): are both in the \
                 same unit?"
            )
        };
        assert_eq!(of("yield_stress = 300e6"), [units("300000000, 1429")]);
        assert_eq!(of("yield_stress = 300e-6"), [units("0.0003, 1.429e-9")]);
        assert_eq!(
            of("hardening_table = [[0.0, 500.0], [2.0, 600.0], [10.0, 700.0]]"),
            ["materials.s: plastic strains up to 10: are they in per cent?"]
        );
    }

    #[test]
    fn a_program_that_ends_too_early_is_named() {
        let of = |program: &str, support: &str| {
            let text = SCENE
                .replace("SYMMETRY", "")
                .replace("CURVE", "")
                .replace("HELD", support)
                .replace(
                    "[{ load_factor = 1.0 }]",
                    "[{ load_factor = 1.0 }, { load_factor = 2.0 }]",
                );
            let scene = Scene::parse(&format!("{text}{program}"), "test").expect("scene");
            of_program(&Model::new(&scene).expect("model"))
        };
        assert_eq!(of("", ""), [""; 0]);
        let unused =
            "program.interference_until: no contact has an interference: this changes nothing";
        assert_eq!(of("program.interference_until = 1.0", ""), [unused]);
        let left = |free: &str| {
            let of = |side: &str| format!("on = \"a.{side}\", fix = [\"x\"]");
            format!(
                "{{ {} }}, {{ {}, until = [1.0, {free}] }}",
                of("right"),
                of("left")
            )
        };
        assert_eq!(of("", &left("2.0")), [""; 0]);
        assert_eq!(
            of("", &left("5.0")),
            [
                "support.2.until: 5 is beyond the largest target, 2: 75 % of the forces that held \
                 until 1 still act in the end"
            ]
        );
    }

    #[test]
    fn a_symmetry_without_a_plane_is_named() {
        let of = |symmetry: &'static str, held: &'static str| {
            warnings([("CURVE", ""), ("SYMMETRY", symmetry), ("HELD", held)])
        };
        let left = "{ on = \"a.left\", fix = [\"x\"] }";
        assert_eq!(of("symmetry = 2", left), [""; 0]);
        assert_eq!(of("", ""), [""; 0]);
        // Clamped, the base is no plane of symmetry.
        let found = of("symmetry = 4", "{ on = \"a.bottom\", fix = [\"x\"] }");
        assert!(
            found[0].starts_with("symmetry = 4: forces are reported for a whole"),
            "{found:?}"
        );
    }

    /// A base that is held in every direction is no plane of symmetry, and does not hide one that
    /// ends at it.
    #[test]
    fn a_plane_of_symmetry_may_end_at_a_clamped_base() {
        let of = |left: &str| {
            let text = format!(
                r#"
kind = "solid"
symmetry = 2
mesh.parts = [
    {{ body = "a", brick = {{ x = [0, 2], y = [-1, 1], z = [0, 2], elements = [2, 2, 2] }} }},
]
materials.s = {{ youngs_modulus = 210e3, poissons_ratio = 0.3 }}
bodies.a.material = "s"
support = [{{ on = "a.bottom", fix = ["x", "y", "z"] }}{left}]
load = [{{ on = "a.top", pressure = 1.0 }}]
program.targets = [{{ load_factor = 1.0 }}]
"#
            );
            Model::new(&Scene::parse(&text, "test").expect("scene"))
                .expect("model")
                .warnings
        };
        assert_eq!(of(", { on = \"a.left\", fix = [\"x\"] }"), [""; 0]);
        let whole = of("");
        assert!(
            whole[0].starts_with("symmetry = 2: forces are"),
            "{whole:?}"
        );
    }
}
