//! The strain of linear triangles and tetrahedra, from displacements fitted over the surrounding
//! nodes.
//!
//! The strain of a linear triangle is constant. Even at the centroid it is accurate to first order
//! at best. Its error depends on the arrangement of the neighbours; a fit over such strains does
//! not remove this error. Instead, a quadratic polynomial is fitted by least squares to the
//! displacements of all surrounding nodes. The gradient of this polynomial is exact for a quadratic
//! field on any mesh, and of second order otherwise. Yield loads then converge with second order
//! too, on regular and on irregular meshes.
//!
//! # Source
//! Z. Zhang, A. Naga, A new finite element gradient recovery method: superconvergence property,
//! SIAM J. Sci. Comput. 26 (2005) 1192-1213, doi:10.1137/S1064827503402837 (polynomial preserving
//! recovery).

use super::patch_fit::{PatchFit, ScaledCoordinates};
use crate::analysis::zone::gather::{NodalPlaces, Places};
use crate::model::Model;
use crate::space::Vector;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Least pivot of the scaled normal equations with which a fit counts as determined.
const LEAST_PIVOT: f64 = 1e-2;
/// Largest number of layers of elements around a triangle from which nodes are taken. A layer is
/// added as long as the nodes do not determine a quadratic polynomial.
const MOST_LAYERS: usize = 3;
/// Least number of elements that a thread takes at a time.
const GRAIN: usize = 64;

/// The strains of the linear triangles and tetrahedra in a list of elements, as sums over nodes.
#[derive(Debug, Default)]
pub struct FittedStrains<const D: usize> {
    nodes: Vec<NodalPlaces>,
    /// Index at which the terms of each element begin. An element that is not linear, or cannot be
    /// fitted, has no terms.
    first: Vec<u32>,
    terms: Vec<Term<D>>,
}

/// Share of the displacement of a node in the strain at a centroid.
#[derive(Debug, Clone, Copy)]
struct Term<const D: usize> {
    node: u32,
    /// Share in the derivatives along the axes.
    gradient: [f64; D],
    /// Share in the displacement divided by the radius, if there are hoop strains.
    hoop: f64,
}

impl<const D: usize> FittedStrains<D> {
    /// Fits displacements around the linear elements among `elements`. For an index in that list,
    /// `around` returns the indices of all elements of the same body that share a node with the
    /// element, itself included.
    pub fn new(
        model: &Model,
        elements: &[usize],
        places: &Places,
        around: impl Fn(usize) -> Vec<u32> + Sync,
    ) -> Self {
        let mesh = &model.mesh;
        let is_linear = |i: usize| mesh.shapes[elements[i]].has_constant_strain();
        if !(0..elements.len()).any(is_linear) {
            return FittedStrains::default();
        }
        let fit = |i: usize| {
            if !is_linear(i) {
                return Vec::new();
            }
            let mut members = vec![i as u32];
            for _ in 0..MOST_LAYERS {
                members = members.iter().flat_map(|&m| around(m as usize)).collect();
                members.sort_unstable();
                members.dedup();
                let corners = |m: &u32| mesh.nodes(elements[*m as usize]);
                let mut nodes: Vec<u32> = members.iter().flat_map(corners).copied().collect();
                nodes.sort_unstable();
                nodes.dedup();
                if let Some(terms) = terms(model, elements[i], nodes) {
                    return terms;
                }
            }
            Vec::new()
        };
        let fits: Vec<Vec<Term<D>>> = (0..elements.len())
            .into_par_iter()
            .with_min_len(GRAIN)
            .map(fit)
            .collect();
        let mut out = FittedStrains {
            first: vec![0],
            ..FittedStrains::default()
        };
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        for fit in fits {
            for mut term in fit {
                let FittedStrains { nodes, .. } = &mut out;
                term.node = *numbers.entry(term.node).or_insert_with(|| {
                    nodes.push(NodalPlaces::new(model, places, term.node as usize));
                    nodes.len() as u32 - 1
                });
                out.terms.push(term);
            }
            out.first.push(out.terms.len() as u32);
        }
        out
    }

    /// The displacements of the fitted nodes in global axes, read from the values of a `Nodal`.
    pub fn displacements(&self, nodal: &[f64]) -> Vec<Vector> {
        self.nodes.iter().map(|node| node.of(nodal)).collect()
    }

    /// The strain `[xx, yy, zz, xy | yz, zx]` of an element at its centroid; `None` if the element
    /// is not fitted.
    pub fn strain<const S: usize>(&self, i: usize, displacements: &[Vector]) -> Option<[f64; S]> {
        let [begin, end] = *self.first.get(i..i + 2)? else {
            return None;
        };
        let terms = &self.terms[begin as usize..end as usize];
        // A translation, which may be large, causes no strain and is subtracted.
        let first = displacements[terms.first()?.node as usize];
        let mut slopes = [[0.0; D]; D];
        let mut hoop = 0.0;
        for term in terms {
            let moved = displacements[term.node as usize];
            for (i, slopes) in slopes.iter_mut().enumerate() {
                for (slope, gradient) in slopes.iter_mut().zip(term.gradient) {
                    *slope += gradient * (moved[i] - first[i]);
                }
            }
            hoop += term.hoop * moved[0];
        }
        let mut out = [0.0; S];
        out[2] = hoop;
        for d in 0..D {
            out[d] = slopes[d][d];
        }
        for (shear, [i, j]) in out[3..].iter_mut().zip([[0, 1], [1, 2], [2, 0]]) {
            *shear = slopes[i][j] + slopes[j][i];
        }
        Some(out)
    }
}

/// Shares of the nodal displacements in the quadratic fit at the centroid of an element; `None` if
/// the nodes do not determine the fit.
fn terms<const D: usize>(model: &Model, element: usize, nodes: Vec<u32>) -> Option<Vec<Term<D>>> {
    let mesh = &model.mesh;
    let own = mesh.nodes(element);
    let mean = |d: usize| {
        let sum: f64 = own.iter().map(|&k| mesh.point(k as usize)[d]).sum();
        sum / own.len() as f64
    };
    let frame = ScaledCoordinates {
        center: std::array::from_fn(mean),
        ..ScaledCoordinates::<D>::about(mesh, element)
    };
    let place = |node: &u32| frame.relative(mesh.point(*node as usize));
    let points = nodes.iter().map(|node| (1.0, place(node)));
    let fit = PatchFit::<D, 2>::to(points, LEAST_PIVOT)?;
    let (value, slopes) = (
        fit.coefficient(0),
        std::array::from_fn::<_, D, _>(|d| fit.coefficient(d + 1)),
    );
    let is_axisymmetric = model.kind.is_axisymmetric();
    let term = |node: u32| {
        let x = place(&node);
        Term {
            node,
            gradient: std::array::from_fn(|d| {
                PatchFit::<D, 2>::value(&slopes[d], 1.0, &x) / frame.scale[d]
            }),
            hoop: if is_axisymmetric {
                PatchFit::<D, 2>::value(&value, 1.0, &x) / frame.center[0]
            } else {
                0.0
            },
        }
    };
    Some(nodes.into_iter().map(term).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::zone::gather::Nodal;
    use crate::model::Slot;
    use crate::scene::{Kind, Scene};
    use crate::shape::Shape;
    use crate::substructure::Trailing;

    /// Strains of a quadratic field that vanishes on the supports are exact to round-off in every
    /// triangle of tubes and spheres.
    #[test]
    fn quadratic_displacements_have_exact_strains() {
        for name in ["thick_cylinder", "thick_sphere"] {
            let path = format!("{}/data/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let mut scene = Scene::load(std::path::Path::new(&path)).unwrap();
            let part = &mut scene.mesh.parts.as_mut().unwrap()[0];
            part.element = Shape::Tri3;
            part.ring.as_mut().unwrap().elements = [5, 7];
            let model = Model::new(&scene).unwrap();
            let (mesh, n) = (&model.mesh, model.freedoms.n);
            let places = Places::new(n, &(0..n).collect::<Vec<_>>(), &[]);
            let field = |[x, y]: [f64; 2]| {
                [
                    x * (0.3 + 0.02 * x - 0.01 * y),
                    y * (0.1 - 0.03 * x + 0.05 * y),
                ]
            };
            let mut zone = vec![0.0; n];
            for node in 0..mesh.n_nodes() {
                let (u, axes) = (field(mesh.in_plane(node)), model.freedoms.local(node));
                for (slot, axis) in model.freedoms.of_node(node).iter().zip(axes) {
                    let along = u[0] * axis[0] + u[1] * axis[1];
                    match *slot {
                        Slot::Free(f) => zone[f as usize] = along,
                        _ => assert!(along.abs() < 1e-9, "{name}: the field is held at {node}"),
                    }
                }
            }
            let u = Trailing {
                zone,
                contact: Vec::new(),
            };
            let elements: Vec<usize> = (0..mesh.n_elements()).collect();
            let around = |i: usize| {
                let nodes = mesh.nodes(i);
                let touches = |e: &usize| mesh.nodes(*e).iter().any(|node| nodes.contains(node));
                elements
                    .iter()
                    .filter(|e| touches(e))
                    .map(|e| *e as u32)
                    .collect()
            };
            let fitted = FittedStrains::<2>::new(&model, &elements, &places, around);
            let mut nodal = Nodal::new(&model, &places);
            let moved = fitted.displacements(nodal.displacements(&u));
            for &e in &elements {
                let nodes = mesh.nodes(e).iter().map(|n| mesh.in_plane(*n as usize));
                let mean = |d: usize| nodes.clone().map(|x| x[d]).sum::<f64>() / 3.0;
                let (x, y) = (mean(0), mean(1));
                let hoop = match scene.kind {
                    Kind::Axisymmetric => 0.3 + 0.02 * x - 0.01 * y,
                    _ => 0.0,
                };
                let exact = [
                    0.3 + 0.04 * x - 0.01 * y,
                    0.1 - 0.03 * x + 0.1 * y,
                    hoop,
                    -0.01 * x - 0.03 * y,
                ];
                let found: [f64; 4] = fitted.strain(e, &moved).unwrap();
                // Round-off of displacements divided by the size of an element, amplified by the
                // least pivot.
                let size = moved.iter().flatten().fold(0.0f64, |m, u| m.max(u.abs()));
                let tolerance = 100.0 * f64::EPSILON * size / LEAST_PIVOT;
                for (a, b) in found.iter().zip(exact) {
                    assert!(
                        (a - b).abs() <= tolerance,
                        "{name} {e}: {found:?} {exact:?}"
                    );
                }
            }
        }
    }
}
