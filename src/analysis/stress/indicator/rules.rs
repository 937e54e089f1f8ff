//! Points at which the stresses of quadratic elements are compared.

use crate::shape::{Functions, Integration, Place, Rule, Shape};
use std::ops::Range;
use std::sync::LazyLock;

/// Abscissas and weights of the three-point Gauss rule.
const GAUSS_3: [(f64, f64); 3] = {
    const G: f64 = 0.774_596_669_241_483_4;
    [(-G, 5.0 / 9.0), (0.0, 8.0 / 9.0), (G, 5.0 / 9.0)]
};
/// Reference coordinates and weights: six points, degree 4 (D. A. Dunavant, Int. J. Numer. Meth.
/// Engng 21 (1985) 1129-1148, doi:10.1002/nme.1620210612).
const TRIANGLE: [(Place, f64); 6] = {
    const A: f64 = 0.445_948_490_915_965;
    const B: f64 = 0.091_576_213_509_771;
    const WA: f64 = 0.111_690_794_839_005_5;
    const WB: f64 = 0.054_975_871_827_661;
    [
        ([A, A, 0.0], WA),
        ([1.0 - 2.0 * A, A, 0.0], WA),
        ([A, 1.0 - 2.0 * A, 0.0], WA),
        ([B, B, 0.0], WB),
        ([1.0 - 2.0 * B, B, 0.0], WB),
        ([B, 1.0 - 2.0 * B, 0.0], WB),
    ]
};
/// Reference coordinates and weights: fourteen points, degree 5 (N. J. Walkington, Quadrature on
/// simplices of arbitrary dimension, Carnegie Mellon University 2000).
const TETRAHEDRON: [(Place, f64); 14] = {
    const A: f64 = 0.310_885_919_263_300_6;
    const B: f64 = 0.092_735_250_310_891_23;
    const C: f64 = 0.045_503_704_125_649_65;
    const D: f64 = 0.5 - C;
    const WA: f64 = 0.018_781_320_953_002_64;
    const WB: f64 = 0.012_248_840_519_393_66;
    const WC: f64 = 0.007_091_003_462_846_911;
    [
        ([A, A, A], WA),
        ([1.0 - 3.0 * A, A, A], WA),
        ([A, 1.0 - 3.0 * A, A], WA),
        ([A, A, 1.0 - 3.0 * A], WA),
        ([B, B, B], WB),
        ([1.0 - 3.0 * B, B, B], WB),
        ([B, 1.0 - 3.0 * B, B], WB),
        ([B, B, 1.0 - 3.0 * B], WB),
        ([C, C, D], WC),
        ([C, D, C], WC),
        ([D, C, C], WC),
        ([C, D, D], WC),
        ([D, C, D], WC),
        ([D, D, C], WC),
    ]
};

/// The quadrature rule for comparing the stresses of a quadratic element.
fn rule(shape: Shape) -> Vec<(Place, f64)> {
    match (shape.n_corners(), shape.dimension()) {
        (3, _) => TRIANGLE.to_vec(),
        (4, 3) => TETRAHEDRON.to_vec(),
        (6, _) => times_lines(TRIANGLE.to_vec(), 2..3),
        (_, dimension) => times_lines(vec![([0.0; 3], 1.0)], 0..dimension),
    }
}

/// The product of a quadrature rule with the rule of a line along further coordinates.
fn times_lines(mut points: Vec<(Place, f64)>, dimensions: Range<usize>) -> Vec<(Place, f64)> {
    for d in dimensions {
        let along = |(place, weight): (Place, f64)| {
            GAUSS_3.map(|(x, w)| {
                let mut at = place;
                at[d] = x;
                (at, weight * w)
            })
        };
        points = points.into_iter().flat_map(along).collect();
    }
    points
}

/// A point at which the stresses of a quadratic element are compared.
pub(super) struct Compared {
    pub(super) weight: f64,
    pub(super) functions: Functions,
    /// Shares of the stresses at the superconvergent points in the stress at this point, see
    /// [`shares`].
    pub(super) shares: Vec<f64>,
}

/// Points at which the stresses of each shape are compared.
pub(super) static COMPARED: LazyLock<[Vec<Compared>; Shape::ALL.len()]> = LazyLock::new(|| {
    Shape::ALL.map(|shape| {
        let point = |(place, weight)| Compared {
            weight,
            functions: shape.functions(place),
            shares: shares(shape, shape.rule(Integration::Reduced), place),
        };
        rule(shape).into_iter().map(point).collect()
    })
});

/// Shares of the values at the points of full integration in the value at each superconvergent
/// point of a quadratic element.
pub(super) static FROM_FULL: LazyLock<[Vec<Vec<f64>>; Shape::ALL.len()]> = LazyLock::new(|| {
    Shape::ALL.map(|shape| {
        let [reduced, full] = Integration::ALL.map(|integration| shape.rule(integration));
        let at = |(place, _): &(Place, f64)| shares(shape, full, *place);
        reduced.iter().map(at).collect()
    })
});

/// Shares of the stresses at the points of a rule in the stress at a place, for a quadratic
/// element: the polynomial through these points.
fn shares(shape: Shape, gauss: &Rule, at: Place) -> Vec<f64> {
    // Number of points of the rule's simplex, and of the coordinates that it takes up first: all of
    // a triangle or tetrahedron, the base of a prism, none of a square or cube.
    let (points, first) = match (shape.is_simplex(), shape.n_corners()) {
        (true, n) if n == gauss.len() => (n, n - 1),
        (false, 6) => (3, 2),
        _ => (1, 0),
    };
    // Linear functions of the volume coordinates: one at their own point and zero at the others.
    let volumes = |place: Place| {
        let within: Place = std::array::from_fn(|d| if d < first { place[d] } else { 0.0 });
        let [x, y, z] = within;
        [1.0 - x - y - z, x, y, z]
    };
    let here = volumes(at);
    let of = |k: usize| {
        let own = k % points;
        let mut share = 1.0;
        if first > 0 {
            let near = volumes(gauss[(own + 1) % points].0)[own];
            share = (here[own] - near) / (volumes(gauss[own].0)[own] - near);
        }
        // Lagrange polynomial: one at its own abscissa and zero at the others.
        let along = |d: usize| {
            let own = gauss[k].0[d];
            let mut others: Vec<f64> = gauss.iter().map(|(place, _)| place[d]).collect();
            others.sort_by(f64::total_cmp);
            others.dedup();
            let others = others.into_iter().filter(|other| *other != own);
            let factors = others.map(|other| (at[d] - other) / (own - other));
            factors.product::<f64>()
        };
        (first..shape.dimension()).fold(share, |share, d| share * along(d))
    };
    (0..gauss.len()).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rules have the volume of their element and are exact for cubics. With either integration,
    /// the share of a Gauss point is one at that point, and shares add up to one.
    #[test]
    fn rules_are_exact_and_shares_interpolate() {
        for shape in Shape::ALL.into_iter().filter(|shape| shape.is_quadratic()) {
            let row = shape.reference();
            let volume: f64 = row.gauss.iter().map(|(_, weight)| weight).sum();
            let sum: f64 = rule(shape).iter().map(|(_, weight)| weight).sum();
            assert!((sum - volume).abs() < 1e-14, "{shape:?}");
            // int x^3 by the rule and in closed form: over a simplex it is d! 3!/(d + 3)! times the
            // volume, over a cube zero, over a prism as over its base.
            let cubes = rule(shape)
                .iter()
                .map(|(x, w)| w * x[0].powi(3))
                .sum::<f64>();
            let exact = match (row.n_corners, row.dimension) {
                (3 | 6, _) => volume / 10.0,
                (4, 3) => volume / 20.0,
                _ => 0.0,
            };
            assert!((cubes - exact).abs() < 1e-14, "{shape:?} {cubes} {exact}");
            let within = |d: usize, x: f64| if d < row.dimension { x } else { 0.0 };
            let place = [within(0, 0.2), within(1, 0.1), within(2, 0.05)];
            for gauss in Integration::ALL.map(|integration| shape.rule(integration)) {
                for (k, (place, _)) in gauss.iter().enumerate() {
                    for (j, share) in shares(shape, gauss, *place).into_iter().enumerate() {
                        let own = f64::from(u8::from(j == k));
                        assert!((share - own).abs() < 1e-14, "{shape:?}");
                    }
                }
                let between: f64 = shares(shape, gauss, place).iter().sum();
                assert!((between - 1.0).abs() < 1e-14, "{shape:?} {between}");
            }
        }
    }
}
