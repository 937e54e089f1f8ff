//! Samples of an element across which its body is only one element thick.
//!
//! The stress of a linear quadrilateral, hexahedron or prism is most accurate at its middle. One
//! sample there does not show how the stress changes across a body that is one element thick. In a
//! strip under bending, for example, the surfaces may be beyond yield while the middle carries
//! nothing. Therefore there is one sample on either side of the middle: the mean over the Gauss
//! points of that side, which is as accurate along the body as the middle.

use super::neighbours::Neighbours;
use crate::mesh::Mesh;
use crate::space::{Vector, difference, length};

/// Groups of Gauss points of an element that are averaged into one sample.
#[derive(Debug, Clone)]
pub struct Layers {
    /// The sample to which each Gauss point belongs.
    sample_of: Vec<usize>,
    /// Number of Gauss points in each sample.
    shares: Vec<f64>,
}

impl Layers {
    /// The layers of an element of a list; `points` returns the positions of its Gauss points.
    /// `None` if the body is more than one element thick here in every direction, or if the element
    /// has several superconvergent points.
    pub fn of(
        (mesh, list, neighbours): (&Mesh, &[usize], &Neighbours),
        element: usize,
        points: impl FnOnce() -> Vec<Vector>,
    ) -> Option<Self> {
        if mesh.shapes[element].reference().sampling.len() > 1 {
            return None;
        }
        let sides = neighbours.free_sides(mesh, list, element);
        if sides.is_empty() {
            return None;
        }
        let middle = |nodes: &Vec<usize>| -> Vector {
            let share = 1.0 / nodes.len() as f64;
            let places = nodes.iter().map(|&node| mesh.point(node));
            places.fold([0.0; 3], |sum, x| [0, 1, 2].map(|d| sum[d] + share * x[d]))
        };
        let ends: Vec<[Vector; 2]> = sides.iter().map(|s| s.each_ref().map(middle)).collect();
        // One bit for each pair of opposite sides: which of the two is nearer.
        let side = |x: &Vector| {
            let bits = ends.iter().enumerate().map(|(bit, ends)| {
                let [one, other] = ends.map(|end| length(difference(*x, end)));
                usize::from(other < one) << bit
            });
            bits.sum::<usize>()
        };
        let keys: Vec<usize> = points().iter().map(side).collect();
        let mut distinct = keys.clone();
        distinct.sort_unstable();
        distinct.dedup();
        let sample = |key: &usize| distinct.partition_point(|other| other < key);
        let sample_of: Vec<usize> = keys.iter().map(sample).collect();
        let mut shares = vec![0.0; distinct.len()];
        sample_of.iter().for_each(|&sample| shares[sample] += 1.0);
        Some(Layers { sample_of, shares })
    }

    /// Number of samples.
    pub fn n_samples(&self) -> usize {
        self.shares.len()
    }

    /// Averages values at the Gauss points (`K` values per point, one lane per point) over each
    /// sample. The lanes of the result are the samples.
    pub fn means<const K: usize, const P: usize>(
        &self,
        at_points: &[[f64; P]; K],
    ) -> [[f64; P]; K] {
        let mut out = [[0.0; P]; K];
        for (means, values) in out.iter_mut().zip(at_points) {
            for (&sample, value) in self.sample_of.iter().zip(values) {
                means[sample] += value / self.shares[sample];
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::Kernel;
    use crate::shape::{Integration, Shape};
    use crate::space::Space;

    /// Three squares in a row and one on top of the last: a square without others above and below
    /// it has two samples, a square with another on top has none.
    #[test]
    fn elements_alone_across_a_body_have_a_sample_on_either_side() {
        let mut mesh = Mesh {
            dimension: 2,
            bodies: vec!["b".into()],
            ..Mesh::default()
        };
        for j in 0..3 {
            for i in 0..4 {
                mesh.coordinates.extend([f64::from(i), f64::from(j)]);
            }
        }
        let square = |i: u32, j: u32| [i + 4 * j, i + 1 + 4 * j, i + 5 + 4 * j, i + 4 + 4 * j];
        for (i, j) in [(0, 0), (1, 0), (2, 0), (2, 1)] {
            mesh.push_element(Shape::Quad4, 0, &square(i, j));
        }
        let list = [0, 1, 2, 3];
        let neighbours = Neighbours::new(&mesh, list.iter().copied());
        let layers = |element: usize| {
            let nodes = mesh.element_coordinates(element);
            let kind = (Shape::Quad4, Integration::Reduced);
            let gauss = Kernel::plane(Space::PlaneStrain).at_gauss_points(kind, &nodes);
            let [x, y] = gauss.positions(&nodes);
            let points = || (0..4).map(|g| [x[g], y[g], 0.0]).collect();
            let layers = Layers::of((&mesh, &list, &neighbours), element, points)?;
            let [x, y] = layers.means(&[x, y]);
            Some(
                (0..layers.n_samples())
                    .map(|s| [x[s], y[s]])
                    .collect::<Vec<_>>(),
            )
        };
        let found = layers(1).expect("a layer");
        let off = 0.5 / 3f64.sqrt();
        assert_eq!(found.len(), 2);
        for (sample, y) in found.iter().zip([0.5 - off, 0.5 + off]) {
            assert!((sample[0] - 1.5).abs() < 1e-15, "{found:?}");
            assert!((sample[1] - y).abs() < 1e-15, "{found:?}");
        }
        assert_eq!(layers(2), None);
        // The square on top has no neighbours to its left and right.
        assert_eq!(layers(3).map(|samples| samples.len()), Some(2));
    }
}
