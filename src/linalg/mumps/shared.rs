//! A symmetric matrix distributed over the ranks by columns, with the view of the first rank.

use super::rank::{Assemble, Columns, Evaluate, Host};
use super::task::{MadeOnRank, Near, Product, Task};
use super::world::{Traffic, World};
use crate::error::{Error, Result};
use crate::linalg::SymmetricCsc;
use crate::linalg::row_sums::RowSums;
use crate::results::Ranks;
use serde::de::DeserializeOwned;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Matrix entry as row, column and value.
pub(super) type Entry = (usize, usize, f64);

/// Part of a matrix for one rank: its freedoms, ascending, in the numbering of the whole matrix,
/// and the message from which the rank makes its columns ([`Assemble`]).
#[derive(Default)]
pub struct Part {
    /// Number in the whole matrix of each freedom of the part.
    pub numbers: Vec<u32>,
    /// Message for the rank that holds the part.
    pub message: Vec<u8>,
}

/// A symmetric matrix on all ranks, which drop it with the last copy of this handle.
#[derive(Debug, Clone)]
pub struct Shared(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    world: World,
    index: usize,
    /// Traffic between the ranks before this matrix was distributed.
    before: Traffic,
    /// Number of entries of each part.
    n_entries: Vec<usize>,
    /// Freedoms of each part, in the numbering of the whole.
    numbers: Vec<Vec<u32>>,
    diagonal: Vec<f64>,
    /// Whether each freedom is coupled with the previous freedom and with the same freedoms as the
    /// previous one.
    continued: Vec<bool>,
}

static NEXT: AtomicUsize = AtomicUsize::new(0);

impl Shared {
    /// Distributes a matrix of `n` freedoms; `part` returns the part of each rank.
    ///
    /// # Errors
    /// Errors of the ranks.
    pub fn new(
        n: usize,
        mut part: impl FnMut(usize) -> Result<Part>,
        assemble: Assemble,
    ) -> Result<Self> {
        let world = World::join()?;
        let before = world.traffic();
        let index = NEXT.fetch_add(1, Ordering::Relaxed);
        let (mut numbers, mut failed) = (vec![Vec::new(); world.size], None);
        let made: Vec<std::result::Result<MadeOnRank, String>> = world.ask(
            |rank| {
                let message = part(rank).map(|part| {
                    numbers[rank] = part.numbers;
                    part.message
                });
                let message = message.unwrap_or_else(|error| {
                    failed = Some(error);
                    Vec::new()
                });
                Task::Matrix(index, message)
            },
            &mut Host {
                assemble: Some(assemble),
                ..Host::default()
            },
        )?;
        let made: std::result::Result<Vec<MadeOnRank>, String> = made.into_iter().collect();
        let made = match (failed, made) {
            (None, Ok(made)) => made,
            (failed, made) => {
                let forget = |_| Task::ForgetMatrix(index);
                let _: Vec<()> = world.ask(forget, &mut Host::default())?;
                let told = made.err().unwrap_or_default();
                return Err(failed.unwrap_or_else(|| Error::analysis(told)));
            }
        };
        let is_damaged = made.iter().any(|made| made.is_damaged);
        let (mut diagonal, mut continued) = (vec![0.0; n], vec![false; n]);
        for (numbers, made) in numbers.iter().zip(&made) {
            for (local, &freedom) in numbers.iter().enumerate() {
                let freedom = freedom as usize;
                diagonal[freedom] += made.diagonal[local];
                let follows = local > 0 && numbers[local - 1] as usize + 1 == freedom;
                continued[freedom] |= follows && made.continued[local];
            }
        }
        let shared = Shared(Arc::new(Inner {
            world,
            index,
            before,
            n_entries: made.iter().map(|made| made.n_entries).collect(),
            numbers,
            diagonal,
            continued,
        }));
        match is_damaged {
            true => Err(Error::internal(
                "an entry of the matrix is not a finite number: check material and mesh",
            )),
            false => Ok(shared),
        }
    }

    /// Wraps a matrix that the first rank holds as a whole.
    ///
    /// # Errors
    /// `Analysis` if MPI does not start.
    pub fn here(matrix: &SymmetricCsc) -> Result<Self> {
        let n = matrix.cols();
        let parts = (matrix.proper_indptr(), matrix.indices(), matrix.data());
        let message = postcard::to_stdvec(&parts)
            .map_err(|cause| Error::internal("a matrix as bytes").because(cause))?;
        let mut all = Part {
            numbers: (0..n as u32).collect(),
            message,
        };
        let part = |rank| match rank {
            0 => Ok(std::mem::take(&mut all)),
            _ => Ok(Part::default()),
        };
        Self::new(n, part, |bytes| {
            let (pointers, rows, values): (Vec<i64>, Vec<i64>, Vec<f64>) =
                postcard::from_bytes(bytes)
                    .map_err(|cause| Error::internal("a matrix from bytes").because(cause))?;
            let n = pointers.len() - 1;
            Ok(Columns {
                matrix: SymmetricCsc::new_csc((n, n), pointers, rows, values),
                continued: vec![false; n],
            })
        })
    }

    /// Number of freedoms.
    pub fn n(&self) -> usize {
        self.0.diagonal.len()
    }

    /// Number of entries of the upper triangle.
    pub fn n_entries(&self) -> usize {
        self.0.n_entries.iter().sum()
    }

    /// Number of entries that each rank holds.
    pub(super) fn entries_by_rank(&self) -> &[usize] {
        &self.0.n_entries
    }

    /// Bytes of the columns that each rank holds.
    pub(super) fn bytes(&self) -> Vec<f64> {
        let bytes = |n: &usize| (size_of::<f64>() + size_of::<i64>()) as f64 * *n as f64;
        self.0.n_entries.iter().map(bytes).collect()
    }

    /// Work of the ranks since the matrix was distributed; `None` if a rank does not answer.
    pub(in crate::linalg) fn ranks(&self) -> Option<Ranks> {
        let world = self.0.world;
        let traffic = world.traffic();
        let peak_memory_bytes = self.ask(|_| Task::Memory, &mut Host::default());
        Some(Ranks {
            count: world.size,
            requests: traffic.requests - self.0.before.requests,
            bytes: traffic.bytes - self.0.before.bytes,
            peak_memory_bytes: peak_memory_bytes.ok()?,
        })
    }

    /// Number of ranks.
    pub fn n_ranks(&self) -> usize {
        self.0.world.size
    }

    /// Sends each rank its message and returns the answers that `evaluate` computes on the ranks.
    /// Ranks other than the first use the function passed to [`World::serve`] instead.
    ///
    /// # Errors
    /// Errors of the ranks.
    pub(in crate::linalg) fn evaluate(
        &self,
        mut message: impl FnMut(usize) -> Vec<u8>,
        evaluate: Evaluate,
    ) -> Result<Vec<Vec<u8>>> {
        let mut host = Host {
            evaluate: Some(evaluate),
            ..Host::default()
        };
        let task = |rank| Task::Evaluate(message(rank));
        let answers: Vec<std::result::Result<Vec<u8>, String>> = self.ask(task, &mut host)?;
        answers
            .into_iter()
            .map(|answer| answer.map_err(Error::analysis))
            .collect()
    }

    /// Diagonal of the matrix.
    pub fn diagonal(&self) -> &[f64] {
        &self.0.diagonal
    }

    /// Whether a freedom is coupled with the previous freedom and with the same freedoms as the
    /// previous one.
    pub(super) fn is_continued(&self, freedom: usize) -> bool {
        self.0.continued[freedom]
    }

    /// Row sums from one pass over the matrix, for a solution `u` with the load `f`.
    pub(in crate::linalg) fn rows(&self, f: &[f64], u: &[f64]) -> Result<RowSums> {
        let task = |rank| Task::Product(self.index(), self.own(rank, |freedom| u[freedom]));
        let products: Vec<Option<Product>> = self.ask(task, &mut Host::default())?;
        let mut rows = RowSums {
            residual: f.to_vec(),
            terms: vec![0.0; u.len()],
            stiffness: vec![0.0; u.len()],
        };
        for (numbers, product) in self.0.numbers.iter().zip(products) {
            let product = product.ok_or_else(forgotten)?;
            for (local, &freedom) in numbers.iter().enumerate() {
                let freedom = freedom as usize;
                rows.residual[freedom] -= product.values[local];
                rows.terms[freedom] += product.terms[local];
                rows.stiffness[freedom] += product.sizes[local];
            }
        }
        Ok(rows)
    }

    /// Entries whose row or column is a trailing freedom, and for each freedom whether the interior
    /// touches it.
    pub(super) fn near(&self, trailing: &[bool]) -> Result<(Vec<Entry>, Vec<bool>)> {
        let task = |rank| Task::Near(self.index(), self.own(rank, |freedom| trailing[freedom]));
        let parts: Vec<Option<Near>> = self.ask(task, &mut Host::default())?;
        let (mut entries, mut touched) = (Vec::new(), vec![false; self.n()]);
        for (numbers, part) in self.0.numbers.iter().zip(parts) {
            let part = part.ok_or_else(forgotten)?;
            let whole = |local: u32| numbers[local as usize] as usize;
            for ((&i, &j), &value) in part.rows.iter().zip(&part.columns).zip(&part.values) {
                entries.push((whole(i), whole(j), value));
            }
            for (&freedom, is_touched) in numbers.iter().zip(part.touched) {
                touched[freedom as usize] |= is_touched;
            }
        }
        Ok((entries, touched))
    }

    /// Graph of the interior and the freedoms that it touches, as pairs of vertices, given each
    /// freedom's vertex (-1 for none). [`Shared::near`] must have set the trailing freedoms.
    pub(super) fn graph(&self, vertex: &[i32]) -> Result<Vec<[i32; 2]>> {
        let task = |rank| Task::Graph(self.index(), self.own(rank, |freedom| vertex[freedom]));
        let parts: Vec<Vec<[i32; 2]>> = self.ask(task, &mut Host::default())?;
        Ok(parts.concat())
    }

    /// Values of a rank's own freedoms, in the rank's numbering.
    pub(super) fn own<V>(&self, rank: usize, of: impl Fn(usize) -> V) -> Vec<V> {
        let numbers = self.0.numbers[rank].iter();
        numbers.map(|&freedom| of(freedom as usize)).collect()
    }

    /// Number by which the ranks identify the matrix.
    pub(super) fn index(&self) -> usize {
        self.0.index
    }

    /// Sends each rank the request that `task` returns for its number, and collects the answers.
    /// `host` is used on the first rank only.
    pub(super) fn ask<T: DeserializeOwned>(
        &self,
        task: impl FnMut(usize) -> Task,
        host: &mut Host,
    ) -> Result<Vec<T>> {
        self.0.world.ask(task, host)
    }
}

fn forgotten() -> Error {
    Error::internal("a rank has forgotten its part of the matrix")
}

impl Drop for Inner {
    fn drop(&mut self) {
        let task = |_| Task::ForgetMatrix(self.index);
        // Ranks that have ended no longer hold the matrix.
        let _: Result<Vec<()>> = self.world.ask(task, &mut Host::default());
    }
}
