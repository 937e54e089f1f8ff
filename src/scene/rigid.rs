//! Rigid surfaces: indenters, rollers and walls that need no mesh.

use crate::space::Components;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A rigid surface that meshed bodies may touch, exactly one of the kinds. It moves by a `force` or
/// a `displacement` on its name, along that push alone; without any it is held.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidSurface {
    /// A sphere; in plane models the circle that a cylinder shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sphere: Option<RigidSphere>,
    /// A cylinder, convex or hollow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cylinder: Option<RigidCylinder>,
    /// A torus: all points at a distance from a ring.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torus: Option<RigidTorus>,
    /// A cone with a rounded tip; in plane models a wedge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cone: Option<RigidCone>,
    /// A plane without end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<RigidPlane>,
    /// A flat end whose edge has a fillet: of a round bar, in plane models of a strip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub punch: Option<RigidPunch>,
    /// Heights on a grid: roughness, a measured dent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heights: Option<RigidHeights>,
}

/// A rigid sphere.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidSphere {
    /// Centre; axisymmetric: on the axis.
    pub center: Components,
    /// Radius of the sphere.
    pub radius: f64,
    /// Whether the bodies are inside, as a ball in its socket.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hollow: bool,
}

/// A rigid cylinder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidCylinder {
    /// A point of its axis.
    pub center: Components,
    /// Direction of its axis, of a solid; in plane models it is z, in axisymmetric ones the axis of
    /// revolution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    /// Radius of the cylinder.
    pub radius: f64,
    /// Whether the bodies are inside, as a pin in its hole.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hollow: bool,
}

/// A rigid torus: all points at a distance from a ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidTorus {
    /// Centre of the ring; axisymmetric: on the axis.
    pub center: Components,
    /// Direction of its axis, of a solid; else it is y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    /// Radius of the ring.
    pub ring_radius: f64,
    /// Radius of the tube.
    pub radius: f64,
    /// Whether the bodies are inside the tube, as a ball in its groove.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub hollow: bool,
}

/// A rigid cone with a rounded tip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidCone {
    /// The outermost point of the rounded tip; axisymmetric: on the axis.
    pub tip: Components,
    /// Direction from the tip into the cone.
    pub axis: Components,
    /// Angle in degrees between its axis and its side.
    pub half_angle: f64,
    /// Radius of the tip. A sharp one would have an infinite pressure.
    pub rounding: f64,
}

/// A rigid plane without end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidPlane {
    /// A point of the plane.
    pub point: Components,
    /// Direction out of the rigid body, towards what it touches.
    pub normal: Components,
}

/// A rigid flat punch with a fillet at its edge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidPunch {
    /// Centre of its flat end; axisymmetric: on the axis.
    pub center: Components,
    /// Direction from the flat end into the punch.
    pub axis: Components,
    /// Radius of the bar, in plane models half the width of the strip: of flat and fillet together.
    pub radius: f64,
    /// Radius of the fillet.
    pub fillet: f64,
}

/// A rigid surface by heights: `y` over `x`, axisymmetric `z` over `r`, of a solid `z` over `x` and
/// `y`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidHeights {
    /// A file of the places of a grid and the heights there, with commas between, relative to the
    /// scene file: `x,y`, of a solid `x,y,z`. Cubics run between them.
    pub file: PathBuf,
    /// Whether the rigid body is below the surface; by default it is above.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub below: bool,
}

impl RigidSurface {
    /// The kinds, and which of them are given.
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
