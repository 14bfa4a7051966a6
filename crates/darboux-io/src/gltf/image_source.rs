//! [`ImageSource`]: recognises images with the same bytes.

use std::path::PathBuf;

use super::Document;
use super::resources::UriTarget;

/// Where the bytes of an image are. Images with the same source have the same bytes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ImageSource {
    /// In a buffer.
    #[non_exhaustive]
    Range {
        /// The index of the buffer.
        buffer: usize,
        /// The first byte.
        offset: usize,
        /// The number of bytes.
        length: usize,
    },
    /// In a file, links resolved.
    File(PathBuf),
}

impl Document {
    /// Where the bytes of an image are; none where no other image can have the same, as after an edit, or
    /// where there are none.
    pub fn image_source(&self, index: usize) -> Option<ImageSource> {
        let image = self.root.images.get(index)?;
        match (&image.uri, image.buffer_view) {
            _ if self.image_files.contains_key(&index) => None,
            (_, Some(view)) => {
                let view = self.root.buffer_views.get(view)?;
                let (buffer, offset, length) = (view.buffer, view.byte_offset, view.byte_length);
                Some(ImageSource::Range { buffer, offset, length })
            }
            (Some(uri), None) => match self.resources.resolve(uri) {
                Ok(UriTarget::File(located)) => Some(ImageSource::File(located.path)),
                _ => None,
            },
            (None, None) => None,
        }
    }

    /// Whether an image has content that may be read. Its file is not read.
    pub(super) fn has_image(&self, index: usize) -> bool {
        match self.image_source(index) {
            Some(ImageSource::File(path)) => self.resources.has(&path),
            Some(ImageSource::Range { .. }) => true,
            None => self.image_bytes(index).is_ok(),
        }
    }

    /// Whether an image is on another machine, from which nothing is read.
    pub fn is_remote_image(&self, index: usize) -> bool {
        let uri = self.root.images.get(index).and_then(|image| image.uri.as_deref());
        !self.image_files.contains_key(&index)
            && uri.is_some_and(|uri| matches!(self.resources.resolve(uri), Ok(UriTarget::Remote)))
    }
}
