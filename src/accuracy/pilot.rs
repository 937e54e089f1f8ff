//! Pilots: coarse runs that tell which part of a mesh the errors come from.

use super::estimate::{Extent, run};
use super::extrapolation::extrapolate;
use super::grading::{PilotError, Share, far_coarser, shares};
use super::meter::work;
use super::outcome::of_mesh;
use super::quantities::{Quantity, quantities, value_of};
use super::refinement::{coarser, largest_order};
use crate::linalg::Backend;
use crate::progress::Observer;
use crate::results::{Accuracy, Results};
use crate::scene::Scene;

/// A pilot with what its far part adds to its errors.
pub(super) struct Pilot {
    quantities: Vec<Quantity>,
    errors: Vec<PilotError>,
    far_coarser: Vec<Quantity>,
    /// Order of the far part, where nothing singular disturbs it.
    far_order: f64,
    /// Operations of the runs that were made for it.
    pub work: f64,
}

impl Pilot {
    /// The shares of near and far part, relative to the error that is wanted.
    pub(super) fn shares(&self, wanted: f64) -> Vec<Share> {
        shares(
            &self.quantities,
            &self.errors,
            &self.far_coarser,
            self.far_order,
            wanted,
        )
    }

    /// The largest relative error of a governing quantity.
    pub(super) fn largest_error(&self) -> f64 {
        let rows = self.quantities.iter().zip(&self.errors);
        rows.filter(|(quantity, _)| quantity.governs && quantity.scale > 0.0)
            .fold(0.0, |most, (quantity, e)| {
                f64::max(most, e.error / quantity.scale)
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
    let highest = largest_order(scene);
    let errors = found.quantities.iter().map(|q| {
        // Where nothing is known of an error, it does not decide.
        let (error, safety) = of_mesh(q, found.companions.len());
        let (error, order) = match (q.order, found.companions.as_slice()) {
            (Some(order), _) => (error, order),
            // Stated from one other mesh with the lowest order: too much where parts are compared.
            (None, [other]) => (
                error * (other.ratio - 1.0) / (other.ratio.powf(highest) - 1.0),
                highest,
            ),
            (None, _) => (error, highest),
        };
        PilotError {
            error,
            order,
            safety,
        }
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
    for level in coarser(scene) {
        let found = run(&level.scene, backend, extent, observer).ok()?;
        spent += work(&found);
        coarse.push((level.ratio, quantities(&found)));
    }
    let errors = quantities(&results).into_iter().map(|quantity| {
        let mut values = vec![(1.0, quantity.value)];
        values.extend(
            (coarse.iter()).filter_map(|(h, found)| Some((*h, value_of(found, &quantity.path)?))),
        );
        let found = extrapolate(&values, [1.0, largest_order(scene)]);
        PilotError {
            error: found.map_or(0.0, |e| e.error),
            order: found.map_or(1.0, |e| e.order.unwrap_or(largest_order(scene))),
            safety: 1.0,
        }
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
    errors: Vec<PilotError>,
    observer: &mut dyn Observer,
) -> Option<Pilot> {
    let found = run(&far_coarser(scene)?, backend, extent, observer).ok()?;
    Some(Pilot {
        quantities: quantities(results),
        errors,
        work: work(&found),
        far_coarser: quantities(&found),
        far_order: largest_order(scene),
    })
}
