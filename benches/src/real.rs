//! Times the primitives of real models: Darboux, mikktspace.c and meshoptimizer in turns on one thread, each
//! result compared with the reference's first.

use std::path::{Path, PathBuf};

use comfy_table::Table;
use darboux::internal::paths::{PathCounts, path_counts};
use darboux::{Context, MikkTSpaceOptions, Mode, Report, TangentOptions, generate_tangents};
use darboux_tests::{OwnedMesh, models};

use crate::engines::{MESHOPT, REFERENCE};
use crate::meshes::Named;
use crate::rounds;
use crate::table::{align_right, empty};

/// Primitives with fewer triangles are left out: they would measure what a call costs.
const MIN_TRIANGLES: usize = 200;

/// The peers, and Darboux with fresh memory at every call, as the peers have it, and with reused memory.
const ENGINES: [&str; 4] = [REFERENCE, MESHOPT, "darboux", "darboux-kept"];

/// The places in [`ENGINES`] of the peers and of the configurations of Darboux, with their names.
const PEERS: [(usize, &str); 2] = [(0, "mikktspace.c"), (1, "meshoptimizer")];
const OURS: [(usize, &str); 2] = [(2, "fresh memory"), (3, "reused memory")];

/// The measurements of one primitive.
pub struct Row {
    /// The model's name and the number of the primitive.
    pub name: String,
    /// Its number of triangles.
    pub triangles: usize,
    /// Nanoseconds per triangle of each of [`ENGINES`], medians.
    pub times: [f64; 4],
    /// Which path decided how many corners.
    pub paths: PathCounts,
    /// What the mesh has that leads away from the first pass.
    report: Report,
    /// Vertices with a component -0.0.
    signed_zeros: usize,
}

/// Measures all primitives of models below some folders. The slowest beside mikktspace.c come first.
///
/// Errors: there are none; a tangent differs from mikktspace.c's.
pub fn measure(folders: &[PathBuf], quick: bool) -> Result<Vec<Row>, String> {
    let engines = rounds::select(&ENGINES.map(str::to_owned))?;
    let mut rows = Vec::new();
    for named in folders.iter().flat_map(|folder| primitives(folder)) {
        eprintln!("{}: {} triangles", named.name, named.triangles());
        rows.push(row(&named, &rounds::measure(&named, &engines, if quick { 3 } else { 7 }, None))?);
    }
    // A model often exists in several containers.
    rows.sort_by(|a: &Row, b| a.name.cmp(&b.name));
    rows.dedup_by(|a, b| a.name == b.name && a.triangles == b.triangles);
    rows.sort_by(|a, b| a.times_over(0, 2).total_cmp(&b.times_over(0, 2)));
    if rows.is_empty() {
        return Err(format!("no primitive of a model has {MIN_TRIANGLES} triangles with normals and UVs"));
    }
    Ok(rows)
}

fn primitives(folder: &Path) -> impl Iterator<Item = Named> {
    models::models(folder).into_iter().flat_map(|path| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let meshes = models::meshes(&path).into_iter();
        let named = meshes.map(move |(number, mesh)| Named { name: format!("{stem}:{number}"), mesh });
        named.filter(|named| named.triangles() >= MIN_TRIANGLES)
    })
}

fn row(named: &Named, measured: &[rounds::Row]) -> Result<Row, String> {
    let mut times = [0.0; ENGINES.len()];
    for (time, engine) in times.iter_mut().zip(ENGINES) {
        let row = measured.iter().find(|row| row.engine == engine).expect("the engine was selected");
        let [_, median] = row.time().ok_or_else(|| format!("{}, {engine}: {}", named.name, row.answer))?;
        if engine != MESHOPT && row.answer != "exact" {
            return Err(format!("{}, {engine}: {}", named.name, row.answer));
        }
        *time = median;
    }
    let options = MikkTSpaceOptions::new().with_mode(Mode::Reference);
    let view = named.mesh.view();
    Ok(Row {
        name: named.name.clone(),
        triangles: named.triangles(),
        times,
        paths: path_counts(&view, &options, &Context::new().with_max_threads(1)),
        report: generate_tangents(&view, &TangentOptions::from(options)).report,
        signed_zeros: signed_zeros(&named.mesh),
    })
}

/// The number of vertices with a component -0.0.
fn signed_zeros(mesh: &OwnedMesh) -> usize {
    let is_negative_zero = |x: &f32| x.to_bits() == (-0.0_f32).to_bits();
    let vertices = mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs);
    vertices.filter(|((p, n), t)| p.iter().chain(*n).chain(*t).any(is_negative_zero)).count()
}

impl Row {
    /// How many times an engine of ours is as fast as a peer.
    pub fn times_over(&self, peer: usize, ours: usize) -> f64 {
        self.times[peer] / self.times[ours]
    }

    /// The numbers of the table after the name and the times.
    fn reasons(&self) -> [String; 6] {
        let share = |count: usize, all: usize| format!("{:.1}", 100.0 * count as f64 / all.max(1) as f64);
        let PathCounts { first_pass, groups, general } = self.paths;
        let corners = first_pass + groups + general;
        let flat = self.report.uv_degenerate_triangles + self.report.degenerate_triangles;
        [
            share(first_pass, corners),
            share(groups, corners),
            share(general, corners),
            share(flat, self.triangles),
            self.report.mirrored_edges.to_string(),
            self.signed_zeros.to_string(),
        ]
    }
}

/// The columns of [`Row::reasons`].
const REASONS: [&str; 6] =
    ["% first pass", "% groups", "% general", "% without UV area", "mirrored edges", "vertices with -0"];

/// One line per primitive.
pub fn table(rows: &[Row]) -> Table {
    let columns = ["primitive", "triangles", "ns/triangle", "reused", "x mikktspace.c", "x meshopt"];
    let header: Vec<&str> = columns.into_iter().chain(REASONS).collect();
    let mut table = empty(&header);
    for row in rows {
        let [_, _, fresh, kept] = row.times.map(|time| format!("{time:.1}"));
        let ratios = PEERS.map(|(peer, _)| format!("{:.2}", row.times_over(peer, 2)));
        let cells = [row.name.clone(), row.triangles.to_string(), fresh, kept];
        table.add_row(cells.into_iter().chain(ratios).chain(row.reasons()));
    }
    (1..header.len()).for_each(|column| align_right(&mut table, column));
    table
}

/// The distribution of the ratios: one line for each configuration of Darboux and each peer.
pub fn summary(rows: &[Row]) -> String {
    let mut text = String::new();
    for (ours, memory) in OURS {
        for (peer, name) in PEERS {
            text += &line(rows, (ours, memory), (peer, name));
        }
    }
    text
}

fn line(rows: &[Row], (ours, memory): (usize, &str), (peer, name): (usize, &str)) -> String {
    let mut ratios: Vec<f64> = rows.iter().map(|row| row.times_over(peer, ours)).collect();
    ratios.sort_by(f64::total_cmp);
    let quantile = |part: f64| ratios[((part * ratios.len() as f64) as usize).min(ratios.len() - 1)];
    let shown = [0.0, 0.05, 0.25, 0.5, 0.75, 0.95].map(|part| format!("{:.2}", quantile(part))).join(", ");
    let total =
        |engine: usize| -> f64 { rows.iter().map(|row| row.times[engine] * row.triangles as f64).sum() };
    let slower = ratios.iter().filter(|ratio| **ratio < 1.0).count();
    format!(
        "times {name}, {memory}: least, 5 %, 25 %, median, 75 %, 95 %: {shown}; all together {:.2}; slower \
         than it: {slower} of {}\n",
        total(peer) / total(ours),
        rows.len()
    )
}
