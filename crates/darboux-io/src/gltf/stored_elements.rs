//! Converts the stored elements of an accessor to floats and indices, or borrows them if the file has them in
//! that form.

use std::borrow::Cow;

use bytemuck::Pod;
use darboux::Indices;

use super::ComponentType;

/// The elements of an accessor in a buffer view, with checked offsets.
#[derive(Debug)]
pub(super) struct StoredElements<'a> {
    /// The bytes from the start of the first element to the end of the last one.
    pub bytes: Cow<'a, [u8]>,
    /// Bytes per element.
    pub size: usize,
    /// Bytes from one element to the next, at least [`StoredElements::size`].
    pub stride: usize,
}

impl<'a> StoredElements<'a> {
    /// The elements without gaps.
    pub fn packed(self) -> Cow<'a, [u8]> {
        let Self { bytes, size, stride } = self;
        if stride == size {
            return bytes;
        }
        let mut packed = Vec::with_capacity(bytes.len().div_ceil(stride) * size);
        bytes.chunks(stride).for_each(|element| packed.extend_from_slice(&element[..size]));
        packed.into()
    }

    /// The elements at some places without gaps. Panics: a place has no element.
    pub fn packed_at(&self, places: &[u32]) -> Vec<u8> {
        let mut packed = Vec::with_capacity(places.len() * self.size);
        for &place in places {
            let start = place as usize * self.stride;
            packed.extend_from_slice(&self.bytes[start..start + self.size]);
        }
        packed
    }

    /// The elements as values of `T`, if they have its size, alignment and byte order.
    fn borrowed<T: Pod>(&self) -> Option<&'a [T]> {
        let fits = cfg!(target_endian = "little") && self.stride == self.size && self.size == size_of::<T>();
        match self.bytes {
            Cow::Borrowed(bytes) if fits => bytemuck::try_cast_slice(bytes).ok(),
            _ => None,
        }
    }

    /// The elements as `N` components of `S` bytes each.
    fn decoded<const N: usize, const S: usize, T>(&self, value: impl Fn([u8; S]) -> T) -> Vec<[T; N]> {
        let element = |bytes: &[[u8; S]; N]| bytes.each_ref().map(|component| value(*component));
        if self.stride == N * S {
            return self.bytes.as_chunks::<S>().0.as_chunks::<N>().0.iter().map(element).collect();
        }
        let first = |bytes: &[u8]| element(bytes.as_chunks().0.first_chunk().expect("a whole element"));
        self.bytes.chunks(self.stride).map(first).collect()
    }
}

/// Elements of `N` components as floats. Normalised integers become fractions (glTF 2.0, 3.11).
pub(super) fn vectors<const N: usize>(
    stored: StoredElements<'_>,
    kind: ComponentType,
    normalized: bool,
) -> Cow<'_, [[f32; N]]> {
    if let Some(vectors) = stored.borrowed().filter(|_| kind == ComponentType::F32) {
        return vectors.into();
    }
    let vectors = match (kind, normalized) {
        (ComponentType::F32, _) => stored.decoded(f32::from_le_bytes),
        (ComponentType::U8, false) => stored.decoded(|b| f32::from(u8::from_le_bytes(b))),
        (ComponentType::I8, false) => stored.decoded(|b| f32::from(i8::from_le_bytes(b))),
        (ComponentType::U16, false) => stored.decoded(|b| f32::from(u16::from_le_bytes(b))),
        (ComponentType::I16, false) => stored.decoded(|b| f32::from(i16::from_le_bytes(b))),
        (ComponentType::U8, true) => stored.decoded(|b| f32::from(u8::from_le_bytes(b)) / 255.0),
        (ComponentType::I8, true) => stored.decoded(|b| (f32::from(i8::from_le_bytes(b)) / 127.0).max(-1.0)),
        (ComponentType::U16, true) => stored.decoded(|b| f32::from(u16::from_le_bytes(b)) / 65535.0),
        (ComponentType::I16, true) => {
            stored.decoded(|b| (f32::from(i16::from_le_bytes(b)) / 32767.0).max(-1.0))
        }
        (ComponentType::U32, _) => stored.decoded(|b| u32::from_le_bytes(b) as f32),
    };
    vectors.into()
}

/// A list of indices with the width of the file; 8-bit indices are widened to 16 bits.
#[derive(Clone, Debug)]
pub enum IndexList<'a> {
    /// Indices of 8 or 16 bits.
    U16(Cow<'a, [u16]>),
    /// Indices of 32 bits.
    U32(Cow<'a, [u32]>),
}

impl<'a> IndexList<'a> {
    /// The indices in `stored`; none if the component type is signed or float.
    pub(super) fn new(stored: StoredElements<'a>, kind: ComponentType) -> Option<Self> {
        let flat = |list: Vec<[u16; 1]>| Self::U16(list.into_flattened().into());
        match kind {
            ComponentType::U8 => Some(flat(stored.decoded(|b| u16::from(u8::from_le_bytes(b))))),
            ComponentType::U16 => Some(match stored.borrowed() {
                Some(list) => Self::U16(list.into()),
                None => flat(stored.decoded(u16::from_le_bytes)),
            }),
            ComponentType::U32 => Some(Self::U32(match stored.borrowed() {
                Some(list) => list.into(),
                None => stored.decoded::<1, 4, _>(u32::from_le_bytes).into_flattened().into(),
            })),
            ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => None,
        }
    }

    /// The number of indices.
    pub fn len(&self) -> usize {
        match self {
            Self::U16(list) => list.len(),
            Self::U32(list) => list.len(),
        }
    }

    /// Whether the list is empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The indices as an argument of mesh functions.
    pub fn as_indices(&self) -> Indices<'_> {
        match self {
            Self::U16(list) => Indices::U16(list),
            Self::U32(list) => Indices::U32(list),
        }
    }

    /// The indices as 32-bit integers.
    pub fn into_u32(self) -> Vec<u32> {
        match self {
            Self::U16(list) => list.iter().map(|&index| index.into()).collect(),
            Self::U32(list) => list.into_owned(),
        }
    }

    /// Shortens the list to `at` indices, at most its length. Returns a copy of the others.
    pub(super) fn split_off(&mut self, at: usize) -> Vec<u32> {
        match self {
            Self::U16(list) => split_off(list, at).into_iter().map(u32::from).collect(),
            Self::U32(list) => split_off(list, at),
        }
    }

    /// An iterator over the indices.
    pub(super) fn iter(&self) -> Box<dyn Iterator<Item = u32> + '_> {
        match self {
            Self::U16(list) => Box::new(list.iter().map(|&index| index.into())),
            Self::U32(list) => Box::new(list.iter().copied()),
        }
    }
}

/// Shortens `list` to `at` elements. Returns the others.
fn split_off<T: Copy>(list: &mut Cow<'_, [T]>, at: usize) -> Vec<T> {
    match list {
        Cow::Borrowed(all) => {
            let (kept, rest) = all.split_at(at);
            *all = kept;
            rest.to_vec()
        }
        Cow::Owned(all) => all.split_off(at),
    }
}
