//! What the benchmarks measure of processes, their own and children.

// Each benchmark uses its share.
#![allow(dead_code)]

use std::process::Command;

pub type Failure = Box<dyn std::error::Error>;

/// The largest resident memory of this process, as Linux counts it.
pub fn peak_memory() -> Result<f64, Failure> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let kilobytes = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))
        .and_then(|rest| {
            rest.trim()
                .trim_end_matches("kB")
                .trim()
                .parse::<f64>()
                .ok()
        })
        .ok_or("/proc/self/status has no VmHWM")?;
    Ok(1024.0 * kilobytes)
}

/// Linux counts processor time in hundredths of a second.
pub const TICK: f64 = 0.01;

/// Processor time of this process in seconds, all threads together: what a busy machine does not
/// change.
pub fn processor_seconds() -> Result<f64, Failure> {
    user_and_system(11)
}

/// Processor time of all children that have been waited for.
pub fn children_seconds() -> Result<f64, Failure> {
    user_and_system(13)
}

/// Two neighbouring times of `/proc/self/stat`, the first after so many fields behind the name.
fn user_and_system(first: usize) -> Result<f64, Failure> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    // The name of the program, in parentheses, may contain spaces.
    let fields = stat.rsplit(')').next().unwrap_or_default();
    let ticks: Vec<f64> = fields
        .split_whitespace()
        .skip(first)
        .take(2)
        .flat_map(str::parse)
        .collect();
    Ok(ticks.iter().sum::<f64>() * TICK)
}

/// What this program prints when it is called with the arguments, in a process of its own;
/// `threads` for brinell's loops and for the BLAS.
pub fn child(arguments: &[&str], threads: Option<usize>) -> Result<String, Failure> {
    let mut command = Command::new(std::env::current_exe()?);
    command
        .args(arguments)
        .stderr(std::process::Stdio::inherit());
    if let Some(threads) = threads {
        for name in ["RAYON_NUM_THREADS", "OPENBLAS_NUM_THREADS"] {
            command.env(name, threads.to_string());
        }
    }
    let output = command.output()?;
    if !output.status.success() {
        return Err(format!("`{}` failed", arguments.join(" ")).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}
