//! Stress where it is most accurate, and its maximum between the points.
//!
//! Stresses are sampled at superconvergent points. Around an element a quadratic polynomial is fitted to each stress
//! component over a patch of elements of the same body, and von Mises' stress is maximised over the element:
//! yield load and yield depth then are continuous quantities, not quantised by the mesh.
//!
//! # Source
//! O. C. Zienkiewicz, J. Z. Zhu, superconvergent patch recovery (1992), doi:10.1002/nme.1620330702, with patches of
//! elements round an element instead of a node.

use super::gather::{GatheredElement, Lookup, Places, Prescribed};
use crate::assembly::LocalElement;
use crate::element::shape_functions;
use crate::material::{Material, Matrix4, stress, von_mises};
use crate::model::Model;
use crate::substructure::Trailing;
use nalgebra::{DMatrix, SVD};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Share of the largest sampled ratio above which an element is searched for the recovered maximum.
const CANDIDATE: f64 = 0.93;
/// Terms of the quadratic polynomial.
const TERMS: usize = 6;
/// Fewest samples for a quadratic fit.
const SAMPLES: usize = 9;

/// The sampled stress `[xx, yy, zz, xy]` of all points of all elements, element by element.
pub type Samples = Vec<[f64; 4]>;

/// Where and how much the material is strained most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Von Mises stress over initial yield stress.
    pub ratio: f64,
    /// Coordinates.
    pub location: [f64; 2],
    /// Body.
    pub body: usize,
}

/// Samples and recovers stresses in the elements that may yield.
pub struct Recovery {
    elements: Vec<GatheredElement>,
    first: Vec<usize>,
    materials: Vec<(Material, Matrix4)>,
    prescribed: Prescribed,
    neighbours: BTreeMap<u32, Vec<u32>>,
    patches: BTreeMap<u32, Patch>,
}

/// Least-squares fit over a patch: polynomial coefficients are `fit * samples`.
#[derive(Debug, Clone)]
struct Patch {
    center: [f64; 2],
    scale: [f64; 2],
    samples: Vec<u32>,
    fit: DMatrix<f64>,
}

impl Recovery {
    /// Recovery over the given elements (ascending).
    pub fn new(model: &Model, elements: &[usize], places: &Places) -> Self {
        let list: Vec<GatheredElement> = elements
            .par_iter()
            .map(|&e| GatheredElement::new(model, e, LocalElement::sampled(model, e), places))
            .collect();
        let mut first = vec![0];
        let mut neighbours: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (i, element) in list.iter().enumerate() {
            first.push(first[i] + element.points.len());
            for &node in model.mesh.nodes(element.element) {
                neighbours.entry(node).or_default().push(i as u32);
            }
        }
        Recovery {
            elements: list,
            first,
            materials: model
                .materials
                .iter()
                .map(|m| (m.clone(), m.elastic_matrix()))
                .collect(),
            prescribed: Prescribed::new(model),
            neighbours,
            patches: BTreeMap::new(),
        }
    }

    /// Elastic stresses at the sampling points for displacements `u` and load factors.
    pub fn sample(&mut self, u: &Trailing, factors: &[f64]) -> Samples {
        self.prescribed.set_factors(factors);
        let lookup = Lookup::new(u, &self.prescribed);
        let blocks: Vec<Vec<[f64; 4]>> = self
            .elements
            .par_iter()
            .with_min_len(64)
            .map(|element| {
                let displacement = lookup.gather(element);
                let elastic = &self.materials[element.body as usize].1;
                element
                    .points
                    .iter()
                    .map(|p| {
                        stress(
                            elastic,
                            &p.strain(&displacement[..element.points.n_freedoms]),
                            &[0.0; 4],
                        )
                    })
                    .collect()
            })
            .collect();
        blocks.concat()
    }

    /// The recovered maximum of von Mises stress over yield stress.
    pub fn peak(&mut self, model: &Model, samples: &Samples) -> Option<Peak> {
        let raw: Vec<f64> = (0..self.elements.len())
            .map(|i| {
                let y = self.materials[self.elements[i].body as usize]
                    .0
                    .yield_stress();
                samples[self.first[i]..self.first[i + 1]]
                    .iter()
                    .map(|s| von_mises(s) / y)
                    .fold(0.0, f64::max)
            })
            .collect();
        let largest = raw.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return None;
        }
        let candidates: Vec<usize> = (0..raw.len())
            .filter(|&i| raw[i] >= CANDIDATE * largest)
            .collect();
        let mut best: Option<Peak> = None;
        for i in candidates {
            let peak = self.search(model, i, samples);
            if best.is_none_or(|b| peak.ratio > b.ratio) {
                best = Some(peak);
            }
        }
        best
    }

    /// Stress over yield stress at a given point of the element that holds the peak is linear in the samples: the value of
    /// the peak's ratio for other samples, at the same location search.
    fn search(&mut self, model: &Model, i: usize, samples: &Samples) -> Peak {
        let body = self.elements[i].body as usize;
        let yield_stress = self.materials[body].0.yield_stress();
        let element = self.elements[i].element;
        if !self.patches.contains_key(&(i as u32)) {
            let patch = self.patch(model, i);
            self.patches.insert(i as u32, patch);
        }
        let patch = &self.patches[&(i as u32)];
        let coefficients = patch.coefficients(samples);
        let shape = model.mesh.shapes[element];
        let x = model.element_coordinates(element);
        let triangle = shape.n_corners() == 3;
        let at = |reference: [f64; 2]| {
            let (n, _) = shape_functions(shape, reference);
            let mut point = [0.0; 2];
            for (n, x) in n.iter().zip(&x).take(shape.n_nodes()) {
                point[0] += n * x[0];
                point[1] += n * x[1];
            }
            (
                von_mises(&patch.value(&coefficients, point)) / yield_stress,
                point,
            )
        };
        // Nested grids: the maximum of a smooth function over the element, to about 1e-7 of its size, hence
        // to 1e-14 in value.
        let (mut center, mut half) = if triangle {
            ([0.5, 0.5], 0.5)
        } else {
            ([0.0, 0.0], 1.0)
        };
        let (mut best, mut place) = at(center);
        let mut best_reference = center;
        while half > 1e-7 {
            for a in -2..=2 {
                for b in -2..=2 {
                    let mut reference = [
                        center[0] + 0.5 * half * f64::from(a),
                        center[1] + 0.5 * half * f64::from(b),
                    ];
                    if triangle {
                        reference = reference.map(|v| v.max(0.0));
                        let sum = reference[0] + reference[1];
                        if sum > 1.0 {
                            reference = reference.map(|v| v / sum);
                        }
                    } else {
                        reference = reference.map(|v| v.clamp(-1.0, 1.0));
                    }
                    let (value, point) = at(reference);
                    if value > best {
                        (best, place, best_reference) = (value, point, reference);
                    }
                }
            }
            center = best_reference;
            half *= 0.5;
        }
        Peak {
            ratio: best,
            location: place,
            body,
        }
    }

    /// Element `i` and its neighbours in the same body, widened until a quadratic fit is possible.
    fn patch(&self, model: &Model, i: usize) -> Patch {
        let body = self.elements[i].body;
        let mut members = std::collections::BTreeSet::from([i as u32]);
        for _ in 0..4 {
            let around: Vec<u32> = members
                .iter()
                .flat_map(|&m| model.mesh.nodes(self.elements[m as usize].element))
                .flat_map(|node| &self.neighbours[node])
                .copied()
                .filter(|&m| self.elements[m as usize].body == body)
                .collect();
            members.extend(around);
            let n_samples: usize = members
                .iter()
                .map(|&m| self.elements[m as usize].points.len())
                .sum();
            if n_samples >= SAMPLES {
                if let Some(patch) = self.fit(i, &members, TERMS) {
                    return patch;
                }
            }
        }
        self.fit(i, &members, 3)
            .or_else(|| self.fit(i, &std::collections::BTreeSet::from([i as u32]), 1))
            .unwrap_or_else(|| {
                let at = self.elements[i].points[0].position;
                Patch {
                    center: at,
                    scale: [1.0; 2],
                    samples: vec![self.first[i] as u32],
                    fit: DMatrix::from_element(1, 1, 1.0),
                }
            })
    }

    fn fit(
        &self,
        i: usize,
        members: &std::collections::BTreeSet<u32>,
        terms: usize,
    ) -> Option<Patch> {
        let mut samples = Vec::new();
        let mut positions = Vec::new();
        for &m in members {
            for (g, point) in self.elements[m as usize].points.iter().enumerate() {
                samples.push((self.first[m as usize] + g) as u32);
                positions.push(point.position);
            }
        }
        let own = &self.elements[i].points;
        let center = own.iter().fold([0.0; 2], |c, p| {
            [
                c[0] + p.position[0] / own.len() as f64,
                c[1] + p.position[1] / own.len() as f64,
            ]
        });
        let mut scale = [0.0f64; 2];
        for p in &positions {
            for d in 0..2 {
                scale[d] = scale[d].max((p[d] - center[d]).abs());
            }
        }
        if scale.iter().any(|s| *s == 0.0) && terms > 1 {
            return None;
        }
        let scale = scale.map(|s| if s == 0.0 { 1.0 } else { s });
        let patch = Patch {
            center,
            scale,
            samples,
            fit: DMatrix::zeros(0, 0),
        };
        let matrix = DMatrix::from_fn(positions.len(), terms, |r, c| patch.terms(positions[r])[c]);
        let svd = SVD::new(matrix, true, true);
        if svd.singular_values.min() < 1e-3 * svd.singular_values.max() {
            return None;
        }
        svd.pseudo_inverse(0.0)
            .ok()
            .map(|fit| Patch { fit, ..patch })
    }
}

impl Patch {
    fn terms(&self, at: [f64; 2]) -> [f64; TERMS] {
        let x = (at[0] - self.center[0]) / self.scale[0];
        let y = (at[1] - self.center[1]) / self.scale[1];
        [1.0, x, y, x * x, x * y, y * y]
    }

    fn coefficients(&self, samples: &Samples) -> Vec<[f64; 4]> {
        (0..self.fit.nrows())
            .map(|t| {
                let mut sum = [0.0; 4];
                for (k, &sample) in self.samples.iter().enumerate() {
                    for c in 0..4 {
                        sum[c] += self.fit[(t, k)] * samples[sample as usize][c];
                    }
                }
                sum
            })
            .collect()
    }

    fn value(&self, coefficients: &[[f64; 4]], at: [f64; 2]) -> [f64; 4] {
        let terms = self.terms(at);
        std::array::from_fn(|c| coefficients.iter().zip(&terms).map(|(k, t)| k[c] * t).sum())
    }
}
