//! Points of the load path.

use serde::{Deserialize, Serialize};

/// A point of the load path: the factor of each load and the share of the interference that is
/// applied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoadPoint {
    /// Load factor in units of the program.
    pub alpha: f64,
    /// Factor of each load.
    pub factors: Vec<f64>,
    /// Share of the interference that is applied, 0 to 1.
    #[serde(rename = "interference")]
    pub interference_share: f64,
}

impl LoadPoint {
    /// The point at which none of `n_loads` loads acts.
    pub fn unloaded(n_loads: usize) -> Self {
        LoadPoint {
            alpha: 0.0,
            factors: vec![0.0; n_loads],
            interference_share: 0.0,
        }
    }

    /// The load point at the share `t` of the way to `end`.
    pub fn towards(&self, end: &LoadPoint, t: f64) -> LoadPoint {
        let mix = |a: f64, b: f64| if t == 1.0 { b } else { a + t * (b - a) };
        let factors = self.factors.iter().zip(&end.factors);
        LoadPoint {
            alpha: mix(self.alpha, end.alpha),
            factors: factors.map(|(a, b)| mix(*a, *b)).collect(),
            interference_share: mix(self.interference_share, end.interference_share),
        }
    }

    /// Changes of all load factors, and of the interference, on the way to `end`.
    pub fn step_to(&self, end: &LoadPoint) -> Vec<f64> {
        let factors = end.factors.iter().zip(&self.factors);
        let mut step: Vec<f64> = factors.map(|(b, a)| b - a).collect();
        step.push(end.interference_share - self.interference_share);
        step
    }

    /// Largest change of a load factor or of the interference on the way to `end`.
    pub fn distance(&self, end: &LoadPoint) -> f64 {
        self.step_to(end).iter().fold(0.0, |m, d| m.max(d.abs()))
    }

    /// The share of the way from this load point to `end` at which `between` lies.
    pub fn share_of(&self, between: &LoadPoint, end: &LoadPoint) -> f64 {
        if end.alpha != self.alpha {
            (between.alpha - self.alpha) / (end.alpha - self.alpha)
        } else {
            (between.interference_share - self.interference_share)
                / (end.interference_share - self.interference_share)
        }
    }
}
