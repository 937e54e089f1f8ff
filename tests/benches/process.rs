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

/// Processor time of this process in seconds, all threads together: what a busy machine does not change. Linux counts
/// it in hundredths.
pub fn processor_seconds() -> Result<f64, Failure> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    // The name of the program, in parentheses, may contain spaces.
    let fields = stat.rsplit(')').next().unwrap_or_default();
    let ticks: Vec<f64> = fields
        .split_whitespace()
        .skip(11)
        .take(2)
        .flat_map(str::parse)
        .collect();
    Ok(ticks.iter().sum::<f64>() / 100.0)
}

/// What this program prints when it is called with the arguments, in a process of its own; `threads` for brinell's loops and for the BLAS.
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
