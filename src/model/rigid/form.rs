//! Forms of rigid surfaces: distance and normal at any point, without a mesh.
//!
//! Surfaces of revolution are given by their meridian. With the axis `a` through `c`,
//!
//! ```text
//!     t = (x - c) . a,    s = |x - c - t a|,    e = (x - c - t a) / s
//! ```
//!
//! the distance `d(s, t)` is positive outside the rigid body, and its gradient `d,s e + d,t a` is
//! the unit normal out of the body at the closest point of the surface. In plane models, where
//! `z = 0`, a meridian is the section itself.

use super::heights::Heights;
use crate::error::{Error, Result};
use crate::scene::{RigidSurface, Scene};
use crate::space::{Vector, along, difference, direction, dot, length, unit};

/// Form of a rigid surface, which gives distance and normal at any point.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) enum Form {
    /// A half space, given by a point and the normal out of it.
    Plane { point: Vector, normal: Vector },
    /// A ball around a point, or the space outside it.
    Sphere { center: Vector, round: Round },
    /// A surface of revolution.
    Revolved {
        center: Vector,
        axis: Vector,
        meridian: Meridian,
    },
    /// A surface given by heights over a line or a plane.
    Heights(Heights),
}

/// A circle; if `hollow`, the rigid body is what lies outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::model) struct Round {
    radius: f64,
    hollow: bool,
}

/// Curve that is revolved about an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::model) enum Meridian {
    /// A line parallel to the axis.
    Cylinder(Round),
    /// A circle around a point at a distance from the axis.
    Torus { ring: f64, round: Round },
    /// An arc about the origin and its tangent at the angle with the given sine and cosine; the
    /// axis leads from the tip into the cone.
    Cone { sin: f64, cos: f64, radius: f64 },
    /// A line `t = 0`, an arc, and a line along the axis; the axis leads into the punch.
    Punch { radius: f64, fillet: f64 },
}

impl Round {
    /// Distance and sign of the outward normal, from the distance to the centre.
    fn at(self, from_center: f64) -> (f64, f64) {
        let off = from_center - self.radius;
        if self.hollow {
            (-off, -1.0)
        } else {
            (off, 1.0)
        }
    }
}

impl Meridian {
    /// Distance and its gradient along `s` and `t`; `None` at a centre.
    fn at(self, s: f64, t: f64) -> Option<(f64, [f64; 2])> {
        let about = |s: f64, t: f64| {
            let far = s.hypot(t);
            (far > 0.0).then(|| (far, [s / far, t / far]))
        };
        match self {
            Meridian::Cylinder(round) => {
                let (distance, sign) = round.at(s);
                (s > 0.0).then_some((distance, [sign, 0.0]))
            }
            Meridian::Torus { ring, round } => {
                let (far, gradient) = about(s - ring, t)?;
                let (distance, sign) = round.at(far);
                Some((distance, gradient.map(|g| sign * g)))
            }
            Meridian::Cone { sin, cos, radius } => {
                if s * sin + t * cos <= 0.0 {
                    let (far, gradient) = about(s, t)?;
                    return Some((far - radius, gradient));
                }
                Some((s * cos - t * sin - radius, [cos, -sin]))
            }
            Meridian::Punch { radius, fillet } => {
                let [p, q] = [s - (radius - fillet), fillet - t];
                if p > 0.0 && q > 0.0 {
                    let (far, [of_p, of_q]) = about(p, q)?;
                    return Some((far - fillet, [of_p, -of_q]));
                }
                Some(match q > p {
                    true => (q - fillet, [0.0, -1.0]),
                    false => (p - fillet, [1.0, 0.0]),
                })
            }
        }
    }
}

impl Form {
    /// Converts a surface of a valid scene.
    ///
    /// # Errors
    /// Errors in a file of heights.
    pub(in crate::model) fn of(surface: &RigidSurface, scene: &Scene) -> Result<Self> {
        let space = scene.kind;
        if let Some(of) = &surface.heights {
            let (path, dimension) = (scene.beside(&of.file), space.dimension());
            let heights = Heights::read(&path, dimension, space.is_axisymmetric(), !of.below);
            return heights.map(Form::Heights);
        }
        // Axis of revolution for a surface that gives none.
        let turned = |axis: Option<Vector>, plane: Vector| {
            let implied = if space.is_axisymmetric() {
                unit(1)
            } else {
                plane
            };
            axis.map_or(implied, direction)
        };
        if let Some(of) = &surface.sphere {
            return Ok(Form::Sphere {
                center: of.center.vector(),
                round: Round {
                    radius: of.radius,
                    hollow: of.hollow,
                },
            });
        }
        if let Some(of) = &surface.plane {
            return Ok(Form::Plane {
                point: of.point.vector(),
                normal: direction(of.normal.vector()),
            });
        }
        let (center, axis, meridian) = if let Some(of) = &surface.cylinder {
            let (radius, hollow) = (of.radius, of.hollow);
            let meridian = Meridian::Cylinder(Round { radius, hollow });
            (of.center.vector(), turned(of.axis, unit(2)), meridian)
        } else if let Some(of) = &surface.torus {
            let (radius, hollow) = (of.radius, of.hollow);
            let meridian = Meridian::Torus {
                ring: of.ring_radius,
                round: Round { radius, hollow },
            };
            (of.center.vector(), turned(of.axis, unit(1)), meridian)
        } else if let Some(of) = &surface.cone {
            let (sin, cos) = of.half_angle.to_radians().sin_cos();
            let radius = of.rounding;
            let axis = direction(of.axis.vector());
            let center = along(of.tip.vector(), radius, axis);
            (center, axis, Meridian::Cone { sin, cos, radius })
        } else {
            let of = (surface.punch.as_ref())
                .ok_or_else(|| Error::input("no kind of rigid surface is given"))?;
            let (radius, fillet) = (of.radius, of.fillet);
            let axis = direction(of.axis.vector());
            (of.center.vector(), axis, Meridian::Punch { radius, fillet })
        };
        Ok(Form::Revolved {
            center,
            axis,
            meridian,
        })
    }

    /// Distance of a point, negative inside the rigid body, and the unit normal out of the body at
    /// the closest point; `None` if no point is closest.
    pub(in crate::model) fn near(&self, x: Vector) -> Option<(f64, Vector)> {
        match self {
            Form::Heights(heights) => heights.near(x),
            Form::Plane { point, normal } => Some((dot(difference(x, *point), *normal), *normal)),
            Form::Sphere { center, round } => {
                let from = difference(x, *center);
                let far = length(from);
                let (distance, sign) = round.at(far);
                (far > 0.0).then(|| (distance, from.map(|f| sign * f / far)))
            }
            Form::Revolved {
                center,
                axis,
                meridian,
            } => {
                let from = difference(x, *center);
                let t = dot(from, *axis);
                let radial = along(from, -t, *axis);
                let s = length(radial);
                let (distance, [of_s, of_t]) = meridian.at(s, t)?;
                let out = match (s > 0.0, of_s != 0.0) {
                    (true, _) => radial.map(|r| of_s * r / s),
                    (false, true) => return None,
                    (false, false) => [0.0; 3],
                };
                Some((distance, direction(along(out, of_t, *axis))))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Space;

    /// Distances are exact along normals, and normals are their gradients.
    #[test]
    fn distance_and_normal_belong_together() {
        let round = |radius, hollow| Round { radius, hollow };
        let axis = direction([1.0, 2.0, -0.5]);
        let center = [0.3, -0.2, 0.1];
        let (sin, cos) = 35f64.to_radians().sin_cos();
        let meridians = [
            Meridian::Cylinder(round(1.5, false)),
            Meridian::Cylinder(round(4.5, true)),
            Meridian::Torus {
                ring: 3.0,
                round: round(0.7, false),
            },
            Meridian::Cone {
                sin,
                cos,
                radius: 0.4,
            },
            Meridian::Punch {
                radius: 2.0,
                fillet: 0.5,
            },
        ];
        let mut forms: Vec<Form> = (meridians.iter())
            .map(|&meridian| Form::Revolved {
                center,
                axis,
                meridian,
            })
            .collect();
        forms.push(Form::Sphere {
            center,
            round: round(1.2, false),
        });
        forms.push(Form::Plane {
            point: center,
            normal: axis,
        });
        for form in forms {
            let mut outside = 0;
            for k in 0..200 {
                let turn = f64::from(k);
                let x = [
                    3.0 * turn.sin(),
                    3.0 * (1.7 * turn).cos(),
                    2.0 * (0.6 * turn).sin(),
                ];
                let (distance, normal) = form.near(x).unwrap();
                assert!((length(normal) - 1.0).abs() < 1e-14);
                if distance < 0.0 {
                    continue;
                }
                outside += 1;
                let foot = along(x, -distance, normal);
                let (left, same) = form.near(foot).unwrap();
                assert!(left.abs() < 1e-13, "{form:?} {x:?}: {left}");
                assert!(length(difference(same, normal)) < 1e-6, "{form:?} {x:?}");
                let step = 1e-6;
                for d in 0..3 {
                    let at = |h: f64| form.near(along(x, h, unit(d))).unwrap().0;
                    let slope = (at(step) - at(-step)) / (2.0 * step);
                    assert!((slope - normal[d]).abs() < 1e-5, "{form:?} {x:?}");
                }
            }
            assert!(outside > 20, "{form:?}: {outside}");
        }
    }

    #[test]
    fn the_tip_of_a_cone_and_the_face_of_a_punch_are_where_they_are_given() {
        let cone: RigidSurface = toml::from_str(
            "cone = { tip = [0.0, 1.0], axis = [0.0, 1.0], half_angle = 60.0, rounding = 0.5 }",
        )
        .unwrap();
        let cone = Form::of(&cone, &Scene::of(Space::Axisymmetric)).unwrap();
        assert_eq!(cone.near([0.0; 3]), Some((1.0, [0.0, -1.0, 0.0])));
        let punch: RigidSurface = toml::from_str(
            "punch = { center = [0.0, 2.0], axis = [0.0, 1.0], radius = 1.0, fillet = 0.25 }",
        )
        .unwrap();
        let punch = Form::of(&punch, &Scene::of(Space::PlaneStrain)).unwrap();
        assert_eq!(punch.near([0.5, 0.0, 0.0]), Some((2.0, [0.0, -1.0, 0.0])));
        assert_eq!(punch.near([3.0, 5.0, 0.0]), Some((2.0, [1.0, 0.0, 0.0])));
    }
}
