//! Without the feature `meshopt`.

use std::collections::BTreeSet;

use super::Budget;
use crate::error::Fault;
use crate::gltf::document::Document;

impl Document {
    /// Errors: there is a compressed view.
    pub(super) fn decode_meshopt(&mut self, _budget: &mut Budget) -> Result<BTreeSet<usize>, Fault> {
        match self.root.buffer_views.iter().position(|view| view.extensions.meshopt.is_some()) {
            None => Ok(BTreeSet::new()),
            Some(view) => Err(Fault::unsupported(
                format!("bufferViews[{view}].extensions"),
                "is compressed with meshoptimizer, which cannot be read here; use the command `darboux`, or decompress the file",
            )),
        }
    }
}
