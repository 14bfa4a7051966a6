//! Which format a file has. The content decides, not the name's ending.

/// A format of models other than glTF.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SourceFormat {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY.
    Ply,
    /// STL, ASCII or binary.
    Stl,
    /// Autodesk FBX.
    Fbx,
    /// Universal Scene Description: USDA, USDC, USDZ.
    Usd,
}

impl SourceFormat {
    /// The name, such as `OBJ`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Fbx => "FBX",
            Self::Usd => "USD",
        }
    }
}

/// The start of a file that is enough to recognise its format.
const HEAD: usize = 4096;

/// A text without the byte order mark of UTF-8 at its start.
pub fn without_byte_order_mark(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(text)
}

/// The format of a file without a byte order mark; none for glTF and for what is not recognised.
pub fn detect(bytes: &[u8]) -> Option<SourceFormat> {
    let head = &bytes[..bytes.len().min(HEAD)];
    let text = head.trim_ascii_start();
    if head.starts_with(b"Kaydara FBX Binary") || is_ascii_fbx(text) {
        return Some(SourceFormat::Fbx);
    }
    if head.starts_with(b"PXR-USDC") || text.starts_with(b"#usda") || is_usdz(head) {
        return Some(SourceFormat::Usd);
    }
    if head.starts_with(b"ply\n") || head.starts_with(b"ply\r") {
        return Some(SourceFormat::Ply);
    }
    if is_stl(bytes, text) {
        return Some(SourceFormat::Stl);
    }
    is_obj(bytes).then_some(SourceFormat::Obj)
}

/// A text that says so in its first comment, or whose first statement is FBX's.
fn is_ascii_fbx(text: &[u8]) -> bool {
    let lines = text.split(|&byte| byte == b'\n' || byte == b'\r').map(<[u8]>::trim_ascii);
    let mut statements = lines.filter(|line| !line.is_empty() && !line.starts_with(b";"));
    text.starts_with(b"; FBX")
        || statements.next().is_some_and(|line| line.starts_with(b"FBXHeaderExtension"))
}

/// A zip archive whose first member is a stage of USD.
fn is_usdz(head: &[u8]) -> bool {
    let length = head.get(26..28).map_or(0, |bytes| usize::from(u16::from_le_bytes([bytes[0], bytes[1]])));
    let name = head.get(30..30 + length).unwrap_or_default().to_ascii_lowercase();
    head.starts_with(b"PK\x03\x04")
        && [&b".usdc"[..], b".usda", b".usd"].iter().any(|end| name.ends_with(end))
}

/// The length of a binary STL follows from its number of triangles. An ASCII STL begins with `solid` and has
/// a `facet`.
fn is_stl(bytes: &[u8], text: &[u8]) -> bool {
    let count = bytes.get(80..84).and_then(|bytes| bytes.first_chunk());
    let is_binary = count.is_some_and(|count| {
        let length = 84 + 50 * u64::from(u32::from_le_bytes(*count));
        length == bytes.len() as u64
    });
    let has_word = |word: &[u8]| text.windows(word.len()).any(|window| window == word);
    is_binary || (text.starts_with(b"solid") && (has_word(b"facet") || has_word(b"endsolid")))
}

/// A file whose first facet is one of a binary STL: numbers that are finite, not all zero, and a normal of
/// length 1 or 0. Its length is wrong, since [`detect`] takes it otherwise.
fn is_cut_stl(bytes: &[u8]) -> bool {
    let Some(facet) = bytes.get(84..132) else { return false };
    let numbers: Vec<f64> =
        facet.as_chunks::<4>().0.iter().map(|bytes| f64::from(f32::from_le_bytes(*bytes))).collect();
    let length = numbers[..3].iter().map(|x| x * x).sum::<f64>().sqrt();
    let is_normal = length == 0.0 || (length - 1.0).abs() < 1e-3;
    let is_position = |x: &f64| *x == 0.0 || (1e-20..1e20).contains(&x.abs());
    is_normal && numbers[3..].iter().all(is_position) && numbers[3..].iter().any(|&x| x != 0.0)
}

/// The first words of statements that only an OBJ has.
const STATEMENTS: [&[u8]; 12] =
    [b"v", b"vt", b"vn", b"vp", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl", b"l", b"p"];

/// A text whose first statement is one of OBJ.
fn is_obj(bytes: &[u8]) -> bool {
    first_word(bytes).is_some_and(|word| STATEMENTS.contains(&word))
}

/// The first word of a text that is not in a comment.
fn first_word(bytes: &[u8]) -> Option<&[u8]> {
    let lines = bytes.split(|&byte| byte == b'\n' || byte == b'\r').map(<[u8]>::trim_ascii);
    let mut statements = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    statements.next().and_then(|line| line.split(u8::is_ascii_whitespace).next())
}

/// What a file is that no reader takes: a clause whose subject is the file, with what to do.
pub fn name_of_other(bytes: &[u8]) -> Option<&'static str> {
    let text = bytes[..bytes.len().min(HEAD)].trim_ascii_start();
    let lower = text[..text.len().min(256)].to_ascii_lowercase();
    let at = |offset: usize, magic: &[u8]| bytes.get(offset..).is_some_and(|rest| rest.starts_with(magic));
    let starts = |start: &[u8]| lower.starts_with(start);
    Some(if at(0, b"BLENDER") || at(0, b"\x28\xB5\x2F\xFD") {
        "is a Blender file; export the model from Blender as .glb"
    } else if at(0, b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1") {
        "is a scene of 3ds Max or another file of that container; export the model as .fbx or .glb"
    } else if at(0, b"\x4D\x4D") && bytes.len() > 6 && !at(2, b"\x00\x2A") {
        "is a 3DS file, which is not read; convert it to .glb"
    } else if at(0, b"PK\x03\x04") {
        "is a zip archive; unpack it and give the model in it"
    } else if at(0, b"\x1F\x8B") {
        "is compressed with gzip; unpack it first"
    } else if at(0, b"Rar!") || at(0, b"7z\xBC\xAF\x27\x1C") {
        "is an archive; unpack it and give the model in it"
    } else if starts(b"<!doctype html") || starts(b"<html") {
        "is a web page, so the download failed; download the model again"
    } else if starts(b"<?xml") && lower.windows(7).any(|window| window == b"collada") {
        "is a COLLADA file, which is not read; convert it to .glb"
    } else if starts(b"version https://git-lfs") {
        "is a pointer of Git LFS, not the model; run: git lfs pull"
    } else if starts(b"//maya ascii") || at(0, b"FOR4") || at(0, b"FOR8") {
        "is a scene of Maya; export the model as .fbx or .glb"
    } else if at(0, b"Ogawa") {
        "is an Alembic file, which is not read; export the model as .glb"
    } else if first_word(bytes) == Some(b"newmtl") {
        "is a material library of an OBJ; give the .obj file"
    } else if at(0, b"\x89PNG") || at(0, b"\xFF\xD8\xFF") || (at(0, b"RIFF") && at(8, b"WEBP")) {
        "is an image, not a model; give the model"
    } else if at(0, b"\xFF\xFE") || at(0, b"\xFE\xFF") {
        "is a text in UTF-16, which is not read; save it in UTF-8"
    } else if at(0, b"%PDF") {
        "is a PDF, not a model; give the model"
    } else if is_cut_stl(bytes) {
        "is an STL that is cut off or counts its facets wrongly; export or download it again"
    } else {
        return None;
    })
}
