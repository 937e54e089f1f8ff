//! How much memory this process may still take, and the refusal of what does not fit.

use crate::error::{Error, Result};
#[cfg(target_os = "linux")]
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Memory that this process may still take, in bytes: the least of what the machine has free, what
/// its control group and its own limits (`ulimit -v`, `ulimit -d`) leave. `None` where the system
/// does not report it.
pub fn available() -> Option<f64> {
    [of_machine(), limits()]
        .into_iter()
        .flatten()
        .reduce(f64::min)
}

/// What the machine and its control groups leave to all processes together.
pub(crate) fn of_machine() -> Option<f64> {
    [machine(), group()].into_iter().flatten().reduce(f64::min)
}

/// How many processes share what is factored: the ranks of MPI, once it has begun.
static SHARED_BY: AtomicUsize = AtomicUsize::new(1);

/// States how many processes share what is factored.
#[cfg(feature = "mumps")]
pub(crate) fn share_by(processes: usize) {
    SHARED_BY.store(processes, Ordering::Relaxed);
}

/// How many processes share what is factored.
pub(crate) fn shared_by() -> usize {
    SHARED_BY.load(Ordering::Relaxed)
}

/// The most memory that this process has held so far, in bytes (Linux: `VmHWM`). `None` where the
/// system does not report it.
pub(crate) fn peak() -> Option<u64> {
    kibibytes("/proc/self/status", "VmHWM:").map(|bytes| bytes as u64)
}

/// Refuses what needs more memory than is available: better before hours of work than after them.
///
/// # Errors
/// `Analysis` with both numbers.
pub(crate) fn require(what: &str, bytes: f64) -> Result<()> {
    match available() {
        Some(free) if bytes > free => Err(Error::analysis(format!(
            "out of memory: the {what} needs about {:.0} MB and {:.0} MB are available: use a \
             coarser mesh, a smaller zone or a machine with more memory, or raise the limit of \
             this process (ulimit -v)",
            (bytes / 1e6).ceil(),
            (free / 1e6).floor()
        ))),
        _ => Ok(()),
    }
}

/// The first line of a file of `/proc` that starts with `key`, in bytes; `None` where there is no
/// such file.
fn kibibytes(file: &str, key: &str) -> Option<f64> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(key))?;
    let value: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024.0 * value)
}

#[cfg(target_os = "linux")]
fn machine() -> Option<f64> {
    kibibytes("/proc/meminfo", "MemAvailable:")
}

/// What the limits of the process leave of its address space and of its data.
#[cfg(target_os = "linux")]
pub(crate) fn limits() -> Option<f64> {
    use rustix::process::{Resource, getrlimit};
    let left = |resource, used| {
        let limit = getrlimit(resource).current?;
        let used = kibibytes("/proc/self/status", used)?;
        Some((limit as f64 - used).max(0.0))
    };
    let all = [
        left(Resource::As, "VmSize:"),
        left(Resource::Data, "VmData:"),
    ];
    all.into_iter().flatten().reduce(f64::min)
}

/// What the control groups around the process leave, those of version 2 and of version 1.
#[cfg(target_os = "linux")]
fn group() -> Option<f64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let of_line = |line: &str| {
        let mut fields = line.splitn(3, ':');
        let (_, controllers, path) = (fields.next()?, fields.next()?, fields.next()?);
        let path = path.trim_start_matches('/');
        match controllers {
            "" => left_in_groups("/sys/fs/cgroup", path, "memory.max", "memory.current"),
            list if list.split(',').any(|c| c == "memory") => left_in_groups(
                "/sys/fs/cgroup/memory",
                path,
                "memory.limit_in_bytes",
                "memory.usage_in_bytes",
            ),
            _ => None,
        }
    };
    groups.lines().filter_map(of_line).reduce(f64::min)
}

/// The least that a group or one of those around it leaves. Pages of files that were not used
/// lately are given back at need.
#[cfg(target_os = "linux")]
fn left_in_groups(root: &str, path: &str, limit: &str, usage: &str) -> Option<f64> {
    let number = |folder: &Path, file: &str| -> Option<f64> {
        let text = std::fs::read_to_string(folder.join(file)).ok()?;
        text.trim().parse().ok()
    };
    let left = |folder: &Path| {
        let (limit, usage) = (number(folder, limit)?, number(folder, usage)?);
        let statistics = std::fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
        let given_back = statistics
            .lines()
            .find_map(|line| line.strip_prefix("inactive_file "))
            .and_then(|value| value.trim().parse().ok())
            .unwrap_or(0.0);
        Some((limit - usage + given_back).max(0.0))
    };
    let root = Path::new(root);
    let folder = root.join(path);
    let around = folder
        .ancestors()
        .take_while(|folder| folder.starts_with(root));
    around.filter_map(left).reduce(f64::min)
}

#[cfg(not(target_os = "linux"))]
fn machine() -> Option<f64> {
    None
}

#[cfg(not(target_os = "linux"))]
pub(crate) fn limits() -> Option<f64> {
    None
}

#[cfg(not(target_os = "linux"))]
fn group() -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_refused_with_both_numbers() {
        let Some(free) = available() else { return };
        assert!(free > 0.0 && require("work", 1.0).is_ok());
        let error = require("factorisation of 7 freedoms", 1e18).unwrap_err();
        assert_eq!(error.kind(), crate::ErrorKind::Analysis);
        for part in [
            "factorisation of 7 freedoms",
            "1000000000000 MB",
            "are available",
        ] {
            assert!(error.message().contains(part), "{error}");
        }
    }

    /// The group inside leaves more than the one around it.
    #[cfg(target_os = "linux")]
    #[test]
    fn the_narrowest_control_group_counts() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("a/b");
        std::fs::create_dir_all(&inner).unwrap();
        for (place, limit, usage) in [("a", "3000", "1000"), ("a/b", "max", "900")] {
            std::fs::write(folder.path().join(place).join("memory.max"), limit).unwrap();
            std::fs::write(folder.path().join(place).join("memory.current"), usage).unwrap();
        }
        std::fs::write(
            folder.path().join("a/memory.stat"),
            "anon 5\ninactive_file 250\n",
        )
        .unwrap();
        let root = folder.path().to_str().unwrap();
        let left = left_in_groups(root, "a/b", "memory.max", "memory.current");
        assert_eq!(left, Some(2250.0));
    }
}
