//! The space of a model: what depends on its dimension and idealisation, as data.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A vector in space; of a plane model the third component is zero.
pub type Vector = [f64; 3];

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
}

/// A motion of a body that does not deform it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RigidMotion {
    /// Along an axis.
    Along(usize),
    /// Turning about an axis.
    About(usize),
}

impl Space {
    /// All of them.
    pub const ALL: [Space; 3] = [Space::PlaneStrain, Space::PlaneStress, Space::Axisymmetric];

    /// The name in scenes and results: `plane_strain`, `plane_stress`, `axisymmetric`.
    pub fn name(self) -> &'static str {
        match self {
            Space::PlaneStrain => "plane_strain",
            Space::PlaneStress => "plane_stress",
            Space::Axisymmetric => "axisymmetric",
        }
    }

    /// Number of coordinates, and of displacements of a node.
    pub fn dimension(self) -> usize {
        self.axes().len()
    }

    /// Whether coordinates are radius and height.
    pub fn is_axisymmetric(self) -> bool {
        self == Space::Axisymmetric
    }

    /// Names of the coordinates.
    pub fn axes(self) -> &'static [&'static str] {
        if self.is_axisymmetric() {
            &["r", "z"]
        } else {
            &["x", "y"]
        }
    }

    /// Names of the components of stress, in their order.
    pub fn components(self) -> &'static [&'static str] {
        if self.is_axisymmetric() {
            &["rr", "zz", "tt", "rz"]
        } else {
            &["xx", "yy", "zz", "xy"]
        }
    }

    /// What a length or area in the coordinates stands for at a first coordinate: thickness 1, or
    /// the circumference `2 pi r`.
    #[inline]
    pub fn measure(self, first: f64) -> f64 {
        if self.is_axisymmetric() {
            2.0 * PI * first
        } else {
            1.0
        }
    }

    /// The rigid motions that the idealisation leaves a body.
    pub fn rigid_motions(self) -> &'static [RigidMotion] {
        use RigidMotion::{About, Along};
        if self.is_axisymmetric() {
            &[Along(1)]
        } else {
            &[Along(0), Along(1), About(2)]
        }
    }
}

impl RigidMotion {
    /// The displacement at an `arm` from the point that stays in place: a unit along the axis, or
    /// the arm's turned by a unit.
    pub fn displacement(self, arm: Vector) -> Vector {
        match self {
            RigidMotion::Along(axis) => unit(axis),
            RigidMotion::About(axis) => cross(unit(axis), arm),
        }
    }
}

/// The unit vector along an axis.
fn unit(axis: usize) -> Vector {
    let mut out = [0.0; 3];
    out[axis] = 1.0;
    out
}

/// A vector of the plane in space.
pub fn in_space([x, y]: [f64; 2]) -> Vector {
    [x, y, 0.0]
}

/// `a . b`
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `|a|`
pub fn length(a: Vector) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// `a x b`
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
            assert_eq!(space.dimension(), 2);
            assert_eq!(space.components().len(), 4);
            let text = serde_json::to_string(&space).unwrap();
            assert_eq!(text, format!("{:?}", space.name()));
        }
        assert_eq!(Space::Axisymmetric.measure(0.5), PI);
        assert_eq!(Space::PlaneStrain.measure(0.5), 1.0);
    }

    /// A rigid motion changes no distance to first order, and stays where the model lives.
    #[test]
    fn rigid_motions_do_not_stretch() {
        let points = [[0.3, -0.7], [2.0, 1.1], [-0.4, 0.9]].map(in_space);
        for space in Space::ALL {
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
