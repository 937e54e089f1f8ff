//! Rigid surfaces: indenters, rollers and walls that need no mesh.

use crate::space::Components;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A rigid surface that meshed bodies may touch: give exactly one kind below. A `force` or a
/// `displacement` load on its name moves it, in the direction of that load only. Without such a
/// load the surface is fixed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidSurface {
    /// A sphere; in plane models a circle, the section of a cylinder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sphere: Option<RigidSphere>,
    /// A cylinder, convex or hollow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cylinder: Option<RigidCylinder>,
    /// A torus: all points at a distance from a circle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torus: Option<RigidTorus>,
    /// A cone with a rounded tip; in plane models a wedge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cone: Option<RigidCone>,
    /// An unbounded plane.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<RigidPlane>,
    /// A punch with a flat end and a fillet at the edge: a round bar, or in plane models a strip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub punch: Option<RigidPunch>,
    /// Heights on a grid, for a rough surface or a measured dent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heights: Option<RigidHeights>,
}

/// A rigid sphere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidSphere {
    /// Centre of the sphere; in an axisymmetric model a point on the axis.
    pub center: Components,
    /// Radius of the sphere.
    pub radius: f64,
    /// Whether the bodies are inside the sphere, like a ball in its socket.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hollow: bool,
}

/// A rigid cylinder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidCylinder {
    /// A point of the cylinder's axis.
    pub center: Components,
    /// Direction of the cylinder's axis, for solids only. In plane models the axis is z, in
    /// axisymmetric models the axis of revolution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    /// Radius of the cylinder.
    pub radius: f64,
    /// Whether the bodies are inside the cylinder, like a pin in its hole.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hollow: bool,
}

/// A rigid torus: all points at distance `radius` from a circle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidTorus {
    /// Centre of the ring; in an axisymmetric model a point on the axis.
    pub center: Components,
    /// Direction of the axis of the ring, for solids only; otherwise the axis is y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    /// Radius of the ring.
    pub ring_radius: f64,
    /// Radius of the tube.
    pub radius: f64,
    /// Whether the bodies are inside the tube, like a ball in its groove.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hollow: bool,
}

/// A rigid cone with a rounded tip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidCone {
    /// The outermost point of the rounded tip; in an axisymmetric model a point on the axis.
    pub tip: Components,
    /// Direction from the tip into the cone.
    pub axis: Components,
    /// Angle in degrees between the axis and the side of the cone.
    pub half_angle: f64,
    /// Radius of the rounded tip. Under a sharp tip the pressure would be infinite.
    pub rounding: f64,
}

/// A rigid unbounded plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidPlane {
    /// A point of the plane.
    pub point: Components,
    /// Normal direction out of the rigid body, towards the bodies that it touches.
    pub normal: Components,
}

/// A rigid flat punch with a fillet at its edge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidPunch {
    /// Centre of the flat end; in an axisymmetric model a point on the axis.
    pub center: Components,
    /// Direction from the flat end into the punch.
    pub axis: Components,
    /// Radius of the bar, or in plane models half the width of the strip, the fillet included.
    pub radius: f64,
    /// Radius of the fillet at the edge.
    pub fillet: f64,
}

/// A rigid surface given by heights: `y` over `x` in plane models, `z` over `r` in axisymmetric
/// models, `z` over `x` and `y` in solids.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidHeights {
    /// A file, relative to the scene file, of grid points and the heights there, separated by
    /// commas: `x,y` per line, in a solid `x,y,z`. The surface between the points is interpolated
    /// by cubics.
    pub file: PathBuf,
    /// Whether the rigid body lies below the surface; by default it lies above.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub below: bool,
}

impl RigidSurface {
    /// The names of all kinds of rigid surface, and whether each is given.
    pub(crate) fn kinds(&self) -> [(&'static str, bool); 7] {
        [
            ("sphere", self.sphere.is_some()),
            ("cylinder", self.cylinder.is_some()),
            ("torus", self.torus.is_some()),
            ("cone", self.cone.is_some()),
            ("plane", self.plane.is_some()),
            ("punch", self.punch.is_some()),
            ("heights", self.heights.is_some()),
        ]
    }
}
