//! The force that acts across a contact: `CF`, `CFN` and `CFS` of `*CONTACT PRINT`.

use super::digits::{fortran, row};
use super::tables::Tables;
use crate::results::{Fields, State};
use crate::scene::ContactForce;
use crate::space::{Vector, along, cross, difference, dot};
use std::io::{self, Write};

/// Sums over a surface, or over the part of a slave surface that presses.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactSums {
    pub(super) force: Vector,
    pub(super) moment: Vector,
    pub(super) area: f64,
    pub(super) center: Vector,
    pub(super) normal: Vector,
}

impl ContactSums {
    /// Divides the sums of places and normals by the area, which makes them means.
    pub(super) fn center(&mut self) {
        if self.area > 0.0 {
            self.center = self.center.map(|x| x / self.area);
            self.normal = self.normal.map(|n| n / self.area);
        }
    }

    /// Returns the moment about the centre of gravity.
    pub(super) fn about_center(&self) -> Vector {
        difference(self.moment, cross(self.center, self.force))
    }

    /// Writes the blocks of the sums: `first` and `last` are the heads of the first and last block,
    /// `values` the numbers of the last.
    pub(super) fn write(
        &self,
        out: &mut impl Write,
        [first, last]: [&str; 2],
        values: &[f64],
    ) -> io::Result<()> {
        let mut block =
            |head: &str, values: &[f64]| writeln!(out, "\n   {head}\n\n  {}", row(values));
        block(first, &[self.force, self.moment].concat())?;
        block(
            "center of gravity and mean normal",
            &[self.center, self.normal].concat(),
        )?;
        block(
            "moment about the center of gravity(mx,my,mz)",
            &self.about_center(),
        )?;
        block(last, values)
    }
}

impl Tables<'_> {
    /// Writes force and moment about the origin, and centre of gravity, mean normal and area of the
    /// part of the slave surface that presses. Places are those of the deformed surface.
    pub(super) fn statistics(
        &self,
        out: &mut impl Write,
        (of, contact, names): (ContactForce, usize, &str),
        (state, fields): (&State, &Fields),
        time: f64,
    ) -> io::Result<()> {
        let mut sums = self.sums(contact, state, fields);
        // Without friction there is no force along the surface.
        if of == ContactForce::Shear {
            (sums.force, sums.moment) = ([0.0; 3], [0.0; 3]);
        }
        let time = fortran(time);
        writeln!(out, "\n\n statistics for {names} and time  {time}")?;
        let heads = [
            "total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)",
            "area,  normal force (+ = tension) and shear force (size)",
        ];
        let last = [sums.area, dot(sums.force, sums.normal), 0.0];
        sums.write(out, heads, &last)
    }

    fn sums(&self, contact: usize, state: &State, fields: &Fields) -> ContactSums {
        let model = self.model;
        let mut out = ContactSums::default();
        let presses =
            |pair: &&crate::results::PairState| pair.contact == contact && pair.force > 0.0;
        for of_pair in state.pairs.iter().filter(presses) {
            let Some((node, pair)) = (self.slaves.node(of_pair)).zip(model.pairs.get(of_pair.pair))
            else {
                continue;
            };
            // The normal of a pair points away from the slave of the pair.
            let side = match self.slaves.is_on_first(pair.slave, contact) {
                true => 1.0,
                false => -1.0,
            };
            let normal = pair.normal.map(|n| side * n);
            let moved = self.vectors.at(node, &fields.displacement);
            let place = along(model.mesh.point(node), 1.0, moved);
            let force = normal.map(|n| -self.of_forces * of_pair.force * n);
            let area = self.of_forces * of_pair.area;
            out.force = along(out.force, 1.0, force);
            out.moment = along(out.moment, 1.0, cross(place, force));
            out.center = along(out.center, area, place);
            out.normal = along(out.normal, area, normal);
            out.area += area;
        }
        out.center();
        out
    }
}
