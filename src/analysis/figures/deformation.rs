//! Whether the computed deformation is small, as the theory assumes.
//!
//! With the gradient `H` of the displacements the exact (Green) strain is
//!
//! ```text
//! E = (H + H')/2 + H'H/2
//! ```
//!
//! Small strain theory leaves the second term out. Of a stretch `|H|` it leaves out the share
//! `|H|/2`; to a rotation `|H|` it adds the spurious strain `|H|^2/2`. Between two nodes of an
//! element `|H|` is at least the difference of their displacements divided by their distance. (G.
//! A. Holzapfel, *Nonlinear Solid Mechanics* (2000), section 2.5.) The strain and the rotation that
//! are stated are those of the `H` that fits the corners of an element best.

use crate::mesh::Mesh;
use crate::model::Model;
use crate::results::Results;
use crate::space::{Vector, along, difference, length};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Displacement gradient beyond which the user is warned: a twentieth of the strains is left out.
const LARGE: f64 = 0.1;

/// The largest displacement gradient of the states so far.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(in crate::analysis) struct Deformation {
    largest: f64,
    /// Largest strain component of any element so far, from the displacement gradient fitted to its
    /// corners; `rotation` is the largest rotation, in radians.
    strain: f64,
    rotation: f64,
    /// Name of the state in which the gradient occurs; `body` is the body in which it occurs.
    state: String,
    body: String,
}

impl Deformation {
    /// Updates the largest gradient with a state, given the displacements of its nodes.
    pub(in crate::analysis) fn take(&mut self, mesh: &Mesh, state: &str, displacements: &[Vector]) {
        let of_element = |e: usize| {
            let corners = &mesh.nodes(e)[..mesh.shapes[e].n_corners()];
            let mut largest = 0.0f64;
            for (i, &a) in corners.iter().enumerate() {
                for &b in &corners[..i] {
                    let [a, b] = [a as usize, b as usize];
                    let apart = length(difference(mesh.point(a), mesh.point(b)));
                    let moved = length(difference(displacements[a], displacements[b]));
                    if apart > 0.0 {
                        largest = largest.max(moved / apart);
                    }
                }
            }
            (largest, e)
        };
        let more = |a: (f64, usize), b: (f64, usize)| if b.0 > a.0 { b } else { a };
        let elements = || (0..mesh.n_elements()).into_par_iter().with_min_len(1 << 12);
        let (largest, element) = elements().map(of_element).reduce(|| (0.0, 0), more);
        let both = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        let [strain, rotation] = elements()
            .map(|e| strain_and_rotation(mesh, e, displacements))
            .reduce(|| [0.0; 2], both);
        self.strain = self.strain.max(strain);
        self.rotation = self.rotation.max(rotation);
        if largest > self.largest {
            self.largest = largest;
            self.state = state.to_string();
            self.body = mesh.bodies[mesh.element_body[element] as usize].clone();
        }
    }

    /// Warning about large deformation, if the user should know of it.
    pub(in crate::analysis) fn warning(&self) -> Option<String> {
        let Deformation {
            largest,
            state,
            body,
            ..
        } = self;
        (*largest > LARGE).then(|| {
            format!(
                "state `{state}`: neighbouring nodes of body `{body}` move against each other by \
                 {:.0} % of their distance, and strains and rotations are taken for small: there \
                 strains are wrong by half of that share. Where less was expected, look for units \
                 that contradict each other (a modulus in GPa beside stresses in MPa)",
                100.0 * largest
            )
        })
    }

    /// Message for a deck that asks for large displacements at a place, and whether small
    /// displacements are sufficient.
    pub(in crate::analysis) fn taken_small(&self, place: &str) -> (String, bool) {
        let is_small = self.largest <= LARGE;
        let text = format!(
            "{place}: *STEP: NLGEOM: displacements are taken for small{}: strains reach {:.2} %, \
             rotations {:.2} degrees; neighbouring nodes move against each other by {:.2} % of \
             their distance at most (state `{}`, body {}), of which half is left out of the \
             strains there{}",
            if is_small {
                ", and are"
            } else {
                ", and are not"
            },
            100.0 * self.strain,
            self.rotation.to_degrees(),
            100.0 * self.largest,
            self.state,
            self.body,
            match is_small {
                true => "",
                false => "; take NLGEOM out, or compute with --small-strain, to have it so",
            }
        );
        (text, is_small)
    }
}

/// Largest component of the strain of an element, and its rotation. Both are parts of the gradient
/// `H` for which `u - H x` is least at the corners (least squares, with `u` and `x` measured from
/// their means).
fn strain_and_rotation(mesh: &Mesh, element: usize, displacements: &[Vector]) -> [f64; 2] {
    let corners = &mesh.nodes(element)[..mesh.shapes[element].n_corners()];
    let share = 1.0 / corners.len() as f64;
    let mean = |of: &dyn Fn(usize) -> Vector| {
        let each = corners.iter().map(|&node| of(node as usize));
        each.fold([0.0; 3], |sum, x| along(sum, share, x))
    };
    let (x0, u0) = (
        mean(&|node| mesh.point(node)),
        mean(&|node| displacements[node]),
    );
    let (mut moments, mut products) = (Matrix3::zeros(), Matrix3::zeros());
    for &node in corners {
        let x = Vector3::from(difference(mesh.point(node as usize), x0));
        let u = Vector3::from(difference(displacements[node as usize], u0));
        moments += x * x.transpose();
        products += u * x.transpose();
    }
    if mesh.dimension == 2 {
        moments[(2, 2)] = 1.0;
    }
    let Some(inverse) = moments.try_inverse() else {
        return [0.0; 2];
    };
    let gradient = products * inverse;
    let strain = 0.5 * (gradient + gradient.transpose());
    let turn = 0.5 * (gradient - gradient.transpose());
    [strain.amax(), turn.norm() / 2.0f64.sqrt()]
}

/// Warning for a deck that asks for large displacements when material flows at a stress that is not
/// small compared with the slope of its hardening curve. If flow spreads through a body, the change
/// of the body's cross sections then matters as much as hardening does (A. Considere, *Annales des
/// ponts et chaussees*, 1885), however small the strains are.
pub(in crate::analysis) fn softened(
    model: &Model,
    results: &Results,
    place: &str,
) -> Option<String> {
    let states = &results.states;
    let strain = states
        .iter()
        .map(|state| state.max_equivalent_plastic_strain);
    let strain = strain.fold(0.0, f64::max);
    let flowed = |body: usize| {
        let mut counts = states
            .iter()
            .map(|state| state.plastic_points_by_body.get(body));
        counts.any(|count| count.is_some_and(|count| *count > 0))
    };
    let shares = model
        .materials
        .iter()
        .enumerate()
        .filter_map(|(body, material)| {
            let curve = material.hardening.as_ref().filter(|_| flowed(body))?;
            let moves = material.back_stresses.linear();
            let stress = curve.yield_stress(strain) + moves * strain;
            Some((stress / (curve.slope(strain) + moves), body))
        });
    let (share, body) = shares.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let body = &model.mesh.bodies[body];
    (share > LARGE).then(|| {
        let (how, added) = match share.is_finite() {
            true => {
                let share = format!("{:.0} %", 100.0 * share);
                (
                    format!("at a stress of {share} of the slope of its curve"),
                    format!("some {share}"),
                )
            }
            false => ("without hardening".to_string(), "a multiple".to_string()),
        };
        format!(
            "{place}: *STEP: NLGEOM: body {body} flows {how}: where flow spreads through all of a \
             section, the change of the section adds {added} to plastic strains and \
             displacements; small displacements leave that out"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Shape;

    /// A bar of two elements that turns by 0.01 and is stretched by 0.02 in its first element.
    #[test]
    fn strains_and_rotations_are_told_apart() {
        let mut mesh = Mesh {
            dimension: 2,
            bodies: vec!["bar".to_string()],
            coordinates: vec![0.0, 0.0, 3.0, 0.0, 6.0, 0.0, 0.0, 2.0, 3.0, 2.0, 6.0, 2.0],
            ..Mesh::default()
        };
        mesh.push_element(Shape::Quad4, 0, &[0, 1, 4, 3]);
        mesh.push_element(Shape::Quad4, 0, &[1, 2, 5, 4]);
        let moved = |node: usize| {
            let [x, y, _] = mesh.point(node);
            [0.02 * x.min(3.0) - 0.01 * y, 0.01 * x, 0.0]
        };
        let displacements: Vec<Vector> = (0..6).map(moved).collect();
        let mut deformation = Deformation::default();
        deformation.take(&mesh, "pulled", &displacements);
        assert!((deformation.strain - 0.02).abs() < 1e-15);
        assert!((deformation.rotation - 0.01).abs() < 1e-15);
        // A diagonal of the first element, whose ends move apart by (0.08, 0.03).
        let diagonal = 0.08f64.hypot(0.03) / 13.0f64.sqrt();
        assert!((deformation.largest - diagonal).abs() < 1e-15);
        assert!(deformation.taken_small("a.inp, line 3").1);
    }
}
