//! Interior and the freedoms that it touches, factored by MUMPS on all ranks.

use super::meaning::meaning;
use super::rank::Host;
use super::shared::{Entry, Shared};
use super::task::{Analysed, Factored, Task};
use crate::error::{Error, ErrorKind, Result};
use crate::linalg::{NotDefinite, check, cholmod};
use crate::memory;
use std::collections::BTreeMap;
use std::ffi::c_int;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Largest error of a known solution of size 1 that is accepted. The error is about the condition
/// number times the unit round-off. If not even one digit is right, the matrix counts as singular.
const LOST: f64 = 0.1;

/// Number of known solutions that are tested. A single solution may be right by chance although
/// nothing holds the body.
const KNOWN: usize = 3;

/// Value of INFOG(7) if the given ordering was used.
const GIVEN: i32 = 1;

/// Bytes of an entry in the form that MUMPS takes: two numbers and a value.
const TRIPLET: f64 = 16.0;

/// Variables, ordering and size of a factor that is not computed yet.
pub(super) struct SymbolicFactor {
    /// Name of the ordering for reports.
    pub(super) order_name: &'static str,
    variables: Variables,
    factor: FactorHandle,
    host: Host,
    by_rank: Vec<Analysed>,
    /// Approximate number of entries of the matrix that each rank passes to MUMPS.
    n_entries: Vec<usize>,
    /// Entries as interior freedom, trailing freedom and value.
    coupling: Vec<Entry>,
}

/// Variables of the factor: the interior freedoms and the freedoms that the interior touches,
/// numbered anew.
struct Variables {
    freedoms: Vec<usize>,
    /// Trailing number of each freedom that stays; `None` for interior freedoms.
    trailing: Vec<Option<usize>>,
}

/// A dense symmetric matrix on some of the trailing freedoms.
pub(super) struct Schur {
    /// Trailing numbers of these freedoms.
    pub(super) freedoms: Vec<usize>,
    /// Entries by rows, of which only the lower triangle is valid; empty if they are unknown.
    pub(super) values: Vec<f64>,
}

impl Schur {
    /// Calls `add` with the entries of the upper triangle.
    pub(super) fn each(&self, add: &mut dyn FnMut(Entry)) {
        let m = self.freedoms.len();
        for a in 0..m {
            for b in 0..=a {
                // Zeros are left out, so that unconnected bodies stay uncoupled.
                let value = self.values.get(a * m + b).copied().unwrap_or(1.0);
                if value != 0.0 {
                    let ends = [self.freedoms[a], self.freedoms[b]];
                    add((ends[0].min(ends[1]), ends[0].max(ends[1]), value));
                }
            }
        }
    }
}

/// Handle of a factor that is distributed over all ranks.
struct FactorHandle {
    index: usize,
    matrix: Shared,
}

/// An interior that MUMPS has factored.
pub(super) struct Exterior {
    factor: FactorHandle,
    n_variables: usize,
    /// Interior freedoms, with their numbers among the variables of the factor.
    pub(super) interior: Vec<(usize, usize)>,
    /// Entries between interior and trailing freedoms: variable, trailing freedom, value.
    pub(super) coupling: Vec<Entry>,
}

static FREE: Mutex<Vec<usize>> = Mutex::new(Vec::new());
static NEXT: AtomicUsize = AtomicUsize::new(0);

impl FactorHandle {
    /// Makes a handle with a number that no other factor has.
    fn of(matrix: &Shared) -> Self {
        let mut free = FREE.lock().unwrap_or_else(PoisonError::into_inner);
        let index = free.pop();
        FactorHandle {
            index: index.unwrap_or_else(|| NEXT.fetch_add(1, Ordering::Relaxed)),
            matrix: matrix.clone(),
        }
    }
}

impl Drop for FactorHandle {
    fn drop(&mut self) {
        let task = |_| Task::ForgetFactor(self.index);
        // Ranks that have ended no longer hold the factor.
        let forgotten: Result<Vec<()>> = self.matrix.ask(task, &mut Host::default());
        if forgotten.is_ok() {
            let mut free = FREE.lock().unwrap_or_else(PoisonError::into_inner);
            free.push(self.index);
        }
    }
}

impl Variables {
    fn new(trailing: &[Option<usize>], touched: &[bool]) -> Self {
        let is_variable = |freedom: &usize| trailing[*freedom].is_none() || touched[*freedom];
        let freedoms: Vec<usize> = (0..trailing.len()).filter(is_variable).collect();
        Variables {
            trailing: freedoms.iter().map(|&freedom| trailing[freedom]).collect(),
            freedoms,
        }
    }

    /// Number of each freedom among the variables, from 1; 0 for none.
    fn numbers(&self, n: usize) -> Vec<i32> {
        let mut numbers = vec![0; n];
        for (k, &freedom) in self.freedoms.iter().enumerate() {
            numbers[freedom] = k as i32 + 1;
        }
        numbers
    }

    /// Place of each variable, from 1, in an ordering that ends with the variables that stay.
    fn order(&self, matrix: &Shared) -> Result<(&'static str, Vec<c_int>)> {
        // Freedoms with the same neighbours form one vertex.
        let mut first = Vec::new();
        let mut vertex = vec![-1; matrix.n()];
        for (k, &freedom) in self.freedoms.iter().enumerate() {
            let stays = self.trailing[k].is_some();
            let goes_on = k > 0
                && self.freedoms[k - 1] + 1 == freedom
                && self.trailing[k - 1].is_some() == stays
                && matrix.is_continued(freedom);
            if !goes_on {
                vertex[freedom] = first.len() as i32;
                first.push(k);
            }
        }
        let graph = matrix.graph(&vertex)?;
        let stays: Vec<bool> = first.iter().map(|&k| self.trailing[k].is_some()).collect();
        first.push(self.freedoms.len());
        let (name, order) = cholmod::order(first, &stays, &graph)?;
        let mut place = vec![0; self.freedoms.len()];
        for (k, &variable) in order.iter().enumerate() {
            place[variable as usize] = k as c_int + 1;
        }
        Ok((name, place))
    }
}

impl SymbolicFactor {
    /// Orders the interior, which consists of the freedoms without a number in `trailing`. The
    /// trailing freedoms that the interior touches (`touched`) come last.
    pub(super) fn new(
        matrix: &Shared,
        trailing: &[Option<usize>],
        touched: &[bool],
        coupling: Vec<Entry>,
    ) -> Result<Self> {
        let variables = Variables::new(trailing, touched);
        let n_variables = variables.freedoms.len();
        if c_int::try_from(n_variables).is_err() {
            return Err(Error::input("more freedoms than MUMPS can number"));
        }
        let numbers = variables.numbers(trailing.len());
        memory::require(
            "ordering of the whole matrix on one rank",
            pattern_bytes(matrix.entries_by_rank()),
        )?;
        let (order_name, order) = variables.order(matrix)?;
        let mut kept: Vec<usize> = (0..n_variables)
            .filter(|&k| variables.trailing[k].is_some())
            .collect();
        // MUMPS requires the variables that stay to be listed in the sequence of the ordering.
        kept.sort_by_key(|&k| order[k]);
        let mut host = Host {
            n: n_variables,
            place: order,
            kept: kept.iter().map(|&k| k as c_int + 1).collect(),
            ..Host::default()
        };
        let factor = FactorHandle::of(matrix);
        let task = |rank| {
            let own = matrix.own(rank, |freedom| numbers[freedom]);
            Task::Analyse(factor.index, matrix.index(), own)
        };
        let by_rank: Vec<Analysed> = matrix.ask(task, &mut host)?;
        require(by_rank[0].state, by_rank.iter().map(|rank| rank.own_state))?;
        if by_rank[0].order != GIVEN {
            return Err(Error::internal(format!(
                "MUMPS did not take the order that it was given (INFOG(7) = {})",
                by_rank[0].order
            )));
        }
        Ok(SymbolicFactor {
            order_name,
            variables,
            factor,
            host,
            by_rank,
            n_entries: matrix.entries_by_rank().to_vec(),
            coupling,
        })
    }

    /// Floating point operations of the factorisation.
    pub(super) fn flops(&self) -> f64 {
        self.by_rank[0].flops
    }

    /// Number of entries of the factor.
    pub(super) fn nonzeros(&self) -> f64 {
        self.by_rank[0].nonzeros
    }

    /// Bytes that each rank needs in addition to its columns: its part of the factor and of the
    /// matrix as passed to MUMPS. The first rank, which uses `own` bytes itself, also needs the
    /// coupling, and either the Schur complement or, during the ordering, the pattern of the whole
    /// matrix.
    pub(super) fn bytes(&self, own: f64) -> Vec<f64> {
        let ranks = self.by_rank.iter().zip(&self.n_entries);
        let mut bytes: Vec<f64> = ranks
            .map(|(rank, n)| rank.needed + TRIPLET * *n as f64)
            .collect();
        let m = self.host.kept.len() as f64;
        let of_order = TRIPLET * self.n_entries[0] as f64 + pattern_bytes(&self.n_entries);
        bytes[0] = (bytes[0] + 8.0 * m * m).max(of_order) + self.bytes_of_coupling() + own;
        bytes
    }

    /// Bytes that the first rank keeps after the Schur complement has been used.
    pub(super) fn bytes_later(&self) -> f64 {
        self.by_rank[0].needed + self.bytes_of_coupling()
    }

    fn bytes_of_coupling(&self) -> f64 {
        (size_of::<Entry>() * self.coupling.len()) as f64
    }

    /// Schur complement without values, before it is computed.
    pub(super) fn unknown(&self) -> Schur {
        Schur {
            freedoms: self.kept(),
            values: Vec::new(),
        }
    }

    /// Trailing numbers of the variables that stay, in the sequence of the ordering.
    fn kept(&self) -> Vec<usize> {
        let trailing = |k: &c_int| self.variables.trailing[*k as usize - 1].unwrap_or(0);
        self.host.kept.iter().map(trailing).collect()
    }

    /// Checks that each rank, and all ranks of a machine together, have the memory that they need.
    pub(super) fn require_memory(&self, needed: &[f64]) -> Result<()> {
        require_memory(needed, &self.by_rank)
    }
}

/// Checks memory as [`SymbolicFactor::require_memory`] does, with the figures that the ranks
/// reported.
fn require_memory(needed: &[f64], by_rank: &[Analysed]) -> Result<()> {
    let figures = |needed: f64, left: f64| {
        format!(
            "needs about {:.0} MB and {:.0} MB are available there: use more ranks, a coarser \
             mesh, or more memory (ulimit -v)",
            (needed / 1e6).ceil(),
            (left / 1e6).floor()
        )
    };
    // For each machine: number of ranks, bytes needed, bytes available.
    let mut machines: BTreeMap<&str, (usize, f64, f64)> = BTreeMap::new();
    for (rank, (&needed, of_rank)) in needed.iter().zip(by_rank).enumerate() {
        if let Some(left) = of_rank.left_by_limits
            && needed > left
        {
            return Err(Error::analysis(format!(
                "out of memory: rank {rank} of {} {}",
                by_rank.len(),
                figures(needed, left)
            )));
        }
        let left = of_rank.left_by_machine.unwrap_or(f64::INFINITY);
        let machine = machines.entry(&of_rank.machine).or_insert((0, 0.0, left));
        *machine = (machine.0 + 1, machine.1 + needed, machine.2.min(left));
    }
    match machines.iter().find(|(_, (_, needed, left))| needed > left) {
        Some((name, (ranks, needed, left))) => Err(Error::analysis(format!(
            "out of memory: the group of {ranks} ranks on `{name}` {}",
            figures(*needed, *left)
        ))),
        None => Ok(()),
    }
}

/// Bytes of the pattern of the whole matrix that MUMPS gathers on the first rank for the symbolic
/// analysis: two numbers for each entry and derived data (measured: 10 to 14).
fn pattern_bytes(n_entries: &[usize]) -> f64 {
    14.0 * n_entries.iter().sum::<usize>() as f64
}

impl Exterior {
    /// Factors the interior and computes its Schur complement on the freedoms that it touches.
    ///
    /// # Errors
    /// Errors of MUMPS, in words; a rank without enough memory; an interior that is not held.
    pub(super) fn new(matrix: &Shared, mut analysis: SymbolicFactor) -> Result<(Self, Schur)> {
        let m = analysis.host.kept.len();
        let schur = &mut analysis.host.schur;
        schur.try_reserve_exact(m * m).map_err(|_| {
            Error::analysis(format!(
                "out of memory for the {m} freedoms between zone and exterior: use a coarser mesh, \
                 a smaller zone or a machine with more memory for the first rank"
            ))
        })?;
        schur.resize(m * m, 0.0);
        let freedoms = analysis.kept();
        let SymbolicFactor {
            variables,
            factor,
            mut host,
            coupling,
            ..
        } = analysis;
        let factored: Vec<Factored> = matrix.ask(|_| Task::Factor(factor.index), &mut host)?;
        require(
            factored[0].state,
            factored.iter().map(|rank| rank.own_state),
        )?;
        let schur = Schur {
            freedoms,
            values: std::mem::take(&mut host.schur),
        };
        let numbers = variables.numbers(matrix.n());
        let variable = |freedom: usize| numbers[freedom] as usize - 1;
        let ends = coupling.into_iter();
        let places = variables.freedoms.iter().zip(&variables.trailing);
        let interior = places
            .enumerate()
            .filter(|(_, (_, trailing))| trailing.is_none());
        let exterior = Exterior {
            factor,
            n_variables: variables.freedoms.len(),
            interior: interior.map(|(k, (&freedom, _))| (freedom, k)).collect(),
            coupling: ends.map(|(i, t, value)| (variable(i), t, value)).collect(),
        };
        exterior.require_held(matrix, factored[0].negative_pivots > 0)?;
        Ok((exterior, schur))
    }

    /// Checks that the interior is held. MUMPS does not stop at pivots that are negative or only
    /// round-off. It counts the negative pivots. A matrix that is singular up to round-off is
    /// detected because it does not reproduce known solutions; several are tested, since one alone
    /// may be reproduced by chance.
    ///
    /// # Errors
    /// [`NotDefinite`] with the freedom whose error is largest.
    fn require_held(&self, matrix: &Shared, is_indefinite: bool) -> Result<()> {
        let mut worst = (0, 0.0);
        for k in 1..=KNOWN {
            let known = |freedom: usize| 1.0 + (freedom / k % (4 + 3 * k)) as f64 / 8.0;
            let mut u = vec![0.0; matrix.n()];
            for &(freedom, _) in &self.interior {
                u[freedom] = known(freedom);
            }
            let mut load = matrix.rows(&vec![0.0; matrix.n()], &u)?.residual;
            load.iter_mut().for_each(|force| *force = -*force);
            let found = self.solve(&load, None)?;
            for &(freedom, k) in &self.interior {
                let off = (found[k] - known(freedom)).abs();
                if off > worst.1 || off.is_nan() {
                    worst = (freedom, if off.is_nan() { f64::INFINITY } else { off });
                }
            }
        }
        let (freedom, off) = worst;
        match is_indefinite || off > LOST {
            true => Err(NotDefinite { freedom }.into()),
            false => Ok(()),
        }
    }

    /// Computes `K_II^-1 (f_I - K_It u_t)`, where `f_I` is the interior part of `load` and `u_t` is
    /// `u_trailing` (zero if `None`). The result has a value for each variable.
    pub(super) fn solve(&self, load: &[f64], u_trailing: Option<&[f64]>) -> Result<Vec<f64>> {
        let mut of_variables = vec![0.0; self.n_variables];
        for &(freedom, k) in &self.interior {
            of_variables[k] = load[freedom];
        }
        if let Some(u) = u_trailing {
            for &(k, t, value) in &self.coupling {
                of_variables[k] -= value * u[t];
            }
        }
        let mut host = Host {
            load: of_variables,
            ..Host::default()
        };
        let index = self.factor.index;
        let states: Vec<[i32; 2]> = (self.factor.matrix).ask(|_| Task::Solve(index), &mut host)?;
        require(states[0], std::iter::empty())?;
        check::length("load", host.load.len(), self.n_variables)?;
        Ok(host.load)
    }
}

/// Converts negative values of INFOG(1) to errors, with the rank in that state.
fn require([code, more]: [i32; 2], mut own_states: impl Iterator<Item = i32>) -> Result<()> {
    if code >= 0 {
        return Ok(());
    }
    let kind = match code {
        -6 | -10 | -40 => ErrorKind::Unheld,
        _ => ErrorKind::Analysis,
    };
    let rank = own_states.position(|own| own == code);
    Err(Error::new(kind, meaning(code, more, rank)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rank(limits: Option<f64>, machine: f64, machine_name: &str) -> Analysed {
        Analysed {
            state: [0, 0],
            own_state: 0,
            order: GIVEN,
            needed: 0.0,
            left_by_limits: limits,
            left_by_machine: Some(machine),
            machine: machine_name.to_string(),
            flops: 0.0,
            nonzeros: 0.0,
        }
    }

    /// The memory that each rank needs is compared with the limits of that rank, and the sum over
    /// the ranks of a machine with the memory of that machine.
    #[test]
    fn memory_is_compared_rank_by_rank_and_machine_by_machine() {
        let ranks = [
            rank(None, 10e9, "a"),
            rank(Some(7e9), 10e9, "a"),
            rank(None, 6.5e9, "b"),
        ];
        assert!(require_memory(&[4e9, 5e9, 6e9], &ranks).is_ok());
        let of = |needed: [f64; 3]| require_memory(&needed, &ranks).unwrap_err().to_string();
        let text = of([6e9, 6e9, 6e9]);
        assert!(
            text.contains("the group of 2 ranks on `a` needs about"),
            "{text}"
        );
        assert!(text.contains("12000 MB and 10000 MB"), "{text}");
        let text = of([1e9, 8e9, 1e9]);
        assert!(
            text.contains("rank 1 of 3 needs about 8000 MB and 7000 MB"),
            "{text}"
        );
        let text = of([1e9, 1e9, 7e9]);
        assert!(text.contains("on `b`"), "{text}");
    }
}
