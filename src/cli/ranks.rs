//! Programs of which `mpirun` starts several processes: the first computes, the others help MUMPS.

use super::common_arguments::CommonArguments;
use crate::error::{Error, Result};
#[cfg(feature = "mumps")]
use crate::linalg::Backend;

/// Environment variables of the launchers of OpenMPI and MPICH: the number of processes, and the
/// number of this one.
const LAUNCHERS: [[&str; 2]; 2] = [
    ["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"],
    ["PMI_SIZE", "PMI_RANK"],
];

/// The part of this process in a command.
pub(super) enum ProcessRole {
    /// The process does all the work, alone or with the help of others.
    First(RankGuard),
    /// The process has helped until the end and has nothing left to do.
    Helped,
}

/// The ranks of a run; the other ranks are released when the guard is dropped.
pub(super) struct RankGuard {
    #[cfg(feature = "mumps")]
    world: Option<crate::linalg::mumps::World>,
}

/// Takes part in a command that computes, with the solver of its arguments.
///
/// # Errors
/// `Input` for several processes that would each compute everything and write the same files, and
/// for ranks of another version.
#[cfg_attr(not(feature = "mumps"), allow(unused_variables))]
pub(super) fn join(common: Option<&CommonArguments>) -> Result<ProcessRole> {
    #[cfg(feature = "mumps")]
    if let Some(common) = common
        && Backend::Mumps == common.solver.into()
    {
        return with_mumps(common);
    }
    let number = |name: &str| std::env::var(name).ok()?.parse::<usize>().ok();
    let started = LAUNCHERS.map(|names| Some([number(names[0])?, number(names[1])?]));
    let several = started.into_iter().flatten().find(|[size, _]| *size > 1);
    let Some([size, rank]) = several else {
        return Ok(ProcessRole::First(RankGuard::alone()));
    };
    if rank > 0 {
        return Ok(ProcessRole::Helped);
    }
    Err(Error::input(format!(
        "{size} processes were started, and each would compute the same and write the same files: \
         share the work with --solver mumps (a build with the cargo feature `mumps`), or start one"
    )))
}

#[cfg(feature = "mumps")]
fn with_mumps(common: &CommonArguments) -> Result<ProcessRole> {
    let world = crate::linalg::mumps::World::join()?;
    if world.rank > 0 {
        super::interrupt::leave_to_first_rank();
        super::threads::start_threads(common.threads.map(usize::from))?;
        world.serve(crate::assembly::shares::columns, crate::analysis::evaluate);
        world.end();
        return Ok(ProcessRole::Helped);
    }
    world.meet().inspect_err(|_| world.end())?;
    Ok(ProcessRole::First(RankGuard { world: Some(world) }))
}

impl RankGuard {
    fn alone() -> Self {
        RankGuard {
            #[cfg(feature = "mumps")]
            world: None,
        }
    }
}

impl Drop for RankGuard {
    fn drop(&mut self) {
        #[cfg(feature = "mumps")]
        if let Some(world) = self.world {
            world.let_go();
            world.end();
        }
    }
}
