//! [`ImageKey`]: images over the same range of a buffer or the same file are decoded once.

use darboux_io::gltf::{Document, ImageSource, TextureUse};

/// An image by the source of its bytes, or else by its index.
#[derive(Debug, PartialEq, Eq, Hash)]
pub enum ImageKey {
    Source(ImageSource),
    Index(Option<usize>),
}

impl ImageKey {
    pub fn of(document: &Document, used: &TextureUse) -> Self {
        let source = used.image.and_then(|image| document.image_source(image));
        source.map_or(Self::Index(used.image), Self::Source)
    }
}
