//! The quantities that a run reports, by their paths in `summary.json`.

use crate::results::{EdgeReading, Results, State};
use std::collections::BTreeMap;

/// A reported quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// `yield.KEY` or `states.NAME.KEY`.
    pub path: String,
    /// Its value.
    pub value: f64,
    /// The largest size that a quantity of this KEY has in the run: what its error is measured
    /// against.
    pub scale: f64,
    /// What the reading of it off the pressures may be wrong by: of half widths, else 0.
    pub reading: f64,
}

impl Quantity {
    /// The last part of its path.
    pub fn key(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or(&self.path)
    }
}

/// Whether a demand on all quantities holds for those of this key. The size of the plastic zone is
/// counted in whole Gauss points; the largest plastic strain and the pressure at the pole are
/// values at one point: their errors are stated, and demanded where they are named.
pub(super) fn is_demanded_with_all(key: &str) -> bool {
    ![
        "plastic_zone_size",
        "pole_pressure",
        "max_equivalent_plastic_strain",
    ]
    .contains(&key)
}

/// Formal order of convergence: that of the displacements, one more than the degree of the elements
/// (G. Strang, G. J. Fix, *An Analysis of the Finite Element Method*, Prentice-Hall 1973, chapter 3). The largest strain of the Gauss points and the zone
/// that they count are those of the nearest point, a share of an element away: of first order.
pub(super) fn formal_order(key: &str, degree: usize) -> f64 {
    match key {
        "max_equivalent_plastic_strain" | "plastic_zone_size" => 1.0,
        _ => degree.max(1) as f64 + 1.0,
    }
}

/// All reported quantities of a run, as far as the scene has contact and yields: loads, pressures,
/// half widths, approach, dent, largest plastic strain and size of the plastic zone.
pub fn quantities(results: &Results) -> Vec<Quantity> {
    let contact = results.sizes.contact_pairs > 0;
    let plastic = results.states.iter().any(|s| s.plastic_points > 0);
    let mut out: Vec<Quantity> = Vec::new();
    let mut add = |prefix: &str, key: &str, value: f64, reading: f64| {
        if value.is_finite() {
            out.push(Quantity {
                path: format!("{prefix}.{key}"),
                value,
                scale: 0.0,
                reading,
            });
        }
    };
    if let Some(first) = &results.first_yield {
        add("yield", "load", first.load, 0.0);
        if contact {
            let reading = first.half_width_reading;
            add("yield", "max_pressure", first.max_pressure, 0.0);
            add("yield", "half_width", first.half_width, reading.error);
        }
    }
    for state in &results.states {
        let prefix = format!("states.{}", state.name);
        for (key, value) in of_state(state, contact, plastic) {
            let EdgeReading { error, .. } = state.half_width_reading;
            let reading = if key == "half_width" { error } else { 0.0 };
            add(&prefix, key, value, reading);
        }
    }
    let mut scales: BTreeMap<String, f64> = BTreeMap::new();
    for quantity in &out {
        let scale = scales.entry(quantity.key().to_string()).or_insert(0.0);
        *scale = scale.max(quantity.value.abs());
    }
    for quantity in &mut out {
        quantity.scale = scales[quantity.key()];
    }
    out
}

/// What a state reports.
fn of_state(state: &State, contact: bool, plastic: bool) -> Vec<(&'static str, f64)> {
    let of_contact = [
        ("max_pressure", state.max_pressure),
        ("pole_pressure", state.pole_pressure),
        ("half_width", state.half_width),
    ];
    let of_yielding = [
        (
            "max_equivalent_plastic_strain",
            state.max_equivalent_plastic_strain,
        ),
        ("plastic_zone_size", state.plastic_zone_size),
    ];
    let mut out = vec![("load", state.load), ("approach", state.approach)];
    out.extend(of_contact.into_iter().filter(|_| contact));
    out.extend(of_yielding.into_iter().filter(|_| plastic));
    if contact && plastic {
        out.push(("residual_depth", state.residual_depth));
    }
    out
}

/// The value of a quantity by its path.
pub fn value_of(quantities: &[Quantity], path: &str) -> Option<f64> {
    quantities.iter().find(|q| q.path == path).map(|q| q.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::YieldPoint;
    use crate::scene::DEMANDED;

    #[test]
    fn quantities_follow_what_the_scene_has() {
        let mut results = Results {
            first_yield: Some(YieldPoint {
                alpha: 1.0,
                load: 5.0,
                max_pressure: 2.0,
                half_width: 0.1,
                half_width_reading: EdgeReading {
                    error: 0.01,
                    pairs: 5,
                },
                location: [0.0; 3],
                body: 0,
            }),
            states: vec![State {
                name: "pressed".into(),
                load: -10.0,
                max_pressure: f64::NAN,
                ..State::default()
            }],
            ..Results::default()
        };
        let paths =
            |r: &Results| -> Vec<String> { quantities(r).into_iter().map(|q| q.path).collect() };
        assert_eq!(
            paths(&results),
            [
                "yield.load",
                "states.pressed.load",
                "states.pressed.approach"
            ]
        );
        let all = quantities(&results);
        assert_eq!((all[0].value, all[0].scale), (5.0, 10.0));
        results.sizes.contact_pairs = 3;
        results.states[0].plastic_points = 1;
        results.states[0].half_width = 0.3;
        // A pressure that is not a number is no quantity.
        let all = quantities(&results);
        assert_eq!(all.len(), 3 + 7);
        let width = all.iter().find(|q| q.path == "yield.half_width").unwrap();
        assert_eq!((width.reading, width.scale), (0.01, 0.3));
        assert!(all.iter().filter(|q| q.reading > 0.0).count() == 1);
        for quantity in &all {
            assert!(DEMANDED.iter().any(|(key, _)| *key == quantity.key()));
        }
    }
}
