//! Symmetric matrices as `cholmod_sparse`, lent to CHOLMOD without a copy.

use crate::linalg::sparse::Pattern;
use std::ffi::c_void;
use std::marker::PhantomData;
use suitesparse_sys as sys;

/// View of the upper triangle of a symmetric matrix in the form that CHOLMOD reads.
pub(super) struct SymmetricView<'a> {
    raw: sys::cholmod_sparse,
    // CHOLMOD reads the arrays of the pattern and the values through `raw`.
    _lent: PhantomData<&'a [f64]>,
}

impl<'a> SymmetricView<'a> {
    /// Makes a view of the pattern alone.
    pub(super) fn new(pattern: &'a Pattern) -> Self {
        Self::view(pattern, None)
    }

    /// Makes a view of the pattern with one value for each stored entry.
    pub(super) fn with_values(pattern: &'a Pattern, values: &'a [f64]) -> Self {
        Self::view(pattern, Some(values))
    }

    fn view(pattern: &'a Pattern, values: Option<&'a [f64]>) -> Self {
        let (columns, rows) = (pattern.columns(), pattern.rows());
        debug_assert!(values.is_none_or(|v| v.len() == rows.len()));
        let raw = sys::cholmod_sparse {
            nrow: pattern.n(),
            ncol: pattern.n(),
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
        SymmetricView {
            raw,
            _lent: PhantomData,
        }
    }

    /// Number of freedoms.
    pub(super) fn n(&self) -> usize {
        self.raw.nrow
    }

    /// Number of stored entries.
    pub(super) fn entries(&self) -> usize {
        self.raw.nzmax
    }

    /// Pointer to pass to CHOLMOD, which only reads the matrix: the functions called here take a
    /// `cholmod_sparse *` because their interface lacks `const`.
    pub(super) fn as_ptr(&self) -> *mut sys::cholmod_sparse {
        &raw const self.raw as *mut sys::cholmod_sparse
    }
}
