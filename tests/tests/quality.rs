//! The angle between tangents and UV derivatives on real models, for every method and for meshoptimizer.

use std::io::Write;
use std::path::{Path, PathBuf};

use darboux::{
    Method, MikkTSpaceOptions, TangentOptions, UvFidelity, generate_tangents, measure_uv_fidelity,
};
use darboux_tests::OwnedMesh;
use darboux_tests::models::{further_models, meshes, models};

const METHODS: [Method; 8] = [
    Method::AngleArea,
    Method::MikkTSpace(MikkTSpaceOptions::new()),
    Method::Lengyel,
    Method::LengyelPerVertex,
    Method::Average,
    Method::Area,
    Method::Face,
    Method::FromNormal,
];

/// The names of the columns: meshoptimizer, then [`METHODS`].
const COLUMNS: [&str; 9] = [
    "meshoptimizer",
    "angle-area",
    "mikktspace",
    "lengyel",
    "per vertex",
    "average",
    "area",
    "face",
    "from-normal",
];

/// The columns that angle-area is compared with: methods that are smooth and follow UVs.
const RIVALS: [usize; 6] = [0, 2, 3, 4, 5, 6];
const ANGLE_AREA: usize = 1;

/// Models on which all these angles are below this, in degrees, are flat and are not compared.
const FLAT: f64 = 0.001;

/// The mean angle of every method and of meshoptimizer on a mesh.
fn measure(mesh: &OwnedMesh) -> Vec<UvFidelity> {
    let view = mesh.view();
    let ours = METHODS.map(|method| {
        let options = TangentOptions::from(method);
        measure_uv_fidelity(&view, generate_tangents(&view, &options).corners.per_corner())
            .expect("the same mesh")
    });
    let theirs = meshopt::generate_tangents(
        mesh.indices.as_deref(),
        &mesh.positions,
        &mesh.normals,
        &mesh.uvs,
        meshopt::TangentOptions::None,
    );
    let theirs = measure_uv_fidelity(&view, &theirs).expect("the same mesh");
    [theirs].into_iter().chain(ours).collect()
}

/// The mean angles over all primitives of a model, weighted by area; `None` if no primitive can be measured.
fn measure_model(path: &Path) -> Option<[f64; COLUMNS.len()]> {
    let mut sums = [0.0; COLUMNS.len()];
    let mut area = 0.0;
    for (_, mesh) in meshes(path) {
        let measured = measure(&mesh);
        area += measured[0].area;
        sums.iter_mut().zip(&measured).for_each(|(sum, measured)| *sum += measured.mean * measured.area);
    }
    (area > 0.0).then(|| sums.map(|sum| sum / area))
}

/// `cargo test -p darboux-tests --test quality -- --ignored --nocapture` prints the table of
/// docs/notes/methods.md.
#[test]
#[ignore = "long: a table of many models"]
fn table() {
    let of_repository = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets");
    let folder = further_models().unwrap_or_else(of_repository);
    let mut out = std::io::stdout();
    let mut rows: Vec<(PathBuf, [f64; COLUMNS.len()])> = Vec::new();
    for path in models(&folder) {
        let name = path.strip_prefix(&folder).expect("below it").to_path_buf();
        let Some(row) = measure_model(&path) else { continue };
        let is_flat = RIVALS.iter().chain([&ANGLE_AREA]).all(|column| row[*column] < FLAT);
        let reason = match rows.iter().find(|(_, other)| *other == row) {
            Some((same, _)) => format!("the same as {}", same.display()),
            None if is_flat => "flat".to_owned(),
            None => {
                rows.push((name, row));
                continue;
            }
        };
        let numbers = row.map(|mean| format!("{mean:.6} ")).concat();
        writeln!(out, "left out: {}: {reason}: {numbers}", name.display()).expect("standard output");
    }
    writeln!(out, "{:46} {}", "", COLUMNS.map(|name| format!("{name:>14}")).concat())
        .expect("standard output");
    for (path, row) in &rows {
        let numbers = row.map(|mean| format!("{mean:14.4}")).concat();
        writeln!(out, "{:46} {numbers}", path.display()).expect("standard output");
    }
    for column in RIVALS {
        let mut ratios: Vec<f64> = rows.iter().map(|(_, row)| row[ANGLE_AREA] / row[column]).collect();
        let lost: Vec<_> = rows.iter().filter(|(_, row)| row[ANGLE_AREA] >= row[column]).collect();
        ratios.sort_unstable_by(f64::total_cmp);
        let (name, median) = (COLUMNS[column], ratios[ratios.len() / 2]);
        writeln!(out, "{name}: median ratio {median:.4}, not better on {} of {}", lost.len(), rows.len())
            .expect("standard output");
        for (path, row) in lost {
            writeln!(out, "  {}: {:.4} > {:.4}", path.display(), row[ANGLE_AREA], row[column])
                .expect("standard output");
        }
    }
}
