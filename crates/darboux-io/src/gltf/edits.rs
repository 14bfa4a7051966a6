//! The edits of a document that have not been written yet.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::elements::Target;

/// Edits of the JSON, as the new text of elements by their index, and new bytes.
#[derive(Clone, Debug, Default)]
pub struct Edits {
    pub primitives: BTreeMap<(usize, usize), String>,
    pub accessors: BTreeMap<usize, String>,
    pub views: BTreeMap<usize, String>,
    pub buffers: BTreeMap<usize, String>,
    pub removed_extensions: Vec<&'static str>,
    pub required_extensions: Vec<&'static str>,
    pub new_accessors: Vec<String>,
    pub asset: Option<String>,
    /// Edited images.
    pub images: BTreeMap<usize, String>,
    /// The new content of images that are files.
    pub image_files: BTreeMap<usize, ImageFile>,
    /// Edited elements of `nodes`, `skins`, `animations` and `materials`.
    pub scene: BTreeMap<&'static str, BTreeMap<usize, String>>,
    /// Elements that are appended to `materials`, `textures` and `images`.
    pub appended: BTreeMap<&'static str, Vec<String>>,
    /// Accessors that primitives referred to before they were edited.
    pub formerly_referenced: BTreeSet<usize>,
    /// Whether a warning about unused data that stays has been given.
    pub is_unused_data_reported: bool,
    pub new_views: Vec<NewView>,
    /// The number of bytes in all new views.
    pub new_byte_count: usize,
}

/// A new buffer view and its bytes.
#[derive(Clone, Debug)]
pub struct NewView {
    pub bytes: Vec<u8>,
    pub stride: Option<usize>,
    pub target: Option<Target>,
}

/// The new content of an image that is a file.
#[derive(Clone, Debug)]
pub struct ImageFile {
    /// The path relative to the document's folder.
    pub relative: PathBuf,
    pub bytes: Vec<u8>,
    pub media_type: String,
}

impl Edits {
    /// The edited and the appended elements of every array that has some.
    pub fn edited_arrays(&self) -> impl Iterator<Item = (&'static str, &BTreeMap<usize, String>, &[String])> {
        static NONE: BTreeMap<usize, String> = BTreeMap::new();
        let keys: BTreeSet<&'static str> = self.scene.keys().chain(self.appended.keys()).copied().collect();
        keys.into_iter().map(|key| {
            let edited = self.scene.get(key).unwrap_or(&NONE);
            (key, edited, self.appended.get(key).map_or(&[][..], Vec::as_slice))
        })
    }

    /// Whether there are no edits.
    pub fn is_empty(&self) -> bool {
        let Self {
            primitives,
            accessors,
            views,
            buffers,
            removed_extensions,
            new_accessors,
            asset,
            images,
            image_files,
            scene,
            appended,
            ..
        } = self;
        primitives.is_empty()
            && accessors.is_empty()
            && views.is_empty()
            && buffers.is_empty()
            && removed_extensions.is_empty()
            && new_accessors.is_empty()
            && asset.is_none()
            && images.is_empty()
            && image_files.is_empty()
            && scene.is_empty()
            && appended.is_empty()
    }
}
