//! Writes the models of the pictures in docs/bake.md into a folder: a crate with a handle above it, as
//! low.glb and high.glb.
//!
//! The low crate is a box with hard edges; the high one has round edges, bolts and a ring. `cargo xtask
//! bake-pictures` bakes and draws them.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use darboux_io::gltf::Document;
use darboux_io::{LoadOptions, SaveOptions};

type Vector = [f64; 3];

/// A box with round edges, and detail on its faces.
struct Part {
    name: &'static str,
    center: Vector,
    half: Vector,
    radius: f64,
    has_detail: bool,
    /// Where its faces lie in the image: the first row of cells, of eight per side.
    first_row: usize,
    /// Cells of the image per face.
    cells: usize,
}

const PARTS: [Part; 2] = [
    Part {
        name: "crate",
        center: [0.0; 3],
        half: [1.0; 3],
        radius: 0.15,
        has_detail: true,
        first_row: 0,
        cells: 2,
    },
    Part {
        name: "handle",
        center: [0.0, 1.4, 0.0],
        half: [0.7, 0.1, 0.14],
        radius: 0.09,
        has_detail: false,
        first_row: 6,
        cells: 1,
    },
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).ok_or("usage: settings FOLDER")?;
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    for (name, cells) in [("low", 1), ("high", 120)] {
        let path = folder.join(name).with_extension("obj");
        fs::write(&path, text(name, cells)?)?;
        let options = SaveOptions::default().with_force(true);
        Document::open(&path, &LoadOptions::default())?.save(&path.with_extension("glb"), &options)?;
    }
    Ok(())
}

/// The parts as an OBJ, with so many cells per side of a face. One cell is a flat face with its own normal,
/// and has UVs.
fn text(suffix: &str, cells: usize) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    let mut first = 1;
    for part in &PARTS {
        writeln!(text, "o {}_{suffix}", part.name)?;
        for face in 0..6 {
            let side = cells + 1;
            for index in 0..side * side {
                let [u, v] = [index % side, index / side].map(|i| i as f64 / cells as f64);
                let at = |u: f64, v: f64| part.point(face, u, v, cells > 1);
                let [x, y, z] = at(u, v);
                let [a, b, c] = normal(at, u, v);
                writeln!(text, "v {x} {y} {z}\nvn {a} {b} {c}")?;
                if cells == 1 {
                    let [s, t] = part.uv(face, u, v);
                    writeln!(text, "vt {s} {t}")?;
                }
            }
            for cell in 0..cells * cells {
                let corner = first + cell / cells * side + cell % cells;
                let corners = [corner, corner + 1, corner + side + 1, corner + side];
                let [a, b, c, d] = corners.map(|i| match cells {
                    1 => format!("{i}/{i}/{i}"),
                    _ => format!("{i}//{i}"),
                });
                writeln!(text, "f {a} {b} {c} {d}")?;
            }
            first += side * side;
        }
    }
    Ok(text)
}

impl Part {
    /// A point of a face, from (0, 0) to (1, 1), u to the right and v up as seen from outside.
    fn point(&self, face: usize, u: f64, v: f64, is_round: bool) -> Vector {
        let (axis, sign) = (face / 2, if face.is_multiple_of(2) { 1.0 } else { -1.0 });
        let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut at = [0.0; 3];
        at[axis] = sign * self.half[axis];
        at[right] = sign * (2.0 * u - 1.0) * self.half[right];
        at[up] = (2.0 * v - 1.0) * self.half[up];
        if is_round {
            let inner =
                [0, 1, 2].map(|i| at[i].clamp(self.radius - self.half[i], self.half[i] - self.radius));
            let out = unit([0, 1, 2].map(|i| at[i] - inner[i]));
            at = [0, 1, 2].map(|i| inner[i] + self.radius * out[i]);
            if self.has_detail {
                at[axis] += sign * detail(2.0 * u - 1.0, 2.0 * v - 1.0);
            }
        }
        [0, 1, 2].map(|i| at[i] + self.center[i])
    }

    /// The place of a face's point in the image: three faces per row, with a margin.
    fn uv(&self, face: usize, u: f64, v: f64) -> [f64; 2] {
        let size = self.cells as f64 / 8.0;
        let [column, row] = [face % 3, face / 3].map(|i| i as f64);
        let inset = |x: f64| 0.04 + 0.92 * x;
        [size * (column + inset(u)), self.first_row as f64 / 8.0 + size * (row + inset(v))]
    }
}

/// The height of bolts near the corners and of a ring in the middle of a face.
fn detail(x: f64, y: f64) -> f64 {
    let dome = |radius: f64, size: f64| (1.0 - (radius / size).powi(2)).max(0.0);
    let bolt = (x.abs() - 0.6).hypot(y.abs() - 0.6);
    let ring = (x.hypot(y) - 0.35).abs();
    0.09 * dome(bolt, 0.12) + 0.06 * dome(ring, 0.06)
}

/// The unit normal, by differences to the inside of the face.
fn normal(at: impl Fn(f64, f64) -> Vector, u: f64, v: f64) -> Vector {
    const STEP: f64 = 1e-4;
    let ends = |x: f64| [(x - STEP).max(0.0), (x + STEP).min(1.0)];
    let ([u0, u1], [v0, v1]) = (ends(u), ends(v));
    let sub = |a: Vector, b: Vector| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let (a, b) = (sub(at(u1, v), at(u0, v)), sub(at(u, v1), at(u, v0)));
    unit([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
}

fn unit(v: Vector) -> Vector {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}
