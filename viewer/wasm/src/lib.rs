//! Files in the viewer's page: checked as they are opened, and written with new tangents, as the command does it.
//!
//! The page writes a name and a file into memory that this side owns, calls, and reads the text and the file that came out.

#![allow(unsafe_code, reason = "functions are exported under the names that JavaScript calls")]

use std::cell::RefCell;
use std::mem::take;

use darboux_io::Error;
use darboux_io::gltf::{Document, LoadOptions, TangentsOptions, add_tangents, inspect};

/// What goes in and what comes out.
#[derive(Default)]
struct Room {
    name: Vec<u8>,
    file: Vec<u8>,
    made: Vec<u8>,
    /// JSON, or the sentence that says what is wrong.
    text: Vec<u8>,
}

thread_local! {
    static ROOM: RefCell<Room> = RefCell::default();
}

/// Where a name of so many bytes goes.
#[unsafe(no_mangle)]
pub extern "C" fn name(len: usize) -> *mut u8 {
    ROOM.with_borrow_mut(|room| sized(&mut room.name, len))
}

/// Where a file of so many bytes goes.
#[unsafe(no_mangle)]
pub extern "C" fn file(len: usize) -> *mut u8 {
    ROOM.with_borrow_mut(|room| sized(&mut room.file, len))
}

/// Where the file that came out lies.
#[unsafe(no_mangle)]
pub extern "C" fn made() -> *const u8 {
    ROOM.with_borrow(|room| room.made.as_ptr())
}

/// Its length.
#[unsafe(no_mangle)]
pub extern "C" fn made_len() -> usize {
    ROOM.with_borrow(|room| room.made.len())
}

/// Where the text that came out lies.
#[unsafe(no_mangle)]
pub extern "C" fn text() -> *const u8 {
    ROOM.with_borrow(|room| room.text.as_ptr())
}

/// Its length.
#[unsafe(no_mangle)]
pub extern "C" fn text_len() -> usize {
    ROOM.with_borrow(|room| room.text.len())
}

/// Reads all that tangents need of a file, and decompresses it. 1: the text lists its primitives, and the file that came out is the
/// one to show; 0: the text says what is wrong.
#[unsafe(no_mangle)]
pub extern "C" fn check() -> u32 {
    run(|document| {
        document.decompress()?;
        let primitives = inspect(document)?;
        Ok((to_json(&primitives), document.to_glb()?))
    })
}

/// Gives every primitive that can have them new tangents. 1: the text tells what was done, and the file that came out is a GLB; 0: the
/// text says what is wrong.
#[unsafe(no_mangle)]
pub extern "C" fn repair() -> u32 {
    run(|document| {
        let options = TangentsOptions { overwrite: true, ..TangentsOptions::default() };
        let summary = add_tangents(document, &options, &mut |_| {})?;
        Ok((to_json(&summary), document.to_glb()?))
    })
}

/// Opens the file that was given; what comes of it goes where the page reads it.
fn run(work: impl FnOnce(&mut Document) -> Result<(Vec<u8>, Vec<u8>), Error>) -> u32 {
    ROOM.with_borrow_mut(|room| {
        let name = String::from_utf8_lossy(&room.name).into_owned();
        let opened = Document::from_bytes(&name, take(&mut room.file), None, &LoadOptions::default());
        match opened.and_then(|mut document| work(&mut document)) {
            Ok((text, file)) => {
                (room.text, room.made) = (text, file);
                1
            }
            Err(error) => {
                room.text = error.to_string().into_bytes();
                0
            }
        }
    })
}

fn to_json(value: &impl serde::Serialize) -> Vec<u8> {
    // Numbers, names and sentences: nothing that JSON could refuse.
    serde_json::to_vec(value).unwrap_or_default()
}

fn sized(bytes: &mut Vec<u8>, len: usize) -> *mut u8 {
    bytes.clear();
    bytes.resize(len, 0);
    bytes.as_mut_ptr()
}
