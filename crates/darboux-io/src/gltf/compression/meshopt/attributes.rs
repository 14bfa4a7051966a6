//! The codec of vertex attributes: `KHR_meshopt_compression`, appendix A, mode 0.
//!
//! ```text
//! stream  = header byte, blocks, padding, first element's baseline, channel modes (version 1)
//! block   = control modes (version 1), then for each byte of an element the deltas of up to 256 elements
//! channel = four bytes of an element; its mode says how deltas become values
//! ```

use super::byte_groups::{self, BLOCK, Control};

const VERSION_0: u8 = 0xa0;
const VERSION_1: u8 = 0xa1;

/// The most channels of an element.
const CHANNELS: usize = 64;

/// How the deltas of a channel become values.
#[derive(Clone, Copy)]
enum Channel {
    Bytes,
    Shorts,
    /// Exclusive or. The encoder rotated to the left, as the specification has it.
    Xor(u32),
}

impl Channel {
    fn new(mode: u8) -> Option<Self> {
        match (mode & 15, mode >> 4) {
            (0, 0) => Some(Self::Bytes),
            (1, 0) => Some(Self::Shorts),
            (2, rotation) => Some(Self::Xor(rotation.into())),
            _ => None,
        }
    }
}

/// Decodes `count` elements of `stride` bytes. None: the stream is broken, or the stride is not one of the
/// codec.
pub fn decode(stream: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    if stride == 0 || stride > 4 * CHANNELS || !stride.is_multiple_of(4) {
        return None;
    }
    let channel_count = stride / 4;
    let (mode_count, least_tail) = match *stream.first()? {
        VERSION_0 => (0, 32),
        VERSION_1 => (channel_count, 24),
        _ => return None,
    };
    let tail = stream.len().checked_sub(stride + mode_count)?;
    let end = stream.len().checked_sub((stride + mode_count).max(least_tail))?;
    let (baseline, modes) = stream[tail..].split_at(stride);
    let mut last = [0; CHANNELS];
    for (last, bytes) in last.iter_mut().zip(baseline.as_chunks().0) {
        *last = u32::from_le_bytes(*bytes);
    }
    let mut channels = [Channel::Bytes; CHANNELS];
    for (channel, &mode) in channels.iter_mut().zip(modes) {
        *channel = Channel::new(mode)?;
    }
    let mut decoder = BlockDecoder {
        stream,
        at: 1,
        has_control: mode_count > 0,
        last,
        channels: &channels[..channel_count],
    };
    let mut elements = vec![0; count.checked_mul(stride)?];
    let block = (8192 / stride / byte_groups::GROUP * byte_groups::GROUP).min(BLOCK);
    for block in elements.chunks_mut(block * stride) {
        decoder.decode(block)?;
    }
    (decoder.at == end).then_some(elements)
}

struct BlockDecoder<'a> {
    stream: &'a [u8],
    at: usize,
    has_control: bool,
    /// The last element that was decoded, by the channel.
    last: [u32; CHANNELS],
    channels: &'a [Channel],
}

impl BlockDecoder<'_> {
    fn decode(&mut self, block: &mut [u8]) -> Option<()> {
        let stride = 4 * self.channels.len();
        let count = block.len() / stride;
        let control_length = if self.has_control { self.channels.len() } else { 0 };
        let controls = self.stream.get(self.at..self.at + control_length)?;
        self.at += control_length;
        let mut planes = [[0; BLOCK]; 4];
        for (i, channel) in self.channels.iter().enumerate() {
            for (byte, plane) in planes.iter_mut().enumerate() {
                let control = controls
                    .get(i)
                    .map_or(Control::Version0, |controls| Control::new(controls >> (2 * byte)));
                self.at = byte_groups::decode(self.stream, self.at, control, plane, count)?;
            }
            let mut words = [0; BLOCK];
            for (i, word) in words.iter_mut().enumerate() {
                *word = u32::from_le_bytes([planes[0][i], planes[1][i], planes[2][i], planes[3][i]]);
            }
            let last = &mut self.last[i];
            match *channel {
                Channel::Bytes => {
                    words.iter_mut().for_each(|word| *word = unzigzag_bytes(*word));
                    write(&words, block, stride, i, last, add_bytes);
                }
                Channel::Shorts => {
                    words.iter_mut().for_each(|word| *word = unzigzag_shorts(*word));
                    write(&words, block, stride, i, last, add_shorts);
                }
                Channel::Xor(rotation) => {
                    words.iter_mut().for_each(|word| *word = word.rotate_right(rotation));
                    write(&words, block, stride, i, last, |value, delta| value ^ delta);
                }
            }
        }
        Some(())
    }
}

/// Sums deltas from `last` on, and writes the sums into the channel `channel` of every element.
#[inline(always)]
fn write(
    deltas: &[u32; BLOCK],
    block: &mut [u8],
    stride: usize,
    channel: usize,
    last: &mut u32,
    add: impl Fn(u32, u32) -> u32,
) {
    let mut value = *last;
    for (element, &delta) in block.chunks_exact_mut(stride).zip(deltas) {
        value = add(value, delta);
        element[4 * channel..][..4].copy_from_slice(&value.to_le_bytes());
    }
    *last = value;
}

/// Four signed bytes from their zigzag codes.
fn unzigzag_bytes(codes: u32) -> u32 {
    ((codes >> 1) & 0x7f7f_7f7f) ^ ((codes & 0x0101_0101) * 0xff)
}

/// Two signed shorts from their zigzag codes.
fn unzigzag_shorts(codes: u32) -> u32 {
    ((codes >> 1) & 0x7fff_7fff) ^ ((codes & 0x0001_0001) * 0xffff)
}

/// The sums of four bytes, without carry from one to the next.
fn add_bytes(a: u32, b: u32) -> u32 {
    ((a & 0x7f7f_7f7f) + (b & 0x7f7f_7f7f)) ^ ((a ^ b) & 0x8080_8080)
}

/// The sums of two shorts, without carry from one to the next.
fn add_shorts(a: u32, b: u32) -> u32 {
    ((a & 0x7fff_7fff) + (b & 0x7fff_7fff)) ^ ((a ^ b) & 0x8000_8000)
}
