//! Tables of results in the form in which `*NODE PRINT`, `*EL PRINT`, `*CONTACT PRINT` and
//! `*SECTION PRINT` of CalculiX write them into its `.dat` file.
//!
//! The time of a state is the time of the deck; for a scene it is the load factor. Forces are those
//! that act from outside: loads and reactions. In a plane model they act on the thickness of the
//! deck. In an axisymmetric model they act on the whole circle, but in the tables that a deck asks
//! for they act on a slice of 2 degrees, as those of CalculiX do. Values of elements are those at
//! the integration points, in the order of CalculiX ([`points`]); if a run did not keep them, the
//! means of elements are written as integration point 0. Shear strains are those of the tensor.

mod digits;
mod loose;
mod points;
mod section;
mod statistics;
mod tables;

use super::atomic;
use crate::error::Result;
use crate::model::Model;
use crate::results::Results;
use crate::scene::{NamedSet, Print, ResultItem, Totals};
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;
use tables::Tables;

pub(super) use digits::fortran;

/// Writes tables of all sets, for all states of a run that have fields, into a file: displacements
/// and forces of node sets and surfaces, stresses of bodies.
///
/// # Errors
/// [`crate::ErrorKind::Io`] naming the file.
pub fn write_dat(path: &Path, model: &Model, results: &Results) -> Result<()> {
    let prints = of_all_sets(model);
    atomic::replace_with(path, |out| {
        write(out, &Tables::new(model, false), results, |_| &prints)
    })
}

/// Writes the tables that the model's scene asks for ([`crate::scene::Moment::prints`]) into a
/// file, which is empty if it asks for none.
///
/// # Errors
/// [`crate::ErrorKind::Io`] naming the file.
pub fn write_prints(path: &Path, model: &Model, results: &Results) -> Result<()> {
    let moments = &model.scene.requests.moments;
    let prints = |state: usize| moments.get(state).map_or(&[][..], |moment| &moment.prints);
    atomic::replace_with(path, |out| {
        write(out, &Tables::new(model, true), results, prints)
    })
}

fn write<'p>(
    out: &mut impl Write,
    tables: &Tables,
    results: &Results,
    prints: impl Fn(usize) -> &'p [Print],
) -> io::Result<()> {
    for (index, state) in results.states.iter().enumerate() {
        let Some(fields) = &state.fields else {
            continue;
        };
        let moment = tables.model.scene.requests.moments.get(index);
        let time = moment.and_then(|moment| moment.time).unwrap_or(state.alpha);
        for print in prints(index) {
            tables.write(out, print, (state, fields), time)?;
        }
    }
    Ok(())
}

/// Requests for all sets and bodies of the mesh.
fn of_all_sets(model: &Model) -> Vec<Print> {
    let mesh = &model.mesh;
    let mut out = Vec::new();
    for name in mesh.set_names() {
        let nodes = mesh.set_nodes(name).unwrap_or_default();
        let labels = nodes.iter().map(|&node| mesh.node_label(node)).collect();
        let set = NamedSet {
            name: name.to_string(),
            labels: Arc::new(labels),
        };
        for (item, totals) in [
            (ResultItem::Displacement, Totals::No),
            (ResultItem::Force, Totals::Yes),
        ] {
            let set = set.clone();
            out.push(Print {
                item,
                set,
                totals,
                is_global: true,
                faces: Arc::default(),
            });
        }
    }
    for (body, name) in mesh.bodies.iter().enumerate() {
        let own = (0..mesh.n_elements()).filter(|&e| mesh.element_body[e] as usize == body);
        out.push(Print {
            item: ResultItem::Stress,
            set: NamedSet {
                name: name.clone(),
                labels: Arc::new(own.map(|e| mesh.element_label(e)).collect()),
            },
            totals: Totals::No,
            is_global: true,
            faces: Arc::default(),
        });
    }
    out
}
