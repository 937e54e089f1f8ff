//! Facets as elements of their own: the lines between two corners.

use super::MAX_FACET_NODES;

/// What is the same for all facets of a shape: `s` from -1 to 1 along the line.
#[derive(Debug)]
pub struct FacetReference {
    /// Where its nodes are: the ends, then the mid-side node.
    pub nodes: &'static [f64],
    /// Values and derivatives of the shape functions at `s`.
    pub functions: fn(f64) -> ([f64; MAX_FACET_NODES], [f64; MAX_FACET_NODES]),
    /// Gmsh's element type.
    pub gmsh: u64,
}

/// Three-point Gauss rule, exact to degree 5: tractions and nodal areas on curved facets.
pub const FACET_RULE: [(f64, f64); 3] = {
    const G: f64 = 0.774_596_669_241_483_4;
    [(-G, 5.0 / 9.0), (0.0, 8.0 / 9.0), (G, 5.0 / 9.0)]
};

/// Two ends.
pub(super) static LINE2: FacetReference = FacetReference {
    nodes: &[-1.0, 1.0],
    functions: |s| ([0.5 * (1.0 - s), 0.5 * (1.0 + s), 0.0], [-0.5, 0.5, 0.0]),
    gmsh: 1,
};

/// Two ends and the node between them.
pub(super) static LINE3: FacetReference = FacetReference {
    nodes: &[-1.0, 1.0, 0.0],
    functions: |s| {
        (
            [0.5 * s * (s - 1.0), 0.5 * s * (s + 1.0), 1.0 - s * s],
            [s - 0.5, s + 0.5, -2.0 * s],
        )
    },
    gmsh: 8,
};

impl FacetReference {
    /// All facets.
    pub const ALL: [&'static FacetReference; 2] = [&LINE2, &LINE3];
}
