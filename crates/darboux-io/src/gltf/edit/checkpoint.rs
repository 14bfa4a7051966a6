//! [`Checkpoint`]: takes back edits that turned out not to help.

use std::collections::BTreeMap;

use crate::json::Value;

use crate::gltf::Document;
use crate::gltf::buffers::{BufferSource, ImageFile};
use crate::gltf::schema::Root;

/// A document's state at one moment; made by [`Document::checkpoint`].
#[derive(Debug)]
pub struct Checkpoint {
    json: Value,
    root: Root,
    image_files: BTreeMap<usize, ImageFile>,
    is_changed: bool,
    buffer_count: usize,
    new_byte_count: usize,
    warning_count: usize,
}

impl Document {
    /// Notes the edits made so far, for [`Document::roll_back`]. Bytes of buffers are not copied.
    pub fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            json: self.json.clone(),
            root: self.root.clone(),
            image_files: self.image_files.clone(),
            is_changed: self.is_changed,
            buffer_count: self.buffers.len(),
            new_byte_count: self.new_byte_count(),
            warning_count: self.warnings.len(),
        }
    }

    /// Takes back all edits since a checkpoint of this document.
    pub fn roll_back(&mut self, checkpoint: Checkpoint) {
        self.json = checkpoint.json;
        self.root = checkpoint.root;
        self.image_files = checkpoint.image_files;
        self.is_changed = checkpoint.is_changed;
        self.buffers.truncate(checkpoint.buffer_count);
        if let Some(BufferSource::New(new)) = self.buffers.last_mut() {
            new.truncate(checkpoint.new_byte_count);
        }
        self.warnings.truncate(checkpoint.warning_count);
        self.backed_count.take();
        self.forget_checked_sparse();
    }
}
