//! The stresses of a state, computed by all ranks: each rank gets the elements in one part of
//! space.
//!
//! A rank gets complete data: its elements with their mesh, displacements, plastic history and free
//! strains, and the surrounding elements if stresses are recovered. The rank keeps none of these
//! data. The stress of an element is the same, to the bit, as if all elements were evaluated
//! together. Forces and recovered stresses of a node that several ranks hold are added rank by
//! rank.

use super::element_stresses::ElementStresses;
use super::stress_field::{Strained, StressField};
use crate::analysis::zone::history::PointHistory;
use crate::analysis::zone::packed;
use crate::element::{Kernel, with_kernel};
use crate::error::{Error, Result};
use crate::material::PlasticState;
use crate::model::{Continuum, FreeOfLoad, Model};
use crate::results::PointValues;
use crate::space::Vector;
use serde::{Deserialize, Serialize};

/// Data sent to a rank.
#[derive(Serialize, Deserialize)]
struct SentPiece {
    continuum: Continuum,
    /// Elements to be evaluated.
    own: Vec<usize>,
    displacements: Vec<Vector>,
    factors: Vec<f64>,
    free: Vec<FreeOfLoad<'static>>,
    in_zone: Vec<usize>,
    #[serde(with = "packed::history")]
    history: Vec<PlasticState<6>>,
    with_fields: bool,
}

/// A state of a model, of which all stresses are to be evaluated.
pub(in crate::analysis) struct Whole<'a> {
    pub(in crate::analysis) model: &'a Model,
    pub(in crate::analysis) displacements: &'a [Vector],
    pub(in crate::analysis) factors: &'a [f64],
    /// Elements of the zone, ascending.
    pub(in crate::analysis) in_zone: &'a [usize],
    pub(in crate::analysis) history: &'a PointHistory,
    pub(in crate::analysis) with_fields: bool,
}

/// Evaluates all elements of a state in `n` pieces. `ask` sends each rank its message and returns
/// the answers that [`evaluate`] gives.
///
/// # Errors
/// Errors of the ranks.
pub(in crate::analysis) fn element_stresses(
    whole: &Whole,
    n: usize,
    ask: impl FnOnce(&mut dyn FnMut(usize) -> Vec<u8>) -> Result<Vec<Vec<u8>>>,
) -> Result<ElementStresses> {
    let mesh = &whole.model.mesh;
    let mut parts = Vec::new();
    let of_ranks = mesh.elements_among(n);
    let around = whole.with_fields.then(|| mesh.with_neighbours(&of_ranks));
    let free = whole.model.free_of_loads();
    let answers = ask(&mut |rank| {
        let own = &of_ranks[rank];
        let all = around.as_ref().map_or(own, |around| &around[rank]);
        let (piece, nodes) = whole.piece(own, all, &free);
        parts.push((rank, nodes, all));
        // The piece consists of vectors and numbers, which can always be serialised.
        postcard::to_stdvec(&piece).unwrap_or_default()
    })?;
    let shown = whole.with_fields.then_some(2 * mesh.dimension);
    let mut sum = ElementStresses::zeros(mesh.n_nodes(), mesh.n_elements(), shown);
    if let Some(shown) = sum.shown.as_mut().filter(|_| whole.model.point_values) {
        let n_points = (0..mesh.n_elements()).map(|e| mesh.n_points(e));
        shown.points = Some(PointValues::zeros(n_points, 2 * mesh.dimension));
    }
    parts.sort_by_key(|(rank, ..)| *rank);
    for ((rank, nodes, all), answer) in parts.iter().zip(answers) {
        sum.add(from_bytes(&answer)?, (&of_ranks[*rank], nodes, all));
    }
    sum.beyond_yield_outside.sort_unstable();
    Ok(sum)
}

impl Whole<'_> {
    /// The piece with the elements `all` (ascending), of which the elements `own` are to be
    /// evaluated, and the nodes of the piece.
    fn piece(&self, own: &[usize], all: &[usize], free: &[FreeOfLoad]) -> (SentPiece, Vec<u32>) {
        let (continuum, nodes) = self.model.continuum.part(all);
        let stride = self.history.points.len() / self.in_zone.len().max(1);
        let (mut in_zone, mut history) = (Vec::new(), Vec::new());
        for (local, e) in all.iter().enumerate() {
            if let Ok(place) = self.in_zone.binary_search(e) {
                in_zone.push(local);
                history.extend_from_slice(&self.history.points[place * stride..][..stride]);
            }
        }
        let local = |e: &usize| all.partition_point(|other| other < e);
        let piece = SentPiece {
            continuum,
            own: own.iter().map(local).collect(),
            displacements: (nodes.iter().map(|&n| self.displacements[n as usize])).collect(),
            factors: self.factors.to_vec(),
            free: free.iter().map(|free| free.part(&nodes)).collect(),
            in_zone,
            history,
            with_fields: self.with_fields,
        };
        (piece, nodes)
    }
}

/// Computes the stresses of a piece. Both are passed as bytes, as ranks send them.
///
/// # Errors
/// `Internal` if the piece cannot be read.
pub fn evaluate(piece: &[u8]) -> Result<Vec<u8>> {
    let piece: SentPiece = from_bytes(piece)?;
    let Continuum {
        kind,
        formulation,
        ref mesh,
        ..
    } = piece.continuum;
    let stresses = with_kernel!(kind, formulation, mesh, kernel => piece.stresses(kernel));
    postcard::to_stdvec(&stresses)
        .map_err(|cause| Error::internal("stresses as bytes").because(cause))
}

fn from_bytes<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T> {
    postcard::from_bytes(bytes)
        .map_err(|cause| Error::internal("stresses from bytes").because(cause))
}

impl SentPiece {
    fn stresses<const D: usize, const S: usize, const P: usize, const N: usize>(
        &self,
        kernel: Kernel<D, S, P, N>,
    ) -> ElementStresses {
        let history: Vec<PlasticState<S>> = self.history.iter().map(|h| h.resized()).collect();
        let state = Strained {
            displacements: &self.displacements,
            factors: &self.factors,
            free: &self.free,
            in_zone: &self.in_zone,
            history: &history,
        };
        let field = StressField::new(kernel, &self.continuum, state);
        ElementStresses::new(&field, &self.own, self.with_fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Scenes that cover plane, axisymmetric and solid models, triangles, free strains, and yield
    /// stress by depth.
    const SCENES: [(&str, &[&str]); 6] = [
        (
            "disc_in_plate",
            &[
                "mesh.disc_in_plate.resolution=6",
                "mesh.disc_in_plate.far_radius=4.0",
            ],
        ),
        (
            "thick_cylinder",
            &[
                "mesh.parts.0.element=\"tri6\"",
                "mesh.parts.0.ring.elements=[6,4]",
            ],
        ),
        (
            "fit_by_heat",
            &[
                "mesh.parts.0.disc.elements=6",
                "mesh.parts.1.ring.elements=[6,6]",
            ],
        ),
        ("blocks_tet10", &[]),
        (
            "ball_in_groove",
            &[
                "mesh.curved_bodies.resolution=2",
                "mesh.curved_bodies.far_size=6",
                "mesh.curved_bodies.contact_width=1.5",
            ],
        ),
        (
            "cylinder_on_half_plane",
            &[
                "mesh.cylinder_on_half_plane.resolution=2",
                "mesh.cylinder_on_half_plane.far_size=10",
                "bodies.half_plane.yield_by_depth=[[0.0, 900.0], [1.0, 500.0]]",
            ],
        ),
    ];

    /// An arbitrary field that is not smooth: strains grow from zero on the left to several times
    /// yield.
    fn displacements(model: &Model) -> Vec<Vector> {
        const YIELD_STRAIN: f64 = 0.02;
        let places = || (0..model.mesh.n_nodes()).map(|n| model.mesh.point(n));
        let ends = |axis: usize| {
            let along = places().map(|x| x[axis]);
            along.fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x), b.max(x)])
        };
        let ends = [0, 1, 2].map(ends);
        let size = ends.iter().fold(0.0f64, |m, [a, b]| m.max(b - a));
        let node = |x: Vector| {
            let [x, y, z] = [0, 1, 2].map(|k| (x[k] - ends[k][0]) / size);
            let rise = size * x * x * x;
            let wave = |k: f64| YIELD_STRAIN * rise * (7.0 * k * (x + 1.3 * y) + z).sin();
            [
                wave(1.0),
                wave(0.6),
                if model.mesh.is_solid() {
                    wave(1.7)
                } else {
                    0.0
                },
            ]
        };
        places().map(node).collect()
    }

    /// Plastic states that differ from point to point, with shear out of the plane in a solid.
    fn plastic_states(n_points: usize, is_solid: bool) -> Vec<PlasticState<6>> {
        let state = |k: usize| {
            let strain = 1e-4 * (k % 7) as f64;
            let shear = if is_solid { 0.3 * strain } else { 0.0 };
            PlasticState {
                strain: [
                    strain,
                    -0.25 * strain,
                    -0.75 * strain,
                    0.5 * strain,
                    shear,
                    -shear,
                ],
                equivalent: strain,
            }
        };
        (0..n_points).map(state).collect()
    }

    /// Results of elements are the same bit for bit in any number of pieces. Sums over several
    /// pieces agree to the round-off of a sum.
    #[test]
    fn elements_come_to_the_same_in_pieces() {
        for (name, changes) in SCENES {
            let file = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let changes: Vec<String> = changes.iter().map(|text| text.to_string()).collect();
            let mut scene = Scene::load_with(file, &changes).unwrap();
            scene.requests.point_values = true;
            let model = Model::new(&scene).unwrap();
            let (mesh, displacements) = (&model.mesh, displacements(&model));
            let in_zone: Vec<usize> = (0..mesh.n_elements()).step_by(3).collect();
            let n_points = mesh.most_points() * in_zone.len();
            let history = PointHistory {
                points: plastic_states(n_points, mesh.is_solid()),
                ..PointHistory::default()
            };
            let whole = Whole {
                model: &model,
                displacements: &displacements,
                factors: &vec![0.7; model.loads.len()],
                in_zone: &in_zone,
                history: &history,
                with_fields: true,
            };
            let in_pieces = |n: usize| {
                element_stresses(&whole, n, |message| {
                    (0..n).map(|rank| evaluate(&message(rank))).collect()
                })
                .unwrap()
            };
            let kind = (model.kind, model.formulation);
            let (expected, largest_force) = with_kernel!(kind.0, kind.1, mesh, kernel => {
                at_once(kernel, &whole)
            });
            let n_beyond = expected.beyond_yield_outside.len();
            let may_yield = model.may_yield.contains(&true);
            assert_eq!(n_beyond > 0, may_yield, "{name}");
            assert!(n_beyond < mesh.n_elements() - in_zone.len(), "{name}");
            for n in [1, 2, 7] {
                let found = in_pieces(n);
                assert_eq!(found.beyond_yield_outside, expected.beyond_yield_outside);
                let [found_shown, shown] =
                    [&found, &expected].map(|stresses| stresses.shown.as_ref().unwrap());
                assert_eq!(found_shown.stress, shown.stress, "{name} in {n}");
                assert_eq!(found_shown.von_mises, shown.von_mises, "{name} in {n}");
                assert_eq!(found_shown.plastic_strain, shown.plastic_strain);
                assert!(shown.points.is_some() && found_shown.points == shown.points);
                let [recovered, whole] = [&found_shown.recovered, &shown.recovered];
                assert_eq!(recovered.energies, whole.energies, "{name} in {n}");
                assert_eq!(recovered.n_elements_of, whole.n_elements_of);
                // A sum has as many terms as elements meet at a node, each no larger than the
                // largest.
                let most = *whole.n_elements_of.iter().max().unwrap();
                let close = |found: &[f64], expected: &[f64], terms: f64| {
                    let size = terms * expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
                    for (a, b) in found.iter().zip(expected) {
                        assert!(
                            (a - b).abs() <= f64::EPSILON * size,
                            "{name} in {n}: {a} {b}"
                        );
                    }
                };
                let terms = f64::from(most);
                close(&recovered.at_nodes, &whole.at_nodes, terms);
                let both = found.forces.as_flattened().iter();
                for (a, b) in both.zip(expected.forces.as_flattened()) {
                    let off = (a - b).abs();
                    assert!(off <= terms * f64::EPSILON * largest_force, "{name} in {n}");
                }
            }
        }
    }

    /// Evaluates all elements in one process, as the reference for the evaluation in pieces; also
    /// returns the largest component, in absolute value, of the nodal forces of any element.
    fn at_once<const D: usize, const S: usize, const P: usize, const N: usize>(
        kernel: Kernel<D, S, P, N>,
        whole: &Whole,
    ) -> (ElementStresses, f64) {
        let points = &whole.history.points;
        let history: Vec<PlasticState<S>> = points.iter().map(|h| h.resized()).collect();
        let state = Strained {
            displacements: whole.displacements,
            factors: whole.factors,
            free: &whole.model.free_of_loads(),
            in_zone: whole.in_zone,
            history: &history,
        };
        let field = StressField::new(kernel, &whole.model.continuum, state);
        let all: Vec<usize> = (0..whole.model.mesh.n_elements()).collect();
        let forces = |e: &usize| {
            let element = field.at(*e);
            element.gradients.forces(&element.stress)
        };
        let forces = all.iter().flat_map(forces).flatten();
        let largest = forces.fold(0.0f64, |m, force| m.max(force.abs()));
        (ElementStresses::new(&field, &all, true), largest)
    }
}
