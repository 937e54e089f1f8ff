//! Writing of a single table.

use super::points;
use crate::element::volume_points;
use crate::labels::LabelIndex;
use crate::model::Model;
use crate::output::slaves::Slaves;
use crate::results::{Fields, State};
use crate::scene::LooseNode;
use crate::scene::{Print, ResultItem, Totals};
use crate::space::{Space, Vector, along, dot};
use std::io::{self, Write};

/// Fraction of the circle that CalculiX computes of an axisymmetric model: 2 degrees.
const SLICE: f64 = 1.0 / 180.0;

/// Writes tables of a model.
pub(super) struct Tables<'a> {
    pub(super) model: &'a Model,
    pub(super) slaves: Slaves<'a>,
    pub(super) nodes: LabelIndex,
    pub(super) elements: LabelIndex,
    /// Factor from the forces of the model to those of the tables.
    pub(super) of_forces: f64,
}

impl<'a> Tables<'a> {
    /// Tables with forces on the whole circle of an axisymmetric model, or on the slice of 2
    /// degrees that CalculiX computes.
    pub(super) fn new(model: &'a Model, is_slice: bool) -> Self {
        let mesh = &model.mesh;
        let thickness = model.scene.requests.thickness.unwrap_or(1.0);
        let of_forces = match model.kind {
            Space::Axisymmetric if is_slice => SLICE,
            _ => thickness,
        };
        let index = |labels: Vec<u64>| LabelIndex::new(&labels).unwrap_or_default();
        Tables {
            model,
            of_forces,
            slaves: Slaves::new(model),
            nodes: index((0..mesh.n_nodes()).map(|n| mesh.node_label(n)).collect()),
            elements: index(
                (0..mesh.n_elements())
                    .map(|e| mesh.element_label(e))
                    .collect(),
            ),
        }
    }

    /// Writes a table of a state.
    pub(super) fn write(
        &self,
        out: &mut impl Write,
        print: &Print,
        (state, fields): (&State, &Fields),
        time: f64,
    ) -> io::Result<()> {
        let of_set = format!("for set {} and time {:>14}", print.set.name, fortran(time));
        match print.item {
            ResultItem::Displacement => {
                let head = format!("displacements (vx,vy,vz) {of_set}");
                self.of_nodes(out, print, &head, (&fields.displacement, 1.0), |loose| {
                    self.displacement_of(loose, fields, time)
                })
            }
            ResultItem::Force if fields.force.is_empty() => Ok(()),
            ResultItem::Force => {
                if print.totals != Totals::Only {
                    let head = format!("forces (fx,fy,fz) {of_set}");
                    let of_loose = |loose: &LooseNode| self.force_of(loose, fields);
                    self.of_nodes(out, print, &head, (&fields.force, self.of_forces), of_loose)?;
                }
                if print.totals != Totals::No {
                    let head = format!("total force (fx,fy,fz) {of_set}");
                    let sum = self.total_force(print, fields);
                    writeln!(out, "\n {head}\n\n{:6}{}", "", row(&sum))?;
                }
                Ok(())
            }
            ResultItem::ContactForce(of) => match print.set.labels.first() {
                Some(&contact) => {
                    let contact = (of, contact as usize, &*print.set.name);
                    self.statistics(out, contact, (state, fields), time)
                }
                None => Ok(()),
            },
            ResultItem::Section => self.section(out, print, fields, time),
            ResultItem::Contact => self.of_contact(out, state, time),
            ResultItem::PlasticStrain if !self.model.may_yield.contains(&true) => Ok(()),
            ResultItem::Volume => self.volumes(out, print, &of_set),
            item => self.of_elements(out, (print, item), fields, &of_set),
        }
    }

    /// Returns the indices of the elements of a set.
    fn elements(&self, print: &Print) -> impl Iterator<Item = (u64, usize)> {
        let labels = print.set.labels.iter();
        labels.filter_map(|&label| Some((label, self.elements.get(label)? as usize)))
    }

    pub(super) fn vector(&self, node: usize, values: &[f64]) -> [f64; 3] {
        let d = self.model.mesh.dimension;
        let own = &values[d * node..d * (node + 1)];
        std::array::from_fn(|k| own.get(k).copied().unwrap_or(0.0))
    }

    fn of_nodes(
        &self,
        out: &mut impl Write,
        print: &Print,
        head: &str,
        (values, factor): (&[f64], f64),
        of_loose: impl Fn(&LooseNode) -> Vector,
    ) -> io::Result<()> {
        writeln!(out, "\n {head}\n")?;
        for &label in print.set.labels.iter() {
            let vector = match self.nodes.get(label) {
                Some(node) => self.vector(node as usize, values).map(|v| factor * v),
                None => self.of_loose(label, &of_loose),
            };
            // A row in local axes is marked with L, as in CalculiX.
            let own = self.model.scene.requests.axes.get(&label);
            match own.filter(|_| !print.is_global) {
                Some(axes) => {
                    let vector = axes.map(|axis| dot(axis, vector));
                    writeln!(out, "{label:10}{} L", row(&vector))?;
                }
                None => writeln!(out, "{label:10}{}", row(&vector))?,
            }
        }
        Ok(())
    }

    fn total_force(&self, print: &Print, fields: &Fields) -> Vector {
        let labels = print.set.labels.iter();
        labels.fold([0.0; 3], |sum, &label| match self.nodes.get(label) {
            Some(node) => {
                let force = self.vector(node as usize, &fields.force);
                along(sum, self.of_forces, force)
            }
            None => {
                let force = self.of_loose(label, |loose| self.force_of(loose, fields));
                along(sum, 1.0, force)
            }
        })
    }

    /// Writes gap and pressure of the pairs that press.
    fn of_contact(&self, out: &mut impl Write, state: &State, time: f64) -> io::Result<()> {
        let (time, slaves) = (fortran(time), &self.slaves);
        for (what, normal) in [
            ("relative contact displacement", "normal"),
            ("contact stress", "press"),
        ] {
            writeln!(
                out,
                "\n {what} (slave node,{normal},tang1,tang2) for all contact elements and time \
                 {time}\n"
            )?;
            for of_pair in state.pairs.iter().filter(|pair| pair.pressure > 0.0) {
                let Some(node) = slaves.node(of_pair) else {
                    continue;
                };
                let label = self.model.mesh.node_label(node);
                let value = match normal {
                    "normal" => slaves.gap(of_pair),
                    _ => of_pair.pressure,
                };
                writeln!(out, "{label:10}{}", row(&[value, 0.0, 0.0]))?;
            }
        }
        Ok(())
    }

    fn volumes(&self, out: &mut impl Write, print: &Print, of_set: &str) -> io::Result<()> {
        let mut total = 0.0;
        let volumes: Vec<(u64, f64)> = (self.elements(print))
            .map(|(label, e)| (label, self.volume(e)))
            .collect();
        if print.totals != Totals::Only {
            writeln!(out, "\n volume (element, volume) {of_set}\n")?;
        }
        for (label, volume) in volumes {
            total += volume;
            if print.totals != Totals::Only {
                writeln!(out, "{label:10}{}", row(&[volume]))?;
            }
        }
        if print.totals != Totals::No {
            writeln!(out, "\n total volume {of_set}\n\n{:6}{}", "", row(&[total]))?;
        }
        Ok(())
    }

    /// Returns the volume of an element: in the plane over the thickness, in an axisymmetric model
    /// over the slice of 2 degrees that CalculiX computes.
    fn volume(&self, element: usize) -> f64 {
        let (mesh, space) = (&self.model.mesh, self.model.kind);
        let nodes = mesh.nodes(element).iter();
        let nodes: Vec<_> = nodes.map(|&node| mesh.point(node as usize)).collect();
        let kind = (mesh.shapes[element], mesh.integration_of(element));
        let points = volume_points(space, kind, &nodes);
        let volume: f64 = points.map(|point| point.weight).sum();
        match space {
            Space::Axisymmetric => SLICE * volume,
            _ => volume * self.model.scene.requests.thickness.unwrap_or(1.0),
        }
    }

    /// Writes values at the integration points of elements.
    fn of_elements(
        &self,
        out: &mut impl Write,
        (print, item): (&Print, ResultItem),
        fields: &Fields,
        of_set: &str,
    ) -> io::Result<()> {
        let mesh = &self.model.mesh;
        let c = 2 * mesh.dimension;
        let points = fields.points.as_ref();
        let (head, values, size, of_shear) = match (item, points) {
            (ResultItem::TotalStrain, Some(points)) => (
                "strains (elem, integ.pnt.,exx,eyy,ezz,exy,exz,eyz) ",
                &points.strain,
                c,
                0.5,
            ),
            (ResultItem::PlasticStrain, Some(points)) => (
                "equivalent plastic strain (elem, integ.pnt.,pe)",
                &points.plastic_strain,
                1,
                1.0,
            ),
            (ResultItem::Stress, _) => (
                "stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) ",
                points.map_or(&fields.stress, |points| &points.stress),
                c,
                1.0,
            ),
            _ => return Ok(()),
        };
        writeln!(out, "\n {head}{of_set}\n")?;
        for (label, e) in self.elements(print) {
            let mut line = |number: usize, of: &[f64]| {
                let at = |k: usize| of.get(k).copied().unwrap_or(0.0);
                // The components here are in the order xx, yy, zz, xy, yz, zx; CalculiX has xz
                // before yz.
                let shear = [3, 5, 4].map(|k| of_shear * at(k));
                let all = [at(0), at(1), at(2), shear[0], shear[1], shear[2]];
                let shown = if size == 1 { &all[..1] } else { &all };
                writeln!(out, "{label:10}{number:4}{}", row(shown))
            };
            let Some(points) = points else {
                line(0, &values[size * e..size * (e + 1)])?;
                continue;
            };
            let own = points.of(e);
            let order = points::order(mesh.shapes[e], own.len());
            for (number, mean) in order.iter().enumerate() {
                let of_point = |g: &usize| &values[size * (own.start + g)..][..size];
                let at = |k: usize| mean.iter().map(|g| of_point(g)[k]).sum::<f64>();
                let of: Vec<f64> = (0..size).map(|k| at(k) / mean.len() as f64).collect();
                line(number + 1, &of)?;
            }
        }
        Ok(())
    }
}

pub(super) fn row(values: &[f64]) -> String {
    let each = values
        .iter()
        .map(|&value| format!(" {:>13}", scientific(value)));
    each.collect()
}

/// Formats a number with seven digits and an exponent of two digits, as C prints it.
fn scientific(value: f64) -> String {
    let text = format!("{value:.6E}");
    let Some((digits, exponent)) = text.split_once('E') else {
        return text;
    };
    match exponent.strip_prefix('-') {
        Some(exponent) => format!("{digits}E-{exponent:0>2}"),
        None => format!("{digits}E+{exponent:0>2}"),
    }
}

/// Formats a number with seven digits after a leading zero and an exponent of two digits, as
/// FORTRAN prints it.
pub(in crate::output) fn fortran(value: f64) -> String {
    let text = format!("{value:.6E}");
    let Some((digits, exponent)) = text.split_once('E') else {
        return text;
    };
    let exponent = match (exponent.parse::<i32>(), value == 0.0) {
        (Ok(exponent), false) => exponent + 1,
        _ => 0,
    };
    let sign = if exponent < 0 { '-' } else { '+' };
    let (minus, digits) = match digits.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", digits),
    };
    let digits = digits.replace('.', "");
    format!("{minus}0.{digits}E{sign}{:02}", exponent.abs())
}

#[cfg(test)]
mod tests {
    use super::{fortran, scientific};

    #[test]
    fn numbers_are_written_as_c_does() {
        for (value, text) in [
            (0.0, "0.000000E+00"),
            (-1.5e-7, "-1.500000E-07"),
            (2.0, "2.000000E+00"),
            (1e120, "1.000000E+120"),
        ] {
            assert_eq!(scientific(value), text);
        }
    }

    #[test]
    fn times_are_written_as_fortran_does() {
        for (value, text) in [
            (0.0, "0.0000000E+00"),
            (1.0, "0.1000000E+01"),
            (126.5, "0.1265000E+03"),
            (-0.0025, "-0.2500000E-02"),
        ] {
            assert_eq!(fortran(value), text);
        }
    }
}
