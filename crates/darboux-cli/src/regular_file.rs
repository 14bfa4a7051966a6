//! Opens regular files only, so that a FIFO, device or socket in a file's place cannot block the command.

use std::fs::{File, OpenOptions};
use std::io::{self, Error, ErrorKind};
use std::path::Path;

/// Whether a symbolic link may stand in a file's place.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Links {
    Follow,
    Refuse,
}

/// Opens `path` with these options and without waiting for the other end of a FIFO.
///
/// Errors: the system refuses; the path is not a regular file.
pub fn open_regular(path: &Path, options: &mut OpenOptions, links: Links) -> io::Result<File> {
    prepare(path, options, links)?;
    let file = options.open(path)?;
    if file.metadata()?.is_file() { Ok(file) } else { Err(irregular()) }
}

fn irregular() -> Error {
    Error::new(ErrorKind::InvalidInput, "it is not a regular file")
}

#[cfg(unix)]
fn prepare(_: &Path, options: &mut OpenOptions, links: Links) -> io::Result<()> {
    use std::os::unix::fs::OpenOptionsExt;

    let refuse_links = if links == Links::Refuse { libc::O_NOFOLLOW } else { 0 };
    options.custom_flags(refuse_links | libc::O_NONBLOCK);
    Ok(())
}

#[cfg(not(unix))]
fn prepare(path: &Path, _: &mut OpenOptions, links: Links) -> io::Result<()> {
    match path.symlink_metadata() {
        Ok(metadata) if links == Links::Refuse && !metadata.is_file() => Err(irregular()),
        _ => Ok(()),
    }
}
