//! Bakes the same pairs with Blender's Cycles and with Darboux, and measures the errors of both in the same
//! way, and their times.
//!
//! `cargo xtask bench --bake` builds and starts it: `peers PYTHON SCRIPT FOLDER SIZE THREADS [MODEL ...]`.
//! PYTHON has the package bpy, SCRIPT is `benches/bake/blender_bake.py`, FOLDER holds what both sides
//! exchange, and MODEL is a glTF model, of which the first primitive is simplified to a tenth of its
//! triangles.
//!
//! Both sides get the same cage, have the meshes in memory when the clock starts, and make tangents and the
//! tree while it runs. The maps are rounded to 16 bits by the same function. The errors of pairs that are
//! known in closed form are measured as the tests of this package do, those of models by `verify`.

#[path = "../tests/support/mod.rs"]
mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use darboux::{Context, Convention, TexelLayout};
use darboux_bake::{BakeOptions, Baked, LowSurface, MapKind, NormalTexture, bake, inflated_cage, verify};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use meshopt::{SimplifyOptions, simplify_decoder};
use support::shading::{Texture, errors, fragments, quantile};
use support::{PAIRS, Pair, Shape};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Cells per side of the low meshes.
const LOW_CELLS: usize = 24;

/// Cells per side of the high meshes: two million triangles.
const HIGH_CELLS: usize = 1000;

/// The distance of the cages of pairs that are known in closed form.
const DISTANCE: f32 = 0.15;

/// Samples per axis of the runs.
const SAMPLES_PER_AXIS: [u32; 2] = [1, 4];

/// A low and a high mesh, and where their truth is known from.
struct Meshes {
    name: String,
    low: Shape,
    high: Shape,
    cage: Vec<[f32; 3]>,
    /// How far inside rays end.
    distance: f32,
    /// The closed form; without one the high mesh is the truth.
    pair: Option<Pair>,
}

struct Runs {
    python: PathBuf,
    script: PathBuf,
    folder: PathBuf,
    size: u32,
    threads: usize,
}

/// The median and the 99th percentile of the errors in degrees, and the seconds that a bake took.
struct Outcome {
    median: f64,
    p99: f64,
    seconds: f64,
}

fn main() -> Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [python, script, folder, size, threads, models @ ..] = &words[..] else {
        return Err("usage: peers PYTHON SCRIPT FOLDER SIZE THREADS [MODEL ...]".into());
    };
    let runs = Runs {
        python: python.into(),
        script: script.into(),
        folder: folder.into(),
        size: size.parse()?,
        threads: threads.parse()?,
    };
    fs::create_dir_all(&runs.folder)?;
    let analytic = PAIRS.into_iter().map(|pair| Ok(analytic(pair)));
    let real = models.iter().map(|model| simplified(Path::new(model)));
    println!(
        "| pair, {0} x {0}, 16 bits, {1} threads | samples | Cycles: median | 99 % | s | Darboux: median | \
         99 % | s | times as fast |",
        runs.size, runs.threads
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for meshes in analytic.chain(real) {
        let meshes = meshes?;
        for per_axis in SAMPLES_PER_AXIS {
            let ours = runs.darboux(&meshes, per_axis)?;
            let (map, seconds) = runs.cycles(&meshes, per_axis)?;
            let theirs = runs.judged(&meshes, &ours.0, &map, seconds)?;
            let normals = ours.0.images.vectors(MapKind::Normal).ok_or("no normal map")?;
            let ours = runs.judged(&meshes, &ours.0, normals, ours.1)?;
            println!(
                "| {} | {} | {:.4} | {:.4} | {:.2} | {:.4} | {:.4} | {:.2} | {:.1} |",
                meshes.name,
                per_axis * per_axis,
                theirs.median,
                theirs.p99,
                theirs.seconds,
                ours.median,
                ours.p99,
                ours.seconds,
                theirs.seconds / ours.seconds
            );
        }
    }
    Ok(())
}

fn analytic(pair: Pair) -> Meshes {
    let (low, high) = (pair.low(LOW_CELLS), pair.high(HIGH_CELLS));
    let moved = |(p, n): (&[f32; 3], &[f32; 3])| [0, 1, 2].map(|i| p[i] + DISTANCE * n[i]);
    let cage = low.positions.iter().zip(&low.normals).map(moved).collect();
    Meshes { name: pair.name.to_owned(), low, high, cage, distance: DISTANCE, pair: Some(pair) }
}

/// The first primitive of a model, and a tenth of its triangles. The cage lies at 2 % of the diagonal of its
/// box.
fn simplified(path: &Path) -> Result<Meshes> {
    let document = Document::open(path, &LoadOptions::default())?;
    let all = document.corners()?;
    let corners = all.first().ok_or("the model has no primitives")?;
    let name = corners.name();
    let attributes = &document.meshes()[name.mesh].primitives[name.primitive].attributes;
    let accessor =
        |semantic: &str| attributes.get(semantic).copied().ok_or(format!("the model has no {semantic}"));
    let high = Shape {
        positions: document.vectors::<3>(accessor("POSITION")?)?.into_owned(),
        normals: document.vectors::<3>(accessor("NORMAL")?)?.into_owned(),
        uvs: document.vectors::<2>(accessor("TEXCOORD_0")?)?.into_owned(),
        indices: corners.vertices().to_vec(),
    };
    let target = high.indices.len() / 30 * 3;
    let indices =
        simplify_decoder(&high.indices, &high.positions, target, 1.0, SimplifyOptions::empty(), None);
    let low = Shape { indices, ..high.clone() };
    let end = |pick: fn(f32, f32) -> f32, start: f32| {
        [0, 1, 2].map(|i| high.positions.iter().fold(start, |found, p| pick(found, p[i])))
    };
    let (least, greatest) = (end(f32::min, f32::INFINITY), end(f32::max, f32::NEG_INFINITY));
    let diagonal = (0..3).map(|i| (greatest[i] - least[i]).powi(2)).sum::<f32>().sqrt();
    let distance = 0.02 * diagonal;
    let cage = inflated_cage(&low.mesh(), distance)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let counts = format!("{} triangles onto {}", high.indices.len() / 3, low.indices.len() / 3);
    Ok(Meshes { name: format!("{stem}, {counts}"), low, high, cage, distance, pair: None })
}

impl Runs {
    fn options(&self, meshes: &Meshes, per_axis: u32) -> BakeOptions {
        let distance = [meshes.distance; 2];
        BakeOptions::new([self.size; 2], distance).with_samples_per_axis(per_axis)
    }

    /// The bake, with the seconds that tangents and bake took.
    fn darboux(&self, meshes: &Meshes, per_axis: u32) -> Result<(Baked, f64)> {
        let start = Instant::now();
        let tangents = meshes.low.tangents();
        let surface = LowSurface::new(meshes.low.mesh(), &tangents)?.with_cage(&meshes.cage)?;
        let mut context = Context::new().with_max_threads(self.threads);
        let options = self.options(meshes, per_axis);
        let baked = bake(&[surface], &[meshes.high.high()], &options, &mut context, &mut |_| {})?;
        Ok((baked, start.elapsed().as_secs_f64()))
    }

    /// The normals of the other map, and the seconds that it took.
    fn cycles(&self, meshes: &Meshes, per_axis: u32) -> Result<(Vec<[f32; 3]>, f64)> {
        let cage = Shape { positions: meshes.cage.clone(), ..meshes.low.clone() };
        for (name, shape) in [("low", &meshes.low), ("cage", &cage), ("high", &meshes.high)] {
            fs::write(self.folder.join(format!("{name}.mesh")), bytes_of(shape))?;
        }
        let numbers = [self.size, per_axis * per_axis, self.threads as u32].map(|number| number.to_string());
        let output = Command::new(&self.python).arg(&self.script).arg(&self.folder).args(numbers).output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        let seconds = text.lines().last().and_then(|line| line.parse().ok());
        let seconds = seconds.ok_or_else(|| format!("{text}{}", String::from_utf8_lossy(&output.stderr)))?;
        let map = fs::read(self.folder.join("map.f32"))?;
        let floats = map.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes));
        let channels: Vec<f32> = floats.collect();
        let normals = channels.as_chunks::<3>().0.iter().map(|rgb| rgb.map(|x| 2.0 * x - 1.0)).collect();
        Ok((normals, seconds))
    }

    /// The errors of a map. `baked`: of our own, which knows where charts lie.
    fn judged(&self, meshes: &Meshes, baked: &Baked, normals: &[[f32; 3]], seconds: f64) -> Result<Outcome> {
        if let Some(pair) = &meshes.pair {
            let texture = Texture::rounded::<u16>(normals, self.size as usize);
            let errors = errors(&fragments(pair, &meshes.low, LOW_CELLS), &texture);
            return Ok(Outcome { median: quantile(&errors, 0.5), p99: quantile(&errors, 0.99), seconds });
        }
        let layout = TexelLayout::<3>::RGB;
        let rounded = normals.iter().map(|&normal| layout.vector(layout.texel::<u16>(normal))).collect();
        let texture = NormalTexture::new([self.size; 2], rounded, Convention::GLTF, Convention::GLTF)?;
        let tangents = meshes.low.tangents();
        let surface = LowSurface::new(meshes.low.mesh(), &tangents)?.with_cage(&meshes.cage)?;
        let (high, options) = (meshes.high.high(), self.options(meshes, 1));
        let found =
            verify(&[surface], &[high], &baked.images, &texture, &options, &mut Context::new(), &mut |_| {})?;
        Ok(Outcome { median: found.all.median, p99: found.all.p99, seconds })
    }
}

/// A mesh as the script reads it.
fn bytes_of(shape: &Shape) -> Vec<u8> {
    let Shape { positions, normals, uvs, indices } = shape;
    let counts = [positions.len() as u32, indices.len() as u32 / 3];
    let floats = [positions.as_flattened(), normals.as_flattened(), uvs.as_flattened()];
    let counts = counts.iter().flat_map(|x| x.to_le_bytes());
    let floats = floats.into_iter().flatten().flat_map(|x| x.to_le_bytes());
    counts.chain(floats).chain(indices.iter().flat_map(|x| x.to_le_bytes())).collect()
}
