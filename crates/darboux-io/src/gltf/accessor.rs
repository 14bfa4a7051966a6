//! Accessors: values behind them, and new ones.

use super::{ComponentType, ElementType};

/// The elements of an accessor as stored, one after the other; sparse elements are in place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Elements {
    /// `count` elements of [`Elements::element_size`] bytes, little-endian.
    pub bytes: Vec<u8>,
    /// The number of elements.
    pub count: usize,
    /// The type of each component.
    pub component_type: ComponentType,
    /// The components of each element.
    pub element_type: ElementType,
    /// Whether integers stand for [0, 1] or [-1, 1].
    pub normalized: bool,
}

impl Elements {
    /// Bytes per element; matrices keep the padding of their columns.
    pub fn element_size(&self) -> usize {
        self.element_type.size(self.component_type)
    }
}

/// An accessor to append, with its bytes. The layout is that of [`Elements`]; alignment is the document's matter.
#[derive(Clone, Debug)]
pub struct NewAccessor {
    /// The elements.
    pub elements: Elements,
    /// What the elements are for: vertex attributes (34962), indices (34963), or neither.
    pub target: Target,
    /// Whether `min` and `max` are written, as they must be for positions. Non-finite values are left out of them.
    pub bounds: bool,
    /// An accessor whose name, extras and extensions are copied.
    pub like: Option<usize>,
}

/// What a buffer view is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Vertex attributes and morph targets: elements start at multiples of four bytes.
    Vertices,
    /// Indices: tightly packed.
    Indices,
}
