//! What this process may still use by its limits: the control groups (memory.max, or memory.limit_in_bytes of
//! version 1) and the addresses (`ulimit -v`) of Linux.

use std::fs;
use std::path::Path;

/// The bytes that this process may still use, by its limits; none without a limit, and on other systems than
/// Linux. What is in use now is subtracted.
pub fn memory_of_process() -> Option<u64> {
    [left_of_addresses(), left_of_groups(Path::new("/"))].into_iter().flatten().min()
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

#[cfg(test)]
mod tests {
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
}
