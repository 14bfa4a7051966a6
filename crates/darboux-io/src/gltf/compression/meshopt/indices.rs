//! The codec of index sequences: `KHR_meshopt_compression`, appendix A, mode 2.

use super::bytes::Bytes;

const HEADER: u8 = 0xd1;

/// The bytes after the last index.
const TAIL: usize = 4;

/// Decodes `count` indices of `SIZE` bytes. None: the stream is broken.
pub fn decode<const SIZE: usize>(stream: &[u8], count: usize) -> Option<Vec<u8>> {
    let (&HEADER, rest) = stream.split_first()? else { return None };
    let mut bytes = Bytes::new(rest.get(..rest.len().checked_sub(TAIL)?)?);
    let mut indices = vec![0; count.checked_mul(SIZE)?];
    let mut last = [0u32; 2];
    for index in indices.as_chunks_mut::<SIZE>().0 {
        // The lowest bit chooses the index that the difference is to.
        let code = bytes.varint()?;
        let last = &mut last[code as usize & 1];
        *last = last.wrapping_add(unzigzag(code >> 1));
        *index = low_bytes(*last);
    }
    bytes.is_empty().then_some(indices)
}

/// A signed difference from its zigzag code.
pub(super) fn unzigzag(code: u32) -> u32 {
    (code >> 1) ^ (code & 1).wrapping_neg()
}

/// The lowest bytes of an index, little-endian.
pub(super) fn low_bytes<const SIZE: usize>(index: u32) -> [u8; SIZE] {
    let bytes = index.to_le_bytes();
    std::array::from_fn(|i| bytes[i])
}
