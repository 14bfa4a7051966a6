//! The deltas of one byte of the elements of a block: groups of 16 with few bits each, and bytes where these
//! are not enough.

/// The most elements of a block.
pub const BLOCK: usize = 256;

/// The number of deltas of a group.
pub const GROUP: usize = 16;

/// The most bytes of a group with few bits per delta: four bits each, and a byte each.
const MAX_GROUP_BYTES: usize = 24;

/// How the deltas of one byte are stored.
#[derive(Clone, Copy)]
pub enum Control {
    /// Groups of 0, 2, 4 or 8 bits.
    Version0,
    /// Groups of 0, 1, 2 or 4 bits.
    Few,
    /// Groups of 1, 2, 4 or 8 bits.
    Many,
    /// All are zero; nothing is stored.
    Zero,
    /// A byte each, without groups.
    Literal,
}

impl Control {
    /// The control mode in the two lowest bits.
    pub fn new(bits: u8) -> Self {
        match bits & 3 {
            0 => Self::Few,
            1 => Self::Many,
            2 => Self::Zero,
            _ => Self::Literal,
        }
    }
}

/// Decodes the deltas of `count` elements, which start at the byte `at` of the stream. Deltas after these are
/// unspecified. Returns where the next byte's start. None: the stream ends before.
pub fn decode(
    stream: &[u8],
    at: usize,
    control: Control,
    deltas: &mut [u8; BLOCK],
    count: usize,
) -> Option<usize> {
    let bits = match control {
        Control::Version0 => [0, 2, 4, 8],
        Control::Few => [0, 1, 2, 4],
        Control::Many => [1, 2, 4, 8],
        Control::Zero => {
            deltas.fill(0);
            return Some(at);
        }
        Control::Literal => {
            deltas[..count].copy_from_slice(stream.get(at..at + count)?);
            return Some(at + count);
        }
    };
    let groups = count.div_ceil(GROUP);
    let header = stream.get(at..at + groups.div_ceil(4))?;
    let mut at = at + header.len();
    for (i, group) in deltas.as_chunks_mut::<GROUP>().0[..groups].iter_mut().enumerate() {
        let mode = header[i / 4] >> (2 * (i % 4)) & 3;
        at += match bits[usize::from(mode)] {
            0 => {
                group.fill(0);
                0
            }
            8 => {
                group.copy_from_slice(stream.get(at..at + GROUP)?);
                GROUP
            }
            // Each group is followed by 24 bytes at least: the tail of the stream is not shorter.
            bits => {
                let bytes = stream.get(at..)?.first_chunk::<MAX_GROUP_BYTES>()?;
                match bits {
                    1 => decode_group::<1>(bytes, group),
                    2 => decode_group::<2>(bytes, group),
                    _ => decode_group::<4>(bytes, group),
                }
            }
        };
    }
    Some(at)
}

/// Decodes 16 deltas of `BITS` bits. A delta of ones only is a byte after the group. Returns the number of
/// bytes.
#[inline(always)]
fn decode_group<const BITS: usize>(bytes: &[u8; MAX_GROUP_BYTES], deltas: &mut [u8; GROUP]) -> usize {
    const ONES: u64 = 0x0101_0101_0101_0101;
    let mut next = 2 * BITS;
    for (half, deltas) in deltas.as_chunks_mut::<8>().0.iter_mut().enumerate() {
        let packed = &bytes[half * BITS..][..BITS];
        let packed = packed.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
        let unpacked = match BITS {
            1 => unpack_1(packed),
            2 => unpack_2(packed),
            _ => unpack_4(packed),
        };
        *deltas = unpacked.to_le_bytes();
        // Adding one to a delta of ones only sets the bit above it.
        let mut escaped = (unpacked + ONES) & ONES << BITS;
        while escaped != 0 {
            deltas[escaped.trailing_zeros() as usize / 8] = bytes[next];
            next += 1;
            escaped &= escaped - 1;
        }
    }
    next
}

/// Eight bits as bytes, the lowest first.
fn unpack_1(bits: u64) -> u64 {
    // Each byte gets one bit at its own place; adding 127 carries it to the top.
    let spread = (bits * 0x0101_0101_0101_0101) & 0x8040_2010_0804_0201;
    (spread + 0x7f7f_7f7f_7f7f_7f7f) >> 7 & 0x0101_0101_0101_0101
}

/// Eight pairs of bits as bytes, the highest pair of each byte first.
fn unpack_2(bytes: u64) -> u64 {
    let spread = (bytes | bytes << 24) & 0x0000_00ff_0000_00ff;
    (spread >> 6 | spread << 4 | spread << 14 | spread << 24) & 0x0303_0303_0303_0303
}

/// Eight nibbles as bytes, the higher one of each byte first.
fn unpack_4(bytes: u64) -> u64 {
    let spread = (bytes | bytes << 16) & 0x0000_ffff_0000_ffff;
    let spread = (spread | spread << 8) & 0x00ff_00ff_00ff_00ff;
    (spread >> 4 | spread << 8) & 0x0f0f_0f0f_0f0f_0f0f
}
