//! `cholmod_sparse`: symmetric matrices lent to CHOLMOD without a copy.

use crate::linalg::SymmetricCsc;
use std::borrow::Cow;
use std::ffi::c_void;
use suitesparse_sys as sys;

/// Upper triangle of a symmetric matrix that lives elsewhere, as CHOLMOD reads it.
pub(super) struct SymmetricView<'a> {
    raw: sys::cholmod_sparse,
    // CHOLMOD reads these through `raw`; they are held for their lifetime.
    columns: Cow<'a, [i64]>,
    rows: &'a [i64],
}

impl<'a> SymmetricView<'a> {
    /// The pattern of `matrix` alone.
    pub(super) fn pattern(matrix: &'a SymmetricCsc) -> Self {
        Self::new(matrix.proper_indptr(), matrix.indices(), None)
    }

    /// The pattern of `matrix` with `values` in place of its own, one for each stored entry.
    pub(super) fn with_values(matrix: &'a SymmetricCsc, values: &'a [f64]) -> Self {
        Self::new(matrix.proper_indptr(), matrix.indices(), Some(values))
    }

    /// A pattern by its column pointers (`n + 1`) and its row indices, ascending in each column.
    pub(super) fn from_parts(columns: &'a [i64], rows: &'a [i64]) -> Self {
        Self::new(Cow::Borrowed(columns), rows, None)
    }

    fn new(columns: Cow<'a, [i64]>, rows: &'a [i64], values: Option<&'a [f64]>) -> Self {
        debug_assert!(values.is_none_or(|v| v.len() == rows.len()));
        let n = columns.len().saturating_sub(1);
        let raw = sys::cholmod_sparse {
            nrow: n,
            ncol: n,
            nzmax: rows.len(),
            p: columns.as_ptr() as *mut c_void,
            i: rows.as_ptr() as *mut c_void,
            nz: std::ptr::null_mut(),
            x: values.map_or(std::ptr::null_mut(), |v| v.as_ptr() as *mut c_void),
            z: std::ptr::null_mut(),
            stype: 1,
            itype: sys::CHOLMOD_LONG as i32,
            xtype: match values {
                Some(_) => sys::CHOLMOD_REAL as i32,
                None => sys::CHOLMOD_PATTERN as i32,
            },
            dtype: sys::CHOLMOD_DOUBLE as i32,
            sorted: 1,
            packed: 1,
        };
        SymmetricView { raw, columns, rows }
    }

    /// Number of freedoms.
    pub(super) fn n(&self) -> usize {
        self.raw.nrow
    }

    /// Column pointers, `n + 1`.
    pub(super) fn columns(&self) -> &[i64] {
        &self.columns
    }

    /// Row indices, column after column.
    pub(super) fn rows(&self) -> &[i64] {
        self.rows
    }

    /// The object to hand to CHOLMOD, which only reads it: the functions called here take a
    /// `cholmod_sparse *` for want of `const` in their interface.
    pub(super) fn as_ptr(&self) -> *mut sys::cholmod_sparse {
        &raw const self.raw as *mut sys::cholmod_sparse
    }
}
