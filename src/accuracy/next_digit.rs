//! Forecast of what a tenth of the stated error would take.

use super::effort::work_of_finer;
use super::extrapolation::LEAST_ORDER;
use super::quantities::{formal_order, is_demanded_with_all};
use crate::results::{FACTORISATION_ROW, QuantityError, Results};
use crate::scene::Scene;

/// Forecast of a mesh on which the largest stated error would be a tenth of the present one.
#[derive(Debug, Clone, PartialEq)]
pub struct NextDigit {
    /// The quantity with the largest stated relative error of those that a demand on all includes.
    pub quantity: String,
    /// The stated relative error of that quantity.
    pub relative_error: f64,
    /// How many times smaller the elements would have to be.
    pub finer: f64,
    /// Seconds of a run on that mesh.
    pub seconds: f64,
    /// Bytes of its factorisation.
    pub memory_bytes: f64,
}

/// Powers of the fineness with which the time of solves and the memory of a factor grow. With `n`
/// freedoms they grow as `n` in the plane, apart from a logarithm, and as `n^(4/3)` in space
/// (George 1973, Lipton, Rose and Tarjan 1979, as the time of the factorisation).
const SOLVES: [f64; 2] = [2.0, 4.0];

/// Forecasts what a tenth of the largest stated error takes: the mesh's share of the error falls
/// with the order that the meshes show, or with first order if they show none. `None` if no error
/// is stated, or if path and algebra leave more than the mesh, so that no mesh would suffice.
pub fn for_a_tenth(scene: &Scene, results: &Results) -> Option<NextDigit> {
    let rows = &results.accuracy.as_ref()?.quantities;
    let key = |row: &QuantityError| row.quantity.rsplit('.').next().unwrap_or("").to_string();
    let counts = |row: &&QuantityError| row.of_part().is_none() && is_demanded_with_all(&key(row));
    let stated = |row: &QuantityError| row.relative_error.filter(|e| e.is_finite() && *e > 0.0);
    let (row, relative_error) = (rows.iter().filter(counts))
        .filter_map(|row| Some((row, stated(row)?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    if row.discretisation? < 0.5 * row.error? {
        return None;
    }
    let formal = formal_order(&key(row), results.sizes.degree);
    let order = row.order.filter(|order| *order >= LEAST_ORDER);
    let finer = 10f64.powf(1.0 / order.map_or(1.0, |order| order.min(formal)));
    let growth = finer.powf(SOLVES[usize::from(scene.kind.is_solid())]);
    let run = (results.timings.iter()).filter(|(name, _)| name != "error estimate");
    let seconds = run.map(|(name, seconds)| match name == FACTORISATION_ROW {
        true => seconds * work_of_finer(scene.kind, finer),
        false => seconds * growth,
    });
    Some(NextDigit {
        quantity: row.quantity.clone(),
        relative_error,
        finer,
        seconds: seconds.sum(),
        memory_bytes: results.factor.memory_bytes * growth,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Accuracy;

    /// Errors of a body, of a set, at a place and of a pressure at a point are larger, but a demand
    /// on all quantities does not include them.
    #[test]
    fn what_a_demand_on_all_counts_is_made_a_tenth() {
        let row = |quantity: &str, share: f64| QuantityError {
            quantity: quantity.to_string(),
            value: 2.0,
            error: Some(2.0 * share),
            relative_error: Some(share),
            discretisation: Some(2.0 * share),
            path: None,
            algebraic: 0.0,
            order: Some(2.0),
            extrapolated: None,
        };
        let results = Results {
            accuracy: Some(Accuracy {
                quantities: vec![
                    row("states.full.load", 0.01),
                    row("states.full.max_pressure", 0.04),
                    row("states.full.pole_pressure", 0.5),
                    row("states.full.residual_depth_by_body.ball", 0.6),
                    row("states.full.history.ball.top.force_y", 0.7),
                    row("reference.1.states.full.stress_xx", 0.8),
                ],
                ..Accuracy::default()
            }),
            ..Results::default()
        };
        let text = include_str!("../../data/scenes/thick_cylinder.toml");
        let scene = Scene::parse(text, "scene.toml").unwrap();
        let next = for_a_tenth(&scene, &results).unwrap();
        assert_eq!(next.quantity, "states.full.max_pressure");
        // Ten times more accurate with second order, whatever the degree of the elements.
        assert_eq!((next.relative_error, next.finer), (0.04, 10f64.sqrt()));
    }
}
