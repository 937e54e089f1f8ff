//! Moments of the part of faces in which a level function is positive.

use nalgebra::{Matrix2, SymmetricEigen, Vector2};

/// Number of pieces along each side of a face into which the face is divided to locate the edge.
const PIECES: usize = 4;

/// Corners of a convex polygon in order.
pub(super) type Polygon = Vec<[f64; 2]>;
/// Corners of a triangle.
pub(super) type TriangleCorners = [[f64; 2]; 3];

/// Moments of a patch in its two coordinates. The area is that of the modelled part; the centre and
/// the second moments are those of the part together with its mirror images.
#[derive(Clone, Copy)]
pub(super) struct Moments {
    pub(super) area: f64,
    pub(super) center: [f64; 2],
    /// Second moments `M`.
    second: [[f64; 2]; 2],
}

/// Sums of moments over the parts of faces that belong to a patch.
#[derive(Default)]
pub(super) struct PatchSums {
    area: f64,
    first: [f64; 2],
    second: [[f64; 2]; 2],
}

impl PatchSums {
    /// Adds whole convex polygons.
    pub(super) fn add_all(&mut self, polygons: &[Polygon]) {
        for corners in polygons {
            for k in 2..corners.len() {
                self.add_whole([corners[0], corners[k - 1], corners[k]]);
            }
        }
    }

    /// Adds the part of convex polygons in which a function is positive.
    pub(super) fn add_parts(&mut self, parts: &[Polygon], level: impl Fn([f64; 2]) -> f64) {
        where_positive(parts, level, &mut |triangle| self.add_whole(triangle));
    }

    /// Adds the part of a face in which a function, given by its values at the corners, is
    /// positive.
    pub(super) fn add_corners(&mut self, corners: &[[f64; 2]], levels: &[f64]) {
        let n = corners.len();
        let middle = [0, 1].map(|d| corners.iter().map(|x| x[d]).sum::<f64>() / n as f64);
        let mean = levels.iter().sum::<f64>() / n as f64;
        for k in 0..n {
            let next = (k + 1) % n;
            let piece = [corners[k], corners[next], middle];
            cut(piece, [levels[k], levels[next], mean], &mut |triangle| {
                self.add_whole(triangle);
            });
        }
    }

    /// Adds a triangle with `int x x' dA = A/12 (sum p p' + 9 c c')`, c its centroid.
    fn add_whole(&mut self, [p, q, r]: TriangleCorners) {
        let [a, b] = [q, r].map(|x| [x[0] - p[0], x[1] - p[1]]);
        let area = 0.5 * (a[0] * b[1] - a[1] * b[0]).abs();
        let center = [0, 1].map(|d| (p[d] + q[d] + r[d]) / 3.0);
        self.area += area;
        for i in 0..2 {
            self.first[i] += area * center[i];
            for j in 0..2 {
                let corners = p[i] * p[j] + q[i] * q[j] + r[i] * r[j];
                self.second[i][j] += area / 12.0 * (corners + 9.0 * center[i] * center[j]);
            }
        }
    }

    /// The moments of the part together with its mirror images. `reflections` produce the images,
    /// about the origin, which lies on the planes of symmetry.
    pub(super) fn moments(&self, reflections: &[[[f64; 2]; 2]]) -> Moments {
        let per_area = 1.0 / self.area.max(f64::MIN_POSITIVE);
        let first = Vector2::from(self.first) * per_area;
        let moment = |i: usize, j: usize| self.second[i][j] * per_area;
        let own = Matrix2::from_fn(moment);
        let (mut center, mut second) = (first, own);
        for rows in reflections {
            let r = Matrix2::from_fn(|i, j| rows[i][j]);
            center += r * first;
            second += r * own * r.transpose();
        }
        let share = 1.0 / (1.0 + reflections.len() as f64);
        let (center, second) = (center * share, second * share);
        let center = [center[0], center[1]];
        let mut second = [0, 1].map(|i| [0, 1].map(|j| second[(i, j)]));
        for i in 0..2 {
            for j in 0..2 {
                second[i][j] -= center[i] * center[j];
            }
        }
        Moments {
            area: self.area,
            center,
            second,
        }
    }
}

/// Passes the part of convex polygons in which a function is positive to `show`, triangle by
/// triangle.
pub(super) fn where_positive(
    parts: &[Polygon],
    level: impl Fn([f64; 2]) -> f64,
    show: &mut dyn FnMut(TriangleCorners),
) {
    for corners in parts {
        match corners.len() {
            3 | 4 => of_face(corners, &level, show),
            n => (2..n).for_each(|k| {
                of_face(&[corners[0], corners[k - 1], corners[k]], &level, show);
            }),
        }
    }
}

/// Passes the part of a face in which a function is positive to `show`, divided into small pieces
/// with straight edges.
fn of_face(
    corners: &[[f64; 2]],
    level: impl Fn([f64; 2]) -> f64,
    show: &mut dyn FnMut(TriangleCorners),
) {
    let n = PIECES;
    let share = |i: usize| i as f64 / n as f64;
    let mixed = |weights: &[f64]| {
        [0, 1].map(|d| {
            corners
                .iter()
                .zip(weights)
                .map(|(x, w)| w * x[d])
                .sum::<f64>()
        })
    };
    let point = |i: usize, j: usize| {
        let (s, t) = (share(i), share(j));
        match corners.len() {
            3 => mixed(&[1.0 - s - t, s, t]),
            _ => mixed(&[(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]),
        }
    };
    if corners.len() == 3 {
        for i in 0..n {
            for j in 0..n - i {
                let piece = [point(i, j), point(i + 1, j), point(i, j + 1)];
                cut(piece, piece.map(&level), show);
                if i + j + 1 < n {
                    let piece = [point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
                    cut(piece, piece.map(&level), show);
                }
            }
        }
        return;
    }
    for i in 0..n {
        for j in 0..n {
            // Each square is divided into four triangles round its middle: neither diagonal is
            // preferred, so mirror images have the same area.
            let square = [
                point(i, j),
                point(i + 1, j),
                point(i + 1, j + 1),
                point(i, j + 1),
            ];
            let middle = [0, 1].map(|d| 0.25 * square.iter().map(|x| x[d]).sum::<f64>());
            for k in 0..4 {
                let piece = [square[k], square[(k + 1) % 4], middle];
                cut(piece, piece.map(&level), show);
            }
        }
    }
}

/// Passes the part of a triangle in which a linear function, given at the corners, is positive to
/// `show`.
fn cut(corners: TriangleCorners, levels: [f64; 3], show: &mut dyn FnMut(TriangleCorners)) {
    let mut inside: Vec<[f64; 2]> = Vec::with_capacity(4);
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        let (a, b) = (levels[k], levels[(k + 1) % 3]);
        if a > 0.0 {
            inside.push(p);
        }
        if (a > 0.0) != (b > 0.0) {
            let t = a / (a - b);
            inside.push([0, 1].map(|d| p[d] + t * (q[d] - p[d])));
        }
    }
    for k in 2..inside.len() {
        show([inside[0], inside[k - 1], inside[k]]);
    }
}

impl Moments {
    /// The moments after scaling the coordinates by `units`.
    pub(super) fn scaled(&self, units: [f64; 2]) -> Moments {
        let second = |i: usize, j: usize| self.second[i][j] * units[i] * units[j];
        Moments {
            area: self.area * units[0] * units[1],
            center: [0, 1].map(|d| self.center[d] * units[d]),
            second: [0, 1].map(|i| [0, 1].map(|j| second(i, j))),
        }
    }

    /// Moments with the same centre and second moments, but another area.
    pub(super) fn with_area(self, area: f64) -> Moments {
        Moments { area, ..self }
    }

    /// Half axes, the larger first, and the direction of the larger one.
    pub(super) fn axes(&self) -> ([f64; 2], [f64; 2]) {
        let [[a, b], [_, c]] = self.second;
        let eigen = SymmetricEigen::new(Matrix2::new(a, b, b, c));
        let (large, small) = if eigen.eigenvalues[0] >= eigen.eigenvalues[1] {
            (0, 1)
        } else {
            (1, 0)
        };
        let semi = [large, small].map(|k| 2.0 * eigen.eigenvalues[k].max(0.0).sqrt());
        let major = eigen.eigenvectors.column(large);
        (semi, [major[0], major[1]])
    }
}
