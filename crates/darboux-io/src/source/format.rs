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
    /// The format of a file by its content; none for glTF and for what is not recognised.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        detect(without_byte_order_mark(bytes))
    }

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

    /// What importers of the format make of mistakes in a file: a sentence, where that differs from glTF.
    pub fn importer_note(self) -> Option<&'static str> {
        match self {
            Self::Fbx => Some(
                "An importer of FBX that computes tangents itself, as Unreal and Unity do by default, meets \
                 what is wrong with positions, normals and UVs, but not what is wrong with tangents.",
            ),
            Self::Obj => Some(
                "OBJ has no tangents: every importer computes its own from these positions, normals and UVs.",
            ),
            Self::Ply | Self::Stl | Self::Usd => None,
        }
    }
}

/// The start of a file that is enough to recognise its format.
pub const HEAD: usize = 4096;

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

/// The first words of statements that only an OBJ has.
const STATEMENTS: [&[u8]; 21] = [
    b"v",
    b"vt",
    b"vn",
    b"vp",
    b"f",
    b"o",
    b"g",
    b"s",
    b"mtllib",
    b"usemtl",
    b"l",
    b"p",
    b"mg",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"maplib",
    b"usemap",
    b"shadow_obj",
    b"trace_obj",
];

/// A text whose first statement is one of OBJ.
fn is_obj(bytes: &[u8]) -> bool {
    first_word(bytes).is_some_and(|word| STATEMENTS.contains(&word))
}

/// The first word of a text that is not in a comment.
pub fn first_word(bytes: &[u8]) -> Option<&[u8]> {
    let lines = bytes.split(|&byte| byte == b'\n' || byte == b'\r').map(<[u8]>::trim_ascii);
    let mut statements = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#"));
    statements.next().and_then(|line| line.split(u8::is_ascii_whitespace).next())
}
