//! Reading models and writing glTF for the viewer's page, with the same code as the command.
//!
//! JavaScript writes a file name and a file into memory that this side owns, calls `check`, `repair` or
//! `make_normals`, and reads a text and a file. The files that the model refers to are asked for meanwhile
//! ([`page_files`]):
//!
//! ```text
//! p = name(n); q = file(m); memory[p ..] = ...; memory[q ..] = ...
//! if check() == 1 { JSON = memory[text() .. + text_len()]; glb = memory[made() .. + made_len()] } else { text() is the error }
//! ```

#![allow(unsafe_code, reason = "functions are exported under the names that JavaScript calls")]

mod page_files;

use std::cell::RefCell;
use std::mem::take;
use std::sync::Arc;

use darboux_io::gltf::{
    AddNormalsOptions, AddTangentsOptions, Document, PrimitiveInfo, add_normals, add_tangents, inspect,
};
use darboux_io::{Error, LoadOptions, OptionNames};

use page_files::PageFiles;

/// The inputs and outputs of a call.
#[derive(Default)]
struct Buffers {
    name: Vec<u8>,
    file: Vec<u8>,
    made: Vec<u8>,
    /// JSON, or the message of an error.
    text: Vec<u8>,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = RefCell::default();
}

/// What `check` says.
#[derive(serde::Serialize)]
struct Checked<'a> {
    primitives: &'a [PrimitiveInfo],
    /// What a model of another format than glTF lost.
    warnings: &'a [String],
    /// None for glTF.
    source: Option<Source>,
}

/// The words of a file of another format than glTF.
#[derive(serde::Serialize)]
struct Source {
    /// What importers of the format make of mistakes.
    importer_note: Option<&'static str>,
    /// The places of all primitives, such as `Armature/Body in your FBX`.
    places: Vec<SourcePlace>,
}

#[derive(serde::Serialize)]
struct SourcePlace {
    mesh: usize,
    primitive: usize,
    place: String,
}

impl Source {
    fn of(document: &Document, primitives: &[PrimitiveInfo]) -> Option<Self> {
        let provenance = document.provenance()?;
        let place = |info: &PrimitiveInfo| {
            let (mesh, primitive) = (info.name.mesh, info.name.primitive);
            Some(SourcePlace { mesh, primitive, place: provenance.place(mesh, primitive)? })
        };
        let places = primitives.iter().filter_map(place).collect();
        Some(Self { importer_note: provenance.format.importer_note(), places })
    }
}

/// Seeds the hash keys with 64 random bits, in two halves. The page calls this first, because WebAssembly
/// itself has no randomness.
#[cfg(target_family = "wasm")]
#[unsafe(no_mangle)]
pub extern "C" fn seed_random(low: u32, high: u32) {
    darboux::internal::seed_random(u64::from(low) | u64::from(high) << 32);
}

/// The address for a file name of `len` bytes.
#[unsafe(no_mangle)]
pub extern "C" fn name(len: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| resized(&mut buffers.name, len))
}

/// The address for a file of `len` bytes.
#[unsafe(no_mangle)]
pub extern "C" fn file(len: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| resized(&mut buffers.file, len))
}

/// Whether this is the smaller module of a page, and the start of the given file is not that of a glTF: the
/// larger module reads the other formats.
#[unsafe(no_mangle)]
pub extern "C" fn needs_larger_module() -> bool {
    const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";
    let is_gltf = |file: &[u8]| {
        let start = file.strip_prefix(BYTE_ORDER_MARK).unwrap_or(file).trim_ascii_start();
        start.starts_with(b"glTF") || start.starts_with(b"{")
    };
    !cfg!(feature = "larger") && BUFFERS.with_borrow(|buffers| !is_gltf(&buffers.file))
}

/// The address of the resulting file.
#[unsafe(no_mangle)]
pub extern "C" fn made() -> *const u8 {
    BUFFERS.with_borrow(|buffers| buffers.made.as_ptr())
}

/// The length of the resulting file.
#[unsafe(no_mangle)]
pub extern "C" fn made_len() -> usize {
    BUFFERS.with_borrow(|buffers| buffers.made.len())
}

/// The address of the resulting text.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    BUFFERS.with_borrow(|buffers| buffers.text.as_ptr())
}

/// The length of the resulting text.
#[unsafe(no_mangle)]
pub extern "C" fn text_len() -> usize {
    BUFFERS.with_borrow(|buffers| buffers.text.len())
}

/// Embeds the files that the model refers to, decodes compressed data, and checks the data that tangents
/// depend on. A model of another format becomes glTF. Returns 1 where the text is JSON about its primitives
/// and that change, and the resulting file is the one to show, and 0 where the text is an error.
#[unsafe(no_mangle)]
pub extern "C" fn check() -> u32 {
    run(|document| {
        let primitives = inspect(document)?;
        let warnings = if document.provenance().is_some() { document.warnings() } else { &[] };
        let source = Source::of(document, &primitives);
        let json = to_json(&Checked { primitives: &primitives, warnings, source });
        document.discard_compression();
        Ok((json, document.to_glb()?))
    })
}

/// Writes new tangents to every eligible primitive. Returns 1 where the text is a summary in JSON and the
/// resulting file is a GLB, and 0 where the text is an error.
#[unsafe(no_mangle)]
pub extern "C" fn repair() -> u32 {
    run(|document| {
        let options = AddTangentsOptions::default().with_overwrite(true);
        let summary = add_tangents(document, &options, &mut |_| {})?;
        Ok((to_json(&summary), document.to_glb()?))
    })
}

/// Makes smooth normals where a primitive has none. Returns 1 where the text is a summary in JSON and the
/// resulting file is a GLB, and 0 where the text is an error.
#[unsafe(no_mangle)]
pub extern "C" fn make_normals() -> u32 {
    run(|document| {
        let summary = add_normals(document, &AddNormalsOptions::default(), &mut |_| {})?;
        Ok((to_json(&summary), document.to_glb()?))
    })
}

/// Decodes the given texture file in KTX 2. Returns 1 where the text is its width and height in JSON and the
/// resulting file has its RGBA texels row by row, and 0 where the text is an error.
#[cfg(feature = "larger")]
#[unsafe(no_mangle)]
pub extern "C" fn decode_texture() -> u32 {
    use darboux_io::image::{DecodeLimits, RgbaImage};

    BUFFERS.with_borrow_mut(|buffers| {
        let file = take(&mut buffers.file);
        let limits = DecodeLimits::of_file(file.len(), LoadOptions::default().memory_limit);
        match RgbaImage::decode(&file, &limits) {
            Ok(RgbaImage { width, height, texels }) => {
                (buffers.text, buffers.made) = (to_json(&[width, height]), texels.into_flattened());
                1
            }
            Err(error) => {
                buffers.text = format!("the texture {error}").into_bytes();
                0
            }
        }
    })
}

/// Opens the given file, and stores the results of `work` or its error.
fn run(work: impl FnOnce(&mut Document) -> Result<(Vec<u8>, Vec<u8>), Error>) -> u32 {
    BUFFERS.with_borrow_mut(|buffers| {
        let name = String::from_utf8_lossy(&buffers.name).into_owned();
        let file = take(&mut buffers.file);
        let options = LoadOptions::default().with_option_names(OptionNames::of_command());
        let opened = Document::from_files(&name, file, Arc::new(PageFiles), &options);
        match opened.and_then(|mut document| work(&mut document)) {
            Ok((text, file)) => {
                (buffers.text, buffers.made) = (text, file);
                1
            }
            Err(error) => {
                buffers.text = error.to_string().into_bytes();
                0
            }
        }
    })
}

fn to_json(value: &impl serde::Serialize) -> Vec<u8> {
    // These structs have string keys only, so serialisation cannot fail.
    serde_json::to_vec(value).unwrap_or_default()
}

/// Clears an array, gives it a length, and returns its address.
fn resized(bytes: &mut Vec<u8>, len: usize) -> *mut u8 {
    bytes.clear();
    bytes.resize(len, 0);
    bytes.as_mut_ptr()
}
