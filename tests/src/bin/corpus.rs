//! Prints the core's results for every case of the conformance suite as lines of JSON, with floats as bits,
//! for tests of the bindings to other languages.

use darboux::{
    Choice, Mesh, Method, MikkTSpaceOptions, Mode, Plan, TangentOptions, Tangents, generate_frames,
    generate_tangents, split_vertices,
};
use darboux_tests::corpus::{CorpusCase, corpus};

fn main() {
    // JSON has neither NaN nor infinities, so the cases with such thresholds are left to the tests in Rust.
    for corpus_case in corpus().into_iter().filter(|corpus_case| corpus_case.threshold.is_finite()) {
        for mode in [Mode::Reference, Mode::Repaired, Mode::Corrected] {
            let mikkt = MikkTSpaceOptions::new().with_mode(mode).with_threshold(corpus_case.threshold);
            println!("{}", line(&corpus_case, mikkt));
        }
    }
}

fn line(CorpusCase { name, mesh, .. }: &CorpusCase, mikkt: MikkTSpaceOptions) -> String {
    let (view, options) = (mesh.view(), &TangentOptions::from(mikkt));
    let Tangents { corners: tangents, report } = generate_tangents(&view, options);
    let frames = generate_frames(&view, options).corners;
    let moved = moved(&mesh.positions);
    let plan = Plan::new(&view, options);
    let moved_view = Mesh::with_faces(&moved, view.normals(), view.uvs(), view.indices(), view.faces());
    let planned = plan.evaluate(&moved_view.expect("a moved mesh is one")).expect("the same corners");
    let split = split_vertices(&view, &tangents).expect("tangents of the same mesh");
    let mode = format!("{:?}", mikkt.mode).to_lowercase();
    let bitangents: Vec<_> = frames.per_corner().iter().map(|frame| frame.bitangent).collect();
    let magnitudes: Vec<_> = frames.per_corner().iter().map(|frame| frame.magnitude).collect();
    let members = [
        ("name", format!("{name:?}")),
        ("mode", format!("{mode:?}")),
        ("threshold", format!("{:?}", mikkt.threshold)),
        ("positions", bits(&mesh.positions)),
        ("normals", bits(&mesh.normals)),
        ("uvs", bits(&mesh.uvs)),
        ("indices", format!("{:?}", mesh.indices.as_deref().unwrap_or_default())),
        ("faces", format!("{:?}", mesh.face_sizes())),
        ("tangents", bits(tangents.per_corner())),
        ("frames", bits(frames.tangents().per_corner())),
        ("bitangents", bits(&bitangents)),
        ("magnitudes", bits(&magnitudes)),
        ("repaired", format!("{}", report.repaired_corners)),
        ("moved", bits(&moved)),
        ("planned", bits(planned.per_corner())),
        ("methods", methods(&view)),
        ("split_indices", format!("{:?}", split.indices)),
        ("split_sources", format!("{:?}", split.source_of_vertex)),
        ("split_tangents", bits(&split.tangent_of_vertex)),
    ];
    let members: Vec<String> = members.iter().map(|(key, value)| format!("{key:?}: {value}")).collect();
    format!("{{{}}}", members.join(", "))
}

/// The results of the other methods.
fn methods(mesh: &Mesh<'_>) -> String {
    let of = |&method: &Method| {
        let tangents = generate_tangents(mesh, &method.into()).corners;
        format!("{:?}: {}", method.name(), bits(tangents.per_corner()))
    };
    format!("{{{}}}", Method::ALL[1..].iter().map(of).collect::<Vec<_>>().join(", "))
}

/// The positions of a bent mesh.
fn moved(positions: &[[f32; 3]]) -> Vec<[f32; 3]> {
    positions.iter().map(|&[x, y, z]| [x, y + 0.25 * x * x, z - 0.5 * y]).collect()
}

fn bits<const N: usize>(rows: &[[f32; N]]) -> String {
    format!("{:?}", rows.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>())
}
