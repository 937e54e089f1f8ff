//! The ranks, and calls of MUMPS that all of them make together.

use super::meaning::meaning;
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::check;
use std::ffi::c_int;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

// Of shim.c.
unsafe extern "C" {
    fn brinell_mpi_begin(rank: *mut c_int, size: *mut c_int) -> c_int;
    fn brinell_mpi_serve();
    fn brinell_mpi_end(is_first: c_int);
    fn brinell_mumps_factor(
        n: c_int,
        n_entries: i64,
        rows: *mut c_int,
        columns: *mut c_int,
        values: *mut f64,
        place: *mut c_int,
        n_schur: c_int,
        schur_list: *mut c_int,
        schur: *mut f64,
        info: *mut c_int,
    ) -> c_int;
    fn brinell_mumps_solve(index: c_int, load: *mut f64, info: *mut c_int);
    fn brinell_mumps_free(index: c_int);
}

/// This process among the ranks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct World {
    /// Its number, from 0.
    pub rank: usize,
    /// How many there are.
    pub size: usize,
}

/// One call at a time: MPI was begun for threads that take turns.
static CALLS: Mutex<()> = Mutex::new(());

fn calls() -> MutexGuard<'static, ()> {
    CALLS.lock().unwrap_or_else(PoisonError::into_inner)
}

impl World {
    /// Joins the ranks that the process was started with, once; it is alone without `mpirun`.
    ///
    /// # Errors
    /// `Analysis` where MPI does not start.
    pub fn join() -> Result<World> {
        static WORLD: OnceLock<Option<World>> = OnceLock::new();
        let world = WORLD.get_or_init(|| {
            let (mut rank, mut size) = (0, 0);
            // SAFETY: writes two numbers; called once.
            let joined = unsafe { brinell_mpi_begin(&mut rank, &mut size) };
            (joined != 0).then_some(World {
                rank: rank as usize,
                size: size as usize,
            })
        });
        world.ok_or_else(|| Error::analysis("MPI does not start: see what it printed"))
    }

    /// Of a rank beyond the first: takes part in what the first one computes, until that ends.
    pub fn serve(self) {
        // SAFETY: MPI was begun, and the first rank does not call this.
        unsafe { brinell_mpi_serve() }
    }

    /// Ends the ranks' common work. No factor may be used afterwards.
    pub fn end(self) {
        let _turn = calls();
        // SAFETY: MPI was begun.
        unsafe { brinell_mpi_end(c_int::from(self.rank == 0)) }
    }
}

/// A factor that lies on all ranks.
#[derive(Debug)]
pub(super) struct Factor {
    index: c_int,
    n: usize,
}

/// Entries of one triangle of a symmetric matrix, numbered from 1, in an order: the place of each
/// variable, from 1.
pub(super) struct Triplets {
    pub(super) n: usize,
    pub(super) rows: Vec<c_int>,
    pub(super) columns: Vec<c_int>,
    pub(super) values: Vec<f64>,
    pub(super) place: Vec<c_int>,
}

/// That the order given is the one used (INFOG(7)).
const GIVEN: c_int = 1;

impl Factor {
    /// Factors, eliminating all but the variables `kept` (from 1), the last ones of the order;
    /// their Schur complement by rows, of which the lower triangle holds.
    ///
    /// # Errors
    /// What MUMPS says, in words.
    pub(super) fn new(matrix: &mut Triplets, kept: &mut [c_int]) -> Result<(Self, Vec<f64>)> {
        World::join()?;
        let m = kept.len();
        let mut schur: Vec<f64> = Vec::new();
        schur
            .try_reserve_exact(m * m)
            .map_err(|_| Error::analysis(out_of_memory(m)))?;
        schur.resize(m * m, 0.0);
        let mut info = [0; 3];
        let turn = calls();
        // SAFETY: all arrays have the lengths that are given beside them and outlive the call;
        // numbers of variables lie in 1..=n.
        let index = unsafe {
            brinell_mumps_factor(
                matrix.n as c_int,
                matrix.values.len() as i64,
                matrix.rows.as_mut_ptr(),
                matrix.columns.as_mut_ptr(),
                matrix.values.as_mut_ptr(),
                matrix.place.as_mut_ptr(),
                m as c_int,
                kept.as_mut_ptr(),
                schur.as_mut_ptr(),
                info.as_mut_ptr(),
            )
        };
        drop(turn);
        if index < 0 {
            return Err(Error::analysis(out_of_memory(m)));
        }
        let factor = Factor { index, n: matrix.n };
        require([info[0], info[1]])?;
        if info[2] != GIVEN {
            return Err(Error::internal(format!(
                "MUMPS did not take the order that it was given (INFOG(7) = {})",
                info[2]
            )));
        }
        Ok((factor, schur))
    }

    /// Solves with the eliminated variables; values of the kept ones are 0 afterwards.
    ///
    /// # Errors
    /// What MUMPS says, in words.
    pub(super) fn solve(&self, load: &mut [f64]) -> Result<()> {
        check::length("load", load.len(), self.n)?;
        let mut info = [0; 2];
        let turn = calls();
        // SAFETY: the factor is there until it is dropped, the load is as long as it is large.
        unsafe { brinell_mumps_solve(self.index, load.as_mut_ptr(), info.as_mut_ptr()) };
        drop(turn);
        require(info)
    }
}

impl Drop for Factor {
    fn drop(&mut self) {
        let _turn = calls();
        // SAFETY: the factor is freed once.
        unsafe { brinell_mumps_free(self.index) }
    }
}

fn out_of_memory(kept: usize) -> String {
    format!(
        "out of memory for the {kept} freedoms between zone and exterior: use a coarser mesh, a \
         smaller zone or a machine with more memory for the first rank"
    )
}

/// Negative numbers of INFOG(1) as errors.
fn require([code, more]: [c_int; 2]) -> Result<()> {
    if code >= 0 {
        return Ok(());
    }
    let kind = match code {
        -6 | -10 | -40 => ErrorKind::Unheld,
        _ => ErrorKind::Analysis,
    };
    Err(Error::new(kind, meaning(code, more)))
}
