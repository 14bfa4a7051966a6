//! Writes what the core makes of every specimen, as lines of JSON, for tests of bindings to other languages: floats as their bits.

use darboux::{Mode, TangentOptions, generate_frames, generate_tangents, split_vertices};
use darboux_tests::corpus::{Specimen, corpus};

fn main() {
    for specimen in corpus() {
        for mode in [Mode::Reference, Mode::Repaired, Mode::Corrected] {
            for &threshold in &specimen.thresholds {
                println!(
                    "{}",
                    line(&specimen, &TangentOptions { mode, threshold, ..TangentOptions::default() })
                );
            }
        }
    }
}

fn line(Specimen { name, mesh, .. }: &Specimen, options: &TangentOptions) -> String {
    let view = mesh.view();
    let tangents = generate_tangents(&view, options).corners;
    let frames = generate_frames(&view, options).corners;
    let split = split_vertices(&view, &tangents).expect("tangents of the same mesh");
    let mode = format!("{:?}", options.mode).to_lowercase();
    let bitangents: Vec<_> = frames.per_corner().iter().map(|frame| frame.bitangent).collect();
    let magnitudes: Vec<_> = frames.per_corner().iter().map(|frame| frame.magnitude).collect();
    let members = [
        ("name", format!("{name:?}")),
        ("mode", format!("{mode:?}")),
        ("threshold", format!("{:?}", options.threshold)),
        ("positions", bits(&mesh.positions)),
        ("normals", bits(&mesh.normals)),
        ("uvs", bits(&mesh.uvs)),
        ("indices", format!("{:?}", mesh.indices.as_deref().unwrap_or_default())),
        ("faces", format!("{:?}", mesh.face_sizes())),
        ("tangents", bits(tangents.per_corner())),
        ("bitangents", bits(&bitangents)),
        ("magnitudes", bits(&magnitudes)),
        ("split_indices", format!("{:?}", split.indices)),
        ("split_sources", format!("{:?}", split.source_of_vertex)),
        ("split_tangents", bits(&split.tangent_of_vertex)),
    ];
    let members: Vec<String> = members.iter().map(|(key, value)| format!("{key:?}: {value}")).collect();
    format!("{{{}}}", members.join(", "))
}

fn bits<const N: usize>(rows: &[[f32; N]]) -> String {
    format!("{:?}", rows.as_flattened().iter().map(|x| x.to_bits()).collect::<Vec<_>>())
}
