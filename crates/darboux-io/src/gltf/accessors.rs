//! Reads the values behind accessors. Every number from the file is checked before it is used.

use std::borrow::Cow;
use std::cmp::Ordering;
use std::sync::PoisonError;

use super::document::{Document, outside_buffer};
use super::element_type::{ComponentType, ElementType};
use super::elements::Elements;
use super::schema::{Accessor, Sparse};
use super::stored_elements::{self, IndexList, StoredElements};
use crate::Error;
use crate::error::ContentError;

/// An accessor without a buffer view may have this many elements even if no accessor with one has as many.
const MAX_ZEROS: usize = 1 << 16;

impl Document {
    /// The elements of an accessor as vectors of floats. Normalised integers become fractions, other integers
    /// become numbers, sparse elements are in place, and an accessor without a buffer view is zero.
    /// Borrowed from the file if its layout permits.
    ///
    /// Errors: the accessor does not have `N` components; its bytes are outside the buffer.
    pub fn vectors<const N: usize>(&self, accessor: usize) -> Result<Cow<'_, [[f32; N]]>, Error> {
        self.find_vectors(accessor).map_err(|error| error.in_file(self.name()))
    }

    /// The values of an accessor of unsigned integers, borrowed from the file if its layout permits.
    ///
    /// Errors: the accessor has another type; its bytes are outside the buffer.
    pub fn indices(&self, accessor: usize) -> Result<IndexList<'_>, Error> {
        self.find_indices(accessor).map_err(|error| error.in_file(self.name()))
    }

    /// The elements of an accessor as bytes. Errors: its bytes are outside the buffer.
    pub fn elements(&self, accessor: usize) -> Result<Elements, Error> {
        self.find_elements(accessor).map_err(|error| error.in_file(self.name()))
    }

    /// The elements of an accessor at some places, as [`Document::vectors`] has them. The time depends on the
    /// number of places only, so that many primitives can share an accessor.
    ///
    /// Errors: as of [`Document::vectors`]; a place without an element.
    pub(super) fn vectors_at<const N: usize>(
        &self,
        accessor: usize,
        places: &[u32],
    ) -> Result<Vec<[f32; N]>, Error> {
        self.find_vectors_at(accessor, places).map_err(|error| error.in_file(self.name()))
    }

    fn find_vectors<const N: usize>(&self, index: usize) -> Result<Cow<'_, [[f32; N]]>, ContentError> {
        let accessor = self.vector_accessor::<N>(index)?;
        let stored = self.stored(index)?;
        Ok(stored_elements::vectors(stored, accessor.component_type, accessor.normalized))
    }

    fn find_vectors_at<const N: usize>(
        &self,
        index: usize,
        places: &[u32],
    ) -> Result<Vec<[f32; N]>, ContentError> {
        let accessor = self.vector_accessor::<N>(index)?;
        let Accessor { component_type, element_type, count, normalized, .. } = *accessor;
        if let Some(place) = places.iter().find(|&&place| place as usize >= count) {
            let problem = format!("has {count} elements, but element {place} is used; export the file again");
            return Err(ContentError::invalid(format!("accessors[{index}]"), problem));
        }
        let size = element_type.size(component_type);
        let mut bytes = match self.without_sparse(index)? {
            Some(stored) => stored.packed_at(places),
            None => vec![0; places.len() * size],
        };
        if let Some(sparse) = &accessor.sparse {
            let at = format!("accessors[{index}].sparse");
            let (indices, values) = self.sparse_elements(sparse, count, size, &at)?;
            self.check_sparse_once(index, &indices, count, &at)?;
            for (place, element) in places.iter().zip(bytes.chunks_exact_mut(size)) {
                if let Some(found) = indices.binary_search(*place) {
                    element.copy_from_slice(&values[found * size..(found + 1) * size]);
                }
            }
        }
        let stored = StoredElements { bytes: bytes.into(), size, stride: size };
        Ok(stored_elements::vectors(stored, component_type, normalized).into_owned())
    }

    /// As [`check_sparse_indices`] for an accessor, whose indices are looked through once.
    fn check_sparse_once(
        &self,
        accessor: usize,
        indices: &SparseIndices<'_>,
        count: usize,
        at: &str,
    ) -> Result<(), ContentError> {
        let checked = || self.checked_sparse.lock().unwrap_or_else(PoisonError::into_inner);
        if !checked().contains(&accessor) {
            check_sparse_indices(indices, count, at)?;
            checked().insert(accessor);
        }
        Ok(())
    }

    /// An accessor of vectors of `N` components.
    fn vector_accessor<const N: usize>(&self, index: usize) -> Result<&Accessor, ContentError> {
        let accessor = self.accessor(index)?;
        let kind = accessor.element_type;
        if kind.components() != N || kind == ElementType::Mat2 {
            let problem = format!("is {}; it must have {N} components here", kind.name());
            return Err(ContentError::invalid(format!("accessors[{index}].type"), problem));
        }
        Ok(accessor)
    }

    fn find_indices(&self, index: usize) -> Result<IndexList<'_>, ContentError> {
        let accessor = self.accessor(index)?;
        let at = |member| format!("accessors[{index}].{member}");
        if accessor.element_type != ElementType::Scalar {
            let problem =
                format!("is {}; indices must be SCALAR; export the file again", accessor.element_type.name());
            return Err(ContentError::invalid(at("type"), problem));
        }
        IndexList::new(self.stored(index)?, accessor.component_type).ok_or_else(|| {
            ContentError::invalid(
                at("componentType"),
                "is signed or float; indices must be unsigned: export the file again",
            )
        })
    }

    fn accessor(&self, index: usize) -> Result<&Accessor, ContentError> {
        let accessors = self.accessors();
        accessors.get(index).ok_or_else(|| {
            let problem =
                format!("does not exist: there are {} accessors; export the file again", accessors.len());
            ContentError::invalid(format!("accessors[{index}]"), problem)
        })
    }

    pub(super) fn find_elements(&self, index: usize) -> Result<Elements, ContentError> {
        let Accessor { component_type, element_type, count, normalized, .. } = *self.accessor(index)?;
        let bytes = self.stored(index)?.packed().into_owned();
        Ok(Elements { bytes, count, component_type, element_type, normalized })
    }

    /// The elements of an accessor in the file, or a copy with sparse elements in place.
    fn stored(&self, index: usize) -> Result<StoredElements<'_>, ContentError> {
        let accessor = self.accessor(index)?;
        let Accessor { component_type, element_type, count, .. } = *accessor;
        let size = element_type.size(component_type);
        let stored = self.without_sparse(index)?.unwrap_or_else(|| StoredElements {
            bytes: vec![0; count.saturating_mul(size)].into(),
            size,
            stride: size,
        });
        let Some(sparse) = &accessor.sparse else { return Ok(stored) };
        let mut bytes = stored.packed().into_owned();
        let at = format!("accessors[{index}].sparse");
        let (indices, values) = self.sparse_elements(sparse, count, size, &at)?;
        check_sparse_indices(&indices, count, &at)?;
        for (place, value) in indices.iter().zip(values.chunks_exact(size)) {
            bytes[place as usize * size..(place as usize + 1) * size].copy_from_slice(value);
        }
        Ok(StoredElements { bytes: bytes.into(), size, stride: size })
    }

    /// The elements of an accessor without its sparse ones; none if all are zero.
    fn without_sparse(&self, index: usize) -> Result<Option<StoredElements<'_>>, ContentError> {
        let accessor = self.accessor(index)?;
        let Accessor { component_type, element_type, count, .. } = *accessor;
        let size = element_type.size(component_type);
        let at = format!("accessors[{index}]");
        match accessor.buffer_view {
            Some(view) => {
                let (bytes, stride) = self.view(view, &format!("{at}.bufferView"))?;
                let layout = ElementLayout { offset: accessor.byte_offset, count, size, stride };
                elements_in_view(bytes, layout, &at).map(Some)
            }
            None if count <= self.most_zeros() => Ok(None),
            None => {
                let problem =
                    format!("{count} elements are too many without a buffer view; export the file again");
                Err(ContentError::invalid(format!("{at}.count"), problem))
            }
        }
    }

    /// The indices of sparse elements and their values of `size` bytes each.
    fn sparse_elements(
        &self,
        sparse: &Sparse,
        count: usize,
        size: usize,
        at: &str,
    ) -> Result<(SparseIndices<'_>, Cow<'_, [u8]>), ContentError> {
        if sparse.count > count {
            let problem = format!(
                "{} is more than the accessor's count of {count}; export the file again",
                sparse.count
            );
            return Err(ContentError::invalid(format!("{at}.count"), problem));
        }
        let indices = self.sparse_indices(sparse, at)?;
        let at_values = format!("{at}.values");
        let (values, _) = self.view(sparse.values.buffer_view, &format!("{at_values}.bufferView"))?;
        let layout =
            ElementLayout { offset: sparse.values.byte_offset, count: sparse.count, size, stride: None };
        Ok((indices, elements_in_view(values, layout, &at_values)?.packed()))
    }

    fn sparse_indices(&self, sparse: &Sparse, at: &str) -> Result<SparseIndices<'_>, ContentError> {
        let at = format!("{at}.indices");
        let indices = &sparse.indices;
        let (bytes, _) = self.view(indices.buffer_view, &format!("{at}.bufferView"))?;
        let size = indices.component_type.size();
        let layout = ElementLayout { offset: indices.byte_offset, count: sparse.count, size, stride: None };
        let bytes = elements_in_view(bytes, layout, &at)?.packed();
        if matches!(indices.component_type, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return Ok(SparseIndices { bytes, size });
        }
        Err(ContentError::invalid(
            format!("{at}.componentType"),
            "is signed or float; indices must be unsigned: export the file again",
        ))
    }

    /// Checks by the sizes in the JSON that every buffer view lies in its buffer, the elements of every
    /// accessor in its buffer view, and that every attribute of a primitive has one element per position.
    pub(super) fn check_sizes(&self) -> Result<(), ContentError> {
        self.check_views()?;
        self.check_accessors()?;
        self.check_attributes()
    }

    fn check_views(&self) -> Result<(), ContentError> {
        for (i, view) in self.root.buffer_views.iter().enumerate() {
            let Some(buffer) = self.root.buffers.get(view.buffer) else { continue };
            let (offset, length) = (view.byte_offset, view.byte_length);
            if offset.checked_add(length).is_none_or(|end| end > buffer.byte_length) {
                return Err(outside_buffer(offset, length, buffer.byte_length, &format!("bufferViews[{i}]")));
            }
        }
        Ok(())
    }

    fn check_accessors(&self) -> Result<(), ContentError> {
        for (i, accessor) in self.accessors().iter().enumerate() {
            let view = accessor.buffer_view.and_then(|view| self.root.buffer_views.get(view));
            if let Some(view) = view {
                let size = accessor.element_type.size(accessor.component_type);
                let Accessor { byte_offset: offset, count, .. } = *accessor;
                let layout = ElementLayout { offset, count, size, stride: view.byte_stride };
                end_in_view(view.byte_length, &layout, &format!("accessors[{i}]"))?;
            }
        }
        Ok(())
    }

    fn check_attributes(&self) -> Result<(), ContentError> {
        let count = |accessor: usize| self.accessors().get(accessor).map(|accessor| accessor.count);
        for (mesh, primitives) in self.meshes().iter().enumerate() {
            for (place, primitive) in primitives.primitives.iter().enumerate() {
                let Some(vertices) = primitive.attributes.get("POSITION").and_then(|&index| count(index))
                else {
                    continue;
                };
                for (name, &index) in &primitive.attributes {
                    if let Some(found) = count(index).filter(|&found| found != vertices) {
                        let at = format!("meshes[{mesh}].primitives[{place}].attributes.{name}");
                        let problem = format!(
                            "has {found} elements but there are {vertices} positions; export the file again"
                        );
                        return Err(ContentError::invalid(at, problem));
                    }
                }
            }
        }
        Ok(())
    }

    /// The most elements of an accessor without a buffer view: as many as the largest accessor with one has.
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
        let layout = ElementLayout { offset: accessor.byte_offset, count: accessor.count, size, stride };
        layout.end().is_some_and(|end| end <= bytes.len())
    }
}

/// The indices of sparse elements, as they are stored.
struct SparseIndices<'a> {
    bytes: Cow<'a, [u8]>,
    /// Bytes per index.
    size: usize,
}

impl SparseIndices<'_> {
    fn iter(&self) -> impl Iterator<Item = u32> {
        self.bytes.chunks_exact(self.size).map(index_of)
    }

    /// The place of an index among ascending ones.
    fn binary_search(&self, index: u32) -> Option<usize> {
        let (mut from, mut to) = (0, self.bytes.len() / self.size);
        while from < to {
            let middle = from.midpoint(to);
            match index_of(&self.bytes[middle * self.size..(middle + 1) * self.size]).cmp(&index) {
                Ordering::Equal => return Some(middle),
                Ordering::Less => from = middle + 1,
                Ordering::Greater => to = middle,
            }
        }
        None
    }
}

/// The number of some little-endian bytes.
fn index_of(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |index, &byte| index << 8 | u32::from(byte))
}

/// Checks that the indices of sparse elements ascend and are below `count`. `at` is the JSON path.
fn check_sparse_indices(indices: &SparseIndices<'_>, count: usize, at: &str) -> Result<(), ContentError> {
    let mut next = 0;
    for (i, place) in indices.iter().enumerate() {
        let place = place as usize;
        if place < next || place >= count {
            let problem = format!(
                "index {place} at place {i} is not greater than the one before, or not below {count}; export \
                 the file again"
            );
            return Err(ContentError::invalid(format!("{at}.indices"), problem));
        }
        next = place + 1;
    }
    Ok(())
}

/// The layout of elements in a buffer view.
struct ElementLayout {
    offset: usize,
    count: usize,
    size: usize,
    stride: Option<usize>,
}

impl ElementLayout {
    /// The offset after the last element; none if that overflows, or if elements overlap.
    fn end(&self) -> Option<usize> {
        let stride = self.stride.unwrap_or(self.size);
        let steps = self.count.saturating_sub(1);
        let length = if self.count == 0 { 0 } else { steps.checked_mul(stride)?.checked_add(self.size)? };
        if stride < self.size { None } else { length.checked_add(self.offset) }
    }
}

/// The elements of a buffer view. `at` is the JSON path of the accessor.
fn elements_in_view<'a>(
    view: &'a [u8],
    layout: ElementLayout,
    at: &str,
) -> Result<StoredElements<'a>, ContentError> {
    let end = end_in_view(view.len(), &layout, at)?;
    let ElementLayout { offset, size, stride, .. } = layout;
    Ok(StoredElements { bytes: view[offset.min(end)..end].into(), size, stride: stride.unwrap_or(size) })
}

/// The offset after the last element. Errors: the elements overlap, or do not fit a view of `view_length`
/// bytes.
fn end_in_view(view_length: usize, layout: &ElementLayout, at: &str) -> Result<usize, ContentError> {
    let ElementLayout { offset, count, size, stride } = *layout;
    if let Some(stride) = stride.filter(|&stride| stride < size) {
        let problem =
            format!("its buffer view's byteStride of {stride} is less than an element's {size} bytes");
        return Err(ContentError::invalid(at, format!("{problem}; export the file again")));
    }
    layout.end().filter(|&end| end <= view_length).ok_or_else(|| {
        let problem = format!(
            "{count} elements of {size} bytes from byte {offset} on do not fit its buffer view of \
             {view_length} bytes"
        );
        ContentError::invalid(at, format!("{problem}; export the file again"))
    })
}
