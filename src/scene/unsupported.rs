//! Effects that other programs have and brinell lacks: a scene that asks for one of them is refused
//! with this reason.

/// Each effect, with the keys and words that ask for it.
const EFFECTS: &[(&str, &[&str])] = &[
    (
        "friction: its contact is frictionless",
        &["friction", "frictional", "coulomb", "mu", "stick", "slip"],
    ),
    (
        "finite strain or large deformation: strains and displacements are small",
        &[
            "finite_strain",
            "finite_strains",
            "large_strain",
            "large_strains",
            "large_deformation",
            "large_deformations",
            "large_displacement",
            "large_displacements",
            "large_rotation",
            "large_sliding",
            "finite_sliding",
            "nlgeom",
            "geometric_nonlinearity",
        ],
    ),
    (
        "dynamics: the loads are applied slowly, without inertia, damping or time",
        &[
            "dynamics",
            "dynamic",
            "mass",
            "inertia",
            "time",
            "time_step",
            "damping",
            "velocity",
            "frequency",
            "impact",
        ],
    ),
    (
        "conduction of heat: temperatures are given, by `temperature` of a load",
        &[
            "thermal",
            "conductivity",
            "heat",
            "heat_flux",
            "specific_heat",
        ],
    ),
    (
        "rate dependence: plastic flow does not depend on time",
        &["creep", "viscosity", "viscoplasticity", "strain_rate"],
    ),
    (
        "adhesion, wear or damage",
        &[
            "adhesion", "cohesion", "cohesive", "wear", "damage", "fracture",
        ],
    ),
    (
        "thickness: plane models are of unit thickness; `kind = \"solid\"` has three dimensions",
        &["3d", "three_dimensional", "thickness"],
    ),
];

/// The effect that an unknown key or word asks for, if it is one that brinell lacks.
pub(super) fn effect(word: &str) -> Option<&'static str> {
    let word = word.to_lowercase().replace('-', "_");
    let asked = |key: &&str| {
        word == **key
            || word
                .strip_prefix(*key)
                .is_some_and(|rest| rest.starts_with('_'))
            || word
                .strip_suffix(*key)
                .is_some_and(|rest| rest.ends_with('_'))
    };
    EFFECTS
        .iter()
        .find(|(_, keys)| keys.iter().any(asked))
        .map(|(effect, _)| *effect)
}
