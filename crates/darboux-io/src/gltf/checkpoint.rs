//! [`Checkpoint`]: takes back edits that turned out not to help.

use super::document::Document;
use super::edits::Edits;
use super::schema::Mesh;

/// The edits of a document at one moment; made by [`Document::checkpoint`].
#[derive(Debug)]
pub struct Checkpoint {
    /// Without the new buffer views, which are only appended.
    edits: Edits,
    new_view_count: usize,
    accessor_count: usize,
    meshes: Vec<Mesh>,
    warning_count: usize,
}

impl Document {
    /// Notes the edits made so far, for [`Document::roll_back`]. Their bytes are not copied.
    pub fn checkpoint(&mut self) -> Checkpoint {
        let views = std::mem::take(&mut self.edits.new_views);
        let edits = self.edits.clone();
        self.edits.new_views = views;
        Checkpoint {
            edits,
            new_view_count: self.edits.new_views.len(),
            accessor_count: self.root.accessors.len(),
            meshes: self.root.meshes.clone(),
            warning_count: self.warnings.len(),
        }
    }

    /// Takes back all edits of primitives since a checkpoint of this document. Decompression, and the replacement of images, cannot be taken
    /// back: make the checkpoint after the first and before the second.
    pub fn roll_back(&mut self, checkpoint: Checkpoint) {
        let mut views = std::mem::take(&mut self.edits.new_views);
        views.truncate(checkpoint.new_view_count);
        self.edits = Edits { new_views: views, ..checkpoint.edits };
        self.root.accessors.truncate(checkpoint.accessor_count);
        self.root.meshes = checkpoint.meshes;
        self.warnings.truncate(checkpoint.warning_count);
        self.backed_count.take();
    }
}
