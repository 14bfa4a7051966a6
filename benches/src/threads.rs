//! Times all threads of the machine against one, in turns: on meshes of all sizes, which several threads
//! share, and on a scene of small meshes, of which each is one thread's.

use std::hint::black_box;
use std::time::Instant;

use comfy_table::Table;
use cpu_time::ProcessTime;
use darboux::{Context, MikkTSpaceOptions, Mode, TangentOptions, write_tangents};
use darboux_tests::OwnedMesh;
use rayon::prelude::*;

use crate::judging::spread;
use crate::meshes::{self, Size};
use crate::run::Tangent;
use crate::table::{align_right, empty};

/// The meshes that can have any size.
const SHAPES: [&str; 5] = ["grid", "quads", "sphere", "soup", "charts"];

/// The sizes of the meshes, in triangles.
const SIZES: [usize; 12] =
    [500, 2_000, 5_000, 8_000, 12_000, 16_000, 24_000, 32_000, 50_000, 100_000, 200_000, 1_000_000];

/// A round takes at least so many triangles.
const TRIANGLES_PER_ROUND: usize = 400_000;

/// The measurements of one mesh.
pub struct Row {
    shape: &'static str,
    triangles: usize,
    /// Nanoseconds of wall time per triangle, one entry per round: on one thread, and on all.
    wall: [Vec<f64>; 2],
    /// As `wall`, of processor time.
    cpu: [Vec<f64>; 2],
}

/// The name of the scene.
const SCENE: &str = "scene";

/// How many meshes the scene has.
const SCENE_MESHES: usize = 2_000;

/// The sizes of its meshes, in turns, in triangles.
const SCENE_SIZES: [usize; 7] = [500, 800, 1_200, 1_800, 2_500, 3_600, 5_000];

/// Measures the shapes with these names, or all of them. Errors: unknown names.
pub fn measure(names: &[String], quick: bool) -> Result<Vec<Row>, String> {
    let known: Vec<&str> = SHAPES.into_iter().chain([SCENE]).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(format!("there is no shape {unknown}; there are {}", known.join(", ")));
    }
    let is_wanted = |shape: &str| names.is_empty() || names.iter().any(|name| name == shape);
    let rounds = if quick { 7 } else { 31 };
    let shapes = SHAPES.into_iter().filter(|shape| is_wanted(shape));
    let mut rows: Vec<Row> =
        shapes.flat_map(|shape| SIZES.map(|size| of_shape(shape, size, rounds))).collect();
    rows.extend(is_wanted(SCENE).then(|| of_scene(rounds)));
    Ok(rows)
}

/// Each mesh is computed by one thread.
fn of_scene(rounds: usize) -> Row {
    let kinds =
        SCENE_SIZES.map(|triangles| meshes::make("grid", Size { triangles }).expect("a mesh of this name"));
    let mut scene: Vec<(&OwnedMesh, Vec<Tangent>)> = (0..SCENE_MESHES)
        .map(|at| &kinds[at % kinds.len()].mesh)
        .map(|mesh| (mesh, vec![[0.0; 4]; mesh.corner_count()]))
        .collect();
    let triangles = (0..SCENE_MESHES).map(|at| kinds[at % kinds.len()].triangles()).sum();
    let options: TangentOptions = MikkTSpaceOptions::new().with_mode(Mode::Reference).into();
    let call = |context: &mut Context, (mesh, out): &mut (&OwnedMesh, Vec<Tangent>)| {
        _ = write_tangents(&mesh.view(), &options, context, black_box(out)).expect("one tangent per corner");
    };
    let context = || Context::new().with_max_threads(1);
    let mut row = Row { shape: SCENE, triangles, wall: Default::default(), cpu: Default::default() };
    for _ in 0..rounds {
        row.time(0, triangles, || {
            let mut context = context();
            scene.iter_mut().for_each(|mesh| call(&mut context, mesh));
        });
        row.time(1, triangles, || scene.par_iter_mut().for_each_init(context, call));
    }
    row
}

fn of_shape(shape: &'static str, triangles: usize, rounds: usize) -> Row {
    let named = meshes::make(shape, Size { triangles }).expect("a mesh of this name");
    let (mesh, triangles) = (&named.mesh, named.triangles());
    let view = mesh.view();
    let options: TangentOptions = MikkTSpaceOptions::new().with_mode(Mode::Reference).into();
    let mut out: Vec<Tangent> = vec![[0.0; 4]; mesh.corner_count()];
    let calls = (TRIANGLES_PER_ROUND / triangles).max(1);
    let mut contexts = [Context::new().with_max_threads(1), Context::new()];
    let mut row = Row { shape, triangles, wall: Default::default(), cpu: Default::default() };
    for round in 0..=rounds {
        for (at, context) in contexts.iter_mut().enumerate() {
            let mut call = || {
                for _ in 0..calls {
                    _ = write_tangents(&view, &options, context, black_box(&mut out))
                        .expect("one tangent per corner");
                }
            };
            // The first round fills the memory of the contexts.
            if round == 0 { call() } else { row.time(at, calls * triangles, call) }
        }
    }
    row
}

impl Row {
    /// Adds a round. `at`: 0 for one thread, 1 for all.
    fn time(&mut self, at: usize, triangles: usize, call: impl FnOnce()) {
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        call();
        self.wall[at].push(wall.elapsed().as_nanos() as f64 / triangles as f64);
        self.cpu[at].push(cpu.elapsed().as_nanos() as f64 / triangles as f64);
    }
}

/// One line per mesh: minimum and median of wall times, the ratios of the rounds, and of processor times.
pub fn table(rows: &[Row]) -> Table {
    let header = [
        "shape",
        "triangles",
        "one thread min",
        "median",
        "all threads min",
        "median",
        "times as fast min",
        "median",
        "max",
        "processor time",
    ];
    let mut table = empty(&header);
    for row in rows {
        let ratios = |[one, all]: &[Vec<f64>; 2]| {
            let ratios: Vec<f64> = one.iter().zip(all).map(|(one, all)| one / all).collect();
            spread(&ratios)
        };
        let [[one_min, one, _], [all_min, all, _]] = [0, 1].map(|at| spread(&row.wall[at]));
        let [min, median, max] = ratios(&row.wall);
        let processor = 1.0 / ratios(&row.cpu)[1];
        let times = [one_min, one, all_min, all].map(|time| format!("{time:.1}"));
        let ratios = [min, median, max, processor].map(|ratio| format!("{ratio:.2}"));
        let names = [row.shape.to_owned(), row.triangles.to_string()];
        table.add_row(names.into_iter().chain(times).chain(ratios));
    }
    (1..header.len()).for_each(|column| align_right(&mut table, column));
    table
}
