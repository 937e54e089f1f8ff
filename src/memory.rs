//! Memory that this process may still take, and refusal of work that does not fit.

use crate::error::{Error, Result};
#[cfg(target_os = "linux")]
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Memory that this process may still take, in bytes: the smallest of what is free on the machine,
/// left by its control group, and left by its own limits (`ulimit -v`, `ulimit -d`). `None` if the
/// system does not report it.
pub fn available() -> Option<f64> {
    [of_machine(), limits()]
        .into_iter()
        .flatten()
        .reduce(f64::min)
}

/// Bytes that the machine and its control groups leave to all processes together.
pub(crate) fn of_machine() -> Option<f64> {
    [machine(), group()].into_iter().flatten().reduce(f64::min)
}

/// Number of processes that share a factorisation: the MPI ranks, once MPI has started.
static SHARED_BY: AtomicUsize = AtomicUsize::new(1);

/// Sets how many processes share a factorisation.
#[cfg(feature = "mumps")]
pub(crate) fn share_by(processes: usize) {
    SHARED_BY.store(processes, Ordering::Relaxed);
}

/// Number of processes that share a factorisation.
pub(crate) fn shared_by() -> usize {
    SHARED_BY.load(Ordering::Relaxed)
}

/// Most memory that this process has held so far, in bytes (Linux: `VmHWM`). `None` if the system
/// does not report it.
pub(crate) fn peak() -> Option<u64> {
    kibibytes("/proc/self/status", "VmHWM:").map(|bytes| bytes as u64)
}

/// Refuses work that needs more memory than is available, before it takes hours.
///
/// # Errors
/// `Analysis` with the memory needed and the memory available.
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

/// Value in bytes of the first line of a `/proc` file that starts with `key`; `None` if there is no
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

/// Bytes that the limits of the process leave of its address space and of its data.
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

/// Bytes that the control groups of the process leave, of version 2 or version 1.
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

/// Smallest number of bytes that a group or one of its parents leaves. File pages that were not
/// used recently count as free, since the system reclaims them.
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

    /// The inner group leaves more than the group around it.
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
