//! The force that a contact passes on: `CF`, `CFN` and `CFS` of `*CONTACT PRINT`.

use super::tables::{Tables, fortran, row};
use crate::results::{Fields, State};
use crate::scene::ContactForce;
use crate::space::{Vector, along, cross, difference, dot};
use std::io::{self, Write};

/// What the pairs of a contact that press add up to, on its slave surface.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    force: Vector,
    moment: Vector,
    area: f64,
    center: Vector,
    normal: Vector,
}

impl Tables<'_> {
    /// Writes force and moment about the origin, the centre of gravity and the mean normal of the
    /// part of the slave surface that presses, and its area; places are those of the deformed
    /// surface.
    pub(super) fn statistics(
        &self,
        out: &mut impl Write,
        (of, contact, names): (ContactForce, usize, &str),
        (state, fields): (&State, &Fields),
        time: f64,
    ) -> io::Result<()> {
        let sums = self.sums(contact, state, fields);
        // Without friction there is no force along the surface.
        let [force, moment] = match of {
            ContactForce::Shear => [[0.0; 3]; 2],
            ContactForce::Total | ContactForce::Normal => [sums.force, sums.moment],
        };
        let about_center = difference(moment, cross(sums.center, force));
        let time = fortran(time);
        writeln!(out, "\n\n statistics for {names} and time  {time}")?;
        let mut block =
            |head: &str, values: &[f64]| writeln!(out, "\n   {head}\n\n  {}", row(values));
        block(
            "total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)",
            &[force, moment].concat(),
        )?;
        block(
            "center of gravity and mean normal",
            &[sums.center, sums.normal].concat(),
        )?;
        block(
            "moment about the center of gravity(mx,my,mz)",
            &about_center,
        )?;
        block(
            "area,  normal force (+ = tension) and shear force (size)",
            &[sums.area, dot(force, sums.normal), 0.0],
        )
    }

    fn sums(&self, contact: usize, state: &State, fields: &Fields) -> Sums {
        let model = self.model;
        let thickness = model.scene.requests.thickness.unwrap_or(1.0);
        let mut out = Sums::default();
        let presses =
            |pair: &&crate::results::PairState| pair.contact == contact && pair.force > 0.0;
        for of_pair in state.pairs.iter().filter(presses) {
            let Some((node, pair)) = (self.slaves.node(of_pair)).zip(model.pairs.get(of_pair.pair))
            else {
                continue;
            };
            // The normal of a pair points away from its own slave.
            let side = match self.slaves.is_on_first(pair.slave, contact) {
                true => 1.0,
                false => -1.0,
            };
            let normal = pair.normal.map(|n| side * n);
            let moved = self.vector(node, &fields.displacement);
            let place = along(model.mesh.point(node), 1.0, moved);
            let force = normal.map(|n| -thickness * of_pair.force * n);
            let area = thickness * of_pair.area;
            out.force = along(out.force, 1.0, force);
            out.moment = along(out.moment, 1.0, cross(place, force));
            out.center = along(out.center, area, place);
            out.normal = along(out.normal, area, normal);
            out.area += area;
        }
        if out.area > 0.0 {
            out.center = out.center.map(|x| x / out.area);
            out.normal = out.normal.map(|n| n / out.area);
        }
        out
    }
}
