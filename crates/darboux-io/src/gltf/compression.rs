//! Decompression: primitives compressed with Draco and buffer views compressed with meshoptimizer become
//! plain data.

mod draco;
mod meshopt;

use std::collections::BTreeSet;

use crate::json::Value;

use super::document::Document;
use super::element_type::ComponentType;
use super::schema::Accessor;
use crate::error::ContentError;
use crate::memory_limit::Budget;

impl Document {
    /// Decodes all compressed meshes and buffer views and removes the extensions. Opening does this before
    /// anything else reads the document. It does not count as an edit: without others, the file is
    /// written as it was.
    ///
    /// A file's uncompressed fallback data is used if there is any. Errors: a stream that is broken, or does
    /// not match its accessors or buffer views; more data than
    /// [`LoadOptions::memory_limit`](crate::LoadOptions::memory_limit) permits.
    pub(super) fn decompress(&mut self) -> Result<(), ContentError> {
        let mut primitives = self.root.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let is_compressed = primitives.any(|primitive| primitive.extensions.draco.is_some())
            || self.root.buffer_views.iter().any(|view| view.extensions.meshopt.is_some());
        if is_compressed {
            let limit = self.memory_limit();
            self.decode_all(&mut DecodeBudget { left: limit.bytes, limit })?;
            self.is_changed = false;
            self.was_compressed = true;
        }
        Ok(())
    }

    /// Makes the decoding of compressed data an edit: the document is then written without compression even
    /// if there are no others.
    pub fn discard_compression(&mut self) {
        self.is_changed |= self.was_compressed;
    }

    fn decode_all(&mut self, budget: &mut DecodeBudget) -> Result<(), ContentError> {
        let views = self.decode_meshopt(budget)?;
        let mut accessors = self.decode_draco(budget)?;
        for (i, accessor) in self.root.accessors.iter().enumerate() {
            if accessor.buffer_view.is_some_and(|view| views.contains(&view)) {
                accessors.insert(i);
            }
        }
        self.refresh_bounds(&accessors, budget)
    }

    /// Corrects `min` and `max` of decoded accessors, since lossy compression changes values.
    fn refresh_bounds(
        &mut self,
        accessors: &BTreeSet<usize>,
        budget: &mut DecodeBudget,
    ) -> Result<(), ContentError> {
        for &index in accessors {
            let stored =
                ["min", "max"].map(|key| self.element("accessors", index).get(key).and_then(numbers));
            if stored == [None, None] {
                continue;
            }
            let Accessor { count, element_type, component_type, .. } = self.root.accessors[index];
            budget.spend(
                count.saturating_mul(element_type.size(component_type)),
                &format!("accessors[{index}]"),
            )?;
            let Some((min, max)) = self.find_elements(index)?.bounds() else { continue };
            for (key, old, found) in [("min", &stored[0], min), ("max", &stored[1], max)] {
                if old.as_ref().is_some_and(|old| !same_values(old, &found, component_type)) {
                    self.edit_element("accessors", index, |accessor| accessor[key] = found.into())?;
                }
            }
        }
        Ok(())
    }
}

/// The numbers of an array; none if it is not one of numbers.
fn numbers(array: &Value) -> Option<Vec<f64>> {
    array.as_array()?.iter().map(Value::as_f64).collect()
}

/// Whether bounds are equal as numbers of the component type: JSON may spell them with fewer digits.
fn same_values(a: &[f64], b: &[f64], kind: ComponentType) -> bool {
    match kind {
        ComponentType::F32 => a.iter().map(|&x| x as f32).eq(b.iter().map(|&x| x as f32)),
        _ => a == b,
    }
}

/// The bytes that may be decoded.
struct DecodeBudget {
    left: usize,
    limit: Budget,
}

impl DecodeBudget {
    /// Subtracts bytes before they are decoded. Errors: too few are left.
    fn spend(&mut self, bytes: usize, at: &str) -> Result<(), ContentError> {
        self.left = self
            .left
            .checked_sub(bytes)
            .ok_or_else(|| ContentError::unsupported(at, self.limit.exceeded("the file decompresses to")))?;
        Ok(())
    }
}
