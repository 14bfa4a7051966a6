//! Parses an FBX with ufbx, within a memory limit, and words its errors and warnings.

use memchr::memchr;
use ufbx::{
    AllocatorOpts, ErrorType, FileFormat, GeometryTransformHandling, InheritModeHandling, LoadOpts,
    SceneRoot, WarningType,
};

use crate::error::ContentError;
use crate::memory_limit::Budget;

const CUT_OFF: &str = "is cut off; copy or export it again";

/// How deep nodes may be nested. Real scenes have fewer than a hundred levels.
const MAX_DEPTH: u32 = 500;

/// The versions whose files were tested. Others are read with a warning.
const KNOWN_VERSIONS: std::ops::RangeInclusive<u32> = 6100..=7700;

/// The scene of a file, in its own units and axes. Missing normals are made by smoothing groups.
///
/// `budget` is shared by ufbx's result, ufbx's temporary memory, and what is made of them. Errors: bytes that
/// are no FBX, or a truncated or broken one; a scene that needs more memory.
pub fn load(bytes: &[u8], budget: &Budget) -> Result<SceneRoot, ContentError> {
    // A limit of 0 means none to ufbx.
    let limit = || AllocatorOpts { memory_limit: (budget.bytes / 3).max(1), ..AllocatorOpts::default() };
    let options = LoadOpts {
        temp_allocator: limit(),
        result_allocator: limit(),
        file_format: FileFormat::Fbx,
        ignore_animation: true,
        clean_skin_weights: true,
        use_blender_pbr_material: true,
        generate_missing_normals: true,
        retain_vertex_attrib_w: true,
        node_depth_limit: MAX_DEPTH,
        // glTF has one transform per node, without pivots, and children inherit all of it.
        geometry_transform_handling: GeometryTransformHandling::HelperNodes,
        inherit_mode_handling: InheritModeHandling::HelperNodes,
        ..LoadOpts::default()
    };
    let invalid = |problem: &str| ContentError::invalid("", problem);
    let loaded = ufbx::load_memory(bytes, options).map_err(|error| match error.type_ {
        _ if ends_early(bytes) => invalid(CUT_OFF),
        ErrorType::EmptyFile => invalid("is empty; export it again"),
        ErrorType::UnrecognizedFileFormat => invalid("is not an FBX file; check what it is"),
        ErrorType::TruncatedFile | ErrorType::Io => invalid(CUT_OFF),
        ErrorType::MemoryLimit | ErrorType::AllocationLimit | ErrorType::OutOfMemory => {
            ContentError::unsupported("", budget.exceeded("the scene needs"))
        }
        ErrorType::NodeDepthLimit => {
            invalid(&format!("has nodes nested more than {MAX_DEPTH} levels deep; flatten its hierarchy"))
        }
        ErrorType::UnsupportedVersion => ContentError::unsupported(
            "",
            format!(
                "has a version of FBX that cannot be read{}; export it as FBX 7.4 (2014)",
                version(error.info())
            ),
        ),
        _ => invalid(&format!("is not a valid FBX ({}); export it again", &*error.description)),
    })?;
    // ufbx itself refuses a binary file that is cut off.
    if loaded.metadata.ascii && ends_early(bytes) {
        return Err(invalid(CUT_OFF));
    }
    Ok(loaded)
}

/// Whether a file is cut off. ufbx does not always say so: it accepts an ASCII file that lacks its last
/// braces, and calls compressed numbers that end early broken.
fn ends_early(bytes: &[u8]) -> bool {
    match bytes.strip_prefix(b"Kaydara FBX Binary") {
        // The last byte is 0 where numbers are little-endian.
        Some(rest) => rest.starts_with(b"  \0\x1A\0") && binary_ends_early(bytes),
        None => text_ends_early(bytes),
    }
}

/// Whether a top-level node of a binary file ends after the end of the file. After the header of 27 bytes,
/// whose last four are the version, each node begins with the offset of its end; a node of zeros ends the
/// list.
fn binary_ends_early(bytes: &[u8]) -> bool {
    const HEADER: usize = 27;
    let number = |place: usize, size: usize| {
        let bytes = bytes.get(place..)?.get(..size)?;
        let digits = bytes.iter().rev();
        Some(digits.fold(0_u64, |number, &byte| number << 8 | u64::from(byte)))
    };
    let Some(version) = number(HEADER - 4, 4) else { return true };
    // The offset, the number of properties, their length, and the length of the name, which follows.
    let size = if version >= 7500 { 8 } else { 4 };
    let least = 3 * size + 1;
    let mut place = HEADER;
    while place < bytes.len() {
        let Some(end) = number(place, size).map(|end| usize::try_from(end).unwrap_or(usize::MAX)) else {
            return true;
        };
        if end < place + least {
            return false;
        }
        if end > bytes.len() {
            // The node's name tells a file that is cut off from one whose offsets are damaged.
            let name = bytes.get(place + least..).unwrap_or_default();
            let length = bytes.get(place + least - 1).map_or(0, |&length| usize::from(length));
            return name.iter().take(length).all(u8::is_ascii_alphanumeric);
        }
        place = end;
    }
    place == HEADER
}

/// Whether an ASCII file ends inside of a block or a string.
fn text_ends_early(text: &[u8]) -> bool {
    let mut open_blocks = 0_usize;
    let mut rest = text;
    while let Some(place) = rest.iter().position(|byte| b"\"{};".contains(byte)) {
        let (byte, after) = (rest[place], &rest[place + 1..]);
        rest = match byte {
            b'{' | b'}' => {
                open_blocks = if byte == b'{' { open_blocks + 1 } else { open_blocks.saturating_sub(1) };
                after
            }
            b'"' => match memchr(b'"', after) {
                Some(end) => &after[end + 1..],
                None => return true,
            },
            _ => memchr(b'\n', after).map_or(&[][..], |end| &after[end..]),
        };
    }
    open_blocks > 0
}

/// The version in an error's details, as a clause in brackets.
fn version(details: &str) -> String {
    if details.is_empty() { String::new() } else { format!(" ({details})") }
}

/// One sentence for each kind of damage that was repaired while the file was read, and for a version that was
/// not tested.
pub fn warnings(scene: &ufbx::Scene) -> Vec<String> {
    let version = scene.metadata.version;
    let mut sentences = Vec::new();
    if !KNOWN_VERSIONS.contains(&version) {
        sentences.push(format!(
            "the file has FBX version {version}; readers are tested with {} to {}, so compare the result \
             with the original",
            KNOWN_VERSIONS.start(),
            KNOWN_VERSIONS.end()
        ));
    }
    for warning in &scene.metadata.warnings {
        let what = match warning.type_ {
            WarningType::TruncatedArray => "the file is damaged: arrays end early and were filled up",
            WarningType::MissingGeometryData => "the file is damaged: meshes lack a part of their data",
            WarningType::IndexClamped => "the file is damaged: indices out of range were clamped",
            WarningType::DuplicateObjectId => {
                "two objects have the same id, so that materials, bones or textures may belong to another \
                 object"
            }
            WarningType::BadBase64Content => "an embedded texture cannot be decoded and is left out",
            WarningType::DuplicateConnection => "objects are connected twice; the first connection counts",
            WarningType::BadUnicode => "names are not valid UTF-8; unreadable characters were replaced",
            // An unsupported version was named above; the others concern nothing that is read.
            _ => continue,
        };
        let times = if warning.count > 1 { format!(" ({} times)", warning.count) } else { String::new() };
        sentences.push(format!("{what}{times}"));
    }
    sentences
}
