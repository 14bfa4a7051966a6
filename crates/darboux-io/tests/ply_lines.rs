//! A record of an ASCII PLY is a line: what a line has too much is ignored, and what the file has after its
//! elements is named.
#![cfg(feature = "ply")]

use darboux_io::LoadOptions;
use darboux_io::gltf::Document;

const TRIANGLES: [&str; 2] = ["3 0 1 2", "3 0 2 3"];

/// A square of two triangles with these lines of vertices and faces.
fn square(vertices: &str, face_count: usize, faces: &str) -> String {
    let xyz = "property float x\nproperty float y\nproperty float z\n";
    let list = "property list uchar int vertex_indices\n";
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\n{xyz}element face {face_count}\n{list}end_header\n{vertices}{faces}"
    )
}

const VERTICES: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

fn open(ply: impl Into<Vec<u8>>) -> Result<Document, String> {
    Document::from_bytes("a.ply", ply.into(), None, &LoadOptions::default())
        .map_err(|error| error.to_string())
}

/// The GLB and the warnings of a file.
fn read(ply: impl Into<Vec<u8>>) -> (Vec<u8>, Vec<String>) {
    let document = open(ply).unwrap();
    (document.to_glb().unwrap(), document.warnings().to_vec())
}

/// The square as its header says it.
fn plain() -> (Vec<u8>, Vec<String>) {
    read(square(VERTICES, 2, &TRIANGLES.join("\n")))
}

#[test]
fn values_beyond_the_header_are_ignored() {
    let (glb, warnings) = plain();
    assert!(warnings.is_empty());
    let of_vertices = square(&VERTICES.replace('\n', " 9\n"), 2, &TRIANGLES.join("\n"));
    let of_faces = square(VERTICES, 2, &TRIANGLES.join(" 255 3 1 2 3\n"));
    let one = square(VERTICES, 2, "3 0 1 2\t7 \n3 0 2 3\n");
    for line_end in ["\n", "\r\n", "\r"] {
        let cases = [
            (
                &of_vertices,
                "4 lines have 4 values more than its header says, line 10 first; they are ignored",
            ),
            (&of_faces, "line 14 has 5 values more than its header says, which are ignored"),
            (&one, "line 14 has 1 value more than its header says, which is ignored"),
        ];
        for (ply, expected) in cases {
            let (other, warnings) = read(ply.replace('\n', line_end));
            assert!(other == glb, "{expected}");
            assert_eq!(warnings, [expected]);
        }
    }
}

#[test]
fn lines_with_too_few_values_are_named() {
    let error = |vertices: &str, faces: &str| open(square(vertices, 2, faces)).unwrap_err();
    let faces = TRIANGLES.join("\n");
    assert_eq!(
        error("0 0 0\n1 0\n1 1 0\n0 1 0\n", &faces),
        "a.ply: line 11: has fewer values than vertex 1 needs by the header; export or download the file again"
    );
    assert!(error(VERTICES, "3 0 1 2\n\n3 0 2\n").contains("line 16: has fewer values than face 1 needs"));
    assert!(error(VERTICES, "3 0 1 x\n3 0 2 3").contains("line 14: has \"x\", which is no number"));
    assert!(error(VERTICES, "3 0 1 2\n").contains("face 1: is missing, cut off or no number"));
}

#[test]
fn records_may_wrap_over_lines_or_share_one() {
    let whole = square(VERTICES, 2, &TRIANGLES.join("\n"));
    let (head, numbers) = whole.split_once("end_header\n").unwrap();
    let words: Vec<&str> = numbers.split_whitespace().collect();
    for in_line in [1, 2, 5, 9, 100] {
        let lines: Vec<String> = words.chunks(in_line).map(|line| line.join(" ")).collect();
        let (glb, warnings) = read(format!("{head}end_header\n{}\n", lines.join("\n")));
        assert!(glb == plain().0, "{in_line}");
        assert!(warnings.is_empty(), "{in_line}");
    }
}

#[test]
fn data_after_the_last_element_is_named() {
    let (glb, _) = read(square(VERTICES, 1, TRIANGLES[0]));
    for (after, expected) in [
        ("\n3 0 2 3", "1 line after the last element that its header counts is ignored"),
        ("\n\n3 0 2 3\n3 0 3 1\n", "2 lines after the last element that its header counts are ignored"),
    ] {
        let (other, warnings) = read(square(VERTICES, 1, &format!("{}{after}", TRIANGLES[0])));
        assert!(glb == other);
        assert_eq!(warnings, [expected]);
    }
    let mut binary = square("", 1, "").replace("ascii", "binary_little_endian").into_bytes();
    for number in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0] {
        binary.extend(number.to_le_bytes());
    }
    binary.push(3);
    binary.extend([0_u32, 1, 2].into_iter().flat_map(u32::to_le_bytes));
    for (after, expected) in [
        (&b""[..], &[][..]),
        (b"\n", &[]),
        (b"abc", &["3 bytes after the last element that its header counts are ignored"]),
    ] {
        let (other, warnings) = read([&binary, after].concat());
        assert!(glb == other);
        assert_eq!(warnings, expected);
    }
}

#[test]
fn negative_indices_are_named() {
    let error = open(square(VERTICES, 2, "3 0 1 2\n3 0 2 -1")).unwrap_err();
    assert_eq!(error, "a.ply: face 1: has the index -1, but indices begin at 0; export the file again");
}
