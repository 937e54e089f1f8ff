//! The quantities that a run reports, by their paths in `summary.json`.

use crate::results::Results;
use std::collections::BTreeMap;

/// A reported quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// `yield.KEY` or `states.NAME.KEY`.
    pub path: String,
    /// Its value.
    pub value: f64,
    /// The largest size that a quantity of this KEY has in the run: what its error is measured against.
    pub scale: f64,
    /// Whether a demanded accuracy holds for it: not for the plastic zone and values at one point
    /// (largest plastic strain, pole).
    pub governs: bool,
}

/// Whether a demanded accuracy holds for quantities of this key. The size of the plastic zone is
/// counted in whole Gauss points; the largest plastic strain and the pressure at the pole are
/// values at one point. Their errors are stated only.
pub(super) fn governs(key: &str) -> bool {
    ![
        "plastic_zone_size",
        "pole_pressure",
        "max_equivalent_plastic_strain",
    ]
    .contains(&key)
}

/// All reported quantities of a run: yield load, maximum pressure, pressure at the pole, half
/// width, residual depth, approach, largest plastic strain and size of the plastic zone, as far as
/// the scene has contact and yields.
pub fn quantities(results: &Results) -> Vec<Quantity> {
    let contact = results.sizes.contact_pairs > 0;
    let plastic = results.states.iter().any(|s| s.plastic_points > 0);
    let mut out: Vec<(&'static str, Quantity)> = Vec::new();
    let mut add = |key: &'static str, prefix: &str, value: f64, when: bool| {
        if when && value.is_finite() {
            let quantity = Quantity {
                path: format!("{prefix}.{key}"),
                value,
                scale: 0.0,
                governs: governs(key),
            };
            out.push((key, quantity));
        }
    };
    if let Some(first) = &results.first_yield {
        add("load", "yield", first.load, true);
        add("max_pressure", "yield", first.max_pressure, contact);
        add("half_width", "yield", first.half_width, contact);
    }
    for state in &results.states {
        let prefix = format!("states.{}", state.name);
        add("load", &prefix, state.load, true);
        add("max_pressure", &prefix, state.max_pressure, contact);
        add("pole_pressure", &prefix, state.pole_pressure, contact);
        add("half_width", &prefix, state.half_width, contact);
        add("approach", &prefix, state.approach, true);
        add(
            "residual_depth",
            &prefix,
            state.residual_depth,
            contact && plastic,
        );
        add(
            "max_equivalent_plastic_strain",
            &prefix,
            state.max_equivalent_plastic_strain,
            plastic,
        );
        add(
            "plastic_zone_size",
            &prefix,
            state.plastic_zone_size,
            plastic,
        );
    }
    let mut scales: BTreeMap<&str, f64> = BTreeMap::new();
    for (key, quantity) in &out {
        let scale = scales.entry(key).or_insert(0.0);
        *scale = scale.max(quantity.value.abs());
    }
    out.into_iter()
        .map(|(key, quantity)| Quantity {
            scale: scales[key],
            ..quantity
        })
        .collect()
}

/// The value of a quantity by its path.
pub fn value_of(quantities: &[Quantity], path: &str) -> Option<f64> {
    quantities.iter().find(|q| q.path == path).map(|q| q.value)
}

/// What goes with the load of first yield and of the states, by path: its factor, and the contact force.
pub(super) fn with_loads(results: &Results) -> BTreeMap<String, f64> {
    let first = results.first_yield.iter();
    let first = first.map(|point| ("yield.alpha".to_string(), point.alpha));
    let states = results.states.iter().flat_map(|state| {
        let values = [
            ("alpha", state.alpha),
            ("contact_force", state.contact_force),
        ];
        values.map(|(key, value)| (format!("states.{}.{key}", state.name), value))
    });
    first.chain(states).collect()
}

/// Sets the value of a quantity, or of what goes with one, by its path.
pub(super) fn put(results: &mut Results, path: &str, value: f64) {
    let Some((prefix, key)) = path.rsplit_once('.') else {
        return;
    };
    let slot = match prefix.strip_prefix("states.") {
        None => results.first_yield.as_mut().and_then(|point| match key {
            "alpha" => Some(&mut point.alpha),
            "load" => Some(&mut point.load),
            "max_pressure" => Some(&mut point.max_pressure),
            "half_width" => Some(&mut point.half_width),
            _ => None,
        }),
        Some(name) => {
            let state = results.states.iter_mut().find(|s| s.name == name);
            state.and_then(|state| match key {
                "alpha" => Some(&mut state.alpha),
                "load" => Some(&mut state.load),
                "contact_force" => Some(&mut state.contact_force),
                "max_pressure" => Some(&mut state.max_pressure),
                "pole_pressure" => Some(&mut state.pole_pressure),
                "half_width" => Some(&mut state.half_width),
                "approach" => Some(&mut state.approach),
                "residual_depth" => Some(&mut state.residual_depth),
                "plastic_zone_size" => Some(&mut state.plastic_zone_size),
                _ => None,
            })
        }
    };
    if let Some(slot) = slot {
        *slot = value;
    }
}

/// A run with one state.
#[cfg(test)]
pub(super) fn pressed(load: f64, approach: f64) -> Results {
    let state = crate::results::State {
        name: "pressed".into(),
        load,
        approach,
        ..Default::default()
    };
    Results {
        states: vec![state],
        ..Results::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{State, YieldPoint};

    #[test]
    fn quantities_follow_what_the_scene_has() {
        let mut results = Results {
            first_yield: Some(YieldPoint {
                alpha: 1.0,
                load: 5.0,
                max_pressure: 2.0,
                half_width: 0.1,
                location: [0.0; 2],
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
        // A pressure that is not a number is no quantity.
        assert_eq!(quantities(&results).len(), 3 + 7);
        results.states[0].max_equivalent_plastic_strain = 0.02;
        results.states[0].pole_pressure = 3.0;
        for (key, value) in [
            ("max_equivalent_plastic_strain", 0.02),
            ("pole_pressure", 3.0),
        ] {
            let path = format!("states.pressed.{key}");
            let all = quantities(&results);
            let found = all.iter().find(|q| q.path == path).unwrap();
            assert_eq!((found.value, found.governs), (value, false), "{path}");
        }
        assert_eq!(
            value_of(&quantities(&results), "yield.half_width"),
            Some(0.1)
        );
        assert!(
            !quantities(&results)
                .iter()
                .any(|q| q.governs && q.path.ends_with("zone_size"))
        );
    }
}
