//! Replaces the content of images.

use std::path::PathBuf;

use serde_json::value::RawValue;

use super::document::Document;
use super::edits::ImageFile;
use super::json_text::{member, quoted, set_member};
use super::resources::{UriTarget, encode_data_uri};
use super::schema::Image;
use crate::Error;
use crate::error::ContentError;

/// Where the content of an image is.
enum Content {
    View(usize),
    Data,
    File(PathBuf),
}

impl Document {
    /// Replaces the content of an image by the bytes of another file, whose media type is `image/png` or another one of glTF.
    ///
    /// An embedded image stays embedded. An image in a file gets a new file, which is written with the document; the old one is kept, since other
    /// documents may refer to it. Errors: the image does not exist, or its content cannot be read.
    pub fn replace_image(&mut self, index: usize, bytes: Vec<u8>, media_type: &str) -> Result<(), Error> {
        let replaced = self.set_image(index, bytes, media_type);
        replaced.map_err(|error| error.in_file(self.name()))
    }

    fn set_image(&mut self, index: usize, bytes: Vec<u8>, media_type: &str) -> Result<(), ContentError> {
        let broken = |error: serde_json::Error| {
            ContentError::invalid(
                format!("images[{index}]"),
                format!("cannot be edited: {error}; export it again"),
            )
        };
        let content = self.image_content(index)?;
        let mut text = self.image_text(index).map_err(broken)?;
        let mut set = |key: &str, value: &str| -> Result<(), ContentError> {
            text = set_member(&text, key, Some(value)).map_err(broken)?;
            Ok(())
        };
        let is_view = matches!(content, Content::View(_));
        if is_view || self.root.images[index].mime_type.is_some() {
            set("mimeType", &quoted(media_type))?;
            self.root.images[index].mime_type = Some(media_type.to_owned());
        }
        match content {
            Content::View(old) => {
                let view = self.replace_view(old, bytes);
                set("bufferView", &view.to_string())?;
                self.root.images[index].buffer_view = Some(view);
            }
            Content::Data => {
                let uri = encode_data_uri(media_type, &bytes);
                set("uri", &quoted(&uri))?;
                self.root.images[index].uri = Some(uri);
            }
            Content::File(relative) => {
                let extension = media_type.strip_prefix("image/").unwrap_or("png");
                let relative = match relative.extension() {
                    Some(old) if Self::is_of_type(old, media_type) => relative,
                    _ => relative.with_extension(extension),
                };
                let file = ImageFile { relative, bytes, media_type: media_type.to_owned() };
                self.edits.image_files.insert(index, file);
            }
        }
        self.edits.images.insert(index, text);
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
            Some(&Image { buffer_view: Some(view), .. }) => Ok(Content::View(view)),
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

    /// The JSON of an image, edits included.
    fn image_text(&self, index: usize) -> serde_json::Result<String> {
        if let Some(edited) = self.edits.images.get(&index) {
            return Ok(edited.clone());
        }
        let images: Vec<&RawValue> = serde_json::from_str(member(self.text(), "images")?.unwrap_or("[]"))?;
        Ok(images.get(index).map_or("{}", |image| image.get()).to_owned())
    }

    /// The index of a buffer view with these bytes: a new one, or `old` if that is new already.
    fn replace_view(&mut self, old: usize, bytes: Vec<u8>) -> usize {
        let new = old.checked_sub(self.root.buffer_views.len());
        match new.and_then(|new| self.edits.new_views.get_mut(new)) {
            Some(view) => {
                view.bytes = bytes;
                old
            }
            None => self.push_view(bytes, 1, 1, None),
        }
    }
}
