//! Measures the phases of `darboux tangents` on an indexed grid, against copying its files.
//!
//! `cargo run --release -p darboux-io --features darboux/parallel --example measure -- FOLDER [QUADS PER SIDE]`. Prints the least wall time of several runs.
//! The grid (708 quads per side: a million triangles) and its output stay in FOLDER, for `/usr/bin/time -v darboux tangents`.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use darboux::{Mesh, TangentOptions, generate_tangents};
use darboux_io::gltf::{AddTangentsOptions, Document, add_tangents};
use darboux_io::{LoadOptions, SaveOptions};

const RUNS: usize = 9;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: measure FOLDER [QUADS PER SIDE]")?);
    let side: u32 = arguments.next().and_then(|text| text.to_str()?.parse().ok()).unwrap_or(708);
    let (input, output) = (folder.join("grid.glb"), folder.join("grid.tangents.glb"));
    let grid = Grid::new(side);
    fs::write(&input, grid.glb())?;

    let mut phases = Phases::default();
    for _ in 0..RUNS {
        let mut document = phases.time("open", || Document::open(&input, &LoadOptions::default()))?;
        phases.time("add_tangents", || {
            add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {})
        })?;
        phases.time("save", || document.save(&output, &SaveOptions::default().with_force(true)))?;
        phases.time("close", || drop(document));
        phases.time("cp of both", || copy_both(&input, &output))?;
        let mesh = Mesh::triangles(&grid.positions, &grid.normals, &grid.uvs, &grid.indices)?;
        phases.time("core alone", || generate_tangents(&mesh, &TangentOptions::default()).corners.len());
    }
    let size = |path: &Path| fs::metadata(path).map_or(0.0, |metadata| metadata.len() as f64 / 1e6);
    println!("{} triangles; {:.1} MB in, {:.1} MB out", 2 * side * side, size(&input), size(&output));
    phases.print();
    Ok(())
}

/// As `cp` does: into files that were not there.
fn copy_both(input: &Path, output: &Path) -> std::io::Result<()> {
    for path in [input, output] {
        let copy = path.with_extension("copy");
        fs::copy(path, &copy)?;
        fs::remove_file(&copy)?;
    }
    Ok(())
}

/// The least time of each phase, in the order in which they come.
#[derive(Default)]
struct Phases(Vec<(&'static str, Duration)>);

impl Phases {
    fn time<T>(&mut self, name: &'static str, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        let took = start.elapsed();
        match self.0.iter_mut().find(|phase| phase.0 == name) {
            Some(phase) => phase.1 = phase.1.min(took),
            None => self.0.push((name, took)),
        }
        result
    }

    fn print(&self) {
        for (name, took) in &self.0 {
            println!("{:>8.2} ms  {name}", took.as_secs_f64() * 1e3);
        }
    }
}

/// A wavy grid, smooth and indexed.
struct Grid {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl Grid {
    fn new(side: u32) -> Self {
        let at = |i: u32| i as f32 / side as f32;
        let places = || (0..=side).flat_map(|y| (0..=side).map(move |x| (at(x), at(y))));
        let slope = |x: f32| (20.0 * x).cos();
        let corner = |x: u32, y: u32| y * (side + 1) + x;
        let squares = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        Self {
            positions: places().map(|(x, y)| [x, y, (20.0 * x).sin() / 20.0]).collect(),
            normals: places()
                .map(|(x, _)| [-slope(x) / slope(x).hypot(1.0), 0.0, 1.0 / slope(x).hypot(1.0)])
                .collect(),
            uvs: places().map(|(x, y)| [x, y]).collect(),
            indices: squares
                .flat_map(|(x, y)| {
                    let [a, b, c, d] =
                        [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
                    [a, b, c, a, c, d]
                })
                .collect(),
        }
    }

    fn glb(&self) -> Vec<u8> {
        let mut bin = Vec::new();
        let mut view = |words: &mut dyn Iterator<Item = [u8; 4]>| {
            let start = bin.len();
            words.for_each(|word| bin.extend(word));
            format!("{{\"buffer\":0,\"byteOffset\":{start},\"byteLength\":{}}}", bin.len() - start)
        };
        let mut floats = |data: &[f32]| view(&mut data.iter().map(|x| x.to_le_bytes()));
        let views = [
            floats(self.positions.as_flattened()),
            floats(self.normals.as_flattened()),
            floats(self.uvs.as_flattened()),
            view(&mut self.indices.iter().map(|index| index.to_le_bytes())),
        ];
        let accessor = |view: usize, component: u32, count: usize, kind: &str, more: &str| {
            format!(
                "{{\"bufferView\":{view},\"componentType\":{component},\"count\":{count},\"type\":\"{kind}\"{more}}}"
            )
        };
        let count = self.positions.len();
        let accessors = [
            accessor(0, 5126, count, "VEC3", ",\"min\":[0,0,-0.05],\"max\":[1,1,0.05]"),
            accessor(1, 5126, count, "VEC3", ""),
            accessor(2, 5126, count, "VEC2", ""),
            accessor(3, 5125, self.indices.len(), "SCALAR", ""),
        ];
        let mut json = format!(
            "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{{\"mesh\":0}}],\"buffers\":[{{\"byteLength\":{}}}],\"bufferViews\":[{}],\"accessors\":[{}],\
             \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}},\"indices\":3}}]}}]}}",
            bin.len(),
            views.join(","),
            accessors.join(",")
        );
        json.extend(std::iter::repeat_n(' ', json.len().next_multiple_of(4) - json.len()));
        let length = 12 + 8 + json.len() + 8 + bin.len();
        let mut glb = b"glTF\x02\0\0\0".to_vec();
        glb.extend((length as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", bin.as_slice())] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        glb
    }
}
