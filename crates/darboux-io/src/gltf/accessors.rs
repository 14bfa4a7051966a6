//! Accessors: the values behind them, and new ones. Every number from the file is checked before it is used.

use std::borrow::Cow;
use std::fmt::Write as _;

use serde_json::Value;

use super::document::Document;
use super::schema::{Accessor, Sparse};
use super::values::{self, IndexList, Stored};
use super::{ComponentType, ElementType, json};
use crate::Error;
use crate::error::Fault;

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

    /// The places of the elements that are not zero, if storing only those takes fewer bytes.
    pub(super) fn worth_storing(&self) -> Option<Vec<u32>> {
        let size = self.element_size();
        let elements = self.bytes.chunks_exact(size).enumerate();
        let places = elements.filter(|(_, element)| element.iter().any(|&byte| byte != 0));
        let places: Vec<_> = places.map(|(place, _)| u32::try_from(place)).collect::<Result<_, _>>().ok()?;
        (places.len() * (4 + size) < self.bytes.len()).then_some(places)
    }

    /// The least and the greatest finite value of every component; none where a component has no finite value.
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
        let known = bounds.iter().all(|(min, max)| min <= max);
        known.then(|| bounds.into_iter().unzip())
    }
}

impl ComponentType {
    /// The number that `bytes` store, not normalised.
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

/// An accessor to append, with its bytes. The layout is that of [`Elements`]; alignment is the document's matter.
#[derive(Clone, Debug)]
pub struct NewAccessor {
    /// The elements.
    pub elements: Elements,
    /// What the elements are for: vertex attributes or indices.
    pub target: Target,
    /// Whether `min` and `max` are written, as they must be for positions. Non-finite values are left out of them.
    pub bounds: bool,
    /// Whether only the elements that are not zero may be stored, where that takes fewer bytes.
    pub sparse: bool,
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
    /// Keyframes, matrices, whatever is not of primitives: tightly packed.
    Other,
}

impl Target {
    /// glTF's number, where it has one.
    pub(super) fn code(self) -> Option<u32> {
        match self {
            Self::Vertices => Some(34962),
            Self::Indices => Some(34963),
            Self::Other => None,
        }
    }

    /// Bytes from one element of `size` bytes to the next.
    pub(super) fn stride(self, size: usize) -> usize {
        match self {
            Self::Vertices => size.next_multiple_of(4),
            Self::Indices | Self::Other => size,
        }
    }
}

/// The JSON of a new accessor with some `bounds`, described `like` another.
pub(super) fn accessor_json(stored: &Accessor, bounds: Option<Bounds>, like: Option<&Accessor>) -> String {
    let mut text = "{".to_owned();
    if let Some(view) = stored.buffer_view {
        let _ = write!(text, "\"bufferView\":{view},");
    }
    let _ = write!(text, "\"componentType\":{}", stored.component_type.code());
    if stored.normalized {
        text.push_str(",\"normalized\":true");
    }
    let _ = write!(text, ",\"count\":{},\"type\":\"{}\"", stored.count, stored.element_type.name());
    if let Some((min, max)) = bounds {
        let (min, max) = (Value::from(min), Value::from(max));
        let _ = write!(text, ",\"min\":{min},\"max\":{max}");
    }
    if let Some(Sparse { count, indices, values }) = stored.sparse.as_deref() {
        let (kind, indices, values) =
            (indices.component_type.code(), indices.buffer_view, values.buffer_view);
        let indices = format!("{{\"bufferView\":{indices},\"componentType\":{kind}}}");
        let values = format!("{{\"bufferView\":{values}}}");
        let _ = write!(text, ",\"sparse\":{{\"count\":{count},\"indices\":{indices},\"values\":{values}}}");
    }
    for (key, value) in like.map(Accessor::descriptions).into_iter().flatten() {
        let _ = write!(text, ",{}:{value}", json::quoted(key));
    }
    text.push('}');
    text
}

/// Accessors without a buffer view may have this many elements even where no accessor with one has as many.
const MAX_ZEROS: usize = 1 << 16;

impl Document {
    /// The values of an accessor as floats: normalised integers as fractions, other integers as numbers, sparse elements in
    /// place, zeros without a buffer view. Borrowed from the file where it has them so.
    ///
    /// Errors: another number of components than `N`; bytes that are not there.
    pub fn vectors<const N: usize>(&self, accessor: usize) -> Result<Cow<'_, [[f32; N]]>, Error> {
        self.find_vectors(accessor).map_err(|fault| fault.in_file(self.name()))
    }

    /// As [`Document::vectors`], copied.
    pub fn read_vectors<const N: usize>(&self, accessor: usize) -> Result<Vec<[f32; N]>, Error> {
        self.vectors(accessor).map(Cow::into_owned)
    }

    /// The values of an accessor of unsigned integers, borrowed from the file where it has them so.
    ///
    /// Errors: another type; bytes that are not there.
    pub fn indices(&self, accessor: usize) -> Result<IndexList<'_>, Error> {
        self.find_indices(accessor).map_err(|fault| fault.in_file(self.name()))
    }

    /// As [`Document::indices`], copied and widened.
    pub fn read_indices(&self, accessor: usize) -> Result<Vec<u32>, Error> {
        self.indices(accessor).map(IndexList::widened)
    }

    /// The elements of an accessor as bytes, to gather and to write again. Errors: bytes that are not there.
    pub fn read_elements(&self, accessor: usize) -> Result<Elements, Error> {
        self.elements(accessor).map_err(|fault| fault.in_file(self.name()))
    }

    fn find_vectors<const N: usize>(&self, index: usize) -> Result<Cow<'_, [[f32; N]]>, Fault> {
        let accessor = self.accessor(index)?;
        let kind = accessor.element_type;
        if kind.components() != N || kind == ElementType::Mat2 {
            let problem = format!("is {}; it must have {N} components here", kind.name());
            return Err(Fault::invalid(format!("accessors[{index}].type"), problem));
        }
        let stored = self.stored(index)?;
        Ok(values::vectors(stored, accessor.component_type, accessor.normalized))
    }

    fn find_indices(&self, index: usize) -> Result<IndexList<'_>, Fault> {
        let accessor = self.accessor(index)?;
        let at = |member| format!("accessors[{index}].{member}");
        if accessor.element_type != ElementType::Scalar {
            let problem = format!("is {}; indices must be SCALAR", accessor.element_type.name());
            return Err(Fault::invalid(at("type"), problem));
        }
        IndexList::new(self.stored(index)?, accessor.component_type).ok_or_else(|| {
            Fault::invalid(at("componentType"), "is signed or float; indices must be unsigned")
        })
    }

    fn accessor(&self, index: usize) -> Result<&Accessor, Fault> {
        let accessors = self.accessors();
        accessors.get(index).ok_or_else(|| {
            let problem =
                format!("does not exist: there are {} accessors; export the file again", accessors.len());
            Fault::invalid(format!("accessors[{index}]"), problem)
        })
    }

    pub(super) fn elements(&self, index: usize) -> Result<Elements, Fault> {
        let Accessor { component_type, element_type, count, normalized, .. } = *self.accessor(index)?;
        let bytes = self.stored(index)?.packed().into_owned();
        Ok(Elements { bytes, count, component_type, element_type, normalized })
    }

    /// The elements of an accessor where they are, sparse ones in place.
    fn stored(&self, index: usize) -> Result<Stored<'_>, Fault> {
        let accessor = self.accessor(index)?;
        let Accessor { component_type, element_type, count, .. } = *accessor;
        let size = element_type.size(component_type);
        let at = format!("accessors[{index}]");
        let stored = match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.view(view, &format!("{at}.bufferView"))?;
                located(bytes, Layout { offset: accessor.byte_offset, count, size, stride }, &at)?
            }
            None if count <= self.most_zeros() => {
                Stored { bytes: vec![0; count.saturating_mul(size)].into(), size, stride: size }
            }
            None => {
                let problem =
                    format!("{count} elements are too many without a buffer view; export the file again");
                return Err(Fault::invalid(format!("{at}.count"), problem));
            }
        };
        let Some(sparse) = &accessor.sparse else { return Ok(stored) };
        let mut bytes = stored.packed().into_owned();
        self.apply_sparse(sparse, &mut bytes, count, size, &format!("{at}.sparse"))?;
        Ok(Stored { bytes: bytes.into(), size, stride: size })
    }

    fn apply_sparse(
        &self,
        sparse: &Sparse,
        bytes: &mut [u8],
        count: usize,
        size: usize,
        at: &str,
    ) -> Result<(), Fault> {
        if sparse.count > count {
            let problem = format!("{} is more than the accessor's count of {count}", sparse.count);
            return Err(Fault::invalid(format!("{at}.count"), problem));
        }
        let places = self.sparse_indices(sparse, at)?;
        let at_values = format!("{at}.values");
        let (values, _) = self.view(sparse.values.buffer_view, &format!("{at_values}.bufferView"))?;
        let layout = Layout { offset: sparse.values.byte_offset, count: sparse.count, size, stride: None };
        let values = located(values, layout, &at_values)?.packed();
        let mut next = 0;
        for (i, (place, value)) in places.widened().into_iter().zip(values.chunks_exact(size)).enumerate() {
            let place = place as usize;
            if place < next || place >= count {
                let problem = format!("index {place} at place {i} does not increase or is not below {count}");
                return Err(Fault::invalid(format!("{at}.indices"), problem));
            }
            bytes[place * size..(place + 1) * size].copy_from_slice(value);
            next = place + 1;
        }
        Ok(())
    }

    fn sparse_indices(&self, sparse: &Sparse, at: &str) -> Result<IndexList<'_>, Fault> {
        let at = format!("{at}.indices");
        let indices = &sparse.indices;
        let (bytes, _) = self.view(indices.buffer_view, &format!("{at}.bufferView"))?;
        let size = indices.component_type.size();
        let layout = Layout { offset: indices.byte_offset, count: sparse.count, size, stride: None };
        IndexList::new(located(bytes, layout, &at)?, indices.component_type).ok_or_else(|| {
            Fault::invalid(format!("{at}.componentType"), "is signed or float; indices must be unsigned")
        })
    }

    /// How many zeros an accessor without a buffer view may stand for: as many as another has real elements.
    fn most_zeros(&self) -> usize {
        *self.backed_count.get_or_init(|| {
            let backed = self.accessors().iter().filter(|accessor| self.is_backed(accessor));
            backed.map(|accessor| accessor.count).max().unwrap_or(0).max(MAX_ZEROS)
        })
    }

    fn is_backed(&self, accessor: &Accessor) -> bool {
        let Some(Ok((bytes, stride))) = accessor.buffer_view.map(|view| self.view(view, "")) else {
            return false;
        };
        let size = accessor.element_type.size(accessor.component_type);
        let layout = Layout { offset: accessor.byte_offset, count: accessor.count, size, stride };
        layout.end().is_some_and(|end| end <= bytes.len())
    }
}

/// Where elements lie in a buffer view.
struct Layout {
    offset: usize,
    count: usize,
    size: usize,
    stride: Option<usize>,
}

impl Layout {
    /// The first byte after the last element, unless that overflows or elements overlap.
    fn end(&self) -> Option<usize> {
        let stride = self.stride.unwrap_or(self.size);
        let steps = self.count.saturating_sub(1);
        let length = if self.count == 0 { 0 } else { steps.checked_mul(stride)?.checked_add(self.size)? };
        if stride < self.size { None } else { length.checked_add(self.offset) }
    }
}

/// The elements in `view`.
fn located<'a>(view: &'a [u8], layout: Layout, at: &str) -> Result<Stored<'a>, Fault> {
    let Layout { offset, count, size, stride } = layout;
    if let Some(stride) = stride.filter(|&stride| stride < size) {
        let problem =
            format!("its buffer view's byteStride of {stride} is less than an element's {size} bytes");
        return Err(Fault::invalid(at, format!("{problem}; export the file again")));
    }
    let Some(end) = layout.end().filter(|&end| end <= view.len()) else {
        let problem = format!(
            "{count} elements of {size} bytes from byte {offset} on do not fit its buffer view of {} bytes",
            view.len()
        );
        return Err(Fault::invalid(at, format!("{problem}; export the file again")));
    };
    Ok(Stored { bytes: view[offset.min(end)..end].into(), size, stride: stride.unwrap_or(size) })
}
