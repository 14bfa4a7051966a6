//! Refuses files compressed with meshoptimizer when the feature `meshopt` is off.

use std::collections::BTreeSet;

use super::DecodeBudget;
use crate::error::ContentError;
use crate::gltf::document::Document;

impl Document {
    /// Errors: the document has a compressed buffer view.
    pub(super) fn decode_meshopt(
        &mut self,
        _budget: &mut DecodeBudget,
    ) -> Result<BTreeSet<usize>, ContentError> {
        match self.root.buffer_views.iter().position(|view| view.extensions.meshopt.is_some()) {
            None => Ok(BTreeSet::new()),
            Some(view) => Err(ContentError::unsupported(
                format!("bufferViews[{view}].extensions"),
                "is compressed with meshoptimizer, which this build cannot decode; use the command `darboux`, or decompress the file",
            )),
        }
    }
}
