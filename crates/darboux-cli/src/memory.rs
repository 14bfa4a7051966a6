//! The memory that this process may use, and how its jobs share it.
//!
//! On Linux the limits are those of the control groups (memory.max, or memory.limit_in_bytes of version 1)
//! and of addresses (`ulimit -v`). What is in use at the start is subtracted once, so that a file is refused
//! or not whatever else is processed at the same time.

use std::fs;
use std::path::Path;
use std::sync::{Condvar, Mutex, OnceLock, PoisonError};

/// The estimate of the memory for a file of a batch: the largest peaks measured (`normals`), per byte of a
/// model without compression.
const PER_BYTE: u64 = 10;

/// What processing an empty file takes, about.
const BASE: u64 = 16 << 20;

/// The bytes that the process may still use, by its limits; none without a limit. Measured at the first call.
pub fn of_process() -> Option<u64> {
    static BYTES: OnceLock<Option<u64>> = OnceLock::new();
    *BYTES.get_or_init(|| [left_of_addresses(), left_of_groups(Path::new("/"))].into_iter().flatten().min())
}

/// The bytes that the process may use and that the system can give without swapping; none where it does not
/// say.
#[cfg(feature = "bake")]
pub fn available() -> Option<u64> {
    let of_system = || {
        let info = fs::read_to_string("/proc/meminfo").ok()?;
        let line = info.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
        let kibibytes: u64 = line.trim().strip_suffix(" kB")?.trim().parse().ok()?;
        Some(kibibytes << 10)
    };
    [of_system(), of_process()].into_iter().flatten().min()
}

/// The limit on addresses without those in use.
fn left_of_addresses() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let used = status.lines().find_map(|line| line.strip_prefix("VmSize:"))?;
    let used: u64 = used.trim().strip_suffix(" kB")?.trim().parse().ok()?;
    Some(limit.saturating_sub(used << 10))
}

/// The least that a control group of this process, or one above it, has left. `root`: the root of the file
/// system.
fn left_of_groups(root: &Path) -> Option<u64> {
    let groups = fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let paths = groups.lines().filter_map(|line| {
        let mut parts = line.splitn(3, ':').skip(1);
        let (controllers, path) = (parts.next()?, parts.next()?);
        let is_of_memory = controllers.split(',').any(|name| name == "memory");
        (controllers.is_empty() || is_of_memory).then_some((is_of_memory, path))
    });
    let left = paths.flat_map(|(is_first_version, path)| {
        let (folder, names) = if is_first_version {
            ("sys/fs/cgroup/memory", ["memory.limit_in_bytes", "memory.usage_in_bytes"])
        } else {
            ("sys/fs/cgroup", ["memory.max", "memory.current"])
        };
        let top = root.join(folder);
        let group = top.join(path.trim_start_matches('/'));
        let groups: Vec<_> =
            group.ancestors().take_while(|group| group.starts_with(&top)).map(Path::to_owned).collect();
        groups.into_iter().filter_map(move |group| left_of_group(&group, names))
    });
    left.min()
}

/// What one group has left. Pages of files count as free, because the system drops them.
fn left_of_group(group: &Path, [limit, usage]: [&str; 2]) -> Option<u64> {
    let number = |name: &str| fs::read_to_string(group.join(name)).ok()?.trim().parse::<u64>().ok();
    // Version 1 says "no limit" by the largest whole number of pages.
    let limit = number(limit).filter(|&limit| limit < 1 << 60)?;
    let pages = fs::read_to_string(group.join("memory.stat")).unwrap_or_default();
    let file =
        |name: &str| pages.lines().find_map(|line| line.strip_prefix(name)?.trim().parse::<u64>().ok());
    let droppable = file("inactive_file ").unwrap_or(0).saturating_add(file("active_file ").unwrap_or(0));
    Some(limit.saturating_sub(number(usage)?.saturating_sub(droppable)))
}

/// Lets jobs begin while the estimates of those at work fit into the memory of the process; a larger one
/// works alone.
pub struct JobMemory {
    total: Option<u64>,
    used: Mutex<u64>,
    freed: Condvar,
}

/// The memory of a job until it is dropped.
pub struct Share<'a> {
    of: &'a JobMemory,
    bytes: u64,
}

impl JobMemory {
    /// The memory of this process.
    pub fn of_process() -> Self {
        Self::new(of_process())
    }

    fn new(total: Option<u64>) -> Self {
        Self { total, used: Mutex::new(0), freed: Condvar::new() }
    }

    /// Waits until a file of `size` bytes has its memory.
    pub fn take(&self, size: u64) -> Share<'_> {
        let Some(total) = self.total else { return Share { of: self, bytes: 0 } };
        let bytes = size.saturating_mul(PER_BYTE).saturating_add(BASE).min(total);
        let used = self.used.lock().unwrap_or_else(PoisonError::into_inner);
        let is_full = |used: &mut u64| *used > 0 && used.saturating_add(bytes) > total;
        *self.freed.wait_while(used, is_full).unwrap_or_else(PoisonError::into_inner) += bytes;
        Share { of: self, bytes }
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        *self.of.used.lock().unwrap_or_else(PoisonError::into_inner) -= self.bytes;
        self.of.freed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::thread;

    use super::*;

    /// A file system with these files.
    fn system(files: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().expect("a folder");
        for (name, content) in files {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("folders");
            fs::write(path, content).expect("a file");
        }
        root
    }

    #[test]
    fn the_least_of_all_groups_above_counts() {
        let second = system(&[
            ("proc/self/cgroup", "0::/pod/job\n"),
            ("sys/fs/cgroup/pod/memory.max", "1000\n"),
            ("sys/fs/cgroup/pod/memory.current", "700\n"),
            ("sys/fs/cgroup/pod/memory.stat", "anon 300\ninactive_file 300\nactive_file 100\n"),
            ("sys/fs/cgroup/pod/job/memory.max", "max\n"),
            ("sys/fs/cgroup/pod/job/memory.current", "10\n"),
        ]);
        assert_eq!(left_of_groups(second.path()), Some(700));
        let first = system(&[
            ("proc/self/cgroup", "7:cpu,cpuacct:/x\n4:memory:/job\n0::/\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "5\n"),
            ("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "5000\n"),
            ("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "4000\n"),
        ]);
        assert_eq!(left_of_groups(first.path()), Some(1000));
        assert_eq!(left_of_groups(system(&[("proc/self/cgroup", "0::/\n")]).path()), None);
        assert_eq!(left_of_groups(system(&[]).path()), None);
    }

    #[test]
    fn jobs_wait_for_memory_and_a_large_one_works_alone() {
        let memory = JobMemory::new(Some(3 * BASE));
        let (at_work, most) = (AtomicU64::new(0), AtomicU64::new(0));
        thread::scope(|scope| {
            for size in [0, 0, 0, 0, u64::MAX, 0, 0, BASE] {
                let (memory, at_work, most) = (&memory, &at_work, &most);
                scope.spawn(move || {
                    let share = memory.take(size);
                    let now = at_work.fetch_add(share.bytes, Ordering::SeqCst) + share.bytes;
                    most.fetch_max(now, Ordering::SeqCst);
                    at_work.fetch_sub(share.bytes, Ordering::SeqCst);
                });
            }
        });
        assert_eq!(most.load(Ordering::SeqCst), 3 * BASE);
        assert_eq!(*memory.used.lock().unwrap(), 0);
    }
}
