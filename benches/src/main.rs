//! The benchmark: every engine on every mesh, checked against the reference, then timed in turns.
//!
//! `cargo xtask bench` builds and starts it.

mod baseline;
mod callbacks;
mod check;
mod engines;
mod instructions;
mod judging;
mod lengyel;
mod memory;
mod meshes;
mod node;
mod real;
mod record;
mod rounds;
mod run;
mod table;
mod threads;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use darboux_tests::models::further_models;

use engines::Engine;
use judging::Sizes;
use meshes::{Named, Size};

/// Times tangent generators, each checked against mikktspace.c.
#[derive(Parser)]
#[command(name = "cargo xtask bench")]
struct Arguments {
    /// Smaller meshes, three rounds; nothing is recorded.
    #[arg(long)]
    quick: bool,
    /// Only these engines.
    #[arg(long, value_delimiter = ',', value_name = "NAME,...")]
    engines: Vec<String>,
    /// Only these meshes.
    #[arg(long, value_delimiter = ',', value_name = "NAME,...")]
    meshes: Vec<String>,
    /// Count instructions per triangle with callgrind instead.
    #[arg(long)]
    instructions: bool,
    /// Compare the counts of our engines with the committed ones, or replace these.
    #[arg(long, value_name = "TASK", conflicts_with_all = ["engines", "meshes"])]
    baseline: Option<baseline::Task>,
    /// Time the check of a normal map against decoding it, and the recognition of a recipe against computing
    /// tangents, instead.
    #[arg(long)]
    check: bool,
    /// Time all threads against one on meshes of all sizes, instead.
    #[arg(long, conflicts_with_all = ["engines", "check", "instructions", "baseline"])]
    threads: bool,
    /// Time the primitives of all models below these folders against mikktspace.c and meshoptimizer on one
    /// thread, the slowest first, instead.
    #[arg(long, num_args = 1.., value_name = "FOLDER", conflicts_with_all = ["engines", "meshes", "check", "threads", "instructions", "baseline"])]
    real: Vec<PathBuf>,
    /// Texels per side of the map of --check.
    #[arg(long, default_value_t = 4096, value_name = "N")]
    map_side: usize,
    /// Folder with FlightHelmet and other large models; by default the one that the environment variable
    /// DARBOUX_MODELS names.
    #[arg(long, value_name = "FOLDER")]
    models: Option<PathBuf>,
    /// Name of this machine in the record, instead of its processor's name.
    #[arg(long, value_name = "NAME")]
    machine: Option<String>,
    /// Folder with the installed packages of node/package.json.
    #[arg(long, hide = true)]
    node: Option<PathBuf>,
    /// Print the memory of one call (used for child processes).
    #[arg(long, hide = true)]
    only_memory: bool,
    /// Make this number of calls and print nothing (used for child processes).
    #[arg(long, hide = true)]
    only_calls: Option<usize>,
}

/// The reference recurses over a vertex's faces.
const DEEP_STACK: usize = 1 << 30;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if arguments.check {
        // Its functions take no context that limits threads.
        rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool has started before");
    }
    let deep = std::thread::Builder::new().stack_size(DEEP_STACK);
    let thread = deep.spawn(move || run(&arguments)).expect("a thread starts");
    match thread.join().expect("no engine panics") {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("bench: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    if let Some(task) = arguments.baseline {
        let engines = rounds::select(&baseline::ENGINES.map(str::to_owned))?;
        return baseline::run(task, || instructions::count(&engines));
    }
    if arguments.check {
        return time_check(arguments);
    }
    if arguments.threads {
        println!("{}", threads::table(&threads::measure(&arguments.meshes, arguments.quick)?));
        return Ok(());
    }
    if !arguments.real.is_empty() {
        return time_real(arguments);
    }
    let engines = rounds::select(&arguments.engines)?;
    if arguments.instructions {
        return count_instructions(arguments, &engines);
    }
    let meshes = select_meshes(arguments)?;
    if arguments.only_memory {
        let bytes = memory::of_this_process(&engines[0], &meshes[0].mesh);
        println!("{}", bytes.map_or("n/a".into(), |bytes| bytes.to_string()));
        return Ok(());
    }
    if let Some(calls) = arguments.only_calls {
        return engines[0].start(&meshes[0].mesh, None)?.run(calls).map(drop);
    }
    time(arguments, engines, &meshes)
}

fn time_check(arguments: &Arguments) -> Result<(), String> {
    if arguments.only_memory {
        let times = judging::memory_of_this_process(arguments.map_side);
        println!("{}", times.map_or("n/a".into(), |times| times.to_string()));
        return Ok(());
    }
    let (triangles, rounds) = if arguments.quick { (100_000, 3) } else { (1_000_000, 9) };
    let rows = judging::measure(&Sizes { side: arguments.map_side, triangles }, rounds);
    println!("{}", judging::table(&rows));
    println!(
        "ms: processor time; ratio: to the first task in the same round; memory: the peak over the file and \
         the decoded map"
    );
    if !arguments.quick {
        println!("recorded in {}", record::checks(&rows, arguments.machine.as_deref())?.display());
    }
    Ok(())
}

fn time_real(arguments: &Arguments) -> Result<(), String> {
    let rows = real::measure(&arguments.real, arguments.quick)?;
    println!("{}", real::table(&rows));
    println!("{}", real::summary(&rows));
    println!("ns/triangle: processor time; x: how many times faster with fresh memory, by medians");
    if !arguments.quick {
        println!("recorded in {}", record::real(&rows, arguments.machine.as_deref())?.display());
    }
    Ok(())
}

/// The meshes with these names, or all if there are none. Errors: unknown names.
fn select_meshes(arguments: &Arguments) -> Result<Vec<Named>, String> {
    let size = if arguments.quick { Size::QUICK } else { Size::FULL };
    let all = arguments.meshes.is_empty();
    let wanted = |name: &str| all || arguments.meshes.iter().any(|wanted| wanted == name);
    let mut found: Vec<Named> =
        meshes::made().filter(|name| wanted(name)).filter_map(|name| meshes::make(name, size)).collect();
    if (all || found.len() < arguments.meshes.len())
        && let Some(folder) = arguments.models.clone().or_else(further_models)
    {
        found.extend(meshes::real(&folder).into_iter().filter(|mesh| wanted(&mesh.name)));
    }
    if let Some(unknown) = arguments.meshes.iter().find(|name| !found.iter().any(|mesh| mesh.name == **name))
    {
        let made: Vec<&str> = meshes::made().collect();
        return Err(format!(
            "there is no mesh {unknown}; there are {} and the models of --models",
            made.join(", ")
        ));
    }
    Ok(found)
}

fn time(arguments: &Arguments, mut engines: Vec<Engine>, meshes: &[Named]) -> Result<(), String> {
    engines.retain(|engine| engine.is_native() || arguments.node.is_some());
    let mut rows = Vec::new();
    for mesh in meshes {
        eprintln!("{}: {} triangles", mesh.name, mesh.triangles());
        let count = if arguments.quick { 3 } else { 7 };
        let mut measured = rounds::measure(mesh, &engines, count, arguments.node.as_deref());
        rounds::add_memory(&mut measured, &engines, arguments.quick, arguments.models.as_deref());
        rows.extend(measured);
    }
    println!("{}", table::table(&rows));
    println!(
        "ns/triangle: processor time where one thread works, else wall time; x: how many times faster, by \
         medians"
    );
    if arguments.quick || !arguments.engines.is_empty() || !arguments.meshes.is_empty() {
        println!("not recorded: only a full run is");
        return Ok(());
    }
    let path = record::timings(&rows, arguments.machine.as_deref())?;
    println!("recorded in {}", path.display());
    Ok(())
}

fn count_instructions(arguments: &Arguments, engines: &[Engine]) -> Result<(), String> {
    let rows = instructions::count(engines)?;
    println!("{}", table::instructions(&rows));
    if arguments.engines.is_empty() {
        let path = record::instructions(&rows, arguments.machine.as_deref())?;
        println!("recorded in {}", path.display());
    }
    Ok(())
}
