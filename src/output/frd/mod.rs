//! Results in the `.frd` format of CalculiX, as text: the mesh, and values at the nodes state by
//! state.
//!
//! [`crate::scene::Requests`] lists the states and values that are written. The mesh is written
//! with the numbers of the deck, in ascending order. Each state of a scene is a separate step whose
//! time is the load factor.
//!
//! | block | values at a node |
//! |---|---|
//! | `DISP` | displacements |
//! | `STRESS`, `TOSTRAIN`, `PE` | values extrapolated from the integration points of each element ([`crate::shape::NodalExtrapolation`]), averaged over the elements of the node |
//! | `FORC` | forces that act from outside: loads and reactions |
//! | `CONTACT` | at slave nodes gap (negative where surfaces overlap) and pressure, compressive positive |
//! | `ZZSTR` | stresses of the polynomials fitted around a node ([`crate::results::Fields::nodal_stress`]) |
//! | `ERROR` | jump of the stresses between the elements of the node, in percent of the largest von Mises stress; CalculiX defines this measure differently |
//!
//! Strains are those of the tensor: shear strains are half the engineering strains. The axes of an
//! axisymmetric model are r, z and the hoop direction.
//!
//! # Source
//! *CalculiX CrunchiX User's Manual* 2.20, chapter 9; *CalculiX GraphiX User's Manual* 2.20,
//! section 12 "Result Format".

mod blocks;
mod extrapolated;
mod header;
mod mesh;
mod text;

pub(super) use extrapolated::Extrapolated;

use super::atomic::{self, Staging};
use crate::error::Result;
use crate::labels::LabelIndex;
use crate::model::Model;
use crate::results::Results;
use crate::scene::{FileRequest, Moment};
use blocks::NodalValues;
use mesh::Numbered;
use std::io::{self, Write};
use std::path::Path;

/// The file in a result directory.
pub(super) const FIELDS_FILE: &str = "fields.frd";

/// Writes the `.frd` file of a result directory if the scene asks for results in it.
///
/// # Errors
/// `Io` naming the file.
pub(super) fn write_fields(staging: &Staging, model: &Model, results: &Results) -> Result<()> {
    if !model.scene.requests.has_file() {
        return Ok(());
    }
    staging.file(FIELDS_FILE, |out| write(out, model, results))
}

/// Writes the results that the model's scene asks for ([`crate::scene::Scene::requests`]) into a
/// `.frd` file, whole or not at all. States without fields are left out.
///
/// # Errors
/// [`crate::ErrorKind::Io`] naming the file.
pub fn write_frd(path: &Path, model: &Model, results: &Results) -> Result<()> {
    atomic::replace_with(path, |out| write(out, model, results))
}

/// Writes the content of a `.frd` file.
///
/// # Errors
/// Errors of the writer.
pub(super) fn write(out: &mut impl Write, model: &Model, results: &Results) -> io::Result<()> {
    let requests = &model.scene.requests;
    let numbered = Numbered::new(&model.mesh);
    let materials = header::materials(model);
    header::write(out, &model.scene, &materials)?;
    mesh::write(out, model, &numbered, &materials)?;
    let states = results.states.iter().zip(&requests.moments);
    let (mut n_moments, mut n_blocks) = (0, 0);
    for (state, moment) in states {
        let Some(fields) = state.fields.as_ref().filter(|_| !moment.file.is_empty()) else {
            continue;
        };
        n_moments += 1;
        let values = NodalValues::new(model, state, fields);
        for request in &moment.file {
            if let Some(of_nodes) = values.of(request) {
                n_blocks += 1;
                let rows = rows(request, &numbered, &model.mesh.node_labels);
                let head = [n_blocks, n_moments, rows.len()];
                block_head(out, head, (moment, moment.time.unwrap_or(state.alpha)))?;
                blocks::write(out, request.item, (&numbered, &rows), &of_nodes)?;
            }
        }
    }
    writeln!(out, " 9999")
}

/// Returns the indices of the nodes of a block, in the order of their numbers.
fn rows(request: &FileRequest, numbered: &Numbered, labels: &[u64]) -> Vec<usize> {
    let Some(set) = &request.nodes else {
        return numbered.nodes.clone();
    };
    let Ok(index) = LabelIndex::new(labels) else {
        return Vec::new();
    };
    let mut known: Vec<u64> = set.labels.to_vec();
    known.sort_unstable();
    let found = known.iter().filter_map(|&label| index.get(label));
    found.map(|node| node as usize).collect()
}

/// Writes the lines in front of a block: numbers of the block and of the moment, and how many nodes
/// the block has.
fn block_head(
    out: &mut impl Write,
    [block, number, n_nodes]: [usize; 3],
    (moment, time): (&Moment, f64),
) -> io::Result<()> {
    let (increment, step) = (moment.increment, moment.step);
    writeln!(out, "    1PSTEP{block:26}{increment:12}{step:12}{:10}", "")?;
    let (code, time) = (100 + number, text::time(time));
    writeln!(
        out,
        "  100CL{code:5}{time:>12}{n_nodes:12}{:20}{:2}{number:5}{:10}{:2}",
        "", 0, "", 1
    )
}
