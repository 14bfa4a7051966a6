//! Times the check of a normal map against decoding it, and the recognition of a recipe against computing
//! tangents, in turns on one thread.

use std::hint::black_box;
use std::process::Command;

use comfy_table::Table;
use cpu_time::ProcessTime;
use darboux::{
    Convention, TangentOptions, TexelLayout, generate_tangents, judge_normal_map, recognise_recipe,
};
use darboux_check::{CheckOptions, check_map};
use darboux_io::image::{DecodeLimits, PngImage, RgbaImage};
use darboux_tests::families;

use crate::memory;
use crate::table::{align_right, empty};

/// The texels per side of the map, and the triangles of the model.
pub struct Sizes {
    pub side: usize,
    pub triangles: usize,
}

/// The measurements of one task.
pub struct Row {
    /// What it works on.
    pub subject: String,
    pub task: &'static str,
    /// Milliseconds of processor time, one entry per round.
    pub rounds: Vec<f64>,
    /// Per round the time over that of the first task on the same subject in that round.
    pub ratios: Vec<f64>,
    /// The bytes of the peak, the input included, over those of the file and the decoded map; for the check
    /// of a map only.
    pub memory: Option<f64>,
}

/// What the codes of a map's texels have beside the shape. A PNG without noise is decoded faster.
#[derive(Clone, Copy)]
enum Texels {
    /// Noise of one code, as the rounding of bakers and of painted detail leaves it.
    Noisy,
    Smooth,
}

/// Every task on maps and on a model, in `rounds` rounds.
pub fn measure(sizes: &Sizes, rounds: usize) -> Vec<Row> {
    let mut rows = on_map(Texels::Noisy, sizes.side, rounds);
    rows[2].memory = memory_of_a_child(sizes.side);
    rows.extend(on_map(Texels::Smooth, sizes.side, rounds));
    rows.extend(on_model(sizes.triangles, rounds));
    rows
}

fn on_map(texels: Texels, side: usize, rounds: usize) -> Vec<Row> {
    let file = bumps(texels, side);
    let image = RgbaImage::decode(&file, &DecodeLimits::default()).expect("a valid PNG");
    let kind = match texels {
        Texels::Noisy => "with noise",
        Texels::Smooth => "without noise",
    };
    let subject = format!("map {kind} of {side} x {side} texels, {} bytes", file.len());
    in_turns(
        &subject,
        rounds,
        [
            ("decode", &mut || drop(black_box(RgbaImage::decode(&file, &DecodeLimits::default())))),
            ("judge", &mut || _ = black_box(judge_normal_map(&image.texels, [side; 2], TexelLayout::RGBA))),
            ("decode + judge + rules", &mut || drop(black_box(check(&file)))),
        ],
    )
}

fn on_model(triangles: usize, rounds: usize) -> Vec<Row> {
    let side = (triangles / 2).isqrt();
    let mesh = families::grid(side, side, false, false);
    let view = mesh.view();
    let tangents = generate_tangents(&view, &TangentOptions::default()).corners;
    let tangents = tangents.converted(Convention::GLTF.generated(), Convention::GLTF.generated());
    in_turns(
        &format!("grid of {} triangles", mesh.corner_count() / 3),
        rounds,
        [
            ("generate tangents", &mut || {
                drop(black_box(generate_tangents(&view, &TangentOptions::default())))
            }),
            ("recognise recipe", &mut || drop(black_box(recognise_recipe(&view, tangents.per_corner())))),
        ],
    )
}

fn check(file: &[u8]) -> darboux_check::CheckedMap {
    check_map(file, &CheckOptions::default())
}

/// Runs tasks in turns.
fn in_turns<const N: usize>(
    subject: &str,
    rounds: usize,
    mut tasks: [(&'static str, &mut dyn FnMut()); N],
) -> Vec<Row> {
    let times: Vec<[f64; N]> = (0..rounds)
        .map(|_| {
            tasks.each_mut().map(|(_, task)| {
                let start = ProcessTime::now();
                task();
                1e3 * start.elapsed().as_secs_f64()
            })
        })
        .collect();
    let row = |(index, (task, _)): (usize, &(&'static str, &mut dyn FnMut()))| Row {
        subject: subject.to_owned(),
        task,
        rounds: times.iter().map(|round| round[index]).collect(),
        ratios: times.iter().map(|round| round[index] / round[0]).collect(),
        memory: None,
    };
    tasks.iter().enumerate().map(row).collect()
}

/// A PNG of bumps.
fn bumps(texels: Texels, side: usize) -> Vec<u8> {
    let amplitude = match texels {
        Texels::Noisy => 1.5,
        Texels::Smooth => 0.0,
    };
    let texel = |i: usize| {
        let (x, y) = ((i % side) as f32 / 17.0, (i / side) as f32 / 17.0);
        let normal = [-x.cos() * y.sin() / 4.0, x.sin() * y.cos() / 4.0, 1.0];
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        let mut bits = i as u32;
        normal.map(|x| {
            bits = (bits ^ bits >> 16).wrapping_mul(0x7feb_352d);
            bits = (bits ^ bits >> 15).wrapping_mul(0x846c_a68b);
            let noise = amplitude * (bits as f32 / u32::MAX as f32 * 2.0 - 1.0);
            (127.5 + 127.5 * x / length + noise) as u8
        })
    };
    let texels: Vec<[u8; 3]> = (0..side * side).map(texel).collect();
    let image = PngImage::from_rgb("bumps", [side as u32; 2], &texels).expect("a square");
    image.to_bytes().expect("an image can be encoded")
}

/// The peak of a check of the map with noise over the file and the decoded map, measured in a child process;
/// none if the system does not report it.
fn memory_of_a_child(side: usize) -> Option<f64> {
    let mut command = Command::new(std::env::current_exe().ok()?);
    command.args(["--check", "--only-memory", "--map-side", &side.to_string()]);
    let output = memory::returning_freed(&mut command).output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// The child process: checks the map with noise once and returns the peak, the file included, over the file
/// and the decoded map.
pub fn memory_of_this_process(side: usize) -> Option<f64> {
    let file = bumps(Texels::Noisy, side);
    let growth = memory::growth(|| drop(black_box(check(&file))))?;
    Some((growth + file.len() as f64) / (file.len() + 4 * side * side) as f64)
}

/// The lowest, the middle and the highest value.
pub fn spread(values: &[f64]) -> [f64; 3] {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    [0, sorted.len() / 2, sorted.len() - 1].map(|i| sorted[i])
}

/// One line per row.
pub fn table(rows: &[Row]) -> Table {
    let mut table = empty(&["subject", "task", "ms median", "ratio median", "ratio from", "to", "memory"]);
    for row in rows {
        let [lowest, middle, highest] = spread(&row.ratios).map(|ratio| format!("{ratio:.2}"));
        let time = format!("{:.1}", spread(&row.rounds)[1]);
        let memory = row.memory.map_or(String::new(), |times| format!("{times:.2}"));
        table.add_row([row.subject.clone(), row.task.to_owned(), time, middle, lowest, highest, memory]);
    }
    (2..7).for_each(|column| align_right(&mut table, column));
    table
}
