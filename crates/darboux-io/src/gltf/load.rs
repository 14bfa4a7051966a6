//! Opens documents: reads the file, its JSON and its buffers, and checks them.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock};

use crate::json::Value;

use super::buffers::load_buffer;
use super::container::Container;
use super::document::Document;
use super::file_bytes::{FileAccess, FileBytes};
use super::primitives::triangles::mode_name;
use super::references::{self, Unreferenced};
use super::resources::Resources;
use super::schema::Root;
use crate::error::{ContentError, shortened};
use crate::json::{self, TextLayout};
use crate::memory_limit::{self, Budget};
use crate::source::{Built, ModelFiles, Provenance};
use crate::{Error, Files, LoadOptions, paths, readers};

impl Document {
    /// Reads a `.glb` or `.gltf` file and the buffers that it refers to, and decodes what is compressed with
    /// Draco or meshopt; or a model of another format, which becomes a glTF document with
    /// [`Document::provenance`]. The content decides, not the name's ending.
    ///
    /// Errors: a file that cannot be read, or is not valid glTF; a mode of a primitive, or a reference to an
    /// element, that does not exist; a compressed stream that is broken.
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        Self::open_with(path, options, FileAccess::default())
    }

    /// As [`Document::open`], with files of 256 MiB and more mapped where the system can: they are not
    /// copied, and parts that are not needed are not read.
    ///
    /// # Safety
    /// Until the document is dropped, no process may write into its files or shorten them. A process that
    /// shortens a file ends this one by a signal (SIGBUS on Unix); one that writes into a file changes
    /// bytes that Rust takes for constant.
    #[expect(unsafe_code, reason = "the caller vouches for other processes")]
    pub unsafe fn open_mapped(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        // SAFETY: the caller makes the promise that `mapped` asks for.
        Self::open_with(path, options, unsafe { FileAccess::mapped() })
    }

    fn open_with(path: &Path, options: &LoadOptions, access: FileAccess) -> Result<Self, Error> {
        let failed = |source| Error::Read { file: path.to_owned(), source };
        let input = paths::resolve_input(path)?;
        let bytes = access.open(&input, options.memory_limit.process()).map_err(failed)?;
        let name = path.display().to_string();
        let mut document = Self::from_file(&name, bytes, Some(paths::folder_of(path)), options, access)?;
        document.input = Some(input);
        Ok(document)
    }

    /// Reads a document from memory.
    ///
    /// `name` stands for the file in messages. `base` is the folder of external files; without it, buffers
    /// must be embedded, and references to image files are kept as they are. Errors: as
    /// [`Document::open`].
    pub fn from_bytes(
        name: &str,
        bytes: Vec<u8>,
        base: Option<&Path>,
        options: &LoadOptions,
    ) -> Result<Self, Error> {
        Self::from_file(name, FileBytes::Read(bytes), base, options, FileAccess::default())
    }

    /// Reads a document from memory, and the buffers and images that it refers to from `files`, in which its
    /// own name is `name`.
    ///
    /// References with `..` reach all of `files`. Errors: as [`Document::open`]; a buffer that is not among
    /// the files.
    pub fn from_files(
        name: &str,
        bytes: Vec<u8>,
        files: Arc<dyn Files>,
        options: &LoadOptions,
    ) -> Result<Self, Error> {
        let folder = Path::new(name).parent().unwrap_or(Path::new(""));
        let options = options.with_allow_outside(true);
        Self::from_file(name, FileBytes::Read(bytes), Some(folder), &options, FileAccess::Given(files))
    }

    fn from_file(
        name: &str,
        file: FileBytes,
        base: Option<&Path>,
        options: &LoadOptions,
        access: FileAccess,
    ) -> Result<Self, Error> {
        let failed = |source| Error::Read { file: base.unwrap_or(Path::new("")).to_owned(), source };
        let files = ModelFiles::new(name, access.model_files(base).map_err(failed)?, options);
        let read =
            readers::read(name, &file, &files, options).transpose().map_err(|error| error.in_file(name))?;
        let Some(Built { bytes, start, provenance, warnings }) = read else {
            let resources = Resources::new(base, *options, access).map_err(failed)?;
            return Self::parse(name, file, resources, *options).map_err(|error| error.in_file(name));
        };
        drop(file);
        let resources = Resources::new(None, *options, access).map_err(failed)?;
        let document = Self::parse(name, FileBytes::Made { bytes, start }, resources, *options);
        let mut document = document.map_err(|error| error.in_file(name))?;
        document.warnings.splice(0..0, warnings);
        document.provenance = Some(Provenance { companions: files.into_read(), ..provenance });
        Ok(document)
    }

    fn parse(
        name: &str,
        file: FileBytes,
        mut resources: Resources,
        options: LoadOptions,
    ) -> Result<Self, ContentError> {
        let container = Container::parse(&file)?;
        let text = std::str::from_utf8(&file[container.json.clone()]).map_err(|error| {
            let byte = error.valid_up_to();
            ContentError::invalid(
                "",
                format!("the JSON is not UTF-8 at its byte {byte}; export the file again"),
            )
        })?;
        let limit = options.budget(file.len(), 0);
        let (json, layout) = (json::parse(text, limit)?, TextLayout::of(text));
        check_primitive_count(&json, limit)?;
        let root = read_root(&json)?;
        check_modes(&root)?;
        let references = references::check(&json)?;
        let chunk = container.bin.clone().map(|range| &file[range]);
        let buffers = root
            .buffers
            .iter()
            .enumerate()
            .map(|(i, buffer)| load_buffer(i, buffer, chunk, &mut resources))
            .collect::<Result<_, _>>()?;
        let mut document = Self {
            name: name.to_owned(),
            input: None,
            warnings: image_warnings(&root, &resources),
            unreferenced: Unreferenced::new(&json, &references),
            file,
            container,
            json,
            layout,
            root,
            resources,
            buffers,
            image_files: BTreeMap::new(),
            is_changed: false,
            was_compressed: false,
            decoded_ranges: Vec::new(),
            decompressed_bytes: 0,
            options,
            backed_count: OnceLock::new(),
            checked_sparse: Mutex::default(),
            is_unused_data_reported: false,
            provenance: None,
        };
        document.decompress()?;
        document.check_sizes()?;
        Ok(document)
    }
}

/// Checks that the primitives do not need more memory than the limit.
fn check_primitive_count(json: &Value, limit: Budget) -> Result<(), ContentError> {
    let meshes = json["meshes"].as_array().into_iter().flatten();
    let count: usize = meshes.filter_map(|mesh| mesh["primitives"].as_array()).map(Vec::len).sum();
    if count.saturating_mul(memory_limit::BYTES_PER_PRIMITIVE) <= limit.bytes {
        return Ok(());
    }
    let (primitives, need) = if count == 1 { ("primitive", "needs") } else { ("primitives", "need") };
    let problem = limit.exceeded(&format!("has {count} {primitives}, which {need}"));
    Err(ContentError::unsupported("meshes", problem))
}

/// Checks that the mode of every primitive is one of glTF's.
fn check_modes(root: &Root) -> Result<(), ContentError> {
    for (i, mesh) in root.meshes.iter().enumerate() {
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            if mode_name(primitive.mode).is_none() {
                let problem = format!("{} is not a mode; use 0 to 6", primitive.mode);
                return Err(ContentError::invalid(format!("meshes[{i}].primitives[{k}].mode"), problem));
            }
        }
    }
    Ok(())
}

/// The typed parts of a document. Errors: it is not glTF 2.0.
fn read_root(json: &Value) -> Result<Root, ContentError> {
    let asset = &json["asset"];
    match &asset["version"] {
        Value::String(version) if !version.starts_with("2.") => {
            let problem = format!("is {:?}; convert the file to glTF 2.0", shortened(version));
            Err(ContentError::invalid("asset.version", problem))
        }
        Value::Null => {
            let problem =
                "asset.version is missing, so this is not a glTF file; give a .gltf or .glb file of glTF 2.0";
            Err(ContentError::invalid("", problem))
        }
        _ => json::read(json, ""),
    }
}

fn image_warnings(root: &Root, resources: &Resources) -> Vec<String> {
    let uris = root.images.iter().enumerate().filter_map(|(i, image)| Some((i, image.uri.as_deref()?)));
    uris.filter_map(|(i, uri)| {
        let problem = resources.resolve(uri).err()?;
        Some(format!("images[{i}].uri: {problem}; a .gltf or .glb that is written keeps the reference"))
    })
    .collect()
}
