//! Reads and writes glTF documents and images. Errors are one sentence each.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use darboux::Convention;
use darboux_io::gltf::Document;
use darboux_io::image::{PngImage, RgbaImage};
use darboux_io::{Error, FileKind, read_regular, system_reason};

use crate::batch::plan::Output;
use crate::batch::report::Status;
use crate::inputs::Input;
use crate::interrupt;
use crate::options::files::FileOptions;
use crate::options::reading::ReadOptions;
use crate::paths::{is_gltf, is_image, is_png, is_written_model};
use crate::terminal::write_stdout;
use crate::text::command_line;

/// An input that can be read several times: the content of standard input is kept.
pub struct Source<'a> {
    input: &'a Input,
    stdin: Option<Vec<u8>>,
}

impl<'a> Source<'a> {
    /// An input, whose content is read if it is standard input.
    pub fn new(input: &'a Input) -> Result<Self, String> {
        let stdin = match input {
            Input::Stdin => Some(read_stdin()?),
            Input::File(_) => None,
        };
        Ok(Self { input, stdin })
    }

    /// The bytes of an image; none for a model. The extension decides what a file is, and the first bytes of
    /// standard input. Errors: the file cannot be read.
    pub fn image(&self) -> Result<Option<Cow<'_, [u8]>>, String> {
        match (&self.stdin, self.input) {
            (Some(bytes), _) => Ok(RgbaImage::is_format_known(bytes).then_some(Cow::Borrowed(bytes))),
            (None, Input::File(path)) if is_image(path) || is_ktx2(path) => {
                read_regular(path).map(|bytes| Some(Cow::Owned(bytes))).map_err(|error| error.to_string())
            }
            (None, _) => Ok(None),
        }
    }

    /// As [`load`].
    pub fn load(&self, reading: &ReadOptions) -> Result<Document, String> {
        match &self.stdin {
            Some(bytes) => from_stdin(self.input, bytes.clone(), reading),
            None => load_any(self.input, reading),
        }
        .and_then(|document| in_gltf_convention(self.input, document))
    }
}

/// Reads a document and refuses one whose vertices are not in glTF's convention.
pub fn load(input: &Input, reading: &ReadOptions) -> Result<Document, String> {
    in_gltf_convention(input, load_any(input, reading)?)
}

/// As [`load`], with the warnings, which begin with the name of the file, because there are several models.
#[cfg(feature = "bake")]
pub fn load_with_warnings(
    path: &Path,
    reading: &ReadOptions,
    warnings: &mut Vec<String>,
) -> Result<Document, String> {
    let document = load(&Input::File(path.to_owned()), reading)?;
    warnings.extend(document.warnings().iter().map(|warning| format!("{}: {warning}", document.name())));
    Ok(document)
}

fn in_gltf_convention(input: &Input, document: Document) -> Result<Document, String> {
    let convention = document.convention().map_err(|error| error.to_string())?;
    if convention == Convention::GLTF {
        return Ok(document);
    }
    let (name, from) = (input.to_string(), convention.to_string());
    let names: Vec<&str> = convention.names().skip(1).collect();
    let names = if names.is_empty() { String::new() } else { format!(" (also called {})", names.join(", ")) };
    let repair = command_line(&["convert", "--from", &from, "--to", "gltf"], &[&name]);
    Err(format!("{name}: its vertices are in the convention {from}{names}; first run: {repair}"))
}

/// Reads a document in any convention. Standard input has no folder, so its buffers must be embedded.
pub fn load_any(input: &Input, reading: &ReadOptions) -> Result<Document, String> {
    match input {
        Input::File(path) if path.is_file() && is_other_image(path) => Err(format!(
            "{input}: is an image in a format that is not read here; save it as .png (8 or 16 bits), .jpg, \
             .webp or .tga, and darboux check judges it as a normal map"
        )),
        Input::File(path) => reading.open(path).map_err(|error| error.to_string()),
        Input::Stdin => from_stdin(input, read_stdin()?, reading),
    }
}

fn from_stdin(input: &Input, bytes: Vec<u8>, reading: &ReadOptions) -> Result<Document, String> {
    let document = Document::from_bytes(&input.to_string(), bytes, None, &reading.load_options());
    document.map_err(|error| error.to_string())
}

/// Whether a path has the extension of a KTX 2 file, and this command was built with its decoder.
fn is_ktx2(path: &Path) -> bool {
    cfg!(feature = "ktx2") && has_extension(path, &["ktx2"])
}

/// Whether a path has the extension of an image without a decoder.
fn is_other_image(path: &Path) -> bool {
    const OTHERS: [&str; 13] =
        ["avif", "bmp", "dds", "exr", "gif", "hdr", "jxl", "ktx", "ktx2", "psd", "tif", "tiff", "xcf"];
    has_extension(path, &OTHERS) && !is_ktx2(path)
}

fn has_extension(path: &Path, extensions: &[&str]) -> bool {
    let is_any = |extension: &OsStr| extensions.iter().any(|other| extension.eq_ignore_ascii_case(other));
    path.extension().is_some_and(is_any)
}

/// Reads all of standard input.
pub fn read_stdin() -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = io::stdin().lock().read_to_end(&mut bytes);
    read.map(|_| bytes)
        .map_err(|error| format!("{}: cannot be read: {}", Input::Stdin, system_reason(&error)))
}

/// Writes a document and returns its status and the files written. `changed`: whether the command changed the
/// document.
pub fn save(
    document: &Document,
    output: &Output,
    files: &FileOptions,
    changed: bool,
) -> Result<(Status, Vec<String>), String> {
    let sentence = |error: Error| error.to_string();
    let is_copy = !changed && document.provenance().is_none() && !is_exchange(output);
    let status = if is_copy { Status::Copied } else { Status::Written };
    let path = match output {
        Output::Stdout => {
            return match document.write_glb(Path::new(&output.to_string()), io::stdout().lock()) {
                // A closed pipe is not an error: its reader has read enough.
                Err(Error::Write { source, .. }) if source.kind() == ErrorKind::BrokenPipe => {
                    Ok((status, Vec::new()))
                }
                written => written.map(|()| (status, Vec::new())).map_err(sentence),
            };
        }
        Output::File(path) => path,
    };
    let _guard = interrupt::writing();
    let written = match files.in_place {
        true => document.save_in_place(),
        false => document.save(path, &files.save_options()),
    };
    let written: Vec<String> =
        written.map_err(sentence)?.iter().map(|path| path.display().to_string()).collect();
    let untouched = files.in_place && written.is_empty();
    Ok((if untouched { Status::Untouched } else { status }, written))
}

/// Whether an output is a model of another format than glTF.
fn is_exchange(output: &Output) -> bool {
    matches!(output, Output::File(path) if !is_gltf(path) && is_written_model(path))
}

/// The warning about what an output does not hold of a document, if there is anything.
pub fn left_out(document: &Document, output: &Output) -> Result<Option<String>, String> {
    let Output::File(path) = output else { return Ok(None) };
    let Some(kind) = FileKind::of(path) else { return Ok(None) };
    let phrases = document.left_out(kind).map_err(|error| error.to_string())?;
    Ok((!phrases.is_empty()).then(|| format!("{output} leaves out: {}", phrases.join("; "))))
}

/// Writes an image and returns its status and the files written.
pub fn save_image(
    image: &PngImage,
    output: &Output,
    files: &FileOptions,
) -> Result<(Status, Vec<String>), String> {
    let sentence = |error: Error| error.to_string();
    let status = if image.is_changed() { Status::Written } else { Status::Copied };
    match output {
        Output::Stdout => {
            let bytes = image.to_bytes().map_err(sentence)?;
            write_stdout(&bytes)
                .map_err(|error| format!("{output}: cannot be written: {}", system_reason(&error)))?;
            Ok((status, Vec::new()))
        }
        Output::File(path) if !is_png(path) => {
            Err(format!("{output}: the input is an image; the name of the output must end in .png"))
        }
        Output::File(_) if files.in_place && !image.is_changed() => Ok((Status::Untouched, Vec::new())),
        Output::File(path) => {
            let _guard = interrupt::writing();
            let written = image.save(path, &files.save_options()).map_err(sentence)?;
            Ok((status, vec![written.display().to_string()]))
        }
    }
}

/// Refuses to write a picture over a file that the inputs use.
pub fn refuse_used(path: &Path, documents: [&Document; 2]) -> Result<(), String> {
    match documents.into_iter().find(|document| document.uses_file(path)) {
        Some(document) => {
            Err(format!("{}: is used by {}; choose another name", path.display(), document.name()))
        }
        None => Ok(()),
    }
}
