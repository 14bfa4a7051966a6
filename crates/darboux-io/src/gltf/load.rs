//! Opens documents: reads the file, its JSON and its buffers, and checks them.

use std::path::Path;
use std::sync::OnceLock;

use super::buffers::load_buffer;
use super::container::Container;
use super::document::Document;
use super::edits::Edits;
use super::file_bytes::{FileAccess, FileBytes};
use super::parse::parse_root;
use super::references;
use super::resources::Resources;
use super::schema::Root;
use crate::error::ContentError;
use crate::memory_limit;
use crate::{Error, LoadOptions, paths};

impl Document {
    /// Reads a `.glb` or `.gltf` file and the buffers that it refers to. The first bytes decide between the two formats.
    ///
    /// Errors: a file that cannot be read, or is not valid glTF; a reference to an element that does not exist.
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        Self::open_with(path, options, FileAccess::default())
    }

    /// As [`Document::open`], with files of 256 MiB and more mapped where the system can: they are not copied, and parts that are not
    /// needed are not read.
    ///
    /// # Safety
    /// Until the document is dropped, no process may write into its files or shorten them. A process that shortens a file ends this
    /// one by a signal (SIGBUS on Unix); one that writes into a file changes bytes that Rust takes for constant.
    #[expect(unsafe_code, reason = "the caller vouches for other processes")]
    pub unsafe fn open_mapped(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        // SAFETY: the caller makes the promise that `mapped` asks for.
        Self::open_with(path, options, unsafe { FileAccess::mapped() })
    }

    fn open_with(path: &Path, options: &LoadOptions, access: FileAccess) -> Result<Self, Error> {
        let failed = |source| Error::Read { file: path.to_owned(), source };
        let input = paths::resolve_input(path)?;
        let bytes = access.open(&input).map_err(failed)?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let name = path.display().to_string();
        let mut document = Self::from_file(&name, bytes, Some(folder), options, access)?;
        document.input = Some(input);
        Ok(document)
    }

    /// Reads a document from memory.
    ///
    /// `name` stands for the file in messages. `base` is the folder of external files; without it, buffers must be embedded, and
    /// references to image files are kept as they are. Errors: as [`Document::open`].
    pub fn from_bytes(
        name: &str,
        bytes: Vec<u8>,
        base: Option<&Path>,
        options: &LoadOptions,
    ) -> Result<Self, Error> {
        Self::from_file(name, FileBytes::Read(bytes), base, options, FileAccess::default())
    }

    fn from_file(
        name: &str,
        file: FileBytes,
        base: Option<&Path>,
        options: &LoadOptions,
        access: FileAccess,
    ) -> Result<Self, Error> {
        let resources = Resources::new(base, *options, access)
            .map_err(|source| Error::Read { file: base.unwrap_or(Path::new("")).to_owned(), source })?;
        Self::parse(name, file, resources, *options).map_err(|error| error.in_file(name))
    }

    fn parse(
        name: &str,
        mut file: FileBytes,
        mut resources: Resources,
        options: LoadOptions,
    ) -> Result<Self, ContentError> {
        let container = Container::parse(&file)?;
        let text = String::from_utf8(file[container.json.clone()].to_vec()).map_err(|error| {
            ContentError::invalid("", format!("the JSON is not UTF-8: {error}; export the file again"))
        })?;
        if !container.is_glb {
            file = FileBytes::Read(Vec::new());
        }
        let root = parse_root(&text)?;
        references::check(&text)?;
        let chunk = container.bin.clone().map(|range| &file[range]);
        let buffer_sources = root
            .buffers
            .iter()
            .enumerate()
            .map(|(i, buffer)| load_buffer(i, buffer, chunk, &mut resources))
            .collect::<Result<_, _>>()?;
        let warnings = image_warnings(&root, &resources);
        let document = Self {
            name: name.to_owned(),
            input: None,
            file,
            container,
            text,
            root,
            resources,
            buffer_sources,
            edits: Edits::default(),
            decompressed_bytes: 0,
            options,
            backed_count: OnceLock::new(),
            primitive_texts: OnceLock::new(),
            warnings,
        };
        document.check_primitive_count()?;
        document.check_sizes()?;
        Ok(document)
    }

    /// Checks that the primitives do not need more memory than the limit.
    fn check_primitive_count(&self) -> Result<(), ContentError> {
        let count: usize = self.root.meshes.iter().map(|mesh| mesh.primitives.len()).sum();
        let limit = self.memory_limit();
        if count.saturating_mul(memory_limit::BYTES_PER_PRIMITIVE) <= limit.bytes {
            return Ok(());
        }
        Err(ContentError::unsupported(
            "meshes",
            limit.exceeded(&format!(
                "has {count} primitive{}, which need{}",
                if count == 1 { "" } else { "s" },
                if count == 1 { "s" } else { "" }
            )),
        ))
    }
}

fn image_warnings(root: &Root, resources: &Resources) -> Vec<String> {
    let uris = root.images.iter().enumerate().filter_map(|(i, image)| Some((i, image.uri.as_deref()?)));
    uris.filter_map(|(i, uri)| {
        let problem = resources.resolve(uri).err()?;
        Some(format!("images[{i}].uri: {problem}; the reference is kept"))
    })
    .collect()
}
