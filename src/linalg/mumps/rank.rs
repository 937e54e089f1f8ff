//! Data that a rank keeps, and the requests that it carries out.

use super::task::{Analysed, Factored, MadeOnRank, Near, Product, Task};
use crate::error::Result;
use crate::linalg::SymmetricCsc;
use crate::linalg::cholmod;
use crate::linalg::row_sums::RowSums;
use crate::memory;
use serde::Serialize;
use std::collections::BTreeMap;
use std::ffi::c_int;
use std::ptr::null_mut;
use std::sync::{Mutex, PoisonError};

/// Version of the program, which all ranks must have in common.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Function that makes a rank's columns from a message.
pub type Assemble = fn(&[u8]) -> Result<Columns>;

/// Some columns of the upper triangle of a symmetric matrix, with freedoms renumbered.
#[derive(Debug, Clone)]
pub struct Columns {
    /// Matrix of the rank; columns of other ranks are empty.
    pub matrix: SymmetricCsc,
    /// Whether each freedom is coupled with the previous freedom and with the same freedoms as the
    /// previous one.
    pub continued: Vec<bool>,
}

impl Default for Columns {
    fn default() -> Self {
        Columns {
            matrix: SymmetricCsc::new_csc((0, 0), vec![0], Vec::new(), Vec::new()),
            continued: Vec::new(),
        }
    }
}

/// Function that answers a request of the program.
pub type Evaluate = fn(&[u8]) -> Result<Vec<u8>>;

/// Functions and data of this rank that a request needs but does not contain.
#[derive(Default)]
pub(super) struct Host {
    /// Function that makes the rank's columns of a matrix.
    pub(super) assemble: Option<Assemble>,
    /// Function that answers requests of the program.
    pub(super) evaluate: Option<Evaluate>,
    // The remaining fields are passed to MUMPS by the first rank alone.
    /// Number of variables.
    pub(super) n: usize,
    /// Place of each variable in the ordering, from 1.
    pub(super) place: Vec<c_int>,
    /// Variables that stay, from 1, in the sequence of the ordering.
    pub(super) kept: Vec<c_int>,
    /// Schur complement on the variables that stay.
    pub(super) schur: Vec<f64>,
    /// Load on entry, solution on return.
    pub(super) load: Vec<f64>,
}

/// Matrix entries in the form that MUMPS takes.
#[derive(Default)]
struct RankEntries {
    rows: Vec<c_int>,
    columns: Vec<c_int>,
    values: Vec<f64>,
}

#[derive(Default)]
struct KeptOnRank {
    matrices: BTreeMap<usize, Columns>,
    /// Whether each freedom of each matrix is trailing.
    trailing: BTreeMap<usize, Vec<bool>>,
    /// Entries of factors that are not computed yet.
    entries: BTreeMap<usize, RankEntries>,
}

static KEPT: Mutex<KeptOnRank> = Mutex::new(KeptOnRank {
    matrices: BTreeMap::new(),
    trailing: BTreeMap::new(),
    entries: BTreeMap::new(),
});

// Functions defined in shim.c.
unsafe extern "C" {
    fn brinell_mumps_analyse(
        index: c_int,
        n: c_int,
        n_entries: i64,
        rows: *mut c_int,
        columns: *mut c_int,
        place: *mut c_int,
        n_schur: c_int,
        schur_list: *mut c_int,
        info: *mut c_int,
        work: *mut f64,
    );
    fn brinell_mumps_factor(index: c_int, values: *mut f64, schur: *mut f64, info: *mut c_int);
    fn brinell_mumps_solve(index: c_int, load: *mut f64, info: *mut c_int);
    fn brinell_mumps_free(index: c_int);
}

/// Carries out a request and returns the answer as bytes.
pub(super) fn perform(task: Task, host: &mut Host) -> Vec<u8> {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    match task {
        Task::Matrix(index, bytes) => {
            let columns = match host.assemble.filter(|_| !bytes.is_empty()) {
                Some(assemble) => assemble(&bytes),
                None => Ok(Columns::default()),
            };
            drop(bytes);
            answer(&match columns {
                Ok(columns) => Ok(kept.take(index, columns)),
                Err(error) => Err(error.to_string()),
            })
        }
        Task::ForgetMatrix(index) => {
            kept.matrices.remove(&index);
            kept.trailing.remove(&index);
            Vec::new()
        }
        Task::Product(index, u) => answer(&kept.matrices.get(&index).map(|c| c.product(&u))),
        Task::Near(index, trailing) => {
            let near = kept.matrices.get(&index).map(|c| c.near(&trailing));
            kept.trailing.insert(index, trailing);
            answer(&near)
        }
        Task::Graph(index, vertex) => {
            let mut pairs: Vec<[i32; 2]> = Vec::new();
            kept.each_interior(index, |i, j, _| {
                let ends = [vertex[i], vertex[j]];
                if ends[0] >= 0 && ends[1] >= 0 {
                    pairs.push(ends);
                }
            });
            answer(&pairs)
        }
        Task::Analyse(factor, index, variable) => {
            let left = left();
            let mut n = 0;
            kept.each_interior(index, |_, _, _| n += 1);
            let mut entries = RankEntries {
                rows: Vec::with_capacity(n),
                columns: Vec::with_capacity(n),
                values: Vec::with_capacity(n),
            };
            kept.each_interior(index, |i, j, value| {
                // MUMPS gets the lower triangle.
                entries.rows.push(variable[j]);
                entries.columns.push(variable[i]);
                entries.values.push(value);
            });
            let analysed = analyse(factor, &mut entries, host, left);
            kept.entries.insert(factor, entries);
            answer(&analysed)
        }
        Task::Factor(factor) => {
            let mut entries = kept.entries.remove(&factor).unwrap_or_default();
            answer(&compute(factor, &mut entries, host))
        }
        Task::Solve(factor) => {
            let mut state = [0; 2];
            // SAFETY: the factor exists until it is forgotten. On the first rank the load has a
            // value for each variable; on other ranks the load is not read.
            unsafe {
                brinell_mumps_solve(factor as c_int, host.load.as_mut_ptr(), state.as_mut_ptr());
            }
            answer(&state)
        }
        Task::ForgetFactor(factor) => {
            kept.entries.remove(&factor);
            // SAFETY: the factor was created, and is forgotten only once.
            unsafe { brinell_mumps_free(factor as c_int) }
            Vec::new()
        }
        Task::Memory => answer(&memory::peak()),
        Task::Evaluate(bytes) => answer(&evaluated(host.evaluate, &bytes)),
    }
}

fn evaluated(evaluate: Option<Evaluate>, bytes: &[u8]) -> std::result::Result<Vec<u8>, String> {
    match evaluate {
        Some(evaluate) => evaluate(bytes).map_err(|error| error.to_string()),
        None => Err("this rank has no function that answers the request".into()),
    }
}

fn answer<T: Serialize>(value: &T) -> Vec<u8> {
    // Vectors and numbers can always be serialised.
    postcard::to_stdvec(value).unwrap_or_default()
}

/// Bytes that the limits of this process leave to this rank, and bytes that its machine leaves to
/// all ranks. The work buffer of the BLAS is allocated first, because calls from MUMPS would
/// request it endlessly if memory is short.
fn left() -> [Option<f64>; 2] {
    let _entered = cholmod::enter_blas().ok();
    [memory::limits(), memory::of_machine()]
}

fn analyse(
    factor: usize,
    entries: &mut RankEntries,
    host: &mut Host,
    [left_by_limits, left_by_machine]: [Option<f64>; 2],
) -> Analysed {
    let (mut info, mut work) = ([0; 5], [0.0; 2]);
    let n_entries = entries.values.len();
    // SAFETY: all arrays have the lengths that are given beside them and stay where they are until
    // the factor is computed or forgotten; numbers of variables lie in 1..=n.
    unsafe {
        brinell_mumps_analyse(
            factor as c_int,
            host.n as c_int,
            n_entries as i64,
            entries.rows.as_mut_ptr(),
            entries.columns.as_mut_ptr(),
            host.place.as_mut_ptr(),
            host.kept.len() as c_int,
            host.kept.as_mut_ptr(),
            info.as_mut_ptr(),
            work.as_mut_ptr(),
        );
    }
    Analysed {
        state: [info[0], info[1]],
        own_state: info[4],
        order: info[2],
        needed: 1e6 * f64::from(info[3]),
        left_by_limits,
        left_by_machine,
        machine: machine_name(),
        flops: work[0],
        nonzeros: work[1],
    }
}

fn compute(factor: usize, entries: &mut RankEntries, host: &mut Host) -> Factored {
    let mut info = [0; 4];
    let schur = match host.schur.is_empty() {
        true => null_mut(),
        false => host.schur.as_mut_ptr(),
    };
    // SAFETY: the entries are those that were analysed; the first rank has room for the matrix of
    // the variables that stay.
    unsafe {
        brinell_mumps_factor(
            factor as c_int,
            entries.values.as_mut_ptr(),
            schur,
            info.as_mut_ptr(),
        );
    }
    Factored {
        state: [info[0], info[1]],
        own_state: info[3],
        negative_pivots: info[2],
    }
}

/// Name of this machine; empty if the system has none.
fn machine_name() -> String {
    let name = std::fs::read_to_string("/proc/sys/kernel/hostname");
    name.unwrap_or_default().trim().to_string()
}

impl KeptOnRank {
    fn take(&mut self, index: usize, columns: Columns) -> MadeOnRank {
        let matrix = &columns.matrix;
        let own = |j: usize| matrix.get(j, j).copied().unwrap_or(0.0);
        let made = MadeOnRank {
            diagonal: (0..matrix.cols()).map(own).collect(),
            continued: columns.continued.clone(),
            n_entries: matrix.nnz(),
            is_damaged: matrix.data().iter().any(|value| !value.is_finite()),
        };
        self.matrices.insert(index, columns);
        made
    }

    /// Calls `visit` with the entries (row, column, value) of a matrix that have an interior end.
    fn each_interior(&self, index: usize, mut visit: impl FnMut(usize, usize, f64)) {
        let parts = (self.matrices.get(&index), self.trailing.get(&index));
        let (Some(columns), Some(trailing)) = parts else {
            return;
        };
        for (j, column) in columns.matrix.outer_iterator().enumerate() {
            for (i, &value) in column.iter() {
                if !(trailing[i] && trailing[j]) {
                    visit(i, j, value);
                }
            }
        }
    }
}

impl Columns {
    fn product(&self, u: &[f64]) -> Product {
        let rows = RowSums::new(&self.matrix, &vec![0.0; u.len()], u);
        Product {
            values: rows.residual.into_iter().map(|r| -r).collect(),
            terms: rows.terms,
            sizes: rows.stiffness,
        }
    }

    fn near(&self, trailing: &[bool]) -> Near {
        let mut near = Near {
            touched: vec![false; trailing.len()],
            ..Near::default()
        };
        for (j, column) in self.matrix.outer_iterator().enumerate() {
            for (i, &value) in column.iter().filter(|(i, _)| trailing[*i] || trailing[j]) {
                near.touched[i] |= !trailing[j];
                near.touched[j] |= !trailing[i];
                near.rows.push(i as u32);
                near.columns.push(j as u32);
                near.values.push(value);
            }
        }
        near
    }
}
