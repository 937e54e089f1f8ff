//! Pilots: coarse runs that tell which part of a mesh the errors come from.

use super::estimate::{Extent, run};
use super::extrapolation::extrapolate;
use super::grading::{Share, elements, far_coarser, shares};
use super::meter::work;
use super::quantities::{Quantity, quantities, value_of};
use super::refinement::{Level, governing_count, largest_order, refined};
use crate::linalg::Backend;
use crate::progress::Observer;
use crate::results::{Accuracy, Results};
use crate::scene::Scene;

/// Elements over what governs, from which on rungs far apart tell more than near ones, and below which they must be very near.
const FINE: f64 = 11.0;
const COARSE: f64 = 7.5;
/// Least change of the element size from rung to rung.
const LEAST_CHANGE: f64 = 1.1;

/// The two coarser meshes from which a run on the way to a demand is judged: a ladder goes up from meshes so coarse that it must not
/// lean on yet coarser ones, nor, with its price in mind, on finer ones.
pub(super) fn rungs(scene: &Scene) -> Vec<Level> {
    let factors = match governing_count(&scene.mesh) {
        Some(n) if n >= FINE => [1.0 / 2.0, 3.0 / 8.0, 2.0 / 3.0, 1.0 / 4.0],
        Some(n) if n >= COARSE => [2.0 / 3.0, 1.0 / 2.0, 3.0 / 4.0, 3.0 / 8.0],
        Some(_) => [5.0 / 6.0, 2.0 / 3.0, 1.0 / 2.0, 3.0 / 4.0],
        None => return Vec::new(),
    };
    let mut out: Vec<Level> = Vec::new();
    for level in factors.into_iter().filter_map(|f| refined(scene, f)) {
        let far = |other: f64| level.ratio.max(other) / level.ratio.min(other) >= LEAST_CHANGE;
        if out.len() < 2
            && level.ratio > 1.0
            && far(1.0)
            && out.iter().all(|l| far(l.ratio))
            && elements(&level.scene).is_some()
        {
            out.push(level);
        }
    }
    out.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
    out
}

/// A pilot with what its far part adds to its errors.
pub(super) struct Pilot {
    quantities: Vec<Quantity>,
    /// Discretisation error and order of each quantity.
    errors: Vec<(f64, f64)>,
    far_coarser: Vec<Quantity>,
    /// Operations of the runs that were made for it.
    pub work: f64,
}

impl Pilot {
    /// The shares of near and far part, relative to the error that is wanted.
    pub(super) fn shares(&self, wanted: f64) -> Vec<Share> {
        shares(&self.quantities, &self.errors, &self.far_coarser, wanted)
    }

    /// The largest relative error of a governing quantity.
    pub(super) fn largest_error(&self) -> f64 {
        let rows = self.quantities.iter().zip(&self.errors);
        rows.filter(|(quantity, _)| quantity.governs && quantity.scale > 0.0)
            .fold(0.0, |most, (quantity, e)| {
                f64::max(most, e.0 / quantity.scale)
            })
    }
}

/// A finished run whose errors were estimated, taken as pilot; `None` where its mesh has no far part or the further run fails.
pub(super) fn pilot(
    scene: &Scene,
    backend: Backend,
    extent: Extent,
    results: &Results,
    found: &Accuracy,
    observer: &mut dyn Observer,
) -> Option<Pilot> {
    let errors = found.quantities.iter().map(|q| {
        // Where nothing is known of an error, it does not decide.
        (q.discretisation.unwrap_or(0.0), q.order.unwrap_or(1.0))
    });
    complete(scene, backend, extent, results, errors.collect(), observer)
}

/// Makes a pilot of a scene: its run and those on two coarser meshes of its family.
pub(super) fn fly(
    scene: &Scene,
    backend: Backend,
    extent: Extent,
    observer: &mut dyn Observer,
) -> Option<Pilot> {
    let results = run(scene, backend, extent, observer).ok()?;
    let mut spent = work(&results);
    let mut coarse: Vec<(f64, Vec<Quantity>)> = Vec::new();
    for level in rungs(scene) {
        let found = run(&level.scene, backend, extent, observer).ok()?;
        spent += work(&found);
        coarse.push((level.ratio, quantities(&found)));
    }
    let errors = quantities(&results).into_iter().map(|quantity| {
        let mut values = vec![(1.0, quantity.value)];
        values.extend(
            (coarse.iter()).filter_map(|(h, found)| Some((*h, value_of(found, &quantity.path)?))),
        );
        extrapolate(&values, [1.0, largest_order(scene)])
            .map_or((0.0, 1.0), |e| (e.error, e.order.unwrap_or(1.0)))
    });
    let mut out = complete(scene, backend, extent, &results, errors.collect(), observer)?;
    out.work += spent;
    Some(out)
}

fn complete(
    scene: &Scene,
    backend: Backend,
    extent: Extent,
    results: &Results,
    errors: Vec<(f64, f64)>,
    observer: &mut dyn Observer,
) -> Option<Pilot> {
    let found = run(&far_coarser(scene)?, backend, extent, observer).ok()?;
    Some(Pilot {
        quantities: quantities(results),
        errors,
        work: work(&found),
        far_coarser: quantities(&found),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_come_nearer_towards_the_foot() {
        let text = include_str!("../../data/scenes/cylinder_on_half_plane.toml");
        let mut scene = Scene::parse(text, "scene.toml").unwrap();
        for (n, wanted) in [(6, [5, 4]), (9, [6, 5]), (16, [8, 6])] {
            scene
                .mesh
                .cylinder_on_half_plane
                .as_mut()
                .unwrap()
                .resolution = n;
            let found: Vec<usize> = rungs(&scene)
                .iter()
                .map(|l| {
                    l.scene
                        .mesh
                        .cylinder_on_half_plane
                        .as_ref()
                        .unwrap()
                        .resolution
                })
                .collect();
            assert_eq!(found, wanted);
        }
    }
}
