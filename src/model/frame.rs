//! Local axes of a node: choice of directions for contact normals and supports.

use crate::space::{Vector, along, cross, direction, dot, length, unit};

/// Three orthogonal unit axes, right-handed.
pub type Frame = [Vector; 3];

/// Sine of the angle by which directions may deviate from a right angle or a common line.
pub(super) const ALIGNED: f64 = 1e-6;

/// Whether two unit vectors lie along a common line.
fn are_aligned(a: Vector, b: Vector) -> bool {
    length(cross(a, b)) <= ALIGNED
}

/// Chooses the axes of a node. The contact normal, if there is one, comes first; the held
/// directions are spanned by some of the other axes. Global axes are kept if possible. In the plane
/// the third axis is the one out of the plane.
///
/// # Errors
/// Number of a held direction that is not at right angles to the normal, or that in the plane is
/// neither parallel nor at right angles to the directions before it.
pub(super) fn frame(
    dimension: usize,
    normal: Option<Vector>,
    held: &[Vector],
) -> Result<Frame, usize> {
    let mut axes: Vec<Vector> = Vec::new();
    if dimension == 2 {
        axes.push(unit(2));
    }
    axes.extend(normal);
    let is_global = |v: &Vector| (0..3).any(|d| are_aligned(*v, unit(d)));
    let in_global_axes = normal.is_none() && held.iter().all(is_global);
    if in_global_axes {
        return Ok([unit(0), unit(1), unit(2)]);
    }
    for (k, &d) in held.iter().enumerate() {
        let off = |axis: &Vector| dot(*axis, d).abs();
        if axes.iter().any(|axis| are_aligned(*axis, d)) {
            continue;
        }
        let rigid = if dimension == 2 {
            axes.len()
        } else {
            usize::from(normal.is_some())
        };
        if axes[..rigid].iter().any(|axis| off(axis) > ALIGNED) {
            return Err(k);
        }
        // Two planes of symmetry at any angle hold the node in all directions across their common
        // edge. If the angle is small, the first difference has relatively large round-off, which a
        // second difference removes.
        let less_axes = |d: Vector| {
            let axes = axes.iter();
            axes.fold(d, |rest, axis| along(rest, -dot(*axis, d), *axis))
        };
        let rest = less_axes(d);
        if length(rest) > ALIGNED {
            let is_across = rest == d;
            axes.push(if is_across {
                d
            } else {
                direction(less_axes(direction(rest)))
            });
        }
    }
    if dimension == 2 {
        let first = axes.get(1).copied().unwrap_or(unit(0));
        return Ok([first, cross(unit(2), first), unit(2)]);
    }
    let first = axes.first().copied().unwrap_or(unit(0));
    let second = axes.get(1).copied().unwrap_or_else(|| across(first));
    let third = cross(first, second);
    // The third axis points along a global axis, not against it: nodes of a plane surface share a
    // freedom.
    if third.iter().any(|x| *x < ALIGNED - 1.0) {
        return Ok([first, second.map(|x| -x), third.map(|x| -x)]);
    }
    Ok([first, second, third])
}

/// A direction at right angles to another, made from the global axis farthest from it.
fn across(first: Vector) -> Vector {
    let share = |d: &usize| first[*d].abs();
    let axis = (0..3).min_by(|a, b| share(a).total_cmp(&share(b)));
    let axis = unit(axis.unwrap_or(0));
    direction(along(axis, -dot(axis, first), first))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_frame(frame: &Frame) -> bool {
        let [a, b, c] = *frame;
        let right = cross(a, b);
        (0..3).all(|d| (right[d] - c[d]).abs() < 1e-15) && (dot(a, a) - 1.0).abs() < 1e-15
    }

    #[test]
    fn the_normal_is_first_and_held_directions_are_axes() {
        let normal = direction([0.0, 0.3, -0.8]);
        for held in [&[][..], &[unit(0)], &[unit(0), unit(0)]] {
            let frame = frame(3, Some(normal), held).unwrap();
            assert!(is_frame(&frame) && frame[0] == normal);
            assert!(held.is_empty() || frame[1] == unit(0));
        }
        // Supports along global axes need no rotated axes.
        assert_eq!(frame(3, None, &[unit(1), unit(0)]).unwrap()[0], unit(0));
        let slanted = direction([1.0, 2.0, 2.0]);
        assert_eq!(frame(3, None, &[slanted]).unwrap()[0], slanted);
        // Two planes at an angle: the second axis lies in the span of their normals.
        let edge = frame(3, None, &[slanted, unit(0)]).unwrap();
        assert!(is_frame(&edge) && edge[0] == slanted);
        assert!(dot(edge[2], unit(0)).abs() < 1e-15);
        // The edge runs along y, whichever plane comes first.
        let turned = direction([1.0, 0.0, 1.0]);
        for held in [[unit(2), turned], [turned, unit(2)]] {
            let edge = frame(3, None, &held).unwrap();
            assert!(is_frame(&edge) && (edge[2][1] - 1.0).abs() < 1e-15);
        }
        // A third plane at an angle holds the node completely.
        assert!(is_frame(
            &frame(3, None, &[slanted, unit(0), unit(1)]).unwrap()
        ));
        assert_eq!(frame(3, Some(slanted), &[unit(0)]), Err(0));
    }

    /// A direction a milliradian off a global axis, or off another direction, is distinct. The
    /// cosine would not tell them apart, and the sine alone would hold the direction across it,
    /// too.
    #[test]
    fn a_small_angle_is_an_angle() {
        for angle in [2e-6, 1e-3] {
            let near = direction([angle, 1.0, 0.0]);
            assert_eq!(frame(2, None, &[near]).unwrap()[0], near);
            assert_eq!(frame(3, None, &[near]).unwrap()[0], near);
            let both = frame(3, None, &[near, unit(1)]).unwrap();
            assert!(is_frame(&both) && (both[2][2].abs() - 1.0).abs() < 1e-15);
        }
        let same = direction([1e-7, 1.0, 0.0]);
        assert_eq!(
            frame(3, None, &[same]).unwrap(),
            [unit(0), unit(1), unit(2)]
        );
    }

    #[test]
    fn in_the_plane_the_second_axis_is_a_quarter_turn_on() {
        let normal = direction([0.6, 0.8, 0.0]);
        let plane = frame(2, Some(normal), &[]).unwrap();
        assert_eq!(plane[1], [-normal[1], normal[0], 0.0]);
        assert_eq!(plane[2], unit(2));
        assert_eq!(frame(2, None, &[normal, unit(0)]), Err(1));
    }
}
