//! Models from arrays: the parts of a model other than its mesh, as scene text; and two parts that
//! are given as arrays: pairs of nodes and forces on nodes.

use super::border::{slice, text};
use super::model::{brinell_model, change};
use crate::error::{Error, Result};
use crate::model::NodePair;
use crate::scene::{Contact, History};
use crate::space::Vector;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::ffi::c_char;

/// Adds tables of a scene (TOML text): materials, bodies, rigid, contact, tie, equation, support,
/// load, program, analysis, units, title. Materials, bodies, rigid surfaces, contacts, ties,
/// equations, supports and loads are added to the existing ones; the other tables replace the
/// existing ones. A model without a target gets one target, at load factor 1.
///
/// # Safety
/// `model` is a living handle, `tables` ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_tables(
    model: *mut brinell_model,
    tables: *const c_char,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            m.builder.tables(text(tables, "the scene text")?)?;
            Ok(())
        })
    }
}

/// Lets two surfaces touch at n given pairs of nodes. `contact` has the keys of a `[[contact]]`
/// table (TOML text): `first`, `second` and any other keys. Nodes of the surfaces that are in no
/// pair do not touch.
///
/// `normals` holds the direction of each pair from the second body to the first, n x 2 components
/// (n x 3 in a solid); NULL for the outward normals of the second surface. `gaps` holds n gaps >=
/// 0; NULL for the contact's key `gap` or, without this key, for the geometric gaps.
///
/// # Safety
/// `model` is a living handle, `contact` ends with a zero byte, the arrays have the stated numbers
/// of values, or are NULL where NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_contact_pairs(
    model: *mut brinell_model,
    contact: *const c_char,
    n: usize,
    first_nodes: *const i64,
    second_nodes: *const i64,
    normals: *const f64,
    gaps: *const f64,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let contact: Contact = keys(text(contact, "the contact")?, "the contact")?;
            let first = slice(first_nodes, n, "first_nodes")?;
            let second = slice(second_nodes, n, "second_nodes")?;
            let unless_null = |is_null: bool| if is_null { 0 } else { n };
            let normals = m.vectors(normals, unless_null(normals.is_null()), "normals")?;
            let gaps = slice(gaps, unless_null(gaps.is_null()), "gaps")?;
            let node =
                |k: usize, nodes: &[i64]| m.builder.node(|| format!("pair {k}: one"), nodes[k]);
            let pairs = (0..n).map(|k| {
                Ok(NodePair {
                    first: node(k, first)?,
                    second: node(k, second)?,
                    normal: normals.get(k).copied(),
                    gap: gaps.get(k).copied(),
                })
            });
            let pairs = pairs.collect::<Result<Vec<_>>>()?;
            m.builder.contact_pairs(contact, &pairs)?;
            Ok(())
        })
    }
}

/// The keys of a load of nodal forces.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NodalLoad {
    name: String,
    #[serde(default)]
    history: History,
}

/// Adds a load with a force of its own on each of n nodes: n x 2 components (n x 3 in a solid). The
/// forces act on the meshed part of a symmetric model, not on the whole. `load` has keys of a
/// `[[load]]` table (TOML text): `name` and, unless the load is proportional, `history`.
///
/// # Safety
/// `model` is a living handle, `load` ends with a zero byte, the arrays have the stated numbers of
/// values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_nodal_load(
    model: *mut brinell_model,
    load: *const c_char,
    n: usize,
    nodes: *const i64,
    forces: *const f64,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let load: NodalLoad = keys(text(load, "the load")?, "the load")?;
            let nodes = slice(nodes, n, "nodes of the load")?;
            let forces = m.vectors(forces, n, "forces of the load")?;
            m.builder
                .nodal_load(&load.name, nodes, &forces, load.history)?;
            Ok(())
        })
    }
}

/// Parses one table of a scene.
fn keys<T: DeserializeOwned>(text: &str, what: &str) -> Result<T> {
    toml::from_str(text).map_err(|e| Error::input(format!("{what}: {e}")))
}

impl brinell_model {
    /// Returns `n` vectors, stored one after the other, of as many components as the model has
    /// coordinates.
    ///
    /// # Safety
    /// `values` is NULL or has `n` vectors.
    unsafe fn vectors(&self, values: *const f64, n: usize, what: &str) -> Result<Vec<Vector>> {
        let each = self.builder.dimension();
        // SAFETY: as vouched for by the caller.
        let values = unsafe { slice(values, n.saturating_mul(each), what) }?;
        let vector = |row: &[f64]| std::array::from_fn(|d| row.get(d).copied().unwrap_or(0.0));
        Ok(values.chunks_exact(each).map(vector).collect())
    }
}
