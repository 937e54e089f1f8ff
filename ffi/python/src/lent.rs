//! numpy's views of memory that brinell owns: nothing is copied, nothing may be written to, and the
//! memory lives as long as a view of it. The one home of `unsafe` here.
#![allow(unsafe_code)]

use numpy::ndarray::{ArrayView1, ArrayView2, ShapeBuilder};
use numpy::{Element, PyArray1, PyArray2};
use pyo3::prelude::*;
use std::sync::Arc;

/// What a view keeps alive.
#[pyclass(frozen, name = "Memory", module = "brinell")]
struct Owner {
    _kept: Box<dyn Send + Sync>,
}

/// A number as numpy sees it.
///
/// # Safety
/// `Seen` has the size and alignment, and takes every value of, the type.
pub unsafe trait Number {
    /// In numpy.
    type Seen: Element;
}
// SAFETY: the same types.
unsafe impl Number for f64 {
    type Seen = f64;
}
// SAFETY: the same types.
unsafe impl Number for u32 {
    type Seen = u32;
}
// SAFETY: the same types.
unsafe impl Number for u8 {
    type Seen = u8;
}
// SAFETY: every pattern of bits of a usize is one of an isize, which indexes numpy's arrays; sizes
// in memory stay below its maximum.
unsafe impl Number for usize {
    type Seen = isize;
}

/// A view of the values that `part` finds in what `owner` holds: as rows of `width` where it is
/// given.
pub fn lent<'py, O, T>(
    py: Python<'py>,
    owner: &Arc<O>,
    part: impl FnOnce(&O) -> &[T],
    width: Option<usize>,
) -> PyResult<Bound<'py, PyAny>>
where
    O: ?Sized + Send + Sync + 'static,
    T: Number,
{
    let values = part(owner);
    let first = values.as_ptr().cast::<T::Seen>();
    let n = values.len();
    let base = keep(py, owner)?;
    // SAFETY: the slice is borrowed from what `owner` points to. `base` holds another Arc of it,
    // never gives out access, and is the base of the array: the borrow may stand as long as the
    // array does. The array is read-only; `Number` vouches for the type.
    let array = unsafe {
        match width {
            None => {
                let view = ArrayView1::from_shape_ptr(n, first);
                PyArray1::borrow_from_array(&view, base).into_any()
            }
            Some(width) => {
                let view = ArrayView2::from_shape_ptr((n / width.max(1), width), first);
                PyArray2::borrow_from_array(&view, base).into_any()
            }
        }
    };
    read_only(array)
}

/// A view of one field of all rows that `rows` finds in what `owner` holds.
pub fn column<'py, O, R, T>(
    py: Python<'py>,
    owner: &Arc<O>,
    rows: impl FnOnce(&O) -> &[R],
    field: impl Fn(&R) -> &T,
) -> PyResult<Bound<'py, PyAny>>
where
    O: ?Sized + Send + Sync + 'static,
    T: Number,
{
    let rows = rows(owner);
    let (size, stride) = (size_of::<T>(), size_of::<R>());
    let begin = rows.as_ptr().addr();
    let offset = rows.first().map_or(0, |row| {
        std::ptr::from_ref(field(row)).addr().wrapping_sub(begin)
    });
    let is_inside = offset.checked_add(size).is_some_and(|end| end <= stride) || rows.is_empty();
    let is_a_column = is_inside
        && stride.is_multiple_of(size)
        && (0..).zip(rows).all(|(k, row): (usize, _)| {
            std::ptr::from_ref(field(row)).addr() == begin + k * stride + offset
        });
    assert!(is_a_column, "a field lies at the same place in every row");
    let base = keep(py, owner)?;
    // SAFETY: as in `lent`; what is checked above is that each row has a `T` at `offset`.
    let array = unsafe {
        let first = rows
            .as_ptr()
            .cast::<u8>()
            .wrapping_add(offset)
            .cast::<T::Seen>();
        let shape = rows.len().strides(stride / size);
        PyArray1::borrow_from_array(&ArrayView1::from_shape_ptr(shape, first), base)
    };
    read_only(array.into_any())
}

fn keep<'py, O>(py: Python<'py>, owner: &Arc<O>) -> PyResult<Bound<'py, PyAny>>
where
    O: ?Sized + Send + Sync + 'static,
{
    let kept = Box::new(Arc::clone(owner));
    Ok(Bound::new(py, Owner { _kept: kept })?.into_any())
}

/// Nobody writes to it.
pub fn read_only(array: Bound<'_, PyAny>) -> PyResult<Bound<'_, PyAny>> {
    array.getattr("flags")?.setattr("writeable", false)?;
    Ok(array)
}
