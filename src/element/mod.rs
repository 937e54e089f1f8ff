//! Element kernels, which take one element's coordinates and know neither mesh nor global matrix.
//!
//! Strain is `[xx, yy, zz, xy]` (axisymmetric `[rr, zz, tt, rz]`) with engineering shear,
//! `eps = B u_e`, `K_e = sum_g w_g B' D B`, `f_e = sum_g w_g B' sigma`. Rows of `K_e` run node by
//! node, `[u_x0, u_y0, u_x1, ...]`. Inside this module the dimension is a constant ([`Gradients`]),
//! outside it is data.
//!
//! `quad4` uses the mean dilatation (B-bar), `quad8` reduced integration: neither locks in
//! isochoric plastic flow. `tri3` does lock.
//!
//! # The shear of an axisymmetric `quad4`
//!
//! Near the axis a regular field is `u_r = a r z`, `u_z = b r^2 + c z^2` to second order, with the
//! shear `(a + 2 b) r`. In a bilinear element `b r^2` has the slope of the centre, and the virtual
//! work of its shear has an error that the next element compensates; on the axis there is no next
//! element. The remaining error acts as a line load of the order `h^2` along the axis, and stresses
//! close to the axis have an error of the order `h`. With `r_c` the radius of the centre and
//!
//! ```text
//! g_rz = sqrt(r/r_c) (du_r/dz at the centre + du_z/dr)
//! ```
//!
//! at the Gauss points the work of that field in a variation of `u_z` is
//! `sum w (r/r_c) (a r_c + 2 b r_c) dv/dr = sum w (a + 2 b) r dv/dr`: exact, element by element.
//! The interpolated field is then in equilibrium node by node on rectangles of any size (tested).
//! The shear changes nothing for constant normal strains and for rotations of a cross-section.
//!
//! The effects of this shear, measured case by case, are listed in `data/elements.md`.
//!
//! `du_r/dz` must be taken at the centre. With the derivative at the point, times `sqrt(r_c/r)`,
//! the field is in equilibrium too, but a cross-section that rotates is sheared, and a ring of flat
//! elements is up to 65 % too stiff.
//!
//! # Source
//! The shear is derived here. It is an assumed strain, of the kind of M. Fredriksson,
//! N. S. Ottosen, A simple and accurate four-node axisymmetric element, Int. J. Numer. Meth. Engng
//! 71 (2007) 175-200, doi:10.1002/nme.1939.

mod facet;
mod gradients;
mod stiffness;
mod volume;

pub use facet::{FacetPoint, facet_points};
pub use gradients::{Components, Gradients, Lanes};
pub use stiffness::packed;
pub use volume::{VolumePoint, volume_points};

use crate::scene::Formulation;
use crate::shape::{Integration, Rule, Shape};
use crate::space::Space;
use gradients::{ShapeFunctionTable, set_trace};
use std::sync::LazyLock;

/// Kernel of the plane: 2 coordinates, 4 components, up to 4 points and 8 nodes.
pub type PlaneKernel = Kernel<2, 4, 4, 8>;
/// Kernel of space: 3 coordinates, 6 components, up to 8 points and 20 nodes.
pub type SolidKernel = Kernel<3, 6, 8, 20>;
/// Kernel of the plane for meshes with a fully integrated body ([`Integration::Full`]).
pub type FullPlaneKernel = Kernel<2, 4, 9, 8>;
/// Kernel of space for meshes with a fully integrated body.
pub type FullSolidKernel = Kernel<3, 6, 27, 20>;

/// Shape functions of all shapes of one dimension.
type ShapeTables<const D: usize, const P: usize, const N: usize> =
    LazyLock<[Option<ShapeFunctionTable<D, P, N>>; Shape::ALL.len()]>;

/// Tables of a kernel at the points of reduced and full integration and at the sampling points.
type AllTables<const D: usize, const P: usize, const N: usize> = [ShapeTables<D, P, N>; 3];

const fn all_tables<const D: usize, const P: usize, const N: usize>() -> AllTables<D, P, N> {
    [
        LazyLock::new(|| tables(|shape| shape.rule(Integration::Reduced))),
        LazyLock::new(|| tables(|shape| shape.rule(Integration::Full))),
        LazyLock::new(|| tables(|shape| shape.reference().sampling)),
    ]
}

static PLANE: AllTables<2, 4, 8> = all_tables();
static SOLID: AllTables<3, 8, 20> = all_tables();
static FULL_PLANE: AllTables<2, 9, 8> = all_tables();
static FULL_SOLID: AllTables<3, 27, 20> = all_tables();

/// Makes a table for each shape; `None` for another dimension or a rule with too many points.
fn tables<const D: usize, const P: usize, const N: usize>(
    rule: fn(Shape) -> &'static Rule,
) -> [Option<ShapeFunctionTable<D, P, N>>; Shape::ALL.len()] {
    Shape::ALL.map(|shape| {
        let row = shape.reference();
        let fits = row.dimension == D && rule(shape).len() <= P;
        fits.then(|| ShapeFunctionTable::new(row, rule(shape)))
    })
}

/// Kernel that computes the gradients of elements of one dimension: D coordinates, S components of
/// strain, up to P points and N nodes. Functions that are generic in these constants take a kernel,
/// which fixes them (`with_kernel!`).
#[derive(Debug, Clone, Copy)]
pub struct Kernel<const D: usize, const S: usize, const P: usize, const N: usize> {
    space: Space,
    formulation: Formulation,
    tables: &'static AllTables<D, P, N>,
}

impl PlaneKernel {
    /// Makes the kernel of a space of two dimensions.
    pub fn plane(space: Space) -> Self {
        Kernel::of(space, &PLANE)
    }
}

impl SolidKernel {
    /// Makes the kernel of three dimensions.
    pub fn solid() -> Self {
        Kernel::of(Space::Solid, &SOLID)
    }
}

impl FullPlaneKernel {
    /// Makes the kernel of a space of two dimensions for a mesh with a fully integrated body.
    pub fn full_plane(space: Space) -> Self {
        Kernel::of(space, &FULL_PLANE)
    }
}

impl FullSolidKernel {
    /// Makes the kernel of three dimensions for a mesh with a fully integrated body.
    pub fn full_solid() -> Self {
        Kernel::of(Space::Solid, &FULL_SOLID)
    }
}

/// Evaluates an expression with the kernel of a model (given its space, formulation and mesh). Only
/// here do the dimension and the largest number of points of an element become constants.
macro_rules! with_kernel {
    ($space:expr, $formulation:expr, $mesh:expr, $kernel:ident => $body:expr) => {
        match ($space, $mesh.has_full_integration()) {
            ($crate::space::Space::Solid, false) => {
                let $kernel = $crate::element::Kernel::solid();
                let $kernel = $kernel.integrated($formulation);
                $body
            }
            (space, false) => {
                let $kernel = $crate::element::Kernel::plane(space);
                let $kernel = $kernel.integrated($formulation);
                $body
            }
            ($crate::space::Space::Solid, true) => {
                let $kernel = $crate::element::Kernel::full_solid();
                let $kernel = $kernel.integrated($formulation);
                $body
            }
            (space, true) => {
                let $kernel = $crate::element::Kernel::full_plane(space);
                let $kernel = $kernel.integrated($formulation);
                $body
            }
        }
    };
}
pub(crate) use with_kernel;

impl<const D: usize, const S: usize, const P: usize, const N: usize> Kernel<D, S, P, N> {
    fn of(space: Space, tables: &'static AllTables<D, P, N>) -> Self {
        Kernel {
            space,
            formulation: Formulation::Mean,
            tables,
        }
    }

    /// Returns the same kernel with another formulation.
    pub fn integrated(self, formulation: Formulation) -> Self {
        Kernel {
            formulation,
            ..self
        }
    }

    /// Gradients at the Gauss points, from the coordinates of the element's nodes.
    #[inline]
    pub fn gauss(
        &self,
        (shape, integration): (Shape, Integration),
        nodes: &[[f64; D]; N],
    ) -> Gradients<D, S, P, N> {
        self.at(&self.tables[integration as usize], shape, nodes)
    }

    /// Element with its sampling points, from the coordinates of its nodes.
    pub(crate) fn sampling(&self, shape: Shape, nodes: &[[f64; D]; N]) -> Sampling<D, S, P, N> {
        self.sampled(&self.tables[2], shape, nodes)
    }

    /// Element sampled at its Gauss points, from the coordinates of its nodes.
    pub(crate) fn at_gauss_points(
        &self,
        (shape, integration): (Shape, Integration),
        nodes: &[[f64; D]; N],
    ) -> Sampling<D, S, P, N> {
        self.sampled(&self.tables[integration as usize], shape, nodes)
    }

    fn sampled(
        &self,
        points: &'static ShapeTables<D, P, N>,
        shape: Shape,
        nodes: &[[f64; D]; N],
    ) -> Sampling<D, S, P, N> {
        Sampling {
            at: self.at(points, shape, nodes),
            // Only linear elements have a mean dilatation, and these have one rule.
            mean: self.has_mean(shape).then(|| {
                let gauss = self.gauss((shape, Integration::Reduced), nodes);
                gauss.mean_dilatation()
            }),
        }
    }

    #[inline]
    fn at(
        &self,
        tables: &'static ShapeTables<D, P, N>,
        shape: Shape,
        nodes: &[[f64; D]; N],
    ) -> Gradients<D, S, P, N> {
        // All shapes of a mesh have its dimension, and full integration has a kernel of its own.
        let table = tables[shape as usize]
            .as_ref()
            .expect("a shape of this dimension");
        Gradients::new(table, self.space, self.has_mean(shape), nodes)
    }

    /// Whether the dilatation of elements of a shape is replaced by its mean (B-bar).
    fn has_mean(&self, shape: Shape) -> bool {
        shape.reference().has_mean_dilatation
            && self.space != Space::PlaneStress
            && self.formulation == Formulation::Mean
    }
}

/// An element with the points at which its stress is most accurate (superconvergent points).
#[derive(Debug, Clone)]
pub struct Sampling<const D: usize, const S: usize, const P: usize, const N: usize> {
    at: Gradients<D, S, P, N>,
    /// Mean dilatation over the Gauss points, for unit displacements of the nodes.
    mean: Option<[[f64; D]; N]>,
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> Sampling<D, S, P, N> {
    /// Number of points.
    pub fn n_points(&self) -> usize {
        self.at.n_points()
    }

    /// Coordinates of the points, axis by axis, from the coordinates of the nodes.
    pub fn positions(&self, nodes: &[[f64; D]; N]) -> [Lanes<P>; D] {
        self.at.positions(nodes)
    }

    /// Values at the points of the field that has the values `nodal` at the nodes.
    pub fn at_points(&self, nodal: &[f64; N]) -> Lanes<P> {
        self.at.at_points(nodal)
    }

    /// Strains at the points, with the dilatation treated as in [`Gradients::strains`].
    pub fn strains(&self, u: &[[f64; D]; N]) -> Components<S, P> {
        let mut out = self.at.local_strains(u);
        if let Some(mean) = &self.mean {
            let terms = mean.as_flattened().iter().zip(u.as_flattened());
            set_trace(&mut out, terms.map(|(m, u)| m * u).sum());
        }
        out
    }
}

#[cfg(test)]
mod tests;
