//! Reads and writes glTF documents. Errors are one sentence each.

use std::io::{self, ErrorKind, Read};
use std::path::Path;

use darboux::Convention;
use darboux_io::Error;
use darboux_io::gltf::Document;

use crate::batch::plan::Output;
use crate::batch::report::Status;
use crate::inputs::Input;
use crate::interrupt;
use crate::options::files::FileOptions;
use crate::options::reading::ReadOptions;
use crate::text::command_line;

/// Reads a document and refuses one whose vertices are not in glTF's convention.
pub fn load(input: &Input, reading: &ReadOptions) -> Result<Document, String> {
    let document = load_any(input, reading)?;
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
    let document = match input {
        Input::File(path) if path.is_file() && is_other_format(path) => {
            return Err(format!(
                "{input}: this command reads glTF files only; export the model as .glb (darboux view and darboux render also read OBJ)"
            ));
        }
        Input::File(path) => reading.open(path),
        Input::Stdin => {
            Document::from_bytes(&input.to_string(), read_stdin()?, None, &reading.load_options())
        }
    };
    document.map_err(|error| error.to_string())
}

/// Whether the extension is that of a model format other than glTF.
fn is_other_format(path: &Path) -> bool {
    const OTHERS: [&str; 12] =
        ["3ds", "abc", "blend", "dae", "fbx", "obj", "ply", "stl", "usd", "usda", "usdc", "usdz"];
    path.extension().is_some_and(|extension| OTHERS.iter().any(|other| extension.eq_ignore_ascii_case(other)))
}

/// Reads all of standard input.
pub fn read_stdin() -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = io::stdin().lock().read_to_end(&mut bytes);
    read.map(|_| bytes).map_err(|error| format!("{}: cannot be read: {error}", Input::Stdin))
}

/// Writes a document and returns its status and the files written. `changed`: whether the command changed the document.
pub fn save(
    document: &Document,
    output: &Output,
    files: &FileOptions,
    changed: bool,
) -> Result<(Status, Vec<String>), String> {
    let sentence = |error: Error| error.to_string();
    let status = if changed { Status::Written } else { Status::Copied };
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

/// Refuses to write a picture over a file that the inputs use.
pub fn refuse_used(path: &Path, documents: [&Document; 2]) -> Result<(), String> {
    match documents.into_iter().find(|document| document.uses_file(path)) {
        Some(document) => {
            Err(format!("{}: is used by {}; choose another name", path.display(), document.name()))
        }
        None => Ok(()),
    }
}
