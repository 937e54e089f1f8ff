//! The choice of the elements that may yield: the program chooses the plastic zone.
//!
//! A first guess from geometry (near the contact surfaces) is enough to find the yield load. The
//! elastic stress at the program's extreme loads then predicts how far yielding spreads. A guard
//! layer round the prediction is watched; if it yields, the zone grows.

use crate::analysis::stress::stress_field::stress;
use crate::analysis::zone::free_strain::take_off_all;
use crate::analysis::zone::local_yield::largest_ratio;
use crate::analysis::zone::region::{Reach, Region};
use crate::element::{Kernel, with_kernel};
use crate::model::Model;
use crate::scene::Kind;
use crate::space::Vector;
use rayon::prelude::*;

/// If fewer elements than this may yield, all of them form the zone.
const SMALL: usize = 1500;
/// Ratio of elastic von Mises stress to yield stress above which an element is predicted to yield:
/// less than 1, because stress redistributes.
pub(super) const PREDICTED: f64 = 0.95;
/// Number of layers of elements added round the prediction.
const MARGIN: usize = 2;
/// Number of layers of guard elements round the prediction and its margin.
const GUARD: usize = 1;

/// A choice of zone elements.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Choice {
    /// Elements of the zone, ascending.
    pub elements: Vec<usize>,
    /// Whether each element belongs to the guard: the layer that only shows when yielding reaches
    /// it.
    pub guard: Vec<bool>,
}

impl Choice {
    fn from_marks(model: &Model, mut core: Vec<bool>, layers: usize) -> Self {
        for &element in model.start.iter().flat_map(|start| &start.elements) {
            core[element] = true;
        }
        let all = widen(model, core.clone(), layers);
        let elements: Vec<usize> = (0..all.len()).filter(|&e| all[e]).collect();
        let guard = elements.iter().map(|&e| !core[e]).collect();
        Choice { elements, guard }
    }

    /// Whether the zone holds all elements that may yield. (A zone without a guard need not hold
    /// all of them: another body may be out of reach.)
    pub fn holds_all(&self, model: &Model) -> bool {
        let n = model.mesh.n_elements();
        self.elements.len() == (0..n).filter(|&e| may_yield(model, e)).count()
    }
}

fn regions(model: &Model, reach: Reach) -> Vec<Region> {
    let contacts = model.contacts.iter();
    contacts
        .map(|contact| Region::round(model, contact, reach))
        .collect()
}

fn may_yield(model: &Model, element: usize) -> bool {
    model.may_yield[model.mesh.element_body[element] as usize]
}

/// The elements that are factored as zone at first: elements so near to the contact surfaces that
/// yielding rarely spreads beyond them, or all that may yield if these are few or there is no
/// contact. A large zone adds nothing to the cost of the factorisation; the part that is used is
/// chosen later.
pub fn first_guess(model: &Model) -> Choice {
    near_contact(model, Reach::OfZone)
}

/// The elements in which first yield is looked for.
pub fn place_of_first_yield(model: &Model) -> Choice {
    near_contact(model, Reach::OfFirstYield)
}

fn near_contact(model: &Model, reach: Reach) -> Choice {
    let n = model.mesh.n_elements();
    let candidates: Vec<bool> = (0..n).map(|e| may_yield(model, e)).collect();
    let count = candidates.iter().filter(|c| **c).count();
    if count <= SMALL || model.pairs.is_empty() {
        return Choice::from_marks(model, candidates, 0);
    }
    let regions = regions(model, reach);
    let core = (0..n)
        .map(|e| {
            let x = model.mesh.point(model.mesh.nodes(e)[0] as usize);
            candidates[e] && regions.iter().any(|region| region.holds(x))
        })
        .collect();
    Choice::from_marks(model, core, GUARD)
}

/// The zone predicted from elastic stress ratios of all elements (the largest over the program's
/// extreme loads).
pub fn predict(model: &Model, ratios: &[f64]) -> Choice {
    let hot: Vec<bool> = ratios
        .iter()
        .enumerate()
        .map(|(e, r)| may_yield(model, e) && *r >= PREDICTED)
        .collect();
    Choice::from_marks(model, widen(model, hot, MARGIN), GUARD)
}

/// The factor by which contact pressure falls if the load falls to `share` of its value: the square
/// root of `share` in line contact, the cube root in point contact.
pub fn decline(model: &Model, share: f64) -> f64 {
    match model.kind {
        Kind::Axisymmetric | Kind::Solid => share.cbrt(),
        Kind::PlaneStrain | Kind::PlaneStress => share.sqrt(),
    }
}

/// The zone for `share` times the load of `ratios`, joined with the `old` zone. All loads grow in
/// proportion; stress is assumed to fall at least as fast as contact pressure.
pub fn stage(model: &Model, ratios: &[f64], share: f64, old: &Choice) -> Choice {
    let limit = PREDICTED / decline(model, share);
    let hot: Vec<bool> = ratios
        .iter()
        .enumerate()
        .map(|(e, r)| may_yield(model, e) && *r >= limit)
        .collect();
    let mut core = widen(model, hot, MARGIN);
    for (&e, guard) in old.elements.iter().zip(&old.guard) {
        core[e] |= !guard;
    }
    Choice::from_marks(model, core, GUARD)
}

/// A larger zone: the old one with further layers around it.
pub fn grown(model: &Model, old: &Choice) -> Choice {
    let mut core = vec![false; model.mesh.n_elements()];
    for &e in &old.elements {
        core[e] = true;
    }
    Choice::from_marks(model, widen(model, core, 2 * MARGIN), GUARD)
}

/// A zone that holds the given elements and the layers around them in addition to the old zone.
pub fn including(model: &Model, old: &Choice, elements: &[usize]) -> Choice {
    let mut core = vec![false; model.mesh.n_elements()];
    for &e in elements {
        core[e] = true;
    }
    let mut core = widen(model, core, MARGIN);
    for &e in &old.elements {
        core[e] = true;
    }
    Choice::from_marks(model, core, GUARD)
}

/// A zone that holds all elements of two zones.
pub fn joined(model: &Model, zones: [&Choice; 2]) -> Choice {
    let mut core = vec![false; model.mesh.n_elements()];
    for &e in zones.iter().flat_map(|zone| &zone.elements) {
        core[e] = true;
    }
    Choice::from_marks(model, core, GUARD)
}

/// Adds layers of neighbouring elements that may yield: elements of any body that share a node.
fn widen(model: &Model, mut marked: Vec<bool>, layers: usize) -> Vec<bool> {
    for _ in 0..layers {
        let mut touched = vec![false; model.mesh.n_nodes()];
        for e in (0..marked.len()).filter(|&e| marked[e]) {
            for &node in model.mesh.nodes(e) {
                touched[node as usize] = true;
            }
        }
        for (e, mark) in marked.iter_mut().enumerate() {
            *mark = *mark
                || (may_yield(model, e)
                    && model
                        .mesh
                        .nodes(e)
                        .iter()
                        .any(|&node| touched[node as usize]));
        }
    }
    marked
}

/// Largest ratio of elastic von Mises stress to yield stress at the sampling points of each element
/// that may yield (0 for all others), for displacements of the whole model.
pub fn stress_ratios(model: &Model, u: &[f64], factors: &[f64]) -> Vec<f64> {
    let displacements = model.nodal(u, factors);
    let formulation = model.formulation;
    with_kernel!(model.kind, formulation, model.mesh, kernel => {
        ratios_of(&kernel, model, (&displacements, factors))
    })
}

fn ratios_of<const D: usize, const S: usize, const P: usize, const N: usize>(
    kernel: &Kernel<D, S, P, N>,
    model: &Model,
    (displacements, factors): (&[Vector], &[f64]),
) -> Vec<f64> {
    let elastic: Vec<_> = model.materials.iter().map(|m| m.lame()).collect();
    let free = model.free_of_loads();
    (0..model.mesh.n_elements())
        .into_par_iter()
        .with_min_len(256)
        .map(|e| {
            if !may_yield(model, e) {
                return 0.0;
            }
            let mut u = [[0.0; D]; N];
            for (u, &node) in u.iter_mut().zip(model.mesh.nodes(e)) {
                u.copy_from_slice(&displacements[node as usize][..D]);
            }
            let nodes = model.mesh.element_coordinates(e);
            let sampling = kernel.sampling(model.mesh.shapes[e], &nodes);
            let body = model.mesh.element_body[e] as usize;
            let mut strains = sampling.strains(&u);
            take_off_all(&mut strains, (&model.mesh, e), (&free, factors), |nodal| {
                sampling.at_points(nodal)
            });
            let places = (|| sampling.positions(&nodes), sampling.n_points());
            largest_ratio(model, e, &stress(&elastic[body], &strains), places)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn scene(name: &str, overrides: &[&str]) -> Scene {
        let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        Scene::load_with(path, &overrides).unwrap()
    }

    /// In point contact stress falls with the cube root of the load: at an eighth of the load an
    /// element is predicted to yield if its ratio at the whole load is twice the limit. In line
    /// contact, with the square root, the same holds at a quarter of the load.
    #[test]
    fn a_stage_of_the_load_takes_the_elements_that_flow_by_then() {
        for (name, share) in [
            ("ball_on_half_space", 0.125),
            ("cylinder_on_half_plane", 0.25),
        ] {
            let model =
                Model::new(&scene(name, &["mesh.cylinder_on_half_plane.resolution=4"])).unwrap();
            let element = model.mesh.n_elements() / 2;
            for (ratio, taken) in [(1.999, false), (2.001, true)] {
                let mut ratios = vec![0.0; model.mesh.n_elements()];
                ratios[element] = ratio * PREDICTED;
                let choice = stage(&model, &ratios, share, &Choice::default());
                let found = choice.elements.binary_search(&element);
                assert_eq!(found.is_ok(), taken, "{name}");
                assert!(found.is_err() || !choice.guard[found.unwrap()]);
                // The outermost layer is the guard: if it yields, the zone is made larger.
                let core = choice.guard.iter().filter(|guard| !**guard).count();
                assert_eq!(taken, core > 0 && core < choice.guard.len(), "{name}");
            }
        }
    }

    /// In bodies that share nodes, only those neighbours that may yield join the zone.
    #[test]
    fn layers_end_where_material_stays_elastic() {
        let scene = scene(
            "contact_patch",
            &[
                "bodies.upper.material=hard",
                "materials.hard={ youngs_modulus = 210000.0, poissons_ratio = 0.3 }",
                "materials.steel.yield_stress=100.0",
            ],
        );
        let mut model = Model::new(&scene).unwrap();
        let upper = model.mesh.bodies.iter().position(|b| b == "upper").unwrap();
        // The right half of the lower block becomes part of the other body.
        let n = model.mesh.n_elements();
        for e in 0..n {
            let [x, ..] = model.mesh.point(model.mesh.nodes(e)[0] as usize);
            if x >= 1.0 {
                model.continuum.mesh.element_body[e] = upper as u32;
            }
        }
        let old = Choice {
            elements: (0..n).filter(|&e| may_yield(&model, e)).take(1).collect(),
            guard: vec![false],
        };
        let grown = grown(&model, &old);
        assert!(grown.elements.len() > 4);
        assert!(grown.elements.iter().all(|&e| may_yield(&model, e)));
    }
}
