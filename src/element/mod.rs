//! Element kernels: they see one element's coordinates, never the mesh or the global matrix.
//!
//! Strain is `[xx, yy, zz, xy]` (axisymmetric `[rr, zz, tt, rz]`) with engineering shear,
//! `eps = B u_e`, `K_e = sum_g w_g B' D B`, `f_e = sum_g w_g B' sigma`. Rows of `K_e` run node by
//! node, `[u_x0, u_y0, u_x1, ...]`. The dimension is a constant in here ([`Gradients`]), outside it
//! is data.
//!
//! `quad4` uses the mean dilatation (B-bar), `quad8` reduced integration: neither locks in
//! isochoric plastic flow. `tri3` does.
//!
//! # The shear of an axisymmetric `quad4`
//!
//! Next to the axis a regular field is `u_r = a r z`, `u_z = b r^2 + c z^2` to second order, with
//! the shear `(a + 2 b) r`. In a bilinear element `b r^2` has the slope of the centre, and the
//! virtual work of its shear is wrong by a share that the next element makes good; on the axis
//! there is none. What is left acts as a line load of the order `h^2` along the axis, and stresses
//! beside it are wrong by the order `h`. With `r_c` the radius of the centre and
//!
//! ```text
//! g_rz = sqrt(r/r_c) (du_r/dz at the centre + du_z/dr)
//! ```
//!
//! at the Gauss points the work of that field in a variation of `u_z` is
//! `sum w (r/r_c) (a r_c + 2 b r_c) dv/dr = sum w (a + 2 b) r dv/dr`: exact, element by element.
//! The interpolated field then is in equilibrium node by node on rectangles of any size (tested).
//! Constant normal strains and turned sections have what they had.
//!
//! Measured errors in %, with those of the shear at the point and without factor in brackets:
//!
//! - Hertz' point contact, pole pressure at first yield with 8, 16, 32 elements over the radius:
//!   0.01, 0.02, 0.00 (-2.8, -1.5, -0.8); load 0.16, 0.10, 0.06 (-0.01, -0.06, -0.02); radius 0.18,
//!   0.08, 0.04 (0.03, -0.02, -0.01). At three times the load, plastic, the pole's pressure: 0.8,
//!   0.3, 0.1 (-1.7, -1.0, -0.6).
//! - Thick sphere, nu 0.3, bore on the axis, 6, 12, 24 elements: displacement 1.1, 0.5, 0.2 (3.0,
//!   1.1, 0.3); limit pressure with 8, 16, for nu 0.4999 too: 0.47, 0.12 (0.49, 0.12). A circular
//!   punch's limit load is 0.2 % lower than it was, with 40 elements.
//! - Point force beside a block: the largest error of stress at the axis falls with order 1.5
//!   (0.8), to a fifth with 32 elements; the mean error of displacements is 3 to 11 % larger.
//! - Thin plates, four elements over the thickness that are 1, 5, 20 times as wide as high:
//!   deflection 3 to 6, 3 to 5, -1 to 5 (2 to 5, -23 to 0, -82 to -35: shear locks). Rings that
//!   turn in their section, 1 to 10 times as wide: 1 to 5 (-14 to 4). What is left is the mean
//!   dilatation's, of order `h^2`.
//! - Tubes of elements that are long along the axis lock as before (four over the wall, five times
//!   as long: -10), because `du_z/dr` is that of the point. That of the centre mends it (-1 to 1)
//!   and is in equilibrium too, but displacements of massive bodies are a fifth less accurate.
//! - A tube whose bore is pushed along the axis, four elements from radius 1 to 2: -0.6 (-0.3).
//!
//! `du_r/dz` must be that of the centre: with that of the point, times `sqrt(r_c/r)`, the field is
//! in equilibrium too, but sections that turn are sheared, and a ring of flat elements is up to 65
//! % too stiff.
//!
//! # Source
//! The shear is derived here. It is an assumed strain, of the kind of M. Fredriksson,
//! N. S. Ottosen, A simple and accurate four-node axisymmetric element, Int. J. Numer. Meth. Engng
//! 71 (2007) 175-200, doi:10.1002/nme.1939.

mod facet;
mod gradients;
mod stiffness;

pub use facet::{FacetPoint, facet_points};
pub use gradients::{Components, Gradients, Lanes};
pub use stiffness::packed;

use crate::shape::{Rule, Shape};
use crate::space::Space;
use gradients::{Table, set_trace};
use std::sync::LazyLock;

/// The kernel of the plane: 2 coordinates, 4 components, up to 4 points and 8 nodes.
pub type PlaneKernel = Kernel<2, 4, 4, 8>;
/// The kernel of space: 3 coordinates, 6 components, up to 8 points and 20 nodes.
pub type SolidKernel = Kernel<3, 6, 8, 20>;

/// The shape functions of all shapes of a dimension.
type Tables<const D: usize, const P: usize, const N: usize> =
    LazyLock<[Option<Table<D, P, N>>; Shape::ALL.len()]>;

static PLANE: [Tables<2, 4, 8>; 2] = [
    LazyLock::new(|| tables(|s| s.reference().gauss)),
    LazyLock::new(|| tables(|s| s.reference().sampling)),
];
static SOLID: [Tables<3, 8, 20>; 2] = [
    LazyLock::new(|| tables(|s| s.reference().gauss)),
    LazyLock::new(|| tables(|s| s.reference().sampling)),
];

fn tables<const D: usize, const P: usize, const N: usize>(
    rule: fn(Shape) -> &'static Rule,
) -> [Option<Table<D, P, N>>; Shape::ALL.len()] {
    Shape::ALL.map(|shape| {
        let row = shape.reference();
        (row.dimension == D).then(|| Table::new(row, rule(shape)))
    })
}

/// Makes the gradients of elements of a dimension: D coordinates, S components of strain, up to P
/// points and N nodes. What is generic in these takes a kernel, which says what they are
/// (`with_kernel!`).
#[derive(Debug, Clone, Copy)]
pub struct Kernel<const D: usize, const S: usize, const P: usize, const N: usize> {
    space: Space,
    gauss: &'static Tables<D, P, N>,
    sampling: &'static Tables<D, P, N>,
}

impl PlaneKernel {
    /// The kernel of a space of two dimensions.
    pub fn plane(space: Space) -> Self {
        let [gauss, sampling] = &PLANE;
        Kernel {
            space,
            gauss,
            sampling,
        }
    }
}

impl SolidKernel {
    /// The kernel of three dimensions.
    pub fn solid() -> Self {
        let [gauss, sampling] = &SOLID;
        Kernel {
            space: Space::Solid,
            gauss,
            sampling,
        }
    }
}

/// Evaluates an expression with the kernel of a space: the one place where the dimension becomes
/// constants.
macro_rules! with_kernel {
    ($space:expr, $kernel:ident => $body:expr) => {
        match $space {
            $crate::space::Space::Solid => {
                let $kernel = $crate::element::Kernel::solid();
                $body
            }
            space => {
                let $kernel = $crate::element::Kernel::plane(space);
                $body
            }
        }
    };
}
pub(crate) use with_kernel;

impl<const D: usize, const S: usize, const P: usize, const N: usize> Kernel<D, S, P, N> {
    /// The gradients at the Gauss points, for the coordinates of the element's nodes.
    #[inline]
    pub fn gauss(&self, shape: Shape, nodes: &[[f64; D]; N]) -> Gradients<D, S, P, N> {
        self.at(self.gauss, shape, nodes)
    }

    /// An element at its sampling points, for the coordinates of its nodes.
    pub fn sampling(&self, shape: Shape, nodes: &[[f64; D]; N]) -> Sampling<D, S, P, N> {
        Sampling {
            at: self.at(self.sampling, shape, nodes),
            mean: self
                .has_mean(shape)
                .then(|| self.gauss(shape, nodes).mean_dilatation()),
        }
    }

    #[inline]
    fn at(
        &self,
        tables: &'static Tables<D, P, N>,
        shape: Shape,
        nodes: &[[f64; D]; N],
    ) -> Gradients<D, S, P, N> {
        // A mesh has shapes of its own dimension only.
        let table = tables[shape as usize]
            .as_ref()
            .expect("a shape of this dimension");
        Gradients::new(table, self.space, self.has_mean(shape), nodes)
    }

    /// Whether the dilatation of an element is replaced by its mean (B-bar).
    fn has_mean(&self, shape: Shape) -> bool {
        shape.reference().has_mean_dilatation && self.space != Space::PlaneStress
    }
}

/// An element at the points where its stress is most accurate
/// ([`Reference::sampling`](crate::shape::Reference::sampling)).
#[derive(Debug, Clone)]
pub struct Sampling<const D: usize, const S: usize, const P: usize, const N: usize> {
    at: Gradients<D, S, P, N>,
    /// The mean dilatation over the Gauss points.
    mean: Option<[[f64; D]; N]>,
}

impl<const D: usize, const S: usize, const P: usize, const N: usize> Sampling<D, S, P, N> {
    /// Number of points.
    pub fn n_points(&self) -> usize {
        self.at.n_points()
    }

    /// Coordinates of the points, axis by axis, for those of the nodes.
    pub fn positions(&self, nodes: &[[f64; D]; N]) -> [Lanes<P>; D] {
        self.at.positions(nodes)
    }

    /// Strains at the points, their dilatation treated as in [`Gradients::strains`].
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
