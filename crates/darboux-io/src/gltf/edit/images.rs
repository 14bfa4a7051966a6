//! Replaces the content of images.

use std::path::PathBuf;

use crate::json::Value;

use crate::Error;
use crate::error::ContentError;
use crate::gltf::Document;
use crate::gltf::buffers::ImageFile;
use crate::gltf::resources::{UriTarget, encode_data_uri};
use crate::gltf::schema::Image;

/// Where the content of an image is.
enum Content {
    View,
    Data,
    File(PathBuf),
}

impl Document {
    /// Replaces the content of an image by the bytes of another file, whose media type is `image/png` or
    /// another one of glTF.
    ///
    /// An embedded image stays embedded. An image in a file gets a new file, which is written with the
    /// document; the old one is kept, since other documents may refer to it. Errors: the image does not
    /// exist, or its content cannot be read.
    pub fn set_image(&mut self, index: usize, bytes: Vec<u8>, media_type: &str) -> Result<(), Error> {
        let replaced = self.replace_content(index, bytes, media_type);
        replaced.map_err(|error| error.in_file(self.name()))
    }

    fn replace_content(
        &mut self,
        index: usize,
        bytes: Vec<u8>,
        media_type: &str,
    ) -> Result<(), ContentError> {
        let content = self.image_content(index)?;
        let says_type = self.root.images[index].mime_type.is_some() || matches!(content, Content::View);
        let (key, value) = match content {
            Content::View => ("bufferView", Value::from(self.push_view(bytes, 1, 1, None))),
            Content::Data => ("uri", Value::from(encode_data_uri(media_type, &bytes))),
            Content::File(relative) => {
                let extension = media_type.strip_prefix("image/").unwrap_or("png");
                let relative = match relative.extension() {
                    Some(old) if Self::is_of_type(old, media_type) => relative,
                    _ => relative.with_extension(extension),
                };
                let file = ImageFile { relative, bytes, media_type: media_type.to_owned() };
                self.image_files.insert(index, file);
                self.is_changed = true;
                // The URI has the file's final name, which writing decides.
                return self.set_media_type(index, says_type, media_type);
            }
        };
        self.edit_element("images", index, |image| image[key] = value)?;
        self.set_media_type(index, says_type, media_type)
    }

    fn set_media_type(
        &mut self,
        index: usize,
        says_type: bool,
        media_type: &str,
    ) -> Result<(), ContentError> {
        if says_type {
            self.edit_element("images", index, |image| image["mimeType"] = media_type.into())?;
        }
        Ok(())
    }

    /// Whether a file name's extension is that of a media type.
    fn is_of_type(extension: &std::ffi::OsStr, media_type: &str) -> bool {
        let names: &[&str] = match media_type {
            "image/png" => &["png"],
            "image/jpeg" => &["jpg", "jpeg"],
            _ => &["webp"],
        };
        names.iter().any(|name| extension.eq_ignore_ascii_case(name))
    }

    fn image_content(&self, index: usize) -> Result<Content, ContentError> {
        let at = format!("images[{index}]");
        match self.root.images.get(index) {
            Some(Image { buffer_view: Some(_), .. }) => Ok(Content::View),
            Some(Image { uri: Some(uri), .. }) => match self.resources.resolve(uri) {
                Ok(UriTarget::Data(_)) => Ok(Content::Data),
                Ok(UriTarget::File(located)) => Ok(Content::File(located.relative)),
                Ok(UriTarget::Remote) => {
                    Err(ContentError::resource(at, "is on another machine; download it"))
                }
                Err(problem) => Err(ContentError::resource(at, problem)),
            },
            _ => Err(ContentError::invalid(at, "has no content; export the file again")),
        }
    }
}
