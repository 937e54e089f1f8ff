//! Space of a model: everything that depends on dimension and idealisation, as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A vector in space; in plane models the third component is zero.
pub type Vector = [f64; 3];

/// The components of a vector as they are given: two in the plane, three in space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
#[schemars(with = "Vec<f64>", extend("minItems" = 2, "maxItems" = 3))]
pub struct Components {
    vector: Vector,
    count: usize,
}

impl Components {
    /// The vector in space; z = 0 if two components were given.
    pub fn vector(&self) -> Vector {
        self.vector
    }

    /// Number of components that were given.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Iterates over the components that were given.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        self.vector.into_iter().take(self.count)
    }
}

impl From<[f64; 2]> for Components {
    fn from(plane: [f64; 2]) -> Self {
        Components {
            vector: in_space(plane),
            count: 2,
        }
    }
}

impl From<Vector> for Components {
    fn from(vector: Vector) -> Self {
        Components { vector, count: 3 }
    }
}

impl TryFrom<Vec<f64>> for Components {
    type Error = String;

    fn try_from(given: Vec<f64>) -> Result<Self, String> {
        match given[..] {
            [x, y] => Ok([x, y].into()),
            [x, y, z] => Ok([x, y, z].into()),
            _ => Err(format!(
                "{} numbers: a vector has 2 components, in a solid model 3",
                given.len()
            )),
        }
    }
}

impl From<Components> for Vec<f64> {
    fn from(components: Components) -> Self {
        components.iter().collect()
    }
}

/// The dimension and idealisation of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Kind")]
pub enum Space {
    /// No strain out of the plane; forces per unit thickness.
    PlaneStrain,
    /// No stress out of the plane; forces per unit thickness.
    PlaneStress,
    /// Coordinates are (r, z), x = 0 is the axis; forces are totals over the full circle.
    Axisymmetric,
    /// Three coordinates.
    Solid,
}

/// A rigid motion of a body, which does not deform it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RigidMotion {
    /// Translation along the axis with this number.
    Along(usize),
    /// Rotation about the axis with this number.
    About(usize),
}

impl Space {
    /// All kinds of space.
    pub const ALL: [Space; 4] = [
        Space::PlaneStrain,
        Space::PlaneStress,
        Space::Axisymmetric,
        Space::Solid,
    ];

    /// Kinds of space with two dimensions.
    pub const PLANE: [Space; 3] = [Space::PlaneStrain, Space::PlaneStress, Space::Axisymmetric];

    /// The name in scenes and results: `plane_strain`, `plane_stress`, `axisymmetric`, `solid`.
    pub fn name(self) -> &'static str {
        match self {
            Space::PlaneStrain => "plane_strain",
            Space::PlaneStress => "plane_stress",
            Space::Axisymmetric => "axisymmetric",
            Space::Solid => "solid",
        }
    }

    /// Number of coordinates, and of displacements of a node.
    pub fn dimension(self) -> usize {
        self.axes().len()
    }

    /// Whether coordinates are radius and height.
    pub(crate) fn is_axisymmetric(self) -> bool {
        self == Space::Axisymmetric
    }

    /// Whether bodies are three-dimensional.
    pub fn is_solid(self) -> bool {
        self == Space::Solid
    }

    /// Names of the coordinates, in order.
    pub fn axes(self) -> &'static [&'static str] {
        match self {
            Space::PlaneStrain | Space::PlaneStress => &["x", "y"],
            Space::Axisymmetric => &["r", "z"],
            Space::Solid => &["x", "y", "z"],
        }
    }

    /// Names of the components of stress, in order.
    pub fn components(self) -> &'static [&'static str] {
        match self {
            Space::PlaneStrain | Space::PlaneStress => &["xx", "yy", "zz", "xy"],
            Space::Axisymmetric => &["rr", "zz", "tt", "rz"],
            Space::Solid => &["xx", "yy", "zz", "xy", "yz", "zx"],
        }
    }

    /// Factor from a length or area in the coordinates to the integral: thickness 1, or the
    /// circumference `2 pi r` at the given first coordinate.
    #[inline]
    pub fn measure(self, first: f64) -> f64 {
        if self.is_axisymmetric() {
            2.0 * PI * first
        } else {
            1.0
        }
    }

    /// Rigid motions that are possible in the idealisation.
    pub(crate) fn rigid_motions(self) -> &'static [RigidMotion] {
        use RigidMotion::{About, Along};
        match self {
            Space::PlaneStrain | Space::PlaneStress => &[Along(0), Along(1), About(2)],
            Space::Axisymmetric => &[Along(1)],
            Space::Solid => &[Along(0), Along(1), Along(2), About(0), About(1), About(2)],
        }
    }
}

impl RigidMotion {
    /// Displacement at the position `arm` relative to the fixed point: the unit vector along the
    /// axis of a translation, or the displacement of a unit rotation.
    pub fn displacement(self, arm: Vector) -> Vector {
        match self {
            RigidMotion::Along(axis) => unit(axis),
            RigidMotion::About(axis) => cross(unit(axis), arm),
        }
    }
}

/// Unit vector along an axis.
pub fn unit(axis: usize) -> Vector {
    let mut out = [0.0; 3];
    out[axis] = 1.0;
    out
}

/// Extends a vector of the plane to space.
pub fn in_space([x, y]: [f64; 2]) -> Vector {
    [x, y, 0.0]
}

/// Scalar product `a . b`.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Length `|a|` of a vector.
pub fn length(a: Vector) -> f64 {
    let square = dot(a, a);
    // The square loses digits, is too large, or is NaN.
    if !(1e-280..1e280).contains(&square) {
        return a[0].hypot(a[1]).hypot(a[2]);
    }
    square.sqrt()
}

/// Scales a vector to length 1; returns zero for the zero vector.
pub fn direction(a: Vector) -> Vector {
    let length = length(a);
    if length > 0.0 {
        a.map(|a| a / length)
    } else {
        [0.0; 3]
    }
}

/// Difference `a - b`.
pub fn difference(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Sum `a + t b`: the point at `t` along `b` from `a`.
pub fn along(a: Vector, t: f64, b: Vector) -> Vector {
    [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]]
}

/// Formats the first components of a vector: `(x, y)` or `(x, y, z)`.
pub(crate) fn in_words(vector: Vector, dimension: usize) -> String {
    let words: Vec<String> = vector.iter().take(dimension).map(f64::to_string).collect();
    format!("({})", words.join(", "))
}

/// Vector product `a x b`.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_space_has_a_name_per_coordinate_and_component() {
        for space in Space::ALL {
            let dimension = if space.is_solid() { 3 } else { 2 };
            assert_eq!(space.dimension(), dimension);
            assert_eq!(space.components().len(), 2 * dimension);
            let text = serde_json::to_string(&space).unwrap();
            assert_eq!(text, format!("{:?}", space.name()));
        }
        assert_eq!(Space::Axisymmetric.measure(0.5), PI);
        assert_eq!(Space::PlaneStrain.measure(0.5), 1.0);
    }

    /// A rigid motion changes no distance to first order, and stays in the plane of a plane model.
    #[test]
    fn rigid_motions_do_not_stretch() {
        for space in Space::ALL {
            let points = [[0.3, -0.7, 0.2], [2.0, 1.1, 1.0], [-0.4, 0.9, -0.6]]
                .map(|[x, y, z]| [x, y, if space.is_solid() { z } else { 0.0 }]);
            for motion in space.rigid_motions() {
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    let [p, q] = [points[a], points[b]];
                    let [u, v] = [p, q].map(|x| motion.displacement(x));
                    let apart = std::array::from_fn(|d| q[d] - p[d]);
                    let moved = std::array::from_fn(|d| v[d] - u[d]);
                    assert!(dot(apart, moved).abs() < 1e-15, "{space:?} {motion:?}");
                    assert!(u[space.dimension()..].iter().all(|u| *u == 0.0));
                }
            }
        }
        let turned = RigidMotion::About(2).displacement([1.0, 2.0, 0.0]);
        assert_eq!(turned, [-2.0, 1.0, 0.0]);
    }
}
