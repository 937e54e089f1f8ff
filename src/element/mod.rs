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

use crate::shape::{MAX_NODES, Shape};
use crate::space::Space;
use gradients::{Table, set_trace};
use std::sync::LazyLock;

/// Most points of an element in the plane.
pub const MAX_POINTS: usize = 4;

/// The gradients of an element in the plane.
pub type PlaneGradients = Gradients<2, 4, MAX_POINTS>;
type PlaneTables = LazyLock<[Table<2, MAX_POINTS>; Shape::ALL.len()]>;

static GAUSS: PlaneTables = LazyLock::new(|| {
    Shape::ALL.map(|shape| Table::new(shape.reference(), shape.reference().gauss))
});
static SAMPLING: PlaneTables = LazyLock::new(|| {
    Shape::ALL.map(|shape| Table::new(shape.reference(), shape.reference().sampling))
});

/// Whether the dilatation of an element is replaced by its mean (B-bar).
fn has_mean(space: Space, shape: Shape) -> bool {
    shape.reference().has_mean_dilatation && space != Space::PlaneStress
}

impl PlaneGradients {
    /// The gradients at the Gauss points, for the coordinates of the element's nodes.
    #[inline]
    pub fn gauss(space: Space, shape: Shape, nodes: &[[f64; 2]; MAX_NODES]) -> Self {
        Self::at(&GAUSS, space, shape, nodes)
    }

    #[inline]
    fn at(
        tables: &'static PlaneTables,
        space: Space,
        shape: Shape,
        nodes: &[[f64; 2]; MAX_NODES],
    ) -> Self {
        Gradients::new(
            &tables[shape as usize],
            space,
            has_mean(space, shape),
            nodes,
        )
    }
}

/// An element at the points where its stress is most accurate
/// ([`Reference::sampling`](crate::shape::Reference::sampling)).
#[derive(Debug, Clone)]
pub struct PlaneSampling {
    at: PlaneGradients,
    /// The mean dilatation over the Gauss points.
    mean: Option<[[f64; 2]; MAX_NODES]>,
}

impl PlaneSampling {
    /// For the coordinates of the element's nodes.
    pub fn new(space: Space, shape: Shape, nodes: &[[f64; 2]; MAX_NODES]) -> Self {
        let gauss = || PlaneGradients::gauss(space, shape, nodes);
        PlaneSampling {
            at: PlaneGradients::at(&SAMPLING, space, shape, nodes),
            mean: has_mean(space, shape).then(|| gauss().mean_dilatation()),
        }
    }

    /// Number of points.
    pub fn n_points(&self) -> usize {
        self.at.n_points()
    }

    /// Coordinates of the points, axis by axis, for those of the nodes.
    pub fn positions(&self, nodes: &[[f64; 2]; MAX_NODES]) -> [Lanes; 2] {
        self.at.positions(nodes)
    }

    /// Strains at the points, their dilatation treated as in [`Gradients::strains`].
    pub fn strains(&self, u: &[[f64; 2]; MAX_NODES]) -> Components {
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
