//! Models from arrays: nodes, elements, sets and surfaces.

use super::border::{exclusive, free, guarded, hand_out, shared, slice, text};
use super::options::brinell_options;
use super::results::brinell_results;
use super::run::{RunTask, brinell_callback, execute};
use crate::error::{Error, Result};
use crate::mesh::{Curve, Shape};
use crate::model::ModelBuilder;
use crate::space::Space;
use std::ffi::{c_char, c_void};

/// A model that is being put together from arrays.
pub struct brinell_model {
    pub(super) builder: ModelBuilder,
}

/// No strain out of the plane; forces per unit thickness.
pub const BRINELL_PLANE_STRAIN: i32 = 0;
/// No stress out of the plane; forces per unit thickness.
pub const BRINELL_PLANE_STRESS: i32 = 1;
/// Coordinates are (r, z); forces are totals over the full circle.
pub const BRINELL_AXISYMMETRIC: i32 = 2;
/// Three coordinates.
pub const BRINELL_SOLID: i32 = 3;

/// A triangle of three corners.
pub const BRINELL_SHAPE_TRI3: i32 = 0;
/// Three corners, then the mid-side nodes, the first between corners 0 and 1.
pub const BRINELL_SHAPE_TRI6: i32 = 1;
/// A quadrilateral of four corners.
pub const BRINELL_SHAPE_QUAD4: i32 = 2;
/// Four corners, then the mid-side nodes.
pub const BRINELL_SHAPE_QUAD8: i32 = 3;
/// Four corners: 0, 1, 2 counter-clockwise seen from 3.
pub const BRINELL_SHAPE_TET4: i32 = 4;
/// Four corners, then the middles of the edges 01, 12, 02, 03, 13, 23.
pub const BRINELL_SHAPE_TET10: i32 = 5;
/// Eight corners: the base counter-clockwise seen from the top, then the top.
pub const BRINELL_SHAPE_HEX8: i32 = 6;
/// Eight corners, then the middles of the edges of base, top, and between them.
pub const BRINELL_SHAPE_HEX20: i32 = 7;
/// Linear prism of six nodes.
pub const BRINELL_SHAPE_PRISM6: i32 = 8;
/// Quadratic prism of fifteen nodes.
pub const BRINELL_SHAPE_PRISM15: i32 = 9;

/// Returns one of several values by its number.
pub(super) fn one_of<T: Copy>(values: &[T], which: i32, what: &str) -> Result<T> {
    usize::try_from(which)
        .ok()
        .and_then(|which| values.get(which))
        .copied()
        .ok_or_else(|| Error::input(format!("there is no {what} {which}")))
}

/// Changes a model under construction. A refused call leaves the model unchanged.
///
/// # Safety
/// `model` is NULL or a living handle.
pub(super) unsafe fn change(
    model: *mut brinell_model,
    act: impl FnOnce(&mut brinell_model) -> Result<()>,
) -> i32 {
    // SAFETY: as vouched for by the caller.
    guarded(|| act(unsafe { exclusive(model, "the model") }?))
}

/// Creates an empty model of the given kind: BRINELL_PLANE_STRAIN, BRINELL_PLANE_STRESS,
/// BRINELL_AXISYMMETRIC or BRINELL_SOLID. `symmetry` is the number of copies of the model that make
/// up the whole: 1 if the whole is meshed, 2 for a half model, 4 for a quarter of a plane or solid
/// model, 8 for an eighth of a solid model. Loads and results are those of the whole.
///
/// # Safety
/// `out` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_new(
    kind: i32,
    symmetry: usize,
    out: *mut *mut brinell_model,
) -> i32 {
    guarded(|| {
        let kind = one_of(&Space::ALL, kind, "kind of model")?;
        kind.check_symmetry(symmetry)?;
        let mut builder = ModelBuilder::new(kind);
        builder.symmetry(symmetry);
        // SAFETY: as vouched for by the caller.
        unsafe { hand_out(out, brinell_model { builder }) }
    })
}

/// Frees a model.
///
/// # Safety
/// `model` is NULL or was handed out by this library and not freed before.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_free(model: *mut brinell_model) {
    // SAFETY: as vouched for by the caller.
    unsafe { free(model) }
}

/// Adds nodes with n x 2 coordinates (n x 3 in a solid), node by node. Nodes are numbered from 0 in
/// the order in which they were added.
///
/// # Safety
/// `model` is a living handle, `coordinates` has 2 n values (3 n in a solid).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_nodes(
    model: *mut brinell_model,
    coordinates: *const f64,
    n: usize,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let n = n.saturating_mul(m.builder.dimension());
            m.builder.nodes(slice(coordinates, n, "coordinates")?)?;
            Ok(())
        })
    }
}

/// Adds `n` elements of one shape (BRINELL_SHAPE_...) to a body. `nodes` holds the nodes of one
/// element after the other, each in the order of the shape.
///
/// # Safety
/// `model` is a living handle, `body` a text that ends with a zero byte, `nodes` has n values for
/// each node of the shape.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_elements(
    model: *mut brinell_model,
    body: *const c_char,
    shape: i32,
    nodes: *const i64,
    n: usize,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let shape = one_of(&Shape::ALL, shape, "shape")?;
            let n = n.saturating_mul(shape.n_nodes());
            let nodes = slice(nodes, n, "nodes of elements")?;
            m.builder.elements(shape, text(body, "the body")?, nodes)?;
            Ok(())
        })
    }
}

/// Adds a named set of nodes.
///
/// # Safety
/// `model` is a living handle, `name` a text that ends with a zero byte, `nodes` has n values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_node_set(
    model: *mut brinell_model,
    name: *const c_char,
    nodes: *const i64,
    n: usize,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let nodes = slice(nodes, n, "nodes")?;
            m.builder.node_set(text(name, "the name")?, nodes)?;
            Ok(())
        })
    }
}

/// Adds a named surface of n facets, each given by its element and its local number in the element.
/// In the plane, facet k lies between corners k and k + 1.
///
/// # Safety
/// `model` is a living handle, `name` a text that ends with a zero byte, `elements` and `facets`
/// have n values each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_surface(
    model: *mut brinell_model,
    name: *const c_char,
    elements: *const i64,
    facets: *const i64,
    n: usize,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let elements = slice(elements, n, "elements of the surface")?.iter();
            let facets = slice(facets, n, "facets of the surface")?.iter();
            let facets = elements.copied().zip(facets.copied());
            m.builder.surface(text(name, "the name")?, facets)?;
            Ok(())
        })
    }
}

/// Adds a named surface by its nodes, mid-side nodes included. The surface consists of all boundary
/// facets that have no other nodes than the given ones.
///
/// # Safety
/// `model` is a living handle, `name` a text that ends with a zero byte, `nodes` has n values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_surface_of_nodes(
    model: *mut brinell_model,
    name: *const c_char,
    nodes: *const i64,
    n: usize,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let nodes = slice(nodes, n, "nodes of the surface")?;
            m.builder.surface_of_nodes(text(name, "the name")?, nodes)?;
            Ok(())
        })
    }
}

/// States that a surface is a circle about (x, y): the body lies inside (`outward` 1) or outside of
/// it (0, a hole). Normals are then exact.
///
/// # Safety
/// `model` is a living handle, `surface` a text that ends with a zero byte.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_circle(
    model: *mut brinell_model,
    surface: *const c_char,
    x: f64,
    y: f64,
    radius: f64,
    outward: i32,
) -> i32 {
    // SAFETY: the caller vouches for every pointer.
    unsafe {
        change(model, |m| {
            let circle = Curve::Circle {
                center: [x, y],
                radius,
                outward: outward != 0,
            };
            m.builder.curve(text(surface, "the surface")?, circle)?;
            Ok(())
        })
    }
}

/// Runs the load program of a model; otherwise like brinell_run. The model may be changed and run
/// again.
///
/// # Safety
/// `model` is a living model, `options` is NULL or as long as its `size` says, `out` may be written
/// to; `callback` does not unwind.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brinell_model_run(
    model: *const brinell_model,
    options: *const brinell_options,
    callback: brinell_callback,
    user: *mut c_void,
    out: *mut *mut brinell_results,
) -> i32 {
    // SAFETY: as vouched for by the caller.
    unsafe {
        execute(
            || {
                let model = shared(model, "the model")?;
                Ok(RunTask::Model(Box::new(model.builder.clone().build()?)))
            },
            options,
            callback,
            user,
            out,
        )
    }
}
