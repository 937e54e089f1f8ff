//! A limit of time for each test: what never ends fails, and does not hang the suite.

use std::collections::BTreeMap;
use std::io::Read;
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::{Mutex, Once};
use std::time::{Duration, Instant};

/// The longest that a process of a test may take: ten times what the longest takes on a loaded
/// machine.
pub const PROCESS: Duration = Duration::from_secs(600);
/// The longest that a test may take.
const TEST: Duration = Duration::from_secs(2400);

/// Runs a process to its end, as [`Command::output`]; one that takes longer than [`PROCESS`] is
/// killed and fails the test.
#[track_caller]
pub fn output(command: &mut Command) -> Output {
    output_within(command, PROCESS)
}

/// As [`output`], with another limit.
#[track_caller]
pub fn output_within(command: &mut Command, limit: Duration) -> Output {
    let child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    finish_within(child, limit)
}

/// Waits for a process and what it writes to its pipes.
#[track_caller]
pub fn finish(child: Child) -> Output {
    finish_within(child, PROCESS)
}

#[track_caller]
fn finish_within(mut child: Child, limit: Duration) -> Output {
    let pipes = [
        child.stdout.take().map(read_all),
        child.stderr.take().map(read_all),
    ];
    let status = wait_within(&mut child, limit);
    let [stdout, stderr] = pipes.map(|p| p.map_or_else(Vec::new, |p| p.join().unwrap()));
    Output {
        status,
        stdout,
        stderr,
    }
}

/// Waits for a process; one that takes longer than [`PROCESS`] is killed and fails the test.
#[track_caller]
pub fn wait(child: &mut Child) -> ExitStatus {
    wait_within(child, PROCESS)
}

#[track_caller]
fn wait_within(child: &mut Child, limit: Duration) -> ExitStatus {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status;
        }
        if start.elapsed() > limit {
            child.kill().unwrap();
            child.wait().unwrap();
            panic!("the process took longer than {limit:?} and was killed");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn read_all(mut pipe: impl Read + Send + 'static) -> std::thread::JoinHandle<Vec<u8>> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        pipe.read_to_end(&mut bytes).unwrap();
        bytes
    })
}

/// Tests under way, by their threads, which have their names: what they are called and when they
/// came here first.
static TESTS: Mutex<BTreeMap<u64, (String, Instant)>> = Mutex::new(BTreeMap::new());

/// Ends the whole binary, as failed, if the test of this thread takes longer than [`TEST`]: a
/// computation in this process cannot be stopped from outside.
pub fn watch() {
    static WATCHDOG: Once = Once::new();
    WATCHDOG.call_once(|| {
        std::thread::spawn(|| {
            loop {
                std::thread::sleep(Duration::from_secs(5));
                if let Some(name) = overdue(TEST).first() {
                    eprintln!("test {name} took longer than {TEST:?}");
                    std::process::exit(101);
                }
            }
        });
    });
    thread_local! {
        static UNDER_WAY: UnderWay = UnderWay::start();
    }
    UNDER_WAY.with(|_| {});
}

/// The names of the tests that have taken longer than `limit`.
pub fn overdue(limit: Duration) -> Vec<String> {
    let tests = TESTS.lock().unwrap();
    let late = tests.values().filter(|(_, start)| start.elapsed() > limit);
    late.map(|(name, _)| name.clone()).collect()
}

/// The entry of a test, taken out when its thread ends.
struct UnderWay(u64);

impl UnderWay {
    fn start() -> Self {
        let mut tests = TESTS.lock().unwrap();
        let key = tests.last_key_value().map_or(0, |(last, _)| last + 1);
        let name = std::thread::current().name().unwrap_or("?").to_string();
        tests.insert(key, (name, Instant::now()));
        UnderWay(key)
    }
}

impl Drop for UnderWay {
    fn drop(&mut self) {
        TESTS.lock().unwrap().remove(&self.0);
    }
}
