//! The files that the page holds, which this side asks for by name.

use std::io;

use darboux_io::Files;

/// The files beside the model. The page answers for the call that is running.
#[derive(Debug)]
pub struct PageFiles;

impl Files for PageFiles {
    fn has(&self, name: &str) -> bool {
        size(name).is_some()
    }

    fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        let size = size(name).ok_or(io::ErrorKind::NotFound)?;
        let mut bytes = vec![0; size];
        if read(name, &mut bytes) {
            Ok(bytes)
        } else {
            Err(io::Error::other("the browser does not give it; open it again"))
        }
    }
}

/// The size of a file; none where the page has none with this name.
#[cfg(target_family = "wasm")]
fn size(name: &str) -> Option<usize> {
    // SAFETY: the page reads the name only.
    let size = unsafe { page::file_size(name.as_ptr(), name.len()) };
    (size >= 0.0).then_some(size as usize)
}

/// Fills `bytes` with the content of a file of that size. Returns whether the page could read it.
#[cfg(target_family = "wasm")]
fn read(name: &str, bytes: &mut [u8]) -> bool {
    // SAFETY: the page reads the name and writes as many bytes as it has told that the file has.
    unsafe { page::read_file(name.as_ptr(), name.len(), bytes.as_mut_ptr()) != 0 }
}

#[cfg(target_family = "wasm")]
mod page {
    #[link(wasm_import_module = "page")]
    unsafe extern "C" {
        /// The size in bytes; -1 where there is no file with this name.
        pub fn file_size(name: *const u8, length: usize) -> f64;

        /// Writes the content to `bytes`. Returns 1, or 0 where it cannot be read.
        pub fn read_file(name: *const u8, length: usize, bytes: *mut u8) -> u32;
    }
}

/// There is no page outside of WebAssembly.
#[cfg(not(target_family = "wasm"))]
fn size(_name: &str) -> Option<usize> {
    None
}

#[cfg(not(target_family = "wasm"))]
fn read(_name: &str, _bytes: &mut [u8]) -> bool {
    false
}
