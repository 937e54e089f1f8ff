//! The MPI ranks, and requests of the first rank to all.

use super::rank::{self, Assemble, Evaluate, Host};
use super::task::Task;
use crate::error::{Error, Result};
use crate::memory;
use serde::de::DeserializeOwned;
use std::ffi::{c_char, c_int};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

// Functions defined in shim.c.
unsafe extern "C" {
    fn brinell_mpi_begin(rank: *mut c_int, size: *mut c_int) -> c_int;
    fn brinell_mpi_end();
    fn brinell_mpi_send(to: c_int, bytes: *const c_char, length: i64);
    fn brinell_mpi_await(from: c_int) -> i64;
    fn brinell_mpi_receive(from: c_int, bytes: *mut c_char, length: i64);
}

/// Place of this process among the ranks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct World {
    /// Number of this rank, counted from 0.
    pub rank: usize,
    /// Number of ranks.
    pub size: usize,
}

/// Requests of the first rank to the others so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Number of requests to all ranks.
    pub requests: u64,
    /// Bytes sent to the ranks and received from them, without the traffic of MUMPS itself.
    pub bytes: u64,
}

static REQUESTS: AtomicU64 = AtomicU64::new(0);
static BYTES: AtomicU64 = AtomicU64::new(0);
/// Whether the other ranks were released.
static ALONE: AtomicBool = AtomicBool::new(false);

/// Lock for one call at a time: MPI was started for threads that take turns.
static CALLS: Mutex<()> = Mutex::new(());

fn calls() -> MutexGuard<'static, ()> {
    CALLS.lock().unwrap_or_else(PoisonError::into_inner)
}

impl World {
    /// Joins the ranks with which this process was started; later calls return the same result.
    /// Without `mpirun` this process is the only rank.
    ///
    /// # Errors
    /// `Analysis` if MPI does not start.
    pub fn join() -> Result<World> {
        static WORLD: OnceLock<Option<World>> = OnceLock::new();
        let world = WORLD.get_or_init(|| {
            let _turn = calls();
            let (mut rank, mut size) = (0, 0);
            // SAFETY: writes two numbers; called once.
            let joined = unsafe { brinell_mpi_begin(&mut rank, &mut size) };
            memory::share_by((size as usize).max(1));
            (joined != 0).then_some(World {
                rank: rank as usize,
                size: size as usize,
            })
        });
        world.ok_or_else(|| Error::analysis("MPI does not start: see what it printed"))
    }

    /// Checks, on the first rank, that all other ranks run the same version of the program.
    ///
    /// # Errors
    /// `Input` if a rank has another version; the message names the rank, and all other ranks are
    /// released.
    pub fn meet(self) -> Result<()> {
        let versions: Vec<String> = {
            let _turn = calls();
            let others = 1..self.size;
            let version = |rank| String::from_utf8_lossy(&receive(rank)).into_owned();
            others.map(version).collect()
        };
        same_version(rank::VERSION, &versions).inspect_err(|_| self.let_go())
    }

    /// Serves on a rank other than the first: takes part in the computations of the first rank
    /// until that rank releases this one.
    pub fn serve(self, assemble: Assemble, evaluate: Evaluate) {
        let _turn = calls();
        send(0, rank::VERSION.as_bytes());
        loop {
            let bytes = receive(0);
            // An empty message means the end in all versions; an unreadable message comes from
            // another version of the program.
            if bytes.is_empty() {
                return;
            }
            let Ok(task) = postcard::from_bytes::<Task>(&bytes) else {
                continue;
            };
            drop(bytes);
            let mut host = Host {
                assemble: Some(assemble),
                evaluate: Some(evaluate),
                ..Host::default()
            };
            send(0, &rank::perform(task, &mut host));
        }
    }

    /// Releases the other ranks; called on the first rank.
    pub fn let_go(self) {
        let _turn = calls();
        ALONE.store(true, Ordering::Relaxed);
        for rank in 1..self.size {
            send(rank, &[]);
        }
    }

    /// Ends the common work of the ranks. No factor may be used afterwards.
    pub fn end(self) {
        let _turn = calls();
        // SAFETY: MPI was begun.
        unsafe { brinell_mpi_end() }
    }

    /// Traffic with the other ranks so far.
    pub fn traffic(self) -> Traffic {
        Traffic {
            requests: REQUESTS.load(Ordering::Relaxed),
            bytes: BYTES.load(Ordering::Relaxed),
        }
    }

    /// Sends a request to each rank, this one last, and collects the answers by rank. `host` is
    /// used on this rank, the first.
    pub(super) fn ask<T: DeserializeOwned>(
        self,
        mut task: impl FnMut(usize) -> Task,
        host: &mut Host,
    ) -> Result<Vec<T>> {
        let garbled = |cause: postcard::Error| {
            Error::internal("a message between ranks cannot be written or read").because(cause)
        };
        let _turn = calls();
        if self.rank > 0 {
            return Err(Error::input(format!(
                "this process is rank {} of {}: it has to serve the first one (World::serve)",
                self.rank, self.size
            )));
        }
        if ALONE.load(Ordering::Relaxed) {
            return Err(Error::internal("the other ranks were let go"));
        }
        let mut bytes = 0;
        for rank in 1..self.size {
            let message = postcard::to_stdvec(&task(rank)).map_err(garbled)?;
            bytes += message.len();
            send(rank, &message);
        }
        let mut answers = vec![rank::perform(task(0), host)];
        for rank in 1..self.size {
            let answer = receive(rank);
            bytes += answer.len();
            answers.push(answer);
        }
        if self.size > 1 {
            REQUESTS.fetch_add(1, Ordering::Relaxed);
            BYTES.fetch_add(bytes as u64, Ordering::Relaxed);
        }
        let read = |answer: Vec<u8>| postcard::from_bytes(&answer).map_err(garbled);
        answers.into_iter().map(read).collect()
    }
}

fn send(to: usize, bytes: &[u8]) {
    // SAFETY: `bytes` has the length that is passed.
    unsafe { brinell_mpi_send(to as c_int, bytes.as_ptr().cast(), bytes.len() as i64) }
}

fn receive(from: usize) -> Vec<u8> {
    // SAFETY: MPI was begun, and this thread has the turn.
    let length = unsafe { brinell_mpi_await(from as c_int) };
    let mut bytes = vec![0; length as usize];
    // SAFETY: `bytes` has room for the length that is passed.
    unsafe { brinell_mpi_receive(from as c_int, bytes.as_mut_ptr().cast(), length) };
    bytes
}

/// Checks that all other ranks have the version of the first.
fn same_version(own: &str, others: &[String]) -> Result<()> {
    match others.iter().enumerate().find(|(_, other)| *other != own) {
        Some((k, other)) => Err(Error::input(format!(
            "rank {} runs brinell {other}, the first one {own}: start the same program on all \
             machines",
            k + 1
        ))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::same_version;

    #[test]
    fn ranks_of_another_version_are_refused_by_number() {
        let ranks = ["1.0", "1.0", "1.1"].map(String::from);
        assert!(same_version("1.0", &ranks[..2]).is_ok());
        let message = same_version("1.0", &ranks).unwrap_err().to_string();
        assert!(message.contains("rank 3 runs brinell 1.1"), "{message}");
    }
}
