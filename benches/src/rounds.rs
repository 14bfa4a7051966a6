//! Measures one mesh: checks every engine, then times all engines in turns, round by round.

use std::path::Path;

use darboux_tests::OwnedMesh;

use crate::check::verdict;
use crate::engines::{self, Engine, Method};
use crate::memory;
use crate::meshes::Named;
use crate::run::{Run, Tangent, Time};

/// The measurements of one engine on one mesh.
pub struct Row {
    /// The mesh's name.
    pub mesh: String,
    /// Its number of triangles.
    pub triangles: usize,
    /// The engine.
    pub engine: &'static str,
    /// Its version.
    pub version: &'static str,
    /// How many threads it used.
    pub threads: usize,
    /// Nanoseconds per triangle, one entry per round; empty if the engine failed.
    pub rounds: Vec<Time>,
    /// Bytes per triangle besides input and output, if they can be measured.
    pub extra_bytes: Option<f64>,
    /// The comparison with the reference, or the reason of the failure.
    pub answer: String,
}

impl Row {
    fn new(engine: &Engine, named: &Named) -> Self {
        Self {
            mesh: named.name.clone(),
            triangles: named.triangles(),
            engine: engine.name,
            version: engine.version,
            threads: engine.threads,
            rounds: Vec::new(),
            extra_bytes: None,
            answer: String::new(),
        }
    }

    /// Minimum and median of one of the times over the rounds; none where the engine failed.
    pub fn spread(&self, part: fn(&Time) -> f64) -> Option<[f64; 2]> {
        let mut times: Vec<f64> = self.rounds.iter().map(part).collect();
        times.sort_by(f64::total_cmp);
        Some([*times.first()?, times[times.len() / 2]])
    }

    /// Minimum and median of the relevant time: processor time for one thread, because it does not contain
    /// what else the machine does; wall time for several threads.
    pub fn time(&self) -> Option<[f64; 2]> {
        if self.threads == 1 { self.spread(|time| time.cpu) } else { self.spread(|time| time.wall) }
    }
}

/// The number of rounds of an engine whose first call took this many seconds. Slow engines get fewer; the
/// slowest keep the time of the first call.
const ROUNDS_OF_SLOW_ENGINES: [(f64, usize); 2] = [(10.0, 1), (3.0, 3)];

/// A round of a fast engine on a small mesh is as many calls as take this many nanoseconds.
const MIN_ROUND: f64 = 2e7;

struct Runner<'a> {
    run: Box<dyn Run + 'a>,
    calls: usize,
    wanted: usize,
    rounds: Vec<Time>,
}

/// Measures each engine that takes a mesh's faces in at most `rounds` rounds. An engine that fails, or is not
/// what it claims, gets a row that says so.
pub fn measure(named: &Named, engines: &[Engine], rounds: usize, node: Option<&Path>) -> Vec<Row> {
    let expected = expected(&named.mesh);
    let engines = engines.iter().filter(|engine| engine.takes(&named.mesh));
    let mut rows: Vec<Row> = engines.clone().map(|engine| Row::new(engine, named)).collect();
    let mut runners = Vec::new();
    for (engine, row) in engines.zip(&mut rows) {
        let started = start(engine, &named.mesh, &expected, rounds, node);
        match started {
            Ok((runner, answer)) => {
                row.answer = answer;
                runners.push((runner, row));
            }
            Err(message) => row.answer = format!("failed: {message}"),
        }
    }
    for round in 0..rounds {
        for (runner, row) in &mut runners {
            if let Err(message) = runner.take_turn(round) {
                row.answer = format!("failed: {message}");
            }
        }
    }
    for (runner, row) in runners {
        let per_call = runner.rounds.into_iter();
        row.rounds = per_call.map(|time| time.divided_by(row.triangles as f64)).collect();
    }
    rows
}

/// The reference's result.
fn expected(mesh: &OwnedMesh) -> Vec<Tangent> {
    let frames = darboux_tests::engine::reference(mesh, 180.0);
    frames.iter().map(|frame| frame.map_or([1.0, 0.0, 0.0, -1.0], |frame| frame.tangent_and_sign())).collect()
}

/// Starts an engine, runs it once and checks its result.
fn start<'a>(
    engine: &'a Engine,
    mesh: &'a OwnedMesh,
    expected: &[Tangent],
    rounds: usize,
    node: Option<&Path>,
) -> Result<(Runner<'a>, String), String> {
    let mut run = engine.start(mesh, node)?;
    let first = run.run(1)?;
    let answer = verdict(engine.method, expected, &run.tangents()?)?;
    let fewer = ROUNDS_OF_SLOW_ENGINES.iter().find(|(seconds, _)| first.wall > seconds * 1e9);
    let wanted = fewer.map_or(rounds, |(_, fewer)| rounds.min(*fewer));
    let calls = (MIN_ROUND / first.wall.max(1.0)).ceil().max(1.0) as usize;
    let mut runner = Runner { run, calls, wanted, rounds: Vec::new() };
    if wanted == 1 {
        runner.rounds.push(first);
    }
    Ok((runner, answer))
}

impl Runner<'_> {
    fn take_turn(&mut self, round: usize) -> Result<(), String> {
        if round >= self.wanted || self.rounds.len() == self.wanted {
            return Ok(());
        }
        let time = self.run.run(self.calls)?;
        self.rounds.push(time.divided_by(self.calls as f64));
        Ok(())
    }
}

/// On smaller meshes, code pages touched by the first call would count more than data.
const LARGE: usize = 20_000;

/// Fills in the memory of the rows on large meshes whose engines run in this process; not where one call
/// takes so long that it is timed once.
pub fn add_memory(rows: &mut [Row], engines: &[Engine], quick: bool, models: Option<&Path>) {
    let countable = |row: &Row| {
        let engine = engines.iter().find(|engine| engine.name == row.engine);
        row.triangles >= LARGE
            && row.rounds.len() > 1
            && engine.is_some_and(|engine| engine.is_native() && engine.method != Method::Copy)
    };
    for row in rows {
        if countable(row) {
            let bytes = memory::of_a_child(row.engine, &row.mesh, quick, models);
            row.extra_bytes = bytes.map(|bytes| bytes / row.triangles as f64);
        }
    }
}

/// The factor by which each row is faster than `engine` on the same mesh.
pub fn times_over(rows: &[Row], engine: &str, row: &Row) -> Option<f64> {
    let other = rows.iter().find(|other| other.engine == engine && other.mesh == row.mesh)?;
    Some(other.time()?[1] / row.time()?[1])
}

/// The engines with these names in the order of the table, or all if there are none. Errors: unknown names.
pub fn select(names: &[String]) -> Result<Vec<Engine>, String> {
    let all = engines::all();
    if let Some(unknown) = names.iter().find(|name| !all.iter().any(|engine| engine.name == *name)) {
        let known: Vec<&str> = all.iter().map(|engine| engine.name).collect();
        return Err(format!("there is no engine {unknown}; there are {}", known.join(", ")));
    }
    Ok(all
        .into_iter()
        .filter(|engine| names.is_empty() || names.iter().any(|name| name == engine.name))
        .collect())
}
