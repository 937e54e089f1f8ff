//! Wrapper of `cholmod_factor`: analyse, factorise, read columns, solve.

use super::blas;
use super::common::Common;
use super::matrix::SymmetricView;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::NotDefinite;
use crate::linalg::sparse::{FactorColumns, LowerFactor, Supernodes, Triangular, prefer_large};
use std::ffi::c_void;
use std::ptr::{NonNull, null_mut};
use suitesparse_sys as sys;

/// Linear system that [`CholmodFactor::solve`] solves.
#[derive(Debug, Clone, Copy)]
pub(super) enum FactorSystem {
    /// The whole system `K x = b`.
    Whole,
    /// The system `L x = b`, with b and x in the order of the factor.
    Lower,
}

/// Factor `P K P' = L L'` with the workspace of its solves.
pub(super) struct CholmodFactor {
    common: Common,
    raw: NonNull<sys::cholmod_factor>,
    solution: *mut sys::cholmod_dense,
    workspace: [*mut sys::cholmod_dense; 2],
    nonzeros: f64,
    flops: f64,
}

// SAFETY: the factor and its workspace belong to this object alone; see `Common` for threads.
unsafe impl Send for CholmodFactor {}

/// Converts memory of CHOLMOD to a slice.
///
/// # Safety
/// `pointer` is null or points to `length` initialised values that outlive `'a`.
unsafe fn slice<'a, T>(pointer: *const c_void, length: usize) -> &'a [T] {
    if pointer.is_null() || length == 0 {
        return &[];
    }
    // SAFETY: by the caller's promise.
    unsafe { std::slice::from_raw_parts(pointer.cast(), length) }
}

impl CholmodFactor {
    /// Analyses a matrix symbolically, with the given ordering or with one that CHOLMOD finds.
    pub(super) fn analyze(
        mut common: Common,
        matrix: &SymmetricView,
        permutation: Option<&mut [i64]>,
    ) -> Result<Self> {
        let n = matrix.n();
        debug_assert!(permutation.as_ref().is_none_or(|p| p.len() == n));
        // SAFETY: `permutation` is absent or has length n and is only read.
        let raw = unsafe {
            sys::cholmod_l_analyze_p(
                matrix.as_ptr(),
                permutation.map_or(null_mut(), |p| p.as_mut_ptr()),
                null_mut(),
                0,
                common.as_mut(),
            )
        };
        let Some(raw) = NonNull::new(raw) else {
            common.check("symbolic analysis", n)?;
            return Err(Error::internal(format!(
                "CHOLMOD returned no analysis of {n} freedoms"
            )));
        };
        let (nonzeros, flops) = (common.get().lnz, common.get().fl);
        let factor = CholmodFactor {
            common,
            raw,
            solution: null_mut(),
            workspace: [null_mut(); 2],
            nonzeros,
            flops,
        };
        factor.common.check("symbolic analysis", n)?;
        Ok(factor)
    }

    /// Allocates the values of a supernodal factor, on large pages if available; otherwise the
    /// factorisation would allocate them.
    pub(super) fn allocate(&mut self) -> Result<()> {
        if !self.is_supernodal() {
            return Ok(());
        }
        // SAFETY: the factor is valid and symbolic; on success `x` holds `xsize` doubles. The
        // fields of the factor are read again after the check below.
        let raw = unsafe {
            sys::cholmod_l_change_factor(
                sys::CHOLMOD_REAL as i32,
                1,
                1,
                1,
                1,
                self.raw.as_ptr(),
                self.common.as_mut(),
            );
            self.raw.as_ref()
        };
        let (n, bytes) = (raw.n, raw.xsize as f64 * 8.0);
        self.common.check_asking("factorisation", n, bytes)?;
        let raw = self.raw();
        prefer_large(raw.x, raw.xsize * size_of::<f64>());
        Ok(())
    }

    /// Factors a matrix with the analysed pattern numerically.
    pub(super) fn factorize(&mut self, matrix: &SymmetricView) -> Result<()> {
        let n = self.n();
        // SAFETY: both objects are valid, and the matrix has values.
        unsafe {
            sys::cholmod_l_factorize(matrix.as_ptr(), self.raw.as_ptr(), self.common.as_mut());
        }
        let needed = self.bytes_within(matrix.entries());
        self.common.check_asking("factorisation", n, needed)?;
        // CHOLMOD reports success on an indefinite matrix and stops at the column `minor`.
        let minor = self.raw().minor;
        if self.common.get().status == sys::CHOLMOD_NOT_POSDEF as i32 || minor < n {
            let freedom = self.permutation().get(minor).copied().unwrap_or(0) as usize;
            return Err(NotDefinite { freedom }.into());
        }
        let raw = self.raw();
        if raw.xtype != sys::CHOLMOD_REAL as i32 || raw.is_ll == 0 {
            return Err(Error::new(
                ErrorKind::Internal,
                format!(
                    "CHOLMOD left a factor of kind {} (LL' {})",
                    raw.xtype, raw.is_ll
                ),
            ));
        }
        self.common.free_workspace();
        Ok(())
    }

    /// Number of freedoms.
    pub(super) fn n(&self) -> usize {
        self.raw().n
    }

    /// Whether `L` is stored as dense blocks of columns.
    pub(super) fn is_supernodal(&self) -> bool {
        self.raw().is_super != 0
    }

    /// Bytes of the numerical factor and of its computation: the largest update block and the
    /// permuted copy of a matrix with `entries` stored entries.
    fn bytes_within(&self, entries: usize) -> f64 {
        let raw = self.raw();
        let factor = if self.is_supernodal() {
            8.0 * (raw.xsize as f64 + raw.ssize as f64 + raw.maxcsize as f64)
        } else {
            16.0 * self.nonzeros
        };
        // Ordering, inverse ordering, counts, pointers, and CHOLMOD's own work of about 6 n.
        factor + 16.0 * entries as f64 + 80.0 * raw.n as f64
    }

    /// Solves for one right-hand side. The solution stays in the factor's workspace, which the
    /// first call allocates and all later calls use.
    pub(super) fn solve(&mut self, system: FactorSystem, load: &[f64]) -> Result<&[f64]> {
        let n = self.n();
        debug_assert_eq!(load.len(), n);
        let mut right = sys::cholmod_dense {
            nrow: n,
            ncol: 1,
            nzmax: n,
            d: n,
            x: load.as_ptr() as *mut c_void,
            z: null_mut(),
            xtype: sys::CHOLMOD_REAL as i32,
            dtype: sys::CHOLMOD_DOUBLE as i32,
        };
        let kind = match system {
            FactorSystem::Whole => sys::CHOLMOD_A,
            FactorSystem::Lower => sys::CHOLMOD_L,
        };
        let _entered = blas::enter()?;
        let [y, e] = &mut self.workspace;
        // SAFETY: `right` and `load` are only read; the handles are null or came from this very
        // function, which keeps or reallocates them.
        let solved = unsafe {
            sys::cholmod_l_solve2(
                kind as i32,
                self.raw.as_ptr(),
                &mut right,
                null_mut(),
                &mut self.solution,
                null_mut(),
                y,
                e,
                self.common.as_mut(),
            )
        };
        self.common.check("solve", n)?;
        if solved == 0 || self.solution.is_null() {
            return Err(Error::internal(format!(
                "CHOLMOD did not solve for {n} freedoms"
            )));
        }
        // SAFETY: on success `solution` is an n x 1 real matrix that lives until the next call.
        Ok(unsafe { slice((*self.solution).x, n) })
    }

    fn raw(&self) -> &sys::cholmod_factor {
        // SAFETY: not null, valid until dropped, and changed only through `&mut self`.
        unsafe { self.raw.as_ref() }
    }
}

impl LowerFactor for CholmodFactor {
    fn nonzeros(&self) -> f64 {
        self.nonzeros
    }

    fn flops(&self) -> f64 {
        self.flops
    }

    fn permutation(&self) -> &[i64] {
        let raw = self.raw();
        // SAFETY: `Perm` has length n from the analysis on.
        unsafe { slice(raw.Perm, raw.n) }
    }

    fn column_counts(&self) -> &[i64] {
        let raw = self.raw();
        // SAFETY: `ColCount` has length n from the analysis on.
        unsafe { slice(raw.ColCount, raw.n) }
    }

    fn columns(&self) -> FactorColumns<'_> {
        let raw = self.raw();
        // SAFETY: callers read columns only after the numerical factorisation. The arrays then have
        // the lengths that CHOLMOD documents for this kind of factor; a null pointer gives an empty
        // slice.
        unsafe {
            if self.is_supernodal() {
                FactorColumns::Supernodal(Supernodes {
                    starts: slice(raw.super_, raw.nsuper + 1),
                    row_starts: slice(raw.pi, raw.nsuper + 1),
                    value_starts: slice(raw.px, raw.nsuper + 1),
                    rows: slice(raw.s, raw.ssize),
                    values: slice(raw.x, raw.xsize),
                })
            } else {
                FactorColumns::Simplicial {
                    starts: slice(raw.p, raw.n),
                    counts: slice(raw.nz, raw.n),
                    rows: slice(raw.i, raw.nzmax),
                    values: slice(raw.x, raw.nzmax),
                }
            }
        }
    }

    fn bytes(&self, entries: usize) -> f64 {
        // `bytes_within` does not include the shifted copy of the values.
        self.bytes_within(entries) + 8.0 * entries as f64
    }

    fn solve_lower<'a>(&'a mut self, _: &Triangular, load: &'a mut [f64]) -> Result<&'a [f64]> {
        self.solve(FactorSystem::Lower, load)
    }
}

impl Drop for CholmodFactor {
    fn drop(&mut self) {
        let common: *mut sys::cholmod_common = self.common.as_mut();
        let mut raw = self.raw.as_ptr();
        // SAFETY: each object was allocated with this `common` and is freed once; null is allowed.
        unsafe {
            sys::cholmod_l_free_dense(&mut self.solution, common);
            for dense in &mut self.workspace {
                sys::cholmod_l_free_dense(dense, common);
            }
            sys::cholmod_l_free_factor(&mut raw, common);
        }
    }
}
