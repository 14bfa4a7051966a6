//! Runs a program within limits of time and memory, and measures both.

use std::fs::{self, File};
use std::io;
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;

/// What a run may take. Beyond it the run is killed.
#[derive(Clone, Copy)]
pub struct Limits {
    /// Time of the processor, over all threads.
    pub processor: Duration,
    /// The longest time without progress: a run that hangs neither uses the processor nor waits for it. A
    /// busy machine does not lengthen it.
    pub idle: Duration,
    /// The longest time of all, for a hang in which a thread goes on with little, such as the display of
    /// progress.
    pub wall: Duration,
    /// Resident bytes.
    pub memory: u64,
}

/// A run that has ended.
pub struct EndedRun {
    pub status: ExitStatus,
    pub stdout: Vec<u8>,
    pub stderr: Vec<u8>,
    pub used: ResourceUse,
    /// The limit for which it was killed.
    pub over: Option<&'static str>,
}

/// What a run took.
#[derive(Clone, Copy, Default)]
pub struct ResourceUse {
    pub processor: Duration,
    pub wall: Duration,
    /// The peak of resident bytes; 0 where the system does not say.
    pub memory: u64,
}

/// The processes that run now. Each is a leader of nothing: the command starts no further ones.
static RUNNING: Mutex<Vec<u32>> = Mutex::new(Vec::new());

/// A process that is killed when this value is dropped, or when the soak itself is ended by Ctrl-C, SIGTERM
/// or SIGHUP.
pub struct OwnedChild(Child);

impl OwnedChild {
    /// Starts a process. Errors: it cannot be started.
    pub fn spawn(command: &mut Command) -> io::Result<Self> {
        let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        let child = command.spawn()?;
        running.push(child.id());
        Ok(Self(child))
    }
}

impl Deref for OwnedChild {
    type Target = Child;

    fn deref(&self) -> &Child {
        &self.0
    }
}

impl DerefMut for OwnedChild {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.0
    }
}

impl Drop for OwnedChild {
    fn drop(&mut self) {
        let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        let _may_have_ended = self.0.kill();
        let _is_no_zombie = self.0.wait();
        running.retain(|&id| id != self.0.id());
    }
}

/// From now on Ctrl-C, SIGTERM and SIGHUP kill what runs and remove `folder` before they end the soak.
/// Errors: the system refuses.
pub fn end_with_signals(folder: PathBuf) -> io::Result<()> {
    let mut signals = Signals::new([SIGHUP, SIGINT, SIGTERM])?;
    thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            // Held to the end of the process, so that nothing is started any more.
            let running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
            for pid in running.iter().filter_map(|&id| Pid::from_raw(i32::try_from(id).ok()?)) {
                let _may_have_ended = kill_process(pid, Signal::KILL);
            }
            let _may_not_exist = fs::remove_dir_all(&folder);
            let _the_process_has_ended = emulate_default_handler(signal);
        }
    });
    Ok(())
}

/// The longest time between two measurements.
const PAUSE: Duration = Duration::from_millis(4);

/// Runs a program to its end. Its standard streams are files in `folder`. `signal` is sent after its time.
/// Errors: the program cannot be started.
pub fn run(
    command: &mut Command,
    folder: &Path,
    stdin: &[u8],
    limits: Limits,
    signal: Option<(Signal, Duration)>,
) -> io::Result<EndedRun> {
    let [input, output, messages] = ["stdin", "stdout", "stderr"].map(|name| folder.join(name));
    fs::write(&input, stdin)?;
    command.stdin(File::open(&input)?).stdout(File::create(&output)?).stderr(File::create(&messages)?);
    let mut child = OwnedChild::spawn(command)?;
    let (status, used, over) = watch(&mut child, limits, signal)?;
    Ok(EndedRun { status, stdout: fs::read(&output)?, stderr: fs::read(&messages)?, used, over })
}

fn watch(
    child: &mut Child,
    limits: Limits,
    mut signal: Option<(Signal, Duration)>,
) -> io::Result<(ExitStatus, ResourceUse, Option<&'static str>)> {
    let start = Instant::now();
    let mut used = ResourceUse::default();
    let mut over = None;
    let mut last_progress = (Duration::ZERO, Duration::ZERO);
    let mut pause = Duration::from_micros(200);
    loop {
        measure(child.id(), &mut used);
        used.wall = start.elapsed();
        let scheduled = time_in_the_scheduler(child.id());
        if scheduled != last_progress.0 {
            last_progress = (scheduled, used.wall);
        }
        if let Some(status) = child.try_wait()? {
            return Ok((status, used, over));
        }
        if over.is_none() {
            over = used.exceeds(limits, used.wall - last_progress.1);
            if over.is_some() {
                child.kill()?;
            }
        }
        if let Some((kind, _)) = signal.take_if(|(_, time)| used.wall >= *time) {
            send(child, kind);
        }
        pause = (pause * 2).min(PAUSE);
        thread::sleep(signal.map_or(pause, |(_, time)| pause.min(time.saturating_sub(used.wall))));
    }
}

impl ResourceUse {
    fn exceeds(&self, limits: Limits, idle: Duration) -> Option<&'static str> {
        if self.memory > limits.memory {
            Some("memory")
        } else if self.processor > limits.processor {
            Some("time")
        } else if idle > limits.idle || self.wall > limits.wall {
            Some("a hang")
        } else {
            None
        }
    }
}

/// Sends a signal to a program that may have ended.
pub fn send(child: &Child, signal: Signal) {
    if let Some(pid) = i32::try_from(child.id()).ok().and_then(Pid::from_raw) {
        let _may_have_ended = kill_process(pid, signal);
    }
}

/// Updates what a running process has used so far, on systems with /proc.
pub fn measure(id: u32, used: &mut ResourceUse) {
    if let Ok(status) = fs::read_to_string(format!("/proc/{id}/status")) {
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB"));
        if let Some(kilobytes) = peak.and_then(|number| number.trim().parse::<u64>().ok()) {
            used.memory = used.memory.max(kilobytes << 10);
        }
    }
    if let Ok(line) = fs::read_to_string(format!("/proc/{id}/stat")) {
        used.processor = used.processor.max(processor_time(&line));
    }
}

/// The time for which the threads of a running process have used the processor or waited for it. Zero on
/// systems without /proc.
pub fn time_in_the_scheduler(id: u32) -> Duration {
    let Ok(threads) = fs::read_dir(format!("/proc/{id}/task")) else { return Duration::ZERO };
    let time_of = |thread: fs::DirEntry| {
        let line = fs::read_to_string(thread.path().join("schedstat")).ok()?;
        let nanoseconds = line.split_whitespace().take(2).filter_map(|field| field.parse::<u64>().ok()).sum();
        Some(Duration::from_nanos(nanoseconds))
    };
    threads.flatten().filter_map(time_of).sum()
}

/// The time of user and system in a line of /proc/ID/stat, whose unit is a hundredth of a second on every
/// Linux.
fn processor_time(line: &str) -> Duration {
    // The name of the program, in parentheses, may contain spaces.
    let fields = line.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: u64 = fields.skip(11).take(2).filter_map(|field| field.parse::<u64>().ok()).sum();
    Duration::from_millis(10 * ticks)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        processor: Duration::from_secs(5),
        idle: Duration::from_millis(300),
        wall: Duration::from_secs(600),
        memory: 1 << 30,
    };

    fn shell(line: &str, limits: Limits) -> EndedRun {
        let folder = tempfile::tempdir().expect("a folder");
        run(Command::new("sh").args(["-c", line]), folder.path(), b"in", limits, None).expect("a shell")
    }

    #[test]
    fn a_child_is_killed_where_it_is_dropped() {
        let child = OwnedChild::spawn(Command::new("sleep").arg("600")).expect("a process");
        let place = format!("/proc/{}", child.id());
        drop(child);
        assert!(!Path::new(&place).exists());
    }

    #[test]
    fn streams_and_status_are_those_of_the_program() {
        let ended = shell("cat; echo out >&2; exit 3", LIMITS);
        assert_eq!(
            (ended.status.code(), &ended.stdout[..], &ended.stderr[..]),
            (Some(3), &b"in"[..], &b"out\n"[..])
        );
        assert!(ended.over.is_none());
    }

    #[test]
    fn runs_over_a_limit_are_killed() {
        assert_eq!(shell("sleep 20", LIMITS).over, Some("a hang"));
        if cfg!(target_os = "linux") {
            let little = Limits { memory: 1, ..LIMITS };
            assert_eq!(shell("sleep 20", little).over, Some("memory"));
            // A loop makes progress, however many others want the processor.
            let short = Limits { processor: Duration::from_millis(600), ..LIMITS };
            assert_eq!(shell("while :; do :; done", short).over, Some("time"));
        }
    }

    #[test]
    fn the_time_of_a_process_is_read_behind_its_name() {
        let line = "7 (a b) c) S 1 2 3 4 5 6 7 8 9 10 150 50 0 0";
        assert_eq!(processor_time(line), Duration::from_secs(2));
    }
}
