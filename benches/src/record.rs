//! Writes the results of a full run to `benches/record/<machine>/<date>.csv`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::available_parallelism;

use darboux::internal::paths::PathCounts;

use crate::engines::{MESHOPT, REFERENCE};
use crate::instructions::{Counts, MESHES};
use crate::judging;
use crate::real;
use crate::rounds::{Row, times_over};

const HEADER: &str = "date,commit,mesh,triangles,engine,version,threads,rounds,cpu_ns_min,cpu_ns_median,wall_ns_min,\
                      wall_ns_median,times_mikktspace_c,times_meshopt,extra_bytes,answer";

/// Writes the rows of a full run and returns the file's path.
pub fn timings(rows: &[Row], machine: Option<&str>) -> Result<PathBuf, String> {
    let (date, commit) = (date(), commit());
    let lines = rows.iter().map(|row| format!("{date},{commit},{}", line(rows, row)));
    write(machine, &format!("{date}.csv"), HEADER, lines)
}

/// Writes instruction counts and returns the file's path.
pub fn instructions(rows: &[Counts], machine: Option<&str>) -> Result<PathBuf, String> {
    let (date, commit) = (date(), commit());
    let lines = rows.iter().flat_map(|row| {
        let known = MESHES.iter().zip(&row.of_mesh).filter_map(|(mesh, count)| Some((mesh, (*count)?)));
        known
            .map(|(mesh, count)| format!("{date},{commit},{mesh},{},{count:.1}", row.engine))
            .collect::<Vec<_>>()
    });
    let header = "date,commit,mesh,engine,instructions_per_triangle";
    write(machine, &format!("{date}-instructions.csv"), header, lines)
}

/// Writes the times of checks and returns the file's path.
pub fn checks(rows: &[judging::Row], machine: Option<&str>) -> Result<PathBuf, String> {
    let (date, commit) = (date(), commit());
    let lines = rows.iter().map(|row| {
        let [times, ratios] = [&row.rounds, &row.ratios].map(|values| judging::spread(values));
        let shown = |values: [f64; 3]| values.map(|value| format!("{value:.3}")).join(",");
        let memory = row.memory.map_or(String::new(), |times| format!("{times:.3}"));
        format!(
            "{date},{commit},\"{}\",{},{},{},{},{memory}",
            row.subject,
            row.task,
            row.rounds.len(),
            shown(times),
            shown(ratios)
        )
    });
    let header = "date,commit,subject,task,rounds,cpu_ms_min,cpu_ms_median,cpu_ms_max,ratio_min,ratio_median,ratio_max,memory";
    write(machine, &format!("{date}-check.csv"), header, lines)
}

/// Writes the times of real primitives and returns the file's path.
pub fn real(rows: &[real::Row], machine: Option<&str>) -> Result<PathBuf, String> {
    let (date, commit) = (date(), commit());
    let lines = rows.iter().map(|row| {
        let times = row.times.map(|time| format!("{time:.2}")).join(",");
        let PathCounts { first_pass, groups, general } = row.paths;
        format!("{date},{commit},\"{}\",{},{times},{first_pass},{groups},{general}", row.name, row.triangles)
    });
    let header = "date,commit,primitive,triangles,mikktspace_c_ns,meshopt_ns,darboux_ns,darboux_kept_ns,first_pass,groups,general";
    write(machine, &format!("{date}-real.csv"), header, lines)
}

fn line(rows: &[Row], row: &Row) -> String {
    let known = |number: Option<f64>| number.map_or(String::new(), |number| format!("{number:.2}"));
    let spread = |times: Option<[f64; 2]>| [0, 1].map(|i| known(times.map(|times| times[i]))).join(",");
    format!(
        "{},{},{},{},{},{},{},{},{},{},{},\"{}\"",
        row.mesh,
        row.triangles,
        row.engine,
        row.version,
        row.threads,
        row.rounds.len(),
        spread(row.spread(|time| time.cpu)),
        spread(row.spread(|time| time.wall)),
        known(times_over(rows, REFERENCE, row)),
        known(times_over(rows, MESHOPT, row)),
        known(row.extra_bytes),
        row.answer.replace('"', "'"),
    )
}

fn write(
    machine: Option<&str>,
    file: &str,
    header: &str,
    lines: impl Iterator<Item = String>,
) -> Result<PathBuf, String> {
    let machine = machine.map_or_else(machine_name, str::to_owned);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("record").join(machine);
    let path = folder.join(file);
    let text: String = std::iter::once(header.to_owned()).chain(lines).map(|line| line + "\n").collect();
    let written = fs::create_dir_all(&folder).and_then(|()| fs::write(&path, text));
    written.map_err(|error| format!("{} cannot be written: {error}", path.display()))?;
    Ok(path)
}

/// The processor's model and the number of cores, as a file name.
fn machine_name() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let cores = available_parallelism().map_or(1, usize::from);
    slug(&format!("{} {cores} cores", model.map_or(std::env::consts::ARCH, |(_, model)| model)))
}

/// Lower-case letters and digits, a hyphen for each run of anything else.
fn slug(text: &str) -> String {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_ascii_lowercase()
}

/// Today, UTC, as year-month-day.
fn date() -> String {
    time::OffsetDateTime::now_utc().date().to_string()
}

/// The commit that is checked out, with a mark if files have changed since; "unknown" outside git.
fn commit() -> String {
    let mut command = Command::new("git");
    command.args(["describe", "--always", "--dirty", "--abbrev=10"]).current_dir(env!("CARGO_MANIFEST_DIR"));
    let output = command.output().ok().filter(|output| output.status.success());
    let text = output.and_then(|output| String::from_utf8(output.stdout).ok());
    text.map_or("unknown".into(), |text| text.trim().to_owned())
}

#[cfg(test)]
mod tests {
    #[test]
    fn names_become_file_names() {
        assert_eq!(super::slug("AMD EPYC(TM) 9B45 / 2 cores"), "amd-epyc-tm-9b45-2-cores");
    }
}
