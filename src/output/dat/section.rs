//! The force that acts across a surface: `*SECTION PRINT`.

use super::digits::fortran;
use super::statistics::ContactSums;
use super::tables::Tables;
use crate::output::frd::Extrapolated;
use crate::results::Fields;
use crate::scene::Print;
use crate::shape::{Integration, Place, Shape};
use crate::space::{Space, Vector, along, cross, dot, length};
use std::io::{self, Write};

/// Half the angle of the slice that represents an axisymmetric model in CalculiX.
const HALF_SLICE: f64 = std::f64::consts::PI / 180.0;

impl Tables<'_> {
    /// Writes the resultant of the stresses on a surface: the force, the moment about the origin
    /// and about the centre of gravity, and the parts of force and moment along and across the mean
    /// normal. Also writes the centre of gravity, mean normal and area of the surface.
    ///
    /// The integrals are computed as in CalculiX: the stresses at nodes (extrapolated from the
    /// integration points of each element, then averaged over the elements) are interpolated over
    /// each face and integrated by the rule of the element. These integrals are in equilibrium with
    /// the loads only as far as the mesh resolves the stresses, whereas the forces at nodes are
    /// exactly in equilibrium. In a plane model the whole thickness counts, in an axisymmetric one
    /// a slice of 2 degrees with z along the hoop direction.
    pub(super) fn section(
        &self,
        out: &mut impl Write,
        print: &Print,
        fields: &Fields,
        time: f64,
    ) -> io::Result<()> {
        let Some(points) = fields.points.as_ref() else {
            return Ok(());
        };
        let extrapolated = Extrapolated::new(&self.model.mesh, points);
        let mut sums = ContactSums::default();
        for &(label, local) in &*print.faces {
            if let Some(element) = self.elements.get(label) {
                let face = (element as usize, usize::from(local));
                self.add_face(face, &extrapolated.stress, &mut sums);
            }
        }
        sums.center();
        let across = dot(sums.force, sums.normal);
        let about_center = sums.about_center();
        let torque = dot(about_center, sums.normal);
        let rest = |vector: Vector, part: f64| length(along(vector, -part, sums.normal));
        let last = [
            sums.area,
            across,
            rest(sums.force, across),
            torque,
            rest(about_center, torque),
        ];
        let (name, time) = (&print.set.name, fortran(time));
        writeln!(
            out,
            "\n\n\n statistics for surface set {name} and time  {time}"
        )?;
        let heads = [
            "total surface force (fx,fy,fz) and moment about the origin(mx,my,mz)",
            "area, normal force (+ = tension), shear force (size), torque and bending moment \
             (size)",
        ];
        sums.write(out, heads, &last)
    }

    /// Adds the force across a face.
    fn add_face(&self, (element, local): (usize, usize), stress: &[f64], sums: &mut ContactSums) {
        let (mesh, space) = (&self.model.mesh, self.model.kind);
        let shape = mesh.shapes[element];
        let c = stress.len() / mesh.n_nodes().max(1);
        let own = mesh.nodes(element);
        let nodes: Vec<usize> = (shape.facet(local).iter())
            .map(|&k| own[k] as usize)
            .collect();
        let places: Vec<Vector> = nodes.iter().map(|&node| mesh.point(node)).collect();
        let facet = shape.facet_reference(local);
        let thickness = self.model.scene.requests.thickness.unwrap_or(1.0);
        for (place, weight) in rule(shape, facet.n_corners, mesh.integration_of(element)) {
            let at = (facet.functions)(place);
            let area = facet.area(&at, &places);
            let (mut x, mut s) = ([0.0; 3], [0.0; 6]);
            for ((value, point), node) in at.values.iter().zip(&places).zip(&nodes) {
                x = along(x, *value, *point);
                let of_node = &stress[c * node..][..c];
                for (sum, component) in s.iter_mut().zip(of_node) {
                    *sum += value * component;
                }
            }
            let [xx, yy, zz, xy, yz, zx] = s;
            let rows = [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]];
            let force = rows.map(|row| dot(row, area));
            match space {
                Space::Axisymmetric => sums.add_turned(x, weight, force, area),
                _ => {
                    let weight = match mesh.is_solid() {
                        true => weight,
                        false => weight * thickness,
                    };
                    sums.add(x, force.map(|f| weight * f), area.map(|a| weight * a));
                }
            }
        }
    }
}

impl ContactSums {
    /// Adds a force at a place, on an area along its outward normal.
    fn add(&mut self, place: Vector, force: Vector, area: Vector) {
        let size = length(area);
        self.force = along(self.force, 1.0, force);
        self.moment = along(self.moment, 1.0, cross(place, force));
        self.center = along(self.center, size, place);
        self.normal = along(self.normal, 1.0, area);
        self.area += size;
    }

    /// Adds the integral over the slice of a force and an area given along r and z. In the middle
    /// of the slice the hoop direction is along z: the component along r is rotated with the angle,
    /// and components that are odd in the angle vanish.
    fn add_turned(&mut self, [r, z, _]: Vector, weight: f64, force: Vector, area: Vector) {
        let (all, turned) = (2.0 * HALF_SLICE, 2.0 * HALF_SLICE.sin());
        let weight = weight * r;
        let over = |[along_r, along_z, _]: Vector| {
            [weight * turned * along_r, weight * all * along_z, 0.0]
        };
        let size = weight * length(area);
        self.force = along(self.force, 1.0, over(force));
        self.moment[2] += weight * turned * (r * force[1] - z * force[0]);
        self.center = along(self.center, size, [turned * r, all * z, 0.0]);
        self.normal = along(self.normal, 1.0, over(area));
        self.area += all * size;
    }
}

/// Returns the points of a face at which CalculiX takes the stresses, for the element into which it
/// turns the shape: plane elements become solids of one layer, triangles prisms.
///
/// # Source
/// *CalculiX CrunchiX User's Manual* 2.20, section 6.2; chapter 7, `*SECTION PRINT`.
fn rule(shape: Shape, n_corners: usize, by: Integration) -> Vec<(Place, f64)> {
    let per_side = match (shape, by) {
        (Shape::Tri3 | Shape::Prism6, _) => 1,
        (Shape::Quad8 | Shape::Hex20, Integration::Full) => 3,
        _ => 2,
    };
    if n_corners == 3 {
        const OFF: f64 = 1.0 / 6.0;
        return match shape.is_quadratic() {
            true => vec![
                ([OFF, OFF, 0.0], OFF),
                ([4.0 * OFF, OFF, 0.0], OFF),
                ([OFF, 4.0 * OFF, 0.0], OFF),
            ],
            false => vec![([1.0 / 3.0, 1.0 / 3.0, 0.0], 0.5)],
        };
    }
    let line: Vec<(f64, f64)> = match per_side {
        1 => vec![(0.0, 2.0)],
        2 => vec![(-(1.0f64 / 3.0).sqrt(), 1.0), ((1.0f64 / 3.0).sqrt(), 1.0)],
        _ => {
            let outer = 0.6f64.sqrt();
            vec![(-outer, 5.0 / 9.0), (0.0, 8.0 / 9.0), (outer, 5.0 / 9.0)]
        }
    };
    match n_corners {
        2 => line.iter().map(|&(x, w)| ([x, 0.0, 0.0], w)).collect(),
        _ => (line.iter())
            .flat_map(|&(y, v)| line.iter().map(move |&(x, w)| ([x, y, 0.0], v * w)))
            .collect(),
    }
}
