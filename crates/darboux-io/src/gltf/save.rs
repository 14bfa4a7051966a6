//! Writes documents: as a GLB in memory or a stream, or as files, the document after the files that it refers
//! to.

use std::collections::{HashMap, HashSet};
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use darboux::Convention;

use super::buffers::{BufferSource, ImageFile};
use super::container::glb;
use super::document::Document;
use super::exchange::{self, ExchangeFormat};
use super::image_source::ImageSource;
use super::output::{FileUris, OutputLayout};
use super::portable_names::{Numbers, image_stem, portable};
use super::resources::{LocatedFile, UriTarget, encode_path};
use super::schema::Buffer;
use super::segments::{self, Segment};
use crate::error::ContentError;
use crate::json::TextLayout;
use crate::staging::{Outputs, Staging};
use crate::{Error, FileKind, SaveOptions, paths};

impl Document {
    /// The document as a GLB with all its buffers and images, except remote and missing ones.
    ///
    /// A GLB without edits and without external files is returned byte for byte. Errors: more than 4 GiB;
    /// files that cannot be read.
    pub fn to_glb(&self) -> Result<Vec<u8>, Error> {
        Ok(segments::joined(&self.glb_segments()?))
    }

    /// Writes the bytes of [`Document::to_glb`] without assembling them in memory.
    ///
    /// Errors: as [`Document::to_glb`], before anything is written; [`Error::Write`] about `name` if `out`
    /// fails.
    pub fn write_glb(&self, name: &Path, out: impl Write) -> Result<(), Error> {
        segments::write(&self.glb_segments()?, out)
            .map_err(|source| Error::Write { file: name.to_owned(), source })
    }

    /// Writes the document and, for a `.gltf`, the files that it refers to. Returns the files written, the
    /// document last.
    ///
    /// The extension decides the container: `.glb` (or `.vrm`) or `.gltf`, or the format: `.obj` or `.ply`,
    /// which do not hold everything ([`Document::left_out`]). New data of a `.gltf` goes into a new
    /// `.bin` file, materials of an `.obj` into a new `.mtl` file. Existing files beside the output are
    /// never changed; one with the same content is reused. Missing folders are created. Errors: an existing
    /// output without [`SaveOptions::force`]; the input, or a file that it refers to, as output; a `.gltf` of
    /// a GLB that has chunks of unknown type. After an error, no file is left.
    pub fn save(&self, path: &Path, options: &SaveOptions) -> Result<Vec<PathBuf>, Error> {
        let mut outputs = Outputs::new(options.run);
        self.stage(path, options, &mut outputs)?;
        outputs.commit()
    }

    /// Stages the document as one of several outputs. The files that a `.gltf` needs get their names at once.
    /// Errors as of [`Document::save`].
    pub fn stage(&self, path: &Path, options: &SaveOptions, outputs: &mut Outputs) -> Result<(), Error> {
        let container = Container::of(path)?;
        let target = self.checked_target(path, options)?;
        self.stage_at(&target, container, options, outputs.staging())
    }

    /// What a file of a kind does not hold of the document: a noun phrase each, such as `2 cameras`; nothing
    /// for glTF. Errors: invalid data.
    pub fn left_out(&self, kind: FileKind) -> Result<Vec<String>, Error> {
        match kind {
            FileKind::Ply => exchange::left_out(self, ExchangeFormat::Ply),
            FileKind::Obj => exchange::left_out(self, ExchangeFormat::Obj),
            _ => Ok(Vec::new()),
        }
    }

    /// Replaces the input file, with the same container and permissions. Returns the files written, none
    /// without edits.
    ///
    /// Errors: as [`Document::save`]; a document that was not read from a file, or from another format than
    /// glTF; an input that no longer exists.
    pub fn save_in_place(&self) -> Result<Vec<PathBuf>, Error> {
        let input = self.input.as_ref().ok_or_else(|| Error::Output {
            file: self.name().into(),
            problem: "was not read from a file; name an output".into(),
        })?;
        if let Some(provenance) = self.provenance() {
            let format = provenance.format.name();
            let problem =
                format!("is {format}, which cannot be edited in place; name an output that ends in .glb");
            return Err(Error::Output { file: self.name().into(), problem });
        }
        if !self.is_changed() {
            return Ok(Vec::new());
        }
        let metadata = fs::metadata(input).map_err(|source| Error::Write { file: input.clone(), source })?;
        paths::refuse_read_only(Path::new(self.name()), &metadata)?;
        let container = if self.container.is_glb { Container::Glb } else { Container::Gltf };
        let mut outputs = Outputs::new(None);
        self.stage_at(input, container, &SaveOptions::default().with_force(true), outputs.staging())?;
        outputs.commit()
    }

    /// The file of a buffer that an earlier run made for new data, if the document has edits: it gets a new
    /// file for that buffer. The old file is kept, since other documents may refer to it.
    pub(super) fn replaced_file(&self, buffer: usize) -> Option<&LocatedFile> {
        let is_ours = self.element("buffers", buffer)["name"] == Buffer::NAME_FOR_NEW_DATA;
        match self.buffers.get(buffer) {
            Some(BufferSource::File(file)) if is_ours && self.is_changed() => Some(&file.located),
            _ => None,
        }
    }

    /// The file to write at `path`, links resolved.
    fn checked_target(&self, path: &Path, options: &SaveOptions) -> Result<PathBuf, Error> {
        paths::resolve_output(path, options.force, |target| {
            if self.input.as_deref() == Some(target) {
                Some("is the input; name another output or write in place")
            } else {
                self.uses(target).then_some("is a file that the input uses; name another output")
            }
        })
    }

    /// Whether a file is the input, or one that it refers to, links resolved.
    pub fn uses_file(&self, path: &Path) -> bool {
        path.canonicalize().is_ok_and(|path| self.input.as_ref() == Some(&path) || self.uses(&path))
    }

    fn uses(&self, resolved: &Path) -> bool {
        let is_companion = self.companions().iter().any(|file| file == resolved);
        is_companion || self.files().iter().any(|file| file.path == resolved)
    }

    fn stage_at(
        &self,
        target: &Path,
        container: Container,
        options: &SaveOptions,
        staging: &mut Staging,
    ) -> Result<(), Error> {
        let segments = self.stage_others(target, container, staging)?;
        staging.stage(target, options.force, |file| segments::write(&segments, file))
    }

    /// Writes the files that an output needs beside it. Returns its content.
    fn stage_others(
        &self,
        target: &Path,
        container: Container,
        staging: &mut Staging,
    ) -> Result<Vec<Segment<'_>>, Error> {
        match container {
            Container::Glb => self.glb_segments(),
            Container::Gltf => self.stage_gltf(target, staging),
            Container::Exchange(format) => self.stage_exchange(target, format, staging),
        }
    }

    /// Whether a file has the bytes that [`Document::save`] would write there, and the files that it needs
    /// are beside it. Nothing is written, and no file is read into memory.
    pub fn is_saved_at(&self, path: &Path) -> bool {
        let compared = || -> Result<bool, Error> {
            let container = Container::of(path)?;
            let failed = |source| Error::Read { file: path.to_owned(), source };
            let target = path.canonicalize().map_err(failed)?;
            let segments = self.stage_others(&target, container, &mut Staging::comparing())?;
            holds(&target, &segments).map_err(failed)
        };
        compared().unwrap_or(false)
    }

    fn glb_segments(&self) -> Result<Vec<Segment<'_>>, Error> {
        if self.container.is_glb && !self.is_changed() && self.files().is_empty() {
            return Ok(vec![Segment::Borrowed(&self.file)]);
        }
        debug_assert!(self.agrees_with_its_json(), "{}: typed parts differ from the JSON", self.name());
        let chunks =
            self.container.other_chunks.iter().map(|(kind, range)| (*kind, &self.file[range.clone()]));
        let segments = || {
            let mut layout = OutputLayout::glb(self)?;
            let json = layout.json(&FileUris::default(), &TextLayout::default());
            glb(json, layout.binaries.pop().map(|binary| binary.segments), chunks.collect())
        };
        segments().map_err(|error| error.in_file(self.name()))
    }

    /// Writes the files that a `.gltf` needs beside it. Returns its text.
    fn stage_gltf(&self, target: &Path, staging: &mut Staging) -> Result<Vec<Segment<'_>>, Error> {
        if !self.container.other_chunks.is_empty() {
            let problem = "has chunks of unknown type, which a .gltf cannot hold; write a .glb";
            return Err(ContentError::unsupported("", problem).in_file(self.name()));
        }
        debug_assert!(self.agrees_with_its_json(), "{}: typed parts differ from the JSON", self.name());
        let folder = target.parent().unwrap_or(Path::new(""));
        let mut names = FileNames::new(folder, target);
        let in_file = |error: ContentError| error.in_file(self.name());
        let layout = OutputLayout::gltf(self).map_err(in_file)?;
        // Without edits the text stays as it was, with everything that it refers to.
        let kept = |buffer| {
            !self.is_changed()
                || !layout.unused_data.has_buffer(buffer) && self.replaced_file(buffer).is_none()
        };
        let is_kept = |image| !self.image_files.contains_key(&image);
        let renamed = self.copy_files(&self.files_of(kept, is_kept), &mut names, staging)?;
        if !self.container.is_glb && !self.is_changed() && renamed.is_empty() {
            return Ok(vec![Segment::Borrowed(&self.file)]);
        }
        let name = Path::new(target.file_stem().unwrap_or(OsStr::new("buffer"))).with_added_extension("bin");
        let mut uris = FileUris { renamed, ..FileUris::default() };
        for binary in &layout.binaries {
            uris.binaries.push(names.place_segments(&name, staging, &binary.segments)?);
        }
        for (&image, ImageFile { relative, bytes, .. }) in &self.image_files {
            uris.images.insert(image, names.place_segments(relative, staging, &[Segment::Borrowed(bytes)])?);
        }
        Ok(vec![Segment::Owned(layout.json(&uris, &self.layout))])
    }

    /// Writes the material library and the textures of an OBJ beside it. Returns the content of the exchange
    /// file.
    fn stage_exchange(
        &self,
        target: &Path,
        format: ExchangeFormat,
        staging: &mut Staging,
    ) -> Result<Vec<Segment<'_>>, Error> {
        if self.convention()? != Convention::GLTF {
            let problem =
                "cannot have vertices in another convention than glTF's; convert them to gltf first";
            return Err(Error::Output { file: target.to_owned(), problem: problem.into() });
        }
        let folder = target.parent().unwrap_or(Path::new(""));
        let mut names = FileNames::new(folder, target);
        let library =
            Path::new(target.file_stem().unwrap_or(OsStr::new("materials"))).with_added_extension("mtl");
        let surfaces = exchange::surfaces(self)?;
        let textures = match format {
            ExchangeFormat::Obj => self.stage_textures(&mut names, staging)?,
            ExchangeFormat::Ply => Vec::new(),
        };
        let library_name = portable(&library).to_string_lossy().into_owned();
        let mut content = exchange::content(self, &surfaces, format, &library_name, &textures)?;
        if let Some(text) = &content.library {
            let path = names.place_content(&library, staging, &[Segment::Borrowed(text.as_bytes())])?;
            if path != portable(&library) {
                content = exchange::content(self, &surfaces, format, &path.to_string_lossy(), &textures)?;
            }
        }
        Ok(content.segments)
    }

    /// Writes the textures of an OBJ beside it. Returns the path of each image in its library. Images over
    /// the same bytes share a file.
    fn stage_textures(
        &self,
        names: &mut FileNames<'_>,
        staging: &mut Staging,
    ) -> Result<Vec<Option<String>>, Error> {
        let mut textures = vec![None; self.root.images.len()];
        let mut path_of_source: HashMap<ImageSource, PathBuf> = HashMap::new();
        for image in exchange::images_of_library(self)? {
            let source = self.image_source(image);
            let path = match source.as_ref().and_then(|source| path_of_source.get(source)) {
                Some(path) => path.clone(),
                None => {
                    let Ok(bytes) = self.image_bytes(image) else { continue };
                    let segments = [Segment::Borrowed(&bytes)];
                    names.place_content(&self.image_file_name(image), staging, &segments)?
                }
            };
            textures[image] = Some(path_in_library(&path));
            path_of_source.extend(source.map(|source| (source, path)));
        }
        Ok(textures)
    }

    /// A file name for an image: the name of its file, or the image's name with the ending of its media type.
    fn image_file_name(&self, index: usize) -> PathBuf {
        let image = &self.root.images[index];
        let file = image.uri.as_deref().and_then(|uri| match self.resources.resolve(uri) {
            Ok(UriTarget::File(located)) => Some(PathBuf::from(located.path.file_name()?)),
            _ => None,
        });
        file.unwrap_or_else(|| {
            let name = self.json["images"][index]["name"].as_str().unwrap_or_default();
            let name = image_stem(name).map_or_else(|| format!("image_{index}"), str::to_owned);
            let (extension, kind) = match image.mime_type.as_deref() {
                Some("image/jpeg") => ("jpg", FileKind::Jpeg),
                Some("image/webp") => ("webp", FileKind::WebP),
                Some("image/ktx2") => ("ktx2", FileKind::OtherImage),
                _ => ("png", FileKind::Png),
            };
            let path = PathBuf::from(name);
            match FileKind::of(&path) {
                Some(same) if same == kind => path,
                Some(other) if other.is_image() => path.with_extension(extension),
                _ => path.with_added_extension(extension),
            }
        })
    }

    /// Copies the files that the document refers to into the output's folder, unless that is the document's
    /// folder. Returns the files whose path had to change, with their new URI.
    fn copy_files(
        &self,
        files: &[LocatedFile],
        names: &mut FileNames,
        staging: &mut Staging,
    ) -> Result<HashMap<PathBuf, String>, Error> {
        let mut renamed = HashMap::new();
        let folder = names.folder.canonicalize().ok();
        if folder.is_some() && folder.as_deref() == self.resources.base() {
            return Ok(renamed);
        }
        for file in files {
            let failed = |source| Error::Read { file: file.path.clone(), source };
            let is_same = |existing: &Path| self.resources.is_same(existing, &file.path);
            let mut source = self.resources.reader(&file.path).map_err(failed)?;
            let copy = |copy: &mut File| io::copy(&mut source, copy).map(drop);
            let relative = names.place(&file.relative, staging, is_same, copy)?;
            if relative != file.relative || file.is_outside {
                renamed.insert(file.path.clone(), encode_path(&relative));
            }
        }
        Ok(renamed)
    }

    /// The input file and the files on the disk that it refers to, links resolved. Missing files are left
    /// out.
    pub fn source_files(&self) -> Vec<PathBuf> {
        if !self.resources.are_on_disk() {
            return Vec::new();
        }
        let own = self.input.iter().chain(self.companions()).cloned();
        own.chain(self.files().into_iter().map(|file| file.path)).collect()
    }

    /// The files that were read with a model of another format.
    fn companions(&self) -> &[PathBuf] {
        self.provenance().map_or(&[], |provenance| &provenance.companions)
    }

    /// The files that the document refers to, each once.
    fn files(&self) -> Vec<LocatedFile> {
        self.files_of(|_| true, |_| true)
    }

    /// As [`Document::files`], for some buffers and some images.
    fn files_of(
        &self,
        is_wanted_buffer: impl Fn(usize) -> bool,
        is_wanted_image: impl Fn(usize) -> bool,
    ) -> Vec<LocatedFile> {
        let buffers = self.buffers.iter().enumerate().filter_map(|(buffer, store)| match store {
            BufferSource::File(file) if is_wanted_buffer(buffer) => Some(file.located.clone()),
            _ => None,
        });
        let wanted = self.root.images.iter().enumerate().filter(|(image, _)| is_wanted_image(*image));
        let uris = wanted.filter_map(|(_, image)| image.uri.as_deref());
        let images = uris.filter_map(|uri| match self.resources.resolve(uri) {
            Ok(UriTarget::File(located)) => Some(located),
            _ => None,
        });
        let mut seen = HashSet::new();
        buffers.chain(images).filter(|file| seen.insert(file.path.clone())).collect()
    }
}

/// How a document is written.
#[derive(Clone, Copy)]
enum Container {
    Glb,
    Gltf,
    Exchange(ExchangeFormat),
}

impl Container {
    /// The container of an output. Errors: the path does not have the extension of a model.
    fn of(path: &Path) -> Result<Self, Error> {
        Ok(match FileKind::of(path) {
            Some(FileKind::Glb) => Self::Glb,
            Some(FileKind::Gltf) => Self::Gltf,
            Some(FileKind::Ply) => Self::Exchange(ExchangeFormat::Ply),
            Some(FileKind::Obj) => Self::Exchange(ExchangeFormat::Obj),
            kind => {
                let problem = paths::wrong_output(kind);
                return Err(Error::Output { file: path.to_owned(), problem });
            }
        })
    }
}

/// The path of a texture as a material library spells it. A path that begins as an option does, or with white
/// space, begins with the folder.
fn path_in_library(path: &Path) -> String {
    let path = path.to_string_lossy().replace('\\', "/");
    if path.starts_with(|c: char| c == '-' || c.is_whitespace()) { format!("./{path}") } else { path }
}

/// The names of files beside an output. No existing file is changed.
struct FileNames<'a> {
    folder: &'a Path,
    taken: HashSet<PathBuf>,
    numbers: Numbers,
}

impl<'a> FileNames<'a> {
    fn new(folder: &'a Path, target: &Path) -> Self {
        Self { folder, taken: HashSet::from([target.to_owned()]), numbers: Numbers::default() }
    }

    /// Puts a new file into the folder, as [`FileNames::place`] does. Returns its URI.
    fn place_segments(
        &mut self,
        wanted: &Path,
        staging: &mut Staging,
        segments: &[Segment<'_>],
    ) -> Result<String, Error> {
        self.place_content(wanted, staging, segments).map(|relative| encode_path(&relative))
    }

    /// As [`FileNames::place_segments`], but returns the relative path.
    fn place_content(
        &mut self,
        wanted: &Path,
        staging: &mut Staging,
        segments: &[Segment<'_>],
    ) -> Result<PathBuf, Error> {
        let write = |file: &mut File| segments::write(segments, file);
        self.place(wanted, staging, |file| holds(file, segments), write)
    }

    /// Puts a file into the folder under the name `wanted` or, if that is taken, `wanted_1`, `wanted_2` and
    /// so on. An existing file for which `is_same` holds is used as it is. Returns the relative path.
    ///
    /// The name has no characters that a URI cannot spell or that readers refuse.
    fn place(
        &mut self,
        wanted: &Path,
        staging: &mut Staging,
        is_same: impl Fn(&Path) -> io::Result<bool>,
        write: impl FnOnce(&mut File) -> io::Result<()>,
    ) -> Result<PathBuf, Error> {
        let wanted = portable(wanted);
        let stem = wanted.file_stem().unwrap_or_default().to_string_lossy();
        let extension = wanted.extension().map(|text| format!(".{}", text.to_string_lossy()));
        let (mut write, mut written) = (Some(write), None);
        for number in self.numbers.first(&wanted).. {
            let relative = match number {
                0 => wanted.clone(),
                _ => wanted.with_file_name(format!("{stem}_{number}{}", extension.as_deref().unwrap_or(""))),
            };
            let path = self.folder.join(&relative);
            let failed = |source| Error::Write { file: path.clone(), source };
            if !self.taken.contains(&path) {
                if path.symlink_metadata().is_err() {
                    if let Some(write) = write.take() {
                        written = Some(staging.write_temporary(&path, write).map_err(failed)?);
                    }
                    if let Some(temporary) = written.take() {
                        written = staging.publish(temporary, &path)?;
                    }
                    if written.is_none() {
                        self.taken.insert(path);
                        return Ok(relative);
                    }
                }
                // Another process may have made the file just now.
                if path.is_file() && is_same(&path).map_err(failed)? {
                    self.taken.insert(path);
                    return Ok(relative);
                }
            }
            if self.taken.contains(&path) {
                self.numbers.take(&wanted, number);
            }
        }
        let problem = "and its numbered variants exist; clear the folder".to_owned();
        Err(Error::Output { file: self.folder.join(wanted), problem })
    }
}

/// Whether the content of a file is `segments`.
fn holds(file: &Path, segments: &[Segment<'_>]) -> io::Result<bool> {
    if fs::metadata(file)?.len() != segments::length(segments) as u64 {
        return Ok(false);
    }
    let mut file = paths::open_resolved(&file.canonicalize()?)?;
    let mut bytes = vec![0; 1 << 16];
    for part in segments.iter().flat_map(|segment| segment.chunks(1 << 16)) {
        let bytes = &mut bytes[..part.len()];
        if file.read_exact(bytes).is_err() || bytes != part {
            return Ok(false);
        }
    }
    Ok(true)
}
