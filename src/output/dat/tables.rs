//! Writing of a single table.

use super::digits::{fortran, row};
use super::loose::NodeVectors;
use super::points;
use crate::element::volume_points;
use crate::labels::LabelIndex;
use crate::model::Model;
use crate::output::slaves::Slaves;
use crate::results::{Fields, State};
use crate::scene::{Print, ResultItem, Totals};
use crate::space::{Space, Vector, along, dot};
use std::io::{self, Write};

/// Fraction of the circle that CalculiX computes of an axisymmetric model: 2 degrees.
const SLICE: f64 = 1.0 / 180.0;

/// Writer of the tables of a model.
pub(super) struct Tables<'a> {
    pub(super) model: &'a Model,
    pub(super) slaves: Slaves<'a>,
    pub(super) vectors: NodeVectors<'a>,
    pub(super) elements: LabelIndex,
    /// Factor from the forces of the model to those of the tables.
    pub(super) of_forces: f64,
}

impl<'a> Tables<'a> {
    /// Makes a writer. In an axisymmetric model, forces act on the slice of 2 degrees that CalculiX
    /// computes if `is_slice`, otherwise on the whole circle.
    pub(super) fn new(model: &'a Model, is_slice: bool) -> Self {
        let mesh = &model.mesh;
        let thickness = model.scene.requests.thickness.unwrap_or(1.0);
        let of_forces = match model.kind {
            Space::Axisymmetric if is_slice => SLICE,
            _ => thickness,
        };
        let elements = (0..mesh.n_elements()).map(|e| mesh.element_label(e));
        let elements: Vec<u64> = elements.collect();
        Tables {
            model,
            of_forces,
            slaves: Slaves::new(model),
            vectors: NodeVectors::new(model),
            elements: LabelIndex::new(&elements).unwrap_or_default(),
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
                self.of_nodes(out, print, &head, |label| {
                    self.vectors.displacement(label, fields, time)
                })
            }
            ResultItem::Force if fields.force.is_empty() => Ok(()),
            ResultItem::Force => {
                if print.totals != Totals::Only {
                    let head = format!("forces (fx,fy,fz) {of_set}");
                    self.of_nodes(out, print, &head, |label| self.force(label, fields))?;
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

    /// Returns label and index of each element of a set.
    fn elements(&self, print: &Print) -> impl Iterator<Item = (u64, usize)> {
        let labels = print.set.labels.iter();
        labels.filter_map(|&label| Some((label, self.elements.get(label)? as usize)))
    }

    fn of_nodes(
        &self,
        out: &mut impl Write,
        print: &Print,
        head: &str,
        of_node: impl Fn(u64) -> Vector,
    ) -> io::Result<()> {
        writeln!(out, "\n {head}\n")?;
        for &label in print.set.labels.iter() {
            let vector = of_node(label);
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

    /// Returns the force on a node, for the part of the model to which the tables refer.
    fn force(&self, label: u64, fields: &Fields) -> Vector {
        self.vectors.force(label, fields, self.of_forces)
    }

    fn total_force(&self, print: &Print, fields: &Fields) -> Vector {
        let labels = print.set.labels.iter();
        labels.fold([0.0; 3], |sum, &label| {
            along(sum, 1.0, self.force(label, fields))
        })
    }

    /// Writes gap and pressure of the pairs with a positive pressure.
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
