//! The elastic stress at the program's largest loads, computed on a coarser mesh so that a solid is
//! factored only once.
//!
//! The region in which a solid will yield is known only after first yield, and factoring the solid
//! again for that zone costs as much as the first time. A mesh of the same family with elements
//! twice as large shows the stress beforehand for a sixty-fourth of the operations. Its error is
//! covered by the margin of the zone; a zone that still proves too small is enlarged like any
//! other.

use super::assembled::Analysis;
use super::position::Purpose;
use super::run::Run;
use super::zone_changes::elastic_ratios;
use crate::analysis::choice::zone_choice::{place_of_first_yield, predict};
use crate::analysis::choice::zone_fit::Expected;
use crate::balls::Balls;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::mesh::generate::Family;
use crate::model::Model;
use crate::progress::Observer;
use crate::scene::Scene;
use crate::space::{Vector, along};
use std::time::Instant;

/// Ratio of the element size of the coarser mesh to that of the run's mesh.
const COARSER: f64 = 2.0;
/// Least ratio of element sizes at which the coarser mesh costs little enough: an eighth of the
/// factorisation.
const LEAST: f64 = 1.4;

/// The stress ratios from a coarser mesh. `None` if the zone is known without them, if there is no
/// coarser mesh on which the program begins, or if no element is predicted to yield. The last may
/// occur if a target searches for its load: only first yield is then known, and elements that are
/// too coarse for the contact miss the largest stress.
pub(super) fn expect(analysis: &Analysis, observer: &mut dyn Observer) -> Option<Expected> {
    let since = Instant::now();
    let model = &analysis.model;
    let is_alone = analysis.system.stiffness.n_ranks() == 1 && model.start.is_none();
    if !model.kind.is_solid() || !is_alone || place_of_first_yield(model).holds_all(model) {
        return None;
    }
    let (mesh, ratio) = model.scene.mesh.member(COARSER).ok()?;
    observer.phase("stress on a coarser mesh");
    let scene = Scene {
        mesh,
        ..model.scene.clone()
    };
    let coarser = Model::new(&scene).ok().filter(|_| ratio >= LEAST)?;
    let coarser = Analysis::new(coarser, analysis.backend).ok()?;
    let ratios = on_its_own_mesh(&coarser, observer).ok().flatten()?;
    let ratios = carried_over(&coarser.model.mesh, &ratios, &model.mesh);
    let yields = !predict(model, &ratios).elements.is_empty();
    yields.then_some(Expected { ratios, since })
}

/// Ratio of elastic von Mises stress to yield stress of each element: the larger of the values at
/// first yield and at the program's extreme loads. `None` if nothing yields.
fn on_its_own_mesh(analysis: &Analysis, observer: &mut dyn Observer) -> Result<Option<Vec<f64>>> {
    let mut quiet = UntilStopped(observer);
    let mut run = Run::new(analysis, Purpose::Zone, None, &mut quiet)?;
    run.execute()?;
    let Some(at_yield) = run.position.first_yield.alpha else {
        return Ok(None);
    };
    let mut factors = run.targets.extreme_factors(at_yield);
    factors.push(at_yield);
    elastic_ratios(&mut run.solver, &factors).map(Some)
}

/// Carries values from one mesh to another: each element gets the value of the nearest element of
/// the same body, the largest one if several are equally near.
fn carried_over(from: &Mesh, values: &[f64], to: &Mesh) -> Vec<f64> {
    let of_body = |name: &String| {
        let body = from.bodies.iter().position(|other| other == name);
        let ours = |e: &usize| Some(from.element_body[*e] as usize) == body;
        let elements: Vec<usize> = (0..from.n_elements()).filter(ours).collect();
        let middles = elements.iter().map(|&e| (middle(from, e), 0.0));
        let tree = Balls::new(middles.collect());
        (elements, tree)
    };
    let bodies: Vec<(Vec<usize>, Balls)> = to.bodies.iter().map(of_body).collect();
    let value = |e: usize| {
        let (elements, tree) = &bodies[to.element_body[e] as usize];
        let near = tree.nearest_few(middle(to, e), 1).into_iter();
        near.fold(0.0, |most: f64, (_, item)| most.max(values[elements[item]]))
    };
    (0..to.n_elements()).map(value).collect()
}

/// The mean of an element's nodes.
fn middle(mesh: &Mesh, element: usize) -> Vector {
    let nodes = mesh.nodes(element);
    let share = 1.0 / nodes.len() as f64;
    let places = nodes.iter().map(|&node| mesh.point(node as usize));
    places.fold([0.0; 3], |sum, x| along(sum, share, x))
}

/// Observer that passes on nothing but the request to stop.
struct UntilStopped<'o>(&'o mut dyn Observer);

impl Observer for UntilStopped<'_> {
    fn stop_requested(&self) -> bool {
        self.0.stop_requested()
    }
}
