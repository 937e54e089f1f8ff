//! Stress recovery: the stress between the points where it is most accurate, and its maximum.
//!
//! Stresses are sampled at superconvergent points. Linear triangles have none; their strains are
//! fitted ([`super::fitted`]). Between samples each component is a moving least-squares fit: at a
//! point `x` a cubic polynomial is fitted to the surrounding samples of the same body, with weights
//! that fall smoothly to zero. The recovered stress is therefore continuous, across elements too.
//! Von Mises' stress is maximised over it, so that yield load and yield depth are continuous
//! quantities, not quantised by the mesh. Beyond a plane of symmetry the samples continue as their
//! mirror images, so that a maximum on the plane, as under a ball or cylinder, is found.
//!
//! # Source
//! O. C. Zienkiewicz, J. Z. Zhu, superconvergent patch recovery (1992), doi:10.1002/nme.1620330702;
//! P. Lancaster, K. Salkauskas, moving least squares (1981), doi:10.1090/S0025-5718-1981-0616367-1.

mod cell;
mod sampled;

pub(in crate::analysis) use sampled::Watched;

use super::fitted::FittedStrains;
use super::maximum::{Maximum, SPACINGS};
use super::neighbours::Neighbours;
use super::patch::{Patch, Sample, reach};
use super::patch_fit::ScaledCoordinates;
use crate::analysis::structure::solver::Solver;
use crate::analysis::zone::free_strain::FreeStrains;
use crate::analysis::zone::gather::{GatheredElements, Nodal, Places};
use crate::element::{Kernel, with_kernel};
use crate::material::{Lame, Material, von_mises};
use crate::model::Model;
use crate::model::images::Images;
use crate::model::symmetry::{Conditions, mirrors};
use crate::space::Vector;
use crate::substructure::Trailing;
use cell::Cell;
use rayon::prelude::*;
use sampled::{Sampled, in_space};
use std::collections::BTreeMap;

/// Fraction of the largest sampled ratio above which an element is searched for the recovered
/// maximum.
const CANDIDATE: f64 = 0.93;
/// Ratio of the largest sample to the yield stress below which no recovered maximum is searched.
const FAR_BELOW: f64 = 0.85;
/// Relative difference below which stresses count as equal.
const TIE: f64 = 1e-9;
/// Bound on the curvature of the stress. Near the highest point found at a spacing, the stress
/// exceeds the value found by at most this share times the square of the spacing; a search at that
/// spacing misses at most this share times the fourth power. The search ends when that is no more
/// than `gamma`, since first yield is an event like changes of contact.
const CURVATURE: f64 = 0.1;
/// Largest amount that a search at a spacing misses, as a fraction of the stress.
fn left_after(spacing: f64) -> f64 {
    CURVATURE * spacing.powi(4)
}

/// Bound on how far the maximum found with a `gamma` may lie below the true one, as a fraction of
/// the maximum.
pub fn left_of_search(gamma: f64) -> f64 {
    let last = SPACINGS.iter().find(|s| left_after(**s) <= gamma);
    left_after(*last.unwrap_or(&SPACINGS[SPACINGS.len() - 1]))
}

/// Largest number of elements for which the fits of one search are kept for the next search, at a
/// load near by: at most a quarter of a megabyte for each element.
const FEW: usize = 100;
/// Least number of elements that a thread takes at a time: the work on fewer elements costs less
/// than waking a thread.
const GRAIN: usize = 256;
/// Layers of elements around an element that belong to its patch.
const LAYERS: usize = 3;

/// The sampled stresses of all points of all elements, component by component.
pub type Samples = Vec<f64>;

/// The place at which the material is strained most, and how much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecoveredPeak {
    /// Ratio of von Mises stress to initial yield stress.
    pub ratio: f64,
    /// Coordinates of the point.
    pub location: Vector,
    /// Number of the body that the point lies in.
    pub body: usize,
}

/// Samples and recovers stresses in the elements that may yield.
pub enum Recovery {
    /// Recovery in a plane or axisymmetric model.
    Plane(Box<RecoveryOf<2, 4, 4, 8>>),
    /// Recovery in a solid.
    Solid(Box<RecoveryOf<3, 6, 8, 20>>),
    /// Recovery in a plane or axisymmetric model with a fully integrated body.
    FullPlane(Box<RecoveryOf<2, 4, 9, 8>>),
    /// Recovery in a solid with a fully integrated body.
    FullSolid(Box<RecoveryOf<3, 6, 27, 20>>),
}

/// Evaluates one expression for the recovery of any kernel.
macro_rules! of_recovery {
    ($self:expr, $recovery:ident => $body:expr) => {
        match $self {
            Recovery::Plane($recovery) => $body,
            Recovery::Solid($recovery) => $body,
            Recovery::FullPlane($recovery) => $body,
            Recovery::FullSolid($recovery) => $body,
        }
    };
}

/// The methods of [`RecoveryOf`], for any kernel.
impl Recovery {
    /// Sets up the recovery over the given elements (ascending).
    pub fn new(model: &Model, elements: &[usize], places: &Places, watched: Watched) -> Self {
        let formulation = model.formulation;
        with_kernel!(model.kind, formulation, model.mesh, kernel => {
            RecoveryOf::new(kernel, model, (elements, places), watched).into()
        })
    }

    /// The points at which the stress is watched for first yield.
    pub fn watched(&self) -> Watched {
        of_recovery!(self, recovery => recovery.watched)
    }

    /// Elastic stresses at the sampling points in the current state.
    pub fn sample_here(&mut self, solver: &mut Solver) -> Samples {
        solver.refresh();
        self.sample(&solver.now.u, &solver.at.factors)
    }

    /// [`RecoveryOf::sample`]
    pub fn sample(&mut self, u: &Trailing, factors: &[f64]) -> Samples {
        of_recovery!(self, recovery => recovery.sample(u, factors))
    }

    /// [`RecoveryOf::peak`]
    pub fn peak(&mut self, model: &Model, samples: &Samples) -> Option<RecoveredPeak> {
        of_recovery!(self, recovery => recovery.peak(model, samples))
    }
}

impl From<RecoveryOf<2, 4, 4, 8>> for Recovery {
    fn from(recovery: RecoveryOf<2, 4, 4, 8>) -> Self {
        Recovery::Plane(Box::new(recovery))
    }
}

impl From<RecoveryOf<3, 6, 8, 20>> for Recovery {
    fn from(recovery: RecoveryOf<3, 6, 8, 20>) -> Self {
        Recovery::Solid(Box::new(recovery))
    }
}

impl From<RecoveryOf<2, 4, 9, 8>> for Recovery {
    fn from(recovery: RecoveryOf<2, 4, 9, 8>) -> Self {
        Recovery::FullPlane(Box::new(recovery))
    }
}

impl From<RecoveryOf<3, 6, 27, 20>> for Recovery {
    fn from(recovery: RecoveryOf<3, 6, 27, 20>) -> Self {
        Recovery::FullSolid(Box::new(recovery))
    }
}

/// Recovery with the constants of a kernel.
pub struct RecoveryOf<const D: usize, const S: usize, const P: usize, const N: usize> {
    elements: GatheredElements,
    sampling: Vec<Sampled<D, S, P, N>>,
    first: Vec<usize>,
    /// Coordinates of the sampling points.
    positions: Vec<[f64; D]>,
    materials: Vec<(Material, Lame)>,
    /// The least yield stress at the nodes of each element, if it varies within a body. Elements to
    /// be searched are chosen by it; the maximum is of the ratio to the yield stress at each point.
    least_yield: Vec<f64>,
    /// The yield stress at each Gauss point, if Gauss points are watched and it varies within a
    /// body.
    yield_stresses: Vec<f64>,
    nodal: Nodal,
    /// Strains of the linear triangles and tetrahedra.
    fitted: FittedStrains<D>,
    /// Free strains of the loads.
    free: FreeStrains<P>,
    neighbours: Neighbours,
    patches: BTreeMap<u32, Patch<D>>,
    /// Loads and equations that a plane of symmetry must be free of.
    conditions: Conditions,
    /// Relative tolerance of the maximum.
    gamma: f64,
    watched: Watched,
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> RecoveryOf<D, S, P, N> {
    /// Sets up the recovery over the given elements (ascending).
    fn new(
        kernel: Kernel<D, S, P, N>,
        model: &Model,
        (elements, places): (&[usize], &Places),
        watched: Watched,
    ) -> Self {
        let neighbours = Neighbours::new(&model.mesh, elements.iter().copied());
        let around = (elements, &neighbours);
        let sampled = |&e: &usize| Sampled::new(&kernel, model, around, e, watched);
        let sampling: Vec<Sampled<D, S, P, N>> = elements.iter().map(sampled).collect();
        let positions: Vec<[f64; D]> = sampling.iter().flat_map(|s| s.positions.clone()).collect();
        let packed = GatheredElements::new(model, elements, places);
        let mut first = vec![0];
        for own in &sampling {
            first.push(first[first.len() - 1] + own.positions.len());
        }
        let mut least_yield = Vec::new();
        if model.yield_by_depth.iter().any(Option::is_some) {
            least_yield.extend(packed.list.iter().map(|own| {
                let nodes = model.mesh.nodes(own.element as usize).iter();
                let places = nodes.map(|&node| model.mesh.point(node as usize));
                let stresses = places.map(|x| model.yield_stress(own.body as usize, x));
                stresses.fold(f64::INFINITY, f64::min)
            }));
        }
        let mut yield_stresses = Vec::new();
        if watched == Watched::GaussPoints && !least_yield.is_empty() {
            for (own, places) in packed.list.iter().zip(first.windows(2)) {
                let places = positions[places[0]..places[1]].iter();
                let body = own.body as usize;
                yield_stresses.extend(places.map(|&x| model.yield_stress(body, in_space(x))));
            }
        }
        let mut out = RecoveryOf {
            least_yield,
            yield_stresses,
            free: FreeStrains::new(model, elements, |i, nodal| {
                sampling[i].points.at_points(nodal)
            }),
            elements: packed,
            sampling,
            first,
            positions,
            fitted: FittedStrains::default(),
            materials: model
                .materials
                .iter()
                .map(|m| (m.clone(), m.lame()))
                .collect(),
            nodal: Nodal::new(model, places),
            neighbours,
            patches: BTreeMap::new(),
            conditions: Conditions::of(model),
            gamma: model.program.gamma,
            watched,
        };
        if watched == Watched::Recovered {
            let around = |i| out.neighbours_of(model, i);
            out.fitted = FittedStrains::new(model, elements, places, around);
        }
        out
    }

    /// Elastic stresses at the sampling points for displacements `u` and load factors.
    fn sample(&mut self, u: &Trailing, factors: &[f64]) -> Samples {
        self.nodal.set_factors(factors);
        let nodal = self.nodal.displacements(u);
        let moved = self.fitted.displacements(nodal);
        let (fitted, free) = (&self.fitted, &self.free);
        let (elements, sampling) = (&self.elements, &self.sampling);
        let strains: Vec<_> = (0..elements.list.len())
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(|i| {
                let mut strains = match fitted.strain(i, &moved) {
                    Some(strain) => strain.map(|e| [e; P]),
                    None => (sampling[i].points).strains(&elements.displacements(i, nodal)),
                };
                free.take_off(i, factors, &mut strains);
                sampling[i].of_points(&strains)
            })
            .collect();
        let mut out = Vec::with_capacity(S * self.positions.len());
        for (i, strains) in strains.iter().enumerate() {
            let law = &self.materials[elements.list[i].body as usize].1;
            let points = 0..sampling[i].positions.len();
            out.extend(points.flat_map(|g| law.times(&strains.each_ref().map(|lanes| lanes[g]))));
        }
        out
    }

    /// The recovered maximum of von Mises stress over yield stress, never below the largest sample;
    /// `None` if there is no stress at all. If the largest sample is far below yield, or if Gauss
    /// points are watched, this sample is returned with its own place. Of equal maxima, the first
    /// in the order of the elements is returned.
    fn peak(&mut self, model: &Model, samples: &Samples) -> Option<RecoveredPeak> {
        let (samples, _) = samples.as_chunks::<S>();
        let raw: Vec<f64> = (0..self.elements.list.len())
            .map(|i| {
                let places = self.first[i]..self.first[i + 1];
                let ratios = places.map(|place| self.ratio(i, place, samples));
                ratios.fold(0.0, f64::max)
            })
            .collect();
        let highest = raw.iter().copied().reduce(f64::max).filter(|r| *r > 0.0)?;
        if highest < FAR_BELOW || self.watched == Watched::GaussPoints {
            return self.largest_sample(samples, &raw, highest);
        }
        // A smooth field has its maximum in or beside an element whose sample is a local maximum.
        // Of equal samples (all round a bore) each counts as a local maximum: only round-off would
        // decide which of them is the largest, and the stresses recovered beside them differ.
        let mut candidates: Vec<u32> = Vec::new();
        for i in (0..raw.len()).filter(|&i| raw[i] >= CANDIDATE * highest) {
            let around = self.neighbours_of(model, i);
            let equal = raw[i] * (1.0 + TIE);
            if around.iter().all(|&j| raw[j as usize] <= equal) {
                candidates.extend(around);
            }
        }
        candidates.sort_unstable();
        candidates.dedup();
        let recovered = self.climb(model, &candidates, samples);
        match recovered.filter(|peak| peak.ratio >= highest) {
            None => self.largest_sample(samples, &raw, highest),
            found => found,
        }
    }

    /// The first sample that is as large as the largest, within round-off.
    fn largest_sample(
        &self,
        samples: &[[f64; S]],
        by_element: &[f64],
        ratio: f64,
    ) -> Option<RecoveredPeak> {
        let least = ratio * (1.0 - TIE);
        let i = by_element.iter().position(|r| *r >= least)?;
        let body = self.elements.list[i].body as usize;
        let place = (self.first[i]..self.first[i + 1])
            .find(|&place| self.ratio(i, place, samples) >= least)?;
        Some(RecoveredPeak {
            ratio,
            location: in_space(self.positions[place]),
            body,
        })
    }

    /// Ratio of von Mises stress to yield stress at a sampling point of element `i`.
    fn ratio(&self, i: usize, place: usize, samples: &[[f64; S]]) -> f64 {
        let body = self.elements.list[i].body as usize;
        let limit = (self.yield_stresses.get(place)).or_else(|| self.least_yield.get(i));
        let limit = limit.copied();
        von_mises(&samples[place]) / limit.unwrap_or_else(|| self.materials[body].0.yield_stress())
    }

    /// Elements of the same body that share a node with element `i`, itself included.
    fn neighbours_of(&self, model: &Model, i: usize) -> Vec<u32> {
        let element = &self.elements.list[i];
        let mut around = Vec::new();
        let nodes = model.mesh.nodes(element.element as usize);
        self.neighbours.at(nodes, &mut around);
        around.retain(|&m| self.elements.list[m as usize].body == element.body);
        around
    }

    /// The recovered maximum over some elements. The recovered field is smooth within an element
    /// but not across elements. All elements that may hold the maximum stay in the search: if only
    /// the best element of the first search were followed, round-off would choose it.
    fn climb(
        &mut self,
        model: &Model,
        elements: &[u32],
        samples: &[[f64; S]],
    ) -> Option<RecoveredPeak> {
        let keep = elements.len() <= FEW;
        let mut tops: Vec<(Cell<D, N>, Maximum<D>)> = Vec::with_capacity(elements.len());
        for &i in elements {
            self.cache_patch(model, i);
            let element = self.elements.list[i as usize].element as usize;
            let nodes = model.mesh.element_coordinates(element);
            let cells = Cell::of(i, model.mesh.shapes[element], nodes).into_iter();
            tops.extend(cells.map(|cell| (cell, Maximum::unknown())));
        }
        let highest = |tops: &[(Cell<D, N>, Maximum<D>)]| {
            tops.iter().fold(f64::NEG_INFINITY, |m, t| m.max(t.1.value))
        };
        for spacing in SPACINGS {
            for (cell, top) in &mut tops {
                top.look_around(spacing, &mut |at, again| {
                    let point = cell.point(at);
                    let stress = self.value_at(cell.element, point, samples, keep && again);
                    let body = self.elements.list[cell.element as usize].body as usize;
                    stress / model.yield_stress(body, in_space(point))
                });
            }
            if left_after(spacing) <= self.gamma {
                break;
            }
            let least = highest(&tops) * (1.0 - CURVATURE * spacing * spacing);
            tops.retain(|t| t.1.value >= least);
        }
        // Equal bodies yield together: the first of equal maxima is returned (elements are
        // ascending), not the one with the larger round-off.
        let ratio = highest(&tops);
        let (cell, top) = tops.iter().find(|t| t.1.value >= ratio * (1.0 - TIE))?;
        Some(RecoveredPeak {
            ratio,
            location: in_space(cell.point(top.at)),
            body: self.elements.list[cell.element as usize].body as usize,
        })
    }

    /// Recovered von Mises stress at a point of an element whose patch is cached.
    fn value_at(&mut self, i: u32, point: [f64; D], samples: &[[f64; S]], keep: bool) -> f64 {
        let patch = self.patches.get_mut(&i);
        patch.map_or(0.0, |patch| von_mises(&patch.value(samples, point, keep)))
    }

    fn cache_patch(&mut self, model: &Model, i: u32) {
        if !self.patches.contains_key(&i) {
            let patch = self.patch(model, i as usize);
            self.patches.insert(i, patch);
        }
    }

    /// The patch of an element: the samples of its body in the layers of elements around it.
    fn patch(&self, model: &Model, i: usize) -> Patch<D> {
        let mut members = std::collections::BTreeSet::from([i as u32]);
        for _ in 0..LAYERS {
            let around: Vec<u32> = members
                .iter()
                .flat_map(|&m| self.neighbours_of(model, m as usize))
                .collect();
            members.extend(around);
        }
        let element = self.elements.list[i].element as usize;
        let frame = ScaledCoordinates::about(&model.mesh, element);
        let elements: Vec<usize> = members
            .iter()
            .map(|&m| self.elements.list[m as usize].element as usize)
            .collect();
        let own: Vec<usize> = members
            .iter()
            .flat_map(|&m| self.first[m as usize]..self.first[m as usize + 1])
            .collect();
        let mut mirrors = mirrors(model, &self.conditions, &elements);
        // A plane with the body on both sides is not part of its boundary, and no plane of
        // symmetry.
        mirrors.retain(|m| {
            own.iter()
                .all(|&i| m.beyond(in_space(self.positions[i])) < 0.0)
        });
        let reach = reach(D, self.sampling[i].positions.len());
        let mut samples: Vec<Sample<D>> = Vec::new();
        let images = Images::of(&mirrors);
        for &i in &own {
            for image in images.iter() {
                let at = image.of(in_space(self.positions[i]));
                let reflection = image.reflection();
                let position: [f64; D] = frame.relative(at);
                // Mirror images are kept if a weight can reach them from a point of the element.
                let far = position.iter().map(|x| x * x).sum::<f64>().sqrt();
                if reflection.is_none() || far < reach + 1.0 {
                    samples.push(Sample {
                        index: i as u32,
                        position,
                        reflection,
                    });
                }
            }
        }
        Patch::new(frame, reach, samples)
    }
}

#[cfg(test)]
mod tests;
