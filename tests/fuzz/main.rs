//! Damaged scenes, overrides, meshes and command lines, by the million: no panic, abort, hang or
//! unbounded memory.
//!
//! ```text
//! cargo test --release --test fuzz                          # 100,000 inputs
//! BRINELL_FUZZ=1000000 cargo test --release --test fuzz     # a million
//! BRINELL_FUZZ_KIND=Deck cargo test --release --test fuzz   # of one kind only
//! BRINELL_FUZZ_ONLY=4711 cargo test --test fuzz             # one, by its number
//! ```
//!
//! An input is a function of its number. What once broke the program is kept in `regressions`: the
//! file's ending says what it is.

mod mutation;
mod targets;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};
use targets::{Seeds, Target};

/// Inputs where nothing else is said.
const INPUTS: u64 = 100_000;
/// An input that takes this long hangs.
const HANG: Duration = Duration::from_secs(60);
/// Most memory, resident and reserved, in bytes: seeds are kilobytes, and so is all that may come
/// of them.
const RESIDENT: u64 = 1 << 30;
const RESERVED: u64 = 4 << 30;

fn number(variable: &str) -> Option<u64> {
    std::env::var(variable)
        .ok()
        .map(|text| text.parse().unwrap())
}

/// The kind of the input of a number: that of the environment, where it says one.
fn target(number: u64) -> Target {
    match std::env::var("BRINELL_FUZZ_KIND") {
        Ok(name) => {
            let named = |target: &Target| format!("{target:?}") == name;
            Target::ALL
                .into_iter()
                .find(named)
                .expect("a kind of input")
        }
        Err(_) => Target::of(number),
    }
}

/// A line of this process's memory, in bytes (Linux).
fn memory(key: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix(key))?;
    line.trim()
        .strip_suffix("kB")?
        .trim()
        .parse::<u64>()
        .ok()
        .map(|k| 1024 * k)
}

#[test]
fn damaged_inputs_are_taken_or_refused() {
    let seeds = Seeds::read();
    if let Some(only) = number("BRINELL_FUZZ_ONLY") {
        let target = target(only);
        let input = seeds.input(only, target);
        println!("{target:?}:\n{}", String::from_utf8_lossy(&input));
        println!("taken: {}", seeds.feed(target, &input));
        return;
    }
    let inputs = number("BRINELL_FUZZ").unwrap_or(INPUTS);
    let reserved = memory("VmPeak:").unwrap_or(0);
    let begin = Instant::now();
    let next = AtomicU64::new(0);
    let done = AtomicBool::new(false);
    let failed = Mutex::new(Vec::new());
    let taken: Vec<AtomicU64> = Target::ALL.iter().map(|_| AtomicU64::new(0)).collect();
    let fed: Vec<AtomicU64> = Target::ALL.iter().map(|_| AtomicU64::new(0)).collect();
    let workers = std::thread::available_parallelism().map_or(1, |n| n.get());
    let at_work: Vec<Mutex<(u64, Instant)>> =
        (0..workers).map(|_| Mutex::new((0, begin))).collect();
    std::thread::scope(|scope| {
        let working: Vec<_> = at_work
            .iter()
            .map(|place| {
                scope.spawn(|| {
                    loop {
                        let number = next.fetch_add(1, Ordering::Relaxed);
                        if number >= inputs || failed.lock().unwrap().len() > 20 {
                            break;
                        }
                        *place.lock().unwrap() = (number, Instant::now());
                        let target = target(number);
                        let outcome = catch_unwind(AssertUnwindSafe(|| {
                            let input = seeds.input(number, target);
                            seeds.feed(target, &input)
                        }));
                        fed[target as usize].fetch_add(1, Ordering::Relaxed);
                        match outcome {
                            Ok(was_taken) => {
                                taken[target as usize]
                                    .fetch_add(u64::from(was_taken), Ordering::Relaxed);
                            }
                            Err(_) => failed.lock().unwrap().push(number),
                        }
                    }
                })
            })
            .collect();
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(50));
                for place in &at_work {
                    let (number, since) = *place.lock().unwrap();
                    if since.elapsed() > HANG && next.load(Ordering::Relaxed) < inputs {
                        eprintln!("input {number} hangs: BRINELL_FUZZ_ONLY={number} shows it");
                        std::process::exit(101);
                    }
                }
            }
        });
        for worker in working {
            let _ = worker.join();
        }
        done.store(true, Ordering::Relaxed);
    });
    let failed = failed.into_inner().unwrap();
    assert!(
        failed.is_empty(),
        "inputs {failed:?}: BRINELL_FUZZ_ONLY=NUMBER shows one"
    );
    let mut counts = String::new();
    for target in Target::ALL {
        let [taken, fed] = [&taken, &fed].map(|c| c[target as usize].load(Ordering::Relaxed));
        counts.push_str(&format!("{target:?} {taken} of {fed} taken; "));
        // The damage is neither always fatal nor never.
        assert!(
            inputs < INPUTS || fed == 0 || (taken > 0 && taken < fed),
            "{target:?}: {taken} of {fed}"
        );
    }
    let [resident, peak] = ["VmHWM:", "VmPeak:"].map(|key| memory(key).unwrap_or(0));
    println!(
        "{inputs} inputs in {:.0} s, {} MB: {counts}",
        begin.elapsed().as_secs_f64(),
        resident >> 20
    );
    assert!(resident < RESIDENT, "{resident} bytes resident");
    assert!(
        peak - reserved.min(peak) < RESERVED,
        "{peak} bytes reserved"
    );
}

#[test]
fn what_once_broke_the_program_does_no_more() {
    let seeds = Seeds::read();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/regressions");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let input = std::fs::read(&path).unwrap();
        let targets: &[Target] = match path.extension().and_then(|e| e.to_str()) {
            Some("toml") => &[Target::Scene, Target::Run],
            Some("set") => &[Target::Override],
            Some("msh") => &[Target::Mesh],
            Some("inp") => &[Target::Deck],
            Some("line") => &[Target::CommandLine],
            other => panic!("{}: no ending {other:?}", path.display()),
        };
        for &target in targets {
            println!("{} as {target:?}", path.display());
            seeds.feed(target, &input);
        }
        seen += 1;
    }
    assert!(seen > 0);
}
