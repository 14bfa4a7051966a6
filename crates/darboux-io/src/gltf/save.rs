//! Writing: every file beside its target first, then all of them renamed, the document last.

use std::collections::{HashMap, HashSet};
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::container::glb;
use super::document::{BufferSource, Document};
use super::file_bytes::FileBytes;
use super::output_layout::{BinaryOutput, OutputLayout};
use super::resources::{LocatedFile, UriTarget, encode_path};
use super::segments::{self, Segment};
use crate::error::Fault;
use crate::staging::Staging;
use crate::{Error, FileKind, SaveOptions, paths};

impl Document {
    /// The document as a GLB that holds all its buffers and images, but for remote and missing ones.
    ///
    /// Without edits, and with nothing to embed, a GLB is given back byte for byte. Errors: more than 4 GiB; files that cannot
    /// be read.
    pub fn to_glb(&self) -> Result<Vec<u8>, Error> {
        Ok(segments::joined(&self.glb_pieces()?))
    }

    /// Writes what [`Document::to_glb`] gives, without putting it together in memory.
    ///
    /// Errors: as [`Document::to_glb`], before anything is written; [`Error::Write`] about `name`, where `out` refuses.
    pub fn write_glb(&self, name: &Path, out: impl Write) -> Result<(), Error> {
        segments::write(&self.glb_pieces()?, out)
            .map_err(|source| Error::Write { file: name.to_owned(), source })
    }

    /// Writes the document and, for a `.gltf`, the files that it needs; gives the files written, the document last.
    ///
    /// The extension decides the container: `.glb` (or `.vrm`) or `.gltf`. New data of a `.gltf` goes to a fresh file; existing
    /// files are never changed, but a file with the same content is used again. Missing folders are made. Errors: an existing
    /// output without [`SaveOptions::force`]; the input, or a file that it uses, as output; a GLB's chunks of unknown type in a
    /// `.gltf`. After an error nothing is left behind.
    pub fn save(&self, path: &Path, options: &SaveOptions) -> Result<Vec<PathBuf>, Error> {
        let is_glb = is_glb(path)?;
        let target = self.checked_target(path, options)?;
        self.write(&target, is_glb, options)
    }

    /// Replaces the input file, keeping its container and permissions; gives the files written, none when there are no edits.
    ///
    /// Errors: as [`Document::save`]; a document that was not read from a file; an input that is gone.
    pub fn save_in_place(&self) -> Result<Vec<PathBuf>, Error> {
        let input = self.input.as_ref().ok_or_else(|| Error::Output {
            file: self.name().into(),
            problem: "was not read from a file; name an output".into(),
        })?;
        if !self.is_changed() {
            return Ok(Vec::new());
        }
        let metadata = fs::metadata(input).map_err(|source| Error::Write { file: input.clone(), source })?;
        paths::refuse_read_only(Path::new(self.name()), &metadata)?;
        self.write(input, self.container.is_glb, &SaveOptions { force: true, run: None })
    }

    /// The file of a buffer that an earlier run made for new data: edited, the document gets another in its place. The file itself
    /// stays: other models, wherever they are, can use it.
    pub(super) fn replaced_file(&self, buffer: usize) -> Option<&LocatedFile> {
        match (self.root.buffers.get(buffer), self.buffer_sources.get(buffer)) {
            (Some(buffer), Some(BufferSource::File(file))) if buffer.is_ours() && self.is_changed() => {
                Some(&file.located)
            }
            _ => None,
        }
    }

    /// The file to write: `path`, or what it links to.
    fn checked_target(&self, path: &Path, options: &SaveOptions) -> Result<PathBuf, Error> {
        paths::writable(path, options.force, |target| {
            if self.input.as_deref() == Some(target) {
                Some("is the input; name another output or write in place")
            } else {
                self.uses(target).then_some("is a file that the input uses; name another output")
            }
        })
    }

    /// Whether a file, links resolved, is the one that was read, or one that it refers to.
    pub fn uses_file(&self, path: &Path) -> bool {
        path.canonicalize().is_ok_and(|path| self.input.as_ref() == Some(&path) || self.uses(&path))
    }

    fn uses(&self, resolved: &Path) -> bool {
        self.files().iter().any(|file| file.path == resolved)
    }

    fn write(&self, target: &Path, is_glb: bool, options: &SaveOptions) -> Result<Vec<PathBuf>, Error> {
        let mut staging = Staging::of_run(options.run);
        let segments = if is_glb { self.glb_pieces()? } else { self.stage_gltf(target, &mut staging)? };
        staging.stage(target, options.force, |file| segments::write(&segments, file))?;
        staging.commit()
    }

    fn glb_pieces(&self) -> Result<Vec<Segment<'_>>, Error> {
        if self.container.is_glb && !self.is_changed() && self.files().is_empty() {
            return Ok(vec![Segment::Borrowed(&self.file)]);
        }
        let chunks =
            self.container.other_chunks.iter().map(|(kind, range)| (*kind, &self.file[range.clone()]));
        let segments = || {
            let mut layout = OutputLayout::glb(self)?;
            let json = layout.json(&[], &HashMap::new())?;
            glb(json, layout.binaries.pop().map(|binary| binary.segments), chunks.collect())
        };
        segments().map_err(|fault| fault.in_file(self.name()))
    }

    /// Stages what a `.gltf` needs beside it; gives its text.
    fn stage_gltf(&self, target: &Path, staging: &mut Staging) -> Result<Vec<Segment<'_>>, Error> {
        if !self.container.other_chunks.is_empty() {
            let problem = "has chunks of unknown type, which a .gltf cannot hold; write a .glb";
            return Err(Fault::unsupported("", problem).in_file(self.name()));
        }
        let folder = target.parent().unwrap_or(Path::new(""));
        let mut names = Names { folder, taken: HashSet::from([target.to_owned()]) };
        let in_file = |fault: Fault| fault.in_file(self.name());
        let layout = OutputLayout::gltf(self).map_err(in_file)?;
        let kept = |buffer| !layout.unused_data.has_buffer(buffer) && self.replaced_file(buffer).is_none();
        let renamed = self.stage_files(&self.files_of(kept), &mut names, staging)?;
        if !self.container.is_glb && !self.is_changed() && renamed.is_empty() {
            return Ok(self
                .container
                .mark()
                .into_iter()
                .chain([self.text().as_bytes()])
                .map(Segment::Borrowed)
                .collect());
        }
        let name = Path::new(target.file_stem().unwrap_or(OsStr::new("buffer"))).with_added_extension("bin");
        let mut uris = Vec::new();
        for binary in &layout.binaries {
            let relative = stage_binary(binary, &name, &mut names, staging)?;
            uris.push(encode_path(&relative));
        }
        Ok(vec![Segment::Owned(layout.json(&uris, &renamed).map_err(in_file)?.into_bytes())])
    }

    /// Stages copies of files that the document refers to, unless it stays in its folder; gives those whose name had to
    /// change, with their new URI.
    fn stage_files(
        &self,
        files: &[LocatedFile],
        names: &mut Names,
        staging: &mut Staging,
    ) -> Result<HashMap<PathBuf, String>, Error> {
        let mut renamed = HashMap::new();
        let there = names.folder.canonicalize().ok();
        if there.is_some() && there.as_deref() == self.resources.base() {
            return Ok(renamed);
        }
        for file in files {
            let failed = |source| Error::Read { file: file.path.clone(), source };
            let same = |existing: &Path| {
                Ok(existing.canonicalize()? == file.path || same_files(existing, &file.path)?)
            };
            let chosen = names.choose(&file.relative, same).map_err(failed)?;
            let path = names.folder.join(&chosen.relative);
            if !chosen.exists {
                let mut source = File::open(&file.path).map_err(failed)?;
                staging.stage(&path, false, |copy| io::copy(&mut source, copy).map(drop))?;
            }
            if chosen.relative != file.relative || file.is_outside {
                renamed.insert(file.path.clone(), encode_path(&chosen.relative));
            }
        }
        Ok(renamed)
    }

    /// The files that the document was read from and those that it refers to, its own first, links resolved. Missing ones are left out.
    pub fn source_files(&self) -> Vec<PathBuf> {
        let own = self.input.iter().cloned();
        own.chain(self.files().into_iter().map(|file| file.path)).collect()
    }

    /// The files that the document refers to, each once.
    fn files(&self) -> Vec<LocatedFile> {
        self.files_of(|_| true)
    }

    /// As [`Document::files`], of some buffers and all images.
    fn files_of(&self, is_wanted: impl Fn(usize) -> bool) -> Vec<LocatedFile> {
        let buffers = self.buffer_sources.iter().enumerate().filter_map(|(buffer, store)| match store {
            BufferSource::File(file) if is_wanted(buffer) => Some(file.located.clone()),
            _ => None,
        });
        let uris = self.root.images.iter().filter_map(|image| image.uri.as_deref());
        let images = uris.filter_map(|uri| match self.resources.resolve(uri) {
            Ok(UriTarget::File(located)) => Some(located),
            _ => None,
        });
        let mut seen = HashSet::new();
        buffers.chain(images).filter(|file| seen.insert(file.path.clone())).collect()
    }
}

/// Whether the file to write is a GLB. Errors: its extension does not say.
fn is_glb(path: &Path) -> Result<bool, Error> {
    match FileKind::of(path) {
        Some(FileKind::Glb) => Ok(true),
        Some(FileKind::Gltf) => Ok(false),
        _ => {
            let problem = "does not say what to write; name it .glb or .gltf".to_owned();
            Err(Error::Output { file: path.to_owned(), problem })
        }
    }
}

fn stage_binary(
    binary: &BinaryOutput<'_>,
    name: &Path,
    names: &mut Names,
    staging: &mut Staging,
) -> Result<PathBuf, Error> {
    let folder = names.folder;
    let chosen = names
        .choose(name, |existing| holds(existing, binary))
        .map_err(|source| Error::Read { file: folder.join(name), source })?;
    if !chosen.exists {
        staging
            .stage(&folder.join(&chosen.relative), false, |file| segments::write(&binary.segments, file))?;
    }
    Ok(chosen.relative)
}

/// Names for files in the output's folder that change no file that is there.
struct Names<'a> {
    folder: &'a Path,
    taken: HashSet<PathBuf>,
}

struct Chosen {
    relative: PathBuf,
    /// Whether a file of that name and content is there.
    exists: bool,
}

impl Names<'_> {
    /// `wanted`, or the first of `wanted_1`, `wanted_2`, ... that is free or that `same` content already has.
    fn choose(&mut self, wanted: &Path, same: impl Fn(&Path) -> io::Result<bool>) -> io::Result<Chosen> {
        let stem = wanted.file_stem().unwrap_or_default().to_string_lossy();
        let extension = wanted.extension().map(|text| format!(".{}", text.to_string_lossy()));
        let mut relative = wanted.to_owned();
        for number in 1u32.. {
            let path = self.folder.join(&relative);
            let is_there = path.symlink_metadata().is_ok();
            let reusable = is_there && path.is_file() && same(&path)?;
            if (!is_there || reusable) && self.taken.insert(path) {
                return Ok(Chosen { relative, exists: is_there });
            }
            relative =
                wanted.with_file_name(format!("{stem}_{number}{}", extension.as_deref().unwrap_or("")));
        }
        Err(io::Error::other("no name is free"))
    }
}

fn same_files(a: &Path, b: &Path) -> io::Result<bool> {
    if fs::metadata(a)?.len() != fs::metadata(b)?.len() {
        return Ok(false);
    }
    let (mut a, mut b) = (io::BufReader::new(File::open(a)?), io::BufReader::new(File::open(b)?));
    let (mut left, mut right) = (vec![0; 1 << 16], vec![0; 1 << 16]);
    loop {
        let length = a.read(&mut left)?;
        if length == 0 {
            return Ok(true);
        }
        if b.read_exact(&mut right[..length]).is_err() || left[..length] != right[..length] {
            return Ok(false);
        }
    }
}

/// Whether a file holds just the bytes of `binary`.
fn holds(file: &Path, binary: &BinaryOutput<'_>) -> io::Result<bool> {
    if fs::metadata(file)?.len() != segments::length(&binary.segments) as u64 {
        return Ok(false);
    }
    let bytes = FileBytes::open(file)?;
    let mut rest = &*bytes;
    Ok(binary.segments.iter().all(|piece| {
        let (start, after) = rest.split_at(piece.len().min(rest.len()));
        rest = after;
        *start == **piece
    }))
}
