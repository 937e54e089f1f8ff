//! Families of hard cases: what they are made of, and how a case is run and measured.

use crate::analysis::Analysis;
use crate::error::{Error, Result};
use crate::linalg::Backend;
use crate::model::Model;
use crate::progress::Silent;
use crate::results::{Results, State};
use crate::scene::Scene;

/// A family of cases, each of which gives a figure.
pub(super) struct CaseFamily {
    pub(super) name: &'static str,
    pub(super) figure: &'static str,
    pub(super) bound: f64,
    pub(super) source: &'static str,
    pub(super) cases: fn(&mut Cases) -> Result<()>,
}

/// The collected figures of a family.
#[derive(Default)]
pub(super) struct Cases {
    pub(super) count: usize,
    pub(super) worst: f64,
}

impl Cases {
    /// Adds a case with its figure (an error, zero at best).
    pub(super) fn add(&mut self, figure: f64) {
        self.count += 1;
        if figure.is_nan() || figure.abs() > self.worst {
            self.worst = if figure.is_nan() {
                f64::INFINITY
            } else {
                figure.abs()
            };
        }
    }
}

/// Parses a scene of the suite.
pub(super) fn scene(text: &str) -> Result<Scene> {
    Scene::parse(text, "selftest")
}

/// Runs a scene without fields; a limit load or another early end is recorded in the results.
pub(super) fn results(scene: &Scene) -> Result<Results> {
    results_by(scene, Backend::default())
}

pub(super) fn results_by(scene: &Scene, backend: Backend) -> Result<Results> {
    let mut scene = scene.clone();
    for target in &mut scene.program.targets {
        target.fields = false;
    }
    Analysis::new(Model::new(&scene)?, backend)?.run(&mut Silent)
}

pub(super) fn state<'r>(results: &'r Results, name: &str) -> Result<&'r State> {
    let found = results.states.iter().find(|s| s.name == name);
    found.ok_or_else(|| {
        let why = results.incomplete.as_ref().map_or("", |i| i.why.as_str());
        Error::analysis(format!("state `{name}` was not reached: {why}"))
    })
}

/// Returns the largest difference of a figure between the pairs of two states, over the largest
/// value of the first state.
pub(super) fn difference(
    a: &State,
    b: &State,
    figure: fn(&crate::results::PairState) -> f64,
) -> f64 {
    if a.pairs.len() != b.pairs.len() {
        return f64::INFINITY;
    }
    let scale = a.pairs.iter().fold(0.0f64, |m, p| m.max(figure(p).abs()));
    let pairs = a.pairs.iter().zip(&b.pairs);
    pairs.fold(0.0f64, |m, (p, q)| m.max((figure(p) - figure(q)).abs())) / scale
}

/// Returns the worst algebraic figure of all states.
pub(super) fn worst_quality(results: &Results) -> f64 {
    let q = &results.quality;
    [
        q.backward_error,
        q.equilibrium,
        q.complementarity,
        q.penetration,
        q.adhesion,
    ]
    .into_iter()
    .fold(0.0, |m, v| if v.is_nan() { f64::NAN } else { v.max(m) })
}

#[cfg(test)]
mod tests {
    use super::Cases;

    #[test]
    fn what_is_not_a_number_is_the_worst_of_all() {
        let mut cases = Cases::default();
        cases.add(-1e-3);
        cases.add(1e-4);
        assert_eq!((cases.count, cases.worst), (2, 1e-3));
        cases.add(f64::NAN);
        cases.add(1.0);
        assert_eq!((cases.count, cases.worst), (4, f64::INFINITY));
    }
}
