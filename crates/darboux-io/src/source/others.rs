//! What a file is that no reader takes: one of another program, a part of one that is read, or unknown.

use std::path::Path;

use super::format::{HEAD, first_word};
use crate::{FileKind, git_lfs};

/// What is wrong with a file whose content has none of the formats that are read: a clause whose subject is
/// the file, with what to do. `name` is the file's name; its ending says what was meant.
pub fn problem(bytes: &[u8], name: &str) -> String {
    let kind = FileKind::of(Path::new(name));
    let clause = if bytes.iter().all(u8::is_ascii_whitespace) {
        "is empty; export or download it again"
    } else if bytes.iter().all(|&byte| byte == 0) {
        "holds zeros only, as after a copy that failed; copy or download it again"
    } else if let Some(clause) = by_ending(bytes, name).or_else(|| by_start(bytes)).or_else(|| by_text(bytes))
    {
        clause
    } else {
        return part_of_stl(bytes, kind)
            .or_else(|| part_of_signature(bytes))
            .unwrap_or_else(|| unknown(kind));
    };
    clause.to_owned()
}

/// A file that could be anything: what its name says it is, and the formats that are read.
fn unknown(kind: Option<FileKind>) -> String {
    let endings = FileKind::model_endings();
    match kind.and_then(FileKind::format_name) {
        Some(format) => format!(
            "is named as {format}, but its content is that of no format that is read ({endings}); export or \
             download it again"
        ),
        None => {
            format!("is of no format that is read; give a model in one of those that are: {endings}")
        }
    }
}

const MAX: &str = "is a scene of 3ds Max or another file of that container; export the model as .fbx or .glb";
const BLENDER: &str = "is a Blender file; export the model from Blender as .glb";
const MAYA: &str = "is a scene of Maya; export the model as .fbx or .glb";
const ALEMBIC: &str = "is an Alembic file, which is not read; export the model as .glb";
const IMAGE: &str = "is an image, not a model; give the model";
const ARCHIVE: &str = "is an archive; unpack it and give the model in it";
const LIGHTWAVE: &str = "is a LightWave or Modo file, which is not read; export the model as .glb";
const QUAKE: &str = "is a model of Quake or a game of its time, which is not read; convert it to .glb";
const MIKU: &str = "is a model of MikuMikuDance, which is not read; convert it to .glb or .vrm";
const X3D: &str = "is a VRML or X3D file, which is not read; convert it to .glb";
const OFF: &str = "is an OFF file, which is not read; convert it to .ply or .glb";
const DXF: &str = "is a drawing of AutoCAD, which is not read; export its meshes as .fbx, .obj or .stl";

/// The bytes that files of other programs and other formats start with.
const STARTS: [(&[u8], &str); 41] = [
    (b"BLENDER", BLENDER),
    (b"\x28\xB5\x2F\xFD", BLENDER),
    (b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", MAX),
    (b"//Maya ASCII", MAYA),
    (b"FOR4", MAYA),
    (b"FOR8", MAYA),
    (b"Ogawa", ALEMBIC),
    (b"\x89HDF\r\n\x1A\n", ALEMBIC),
    (b"QC4DC4D6", "is a scene of Cinema 4D; export the model as .fbx or .glb"),
    (b"3D Geometry File Format", "is a file of Rhino; export its meshes as .fbx, .obj or .glb"),
    (b"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0U\0p\0", "is a file of SketchUp; export the model as .fbx or .glb"),
    (
        b"ISO-10303-21",
        "is a STEP file of a CAD program, which has no triangles; export it as .stl, .obj or .glb",
    ),
    (b"AC10", DXF),
    (b"AutoCAD Binary DXF", DXF),
    (b"#VRML", X3D),
    (b"#X3D", X3D),
    (b"DRACO", "is geometry compressed with Draco outside a glTF, which is not read; convert it to .glb"),
    (b"b3dm", "is a tile of 3D Tiles; give the .glb that it was made from"),
    (b"xof 0", "is a DirectX .x file, which is not read; convert it to .glb"),
    (b"PMX ", MIKU),
    (b"Pmd\0\0\x80\x3F", MIKU),
    (b"IDP2", QUAKE),
    (b"IDP3", QUAKE),
    (b"MD5Version", QUAKE),
    (b"\x1F\x8B", "is compressed with gzip; unpack it first"),
    (b"Rar!", ARCHIVE),
    (b"7z\xBC\xAF\x27\x1C", ARCHIVE),
    (b"\x89PNG", IMAGE),
    (b"\xFF\xD8\xFF", IMAGE),
    (b"GIF8", IMAGE),
    (b"8BPS", IMAGE),
    (b"DDS ", IMAGE),
    (b"\xABKTX ", IMAGE),
    (b"II*\0", IMAGE),
    (b"MM\0*", IMAGE),
    (b"\x76\x2F\x31\x01", IMAGE),
    (b"#?RADIANCE", IMAGE),
    (b"%PDF", "is a PDF, not a model; give the model"),
    (b"\xFF\xFE", "is a text in UTF-16, which is not read; save it in UTF-8"),
    (b"\xFE\xFF", "is a text in UTF-16, which is not read; save it in UTF-8"),
    (git_lfs::START, "is a pointer of Git LFS, not the model; run: git lfs pull"),
];

/// Containers that several programs use: the name's ending distinguishes them.
fn by_ending(bytes: &[u8], name: &str) -> Option<&'static str> {
    let ends = |ending: &str| name.to_ascii_lowercase().ends_with(ending);
    if bytes.starts_with(b"PK\x03\x04") {
        return Some(if ends(".3mf") {
            "is a 3MF file, which is not read; export the model as .stl, .obj or .glb"
        } else {
            "is a zip archive; unpack it and give the model in it"
        });
    }
    // Blender before version 3.0 compressed its files with gzip.
    (bytes.starts_with(b"\x1F\x8B") && ends(".blend")).then_some(BLENDER)
}

fn by_start(bytes: &[u8]) -> Option<&'static str> {
    let at = |offset: usize, magic: &[u8]| bytes.get(offset..).is_some_and(|rest| rest.starts_with(magic));
    let found = STARTS.iter().find(|(start, _)| bytes.starts_with(start)).map(|&(_, clause)| clause);
    found.or_else(|| {
        Some(if at(0, b"\x4D\x4D") && length_of_3ds(bytes) == Some(bytes.len()) {
            "is a 3DS file, which is not read; convert it to .glb"
        } else if at(0, b"FORM") && (at(8, b"LWO") || at(8, b"LXO")) {
            LIGHTWAVE
        } else if (at(0, b"RIFF") && at(8, b"WEBP")) || at(4, b"ftypavif") {
            IMAGE
        } else {
            return None;
        })
    })
}

/// The length that the first chunk of a 3DS file states, which is the length of the file.
fn length_of_3ds(bytes: &[u8]) -> Option<usize> {
    let length = bytes.get(2..6)?.first_chunk()?;
    usize::try_from(u32::from_le_bytes(*length)).ok()
}

/// Texts that may begin with white space and comments.
fn by_text(bytes: &[u8]) -> Option<&'static str> {
    let lower = bytes[..bytes.len().min(HEAD)].trim_ascii_start().to_ascii_lowercase();
    let starts = |start: &str| lower.starts_with(start.as_bytes());
    let has = |word: &str| lower.windows(word.len()).any(|window| window == word.as_bytes());
    Some(if starts("<!doctype html") || starts("<html") {
        "is a web page, so the download failed; download the model again"
    } else if starts("<") && has("<collada") {
        "is a COLLADA file, which is not read; convert it to .glb"
    } else if starts("<") && has("<x3d") {
        X3D
    } else if starts("<") && has("<materialx") {
        "is a MaterialX file, which has materials and no model; give the model"
    } else if starts("<?xml") {
        "is an XML file of a kind that is not read; export the model as .glb"
    } else if starts("//maya ascii") {
        MAYA
    } else if starts("0") && has("section") && first_word(bytes) == Some(b"0") {
        DXF
    } else if [&b"OFF"[..], b"COFF", b"NOFF", b"STOFF"].iter().any(|&word| first_word(bytes) == Some(word)) {
        OFF
    } else if first_word(bytes) == Some(b"newmtl") {
        "is a material library of an OBJ; give the .obj file"
    } else {
        return None;
    })
}

/// What is wrong with a file that begins as an STL, or is named so.
fn part_of_stl(bytes: &[u8], kind: Option<FileKind>) -> Option<String> {
    const CUT: &str = "is an STL that is cut off or counts its facets wrongly; export or download it again";
    let is_named = kind == Some(FileKind::Stl);
    let text = bytes.trim_ascii_start();
    let is_text = bytes[..bytes.len().min(HEAD)]
        .iter()
        .all(|&byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace());
    if is_text {
        let begins = text.starts_with(b"solid ") || text.starts_with(b"solid\n") || text == b"solid";
        return (begins || (is_named && text.starts_with(b"solid"))).then(|| {
            "is an STL that is cut off before its first facet; export or download it again".to_owned()
        });
    }
    if is_cut_stl(bytes) && !is_named {
        return Some(CUT.to_owned());
    }
    if !is_named {
        return None;
    }
    let count =
        bytes.get(80..84).and_then(|bytes| bytes.first_chunk()).map(|count| u32::from_le_bytes(*count));
    let header = &bytes[..bytes.len().min(84)];
    let is_control = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
    let is_text = header.iter().any(u8::is_ascii_alphabetic) && !header.iter().any(is_control);
    Some(match count {
        _ if is_text => unknown(kind),
        None => format!(
            "is named as STL and has {} bytes, fewer than the 84 of an STL's header; export or download it \
             again",
            bytes.len()
        ),
        Some(count) => format!(
            "is named as STL, whose header counts {count} facets, which take {} bytes, but there are {}; \
             export or download it again",
            84 + 50 * u64::from(count),
            bytes.len()
        ),
    })
}

/// A file whose first facet is one of a binary STL: numbers that are finite, not all zero, and a normal of
/// length 1 or 0. Its length is wrong, since [`detect`](super::format::detect) takes it otherwise.
fn is_cut_stl(bytes: &[u8]) -> bool {
    let Some(facet) = bytes.get(84..132) else { return false };
    let numbers: Vec<f64> =
        facet.as_chunks::<4>().0.iter().map(|bytes| f64::from(f32::from_le_bytes(*bytes))).collect();
    let length = numbers[..3].iter().map(|x| x * x).sum::<f64>().sqrt();
    let is_normal = length == 0.0 || (length - 1.0).abs() < 1e-3;
    let is_position = |x: &f64| *x == 0.0 || (1e-20..1e20).contains(&x.abs());
    is_normal && numbers[3..].iter().all(is_position) && numbers[3..].iter().any(|&x| x != 0.0)
}

/// A file that ends within the bytes with which a format that is read begins.
fn part_of_signature(bytes: &[u8]) -> Option<String> {
    let signatures: [(&[u8], &str); 4] = [
        (b"glTF", "a GLB"),
        (b"Kaydara FBX Binary", "an FBX"),
        (b"PXR-USDC", "a USD file"),
        (b"ply\n", "a PLY"),
    ];
    let (_, format) =
        signatures.into_iter().find(|(signature, _)| bytes.len() > 1 && signature.starts_with(bytes))?;
    Some(format!("is {format} that is cut off in its first bytes; export or download it again"))
}
