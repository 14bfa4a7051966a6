//! Elements of accessors as bytes, and new accessors made of them.

use crate::json::{Map, Value, object};

use super::element_type::{ComponentType, ElementType};
use super::schema::{Accessor, Sparse};

/// The elements of an accessor as bytes, one after the other, with sparse elements in place.
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
    /// Whether integers encode [0, 1] or [-1, 1].
    pub normalized: bool,
}

impl Elements {
    /// Bytes per element, with the padding of matrix columns.
    pub fn element_size(&self) -> usize {
        self.element_type.size(self.component_type)
    }

    /// The indices of the elements that are not zero, if a sparse accessor of them takes fewer bytes.
    pub(super) fn sparse_indices(&self) -> Option<Vec<u32>> {
        let size = self.element_size();
        let elements = self.bytes.chunks_exact(size).enumerate();
        let places = elements.filter(|(_, element)| element.iter().any(|&byte| byte != 0));
        let places: Vec<_> = places.map(|(place, _)| u32::try_from(place)).collect::<Result<_, _>>().ok()?;
        (places.len() * (4 + size) < self.bytes.len()).then_some(places)
    }

    /// The least and the greatest finite value of every component; none if a component has no finite value.
    pub(super) fn bounds(&self) -> Option<Bounds> {
        let (columns, rows) = self.element_type.shape();
        let (size, column_size) = (self.component_type.size(), self.element_size() / columns);
        let mut bounds = vec![(f64::INFINITY, f64::NEG_INFINITY); columns * rows];
        for element in self.bytes.chunks_exact(self.element_size()) {
            let columns = element.chunks_exact(column_size);
            let components = columns.flat_map(|column| column.chunks_exact(size).take(rows));
            for (bound, bytes) in bounds.iter_mut().zip(components) {
                let value = self.component_type.value(bytes);
                if value.is_finite() {
                    *bound = (bound.0.min(value), bound.1.max(value));
                }
            }
        }
        let has_all = bounds.iter().all(|(min, max)| min <= max);
        has_all.then(|| bounds.into_iter().unzip())
    }
}

impl ComponentType {
    /// The number in `bytes`, without normalisation.
    fn value(self, bytes: &[u8]) -> f64 {
        let word = bytes.iter().rev().fold(0u32, |word, &byte| word << 8 | u32::from(byte));
        match self {
            Self::U8 | Self::U16 | Self::U32 => f64::from(word),
            Self::I8 => f64::from(word as u8 as i8),
            Self::I16 => f64::from(word as u16 as i16),
            Self::F32 => f64::from(f32::from_bits(word)),
        }
    }
}

/// The least and the greatest value of every component.
pub(super) type Bounds = (Vec<f64>, Vec<f64>);

/// An accessor to append to a document, which aligns its elements.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct NewAccessor {
    /// The elements.
    pub elements: Elements,
    /// The use of the elements.
    pub target: Target,
    /// Writes `min` and `max`, which positions must have. Values that are not finite are ignored.
    pub bounds: bool,
    /// Permits a sparse accessor, if that takes fewer bytes.
    pub sparse: bool,
    /// The accessor whose name, extras and extensions are copied.
    pub metadata_of: Option<usize>,
}

impl NewAccessor {
    /// An accessor of these elements, without `min` and `max`, not sparse and without a name.
    pub const fn new(elements: Elements, target: Target) -> Self {
        Self { elements, target, bounds: false, sparse: false, metadata_of: None }
    }

    /// This accessor with `min` and `max`, or without.
    #[must_use]
    pub fn with_bounds(self, bounds: bool) -> Self {
        Self { bounds, ..self }
    }

    /// This accessor, sparse if that takes fewer bytes, or never sparse.
    #[must_use]
    pub fn with_sparse(self, sparse: bool) -> Self {
        Self { sparse, ..self }
    }

    /// This accessor with the name, extras and extensions of an existing accessor.
    #[must_use]
    pub fn with_metadata_of(self, accessor: Option<usize>) -> Self {
        Self { metadata_of: accessor, ..self }
    }
}

/// The use of a buffer view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Vertex attributes and morph targets: elements start at multiples of four bytes.
    Vertices,
    /// Indices: tightly packed.
    Indices,
    /// Keyframes, matrices and other data: tightly packed.
    Other,
}

impl Target {
    /// The constant of glTF, if there is one.
    pub(super) fn code(self) -> Option<u32> {
        match self {
            Self::Vertices => Some(34962),
            Self::Indices => Some(34963),
            Self::Other => None,
        }
    }

    /// The stride of elements of `size` bytes.
    pub(super) fn stride(self, size: usize) -> usize {
        match self {
            Self::Vertices => size.next_multiple_of(4),
            Self::Indices | Self::Other => size,
        }
    }
}

impl Accessor {
    /// The JSON of a new accessor.
    pub(super) fn to_json(&self, bounds: Option<Bounds>) -> Map {
        let mut element = Map::default();
        let mut set = |key: &str, value: Value| element.insert(key, value);
        if let Some(view) = self.buffer_view {
            set("bufferView", view.into());
        }
        set("componentType", self.component_type.code().into());
        if self.normalized {
            set("normalized", true.into());
        }
        set("count", self.count.into());
        set("type", self.element_type.name().into());
        if let Some((min, max)) = bounds {
            set("min", min.into());
            set("max", max.into());
        }
        if let Some(Sparse { count, indices, values }) = self.sparse.as_deref() {
            let kind = indices.component_type.code();
            let indices = object! { "bufferView": indices.buffer_view, "componentType": kind };
            let values = object! { "bufferView": values.buffer_view };
            set("sparse", object! { "count": *count, "indices": indices, "values": values });
        }
        element
    }
}
