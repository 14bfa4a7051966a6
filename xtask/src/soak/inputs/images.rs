//! Makes small images of every format that the command reads, and images that are much larger than their
//! files.

use png::{BitDepth, ColorType};

use crate::soak::random::Random;

/// A normal map with bumps in 16 x 16 texels, in each format.
pub const BUMPS_PNG: &[u8] = include_bytes!("bumps.png");
pub const BUMPS_JPEG: &[u8] = include_bytes!("bumps.jpeg");
/// Without loss.
pub const BUMPS_WEBP: &[u8] = include_bytes!("bumps.webp");

/// A PNG of random texels, of any colour type and bit depth.
pub fn any_png(random: &mut Random) -> Result<Vec<u8>, String> {
    use BitDepth::{Eight, Four, One, Sixteen, Two};
    let color = random.pick(&[
        ColorType::Grayscale,
        ColorType::GrayscaleAlpha,
        ColorType::Indexed,
        ColorType::Rgb,
        ColorType::Rgba,
    ]);
    let depth = match color {
        ColorType::Grayscale => random.pick(&[One, Two, Four, Eight, Sixteen]),
        ColorType::Indexed => random.pick(&[One, Two, Four, Eight]),
        _ => random.pick(&[Eight, Sixteen]),
    };
    let [width, height] = [1 + random.below(40) as u32, 1 + random.below(40) as u32];
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == ColorType::Indexed {
        encoder.set_palette((0..=255u8).flat_map(|i| [i, 255 - i, 200]).collect::<Vec<u8>>());
    }
    let row = (width as usize * color.samples() * depth as usize).div_ceil(8);
    let texels: Vec<u8> = (0..row * height as usize).map(|_| random.byte()).collect();
    finish(encoder, &texels)?;
    Ok(bytes)
}

/// A PNG of RGBA texels with 16 bits per channel that are all zero: its texels take 158 times the size of the
/// file.
pub fn flat_png(side: u32) -> Vec<u8> {
    let header = [&side.to_be_bytes()[..], &side.to_be_bytes(), &[16, 6, 0, 0, 0]].concat();
    let texels = compressed_zeros((side as usize) * (8 * side as usize + 1));
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    for (kind, content) in [(b"IHDR", &header), (b"IDAT", &texels), (b"IEND", &Vec::new())] {
        file.extend((content.len() as u32).to_be_bytes());
        let chunk = [&kind[..], content].concat();
        file.extend(&chunk);
        file.extend(crc32fast::hash(&chunk).to_be_bytes());
    }
    file
}

/// A zlib stream of `count` zeros: one block of fixed Huffman codes (RFC 1951, 3.2.6), which repeats a zero
/// by its longest match.
fn compressed_zeros(count: usize) -> Vec<u8> {
    const LONGEST: usize = 258;
    let mut bits = BitWriter { bytes: vec![0x78, 0x01], used: 0 };
    bits.push(0b011, 3);
    let literals = 1 + (count - 1) % LONGEST;
    (0..literals).for_each(|_| bits.push(0b0000_1100, 8));
    // The length 258 is the code 11000101, the distance 1 the code 00000; Huffman codes are written from
    // their first bit.
    (0..(count - literals) / LONGEST).for_each(|_| bits.push(0b0_0000_1010_0011, 13));
    bits.push(0, 7);
    // Adler-32 of zeros: the first sum stays 1, the second counts.
    bits.bytes.extend(((((count % 65521) as u32) << 16) | 1).to_be_bytes());
    bits.bytes
}

/// BitWriter from the lowest of each byte.
struct BitWriter {
    bytes: Vec<u8>,
    /// How many bits of the last byte are used; 0 means all.
    used: usize,
}

impl BitWriter {
    fn push(&mut self, bits: u32, count: usize) {
        for bit in 0..count {
            if self.used == 0 {
                self.bytes.push(0);
            }
            if let Some(last) = self.bytes.last_mut() {
                *last |= (((bits >> bit) & 1) as u8) << self.used;
            }
            self.used = (self.used + 1) % 8;
        }
    }
}

fn finish(encoder: png::Encoder<'_, &mut Vec<u8>>, texels: &[u8]) -> Result<(), String> {
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(texels));
    written.map_err(|error| format!("an image cannot be encoded: {error}"))
}

/// Whether a PNG can be decoded.
pub fn png_is_readable(bytes: &[u8]) -> bool {
    let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.read_info().is_ok_and(|mut reader| {
        let size = reader.output_buffer_size().unwrap_or(0);
        reader.next_frame(&mut vec![0; size]).is_ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_can_be_decoded() {
        let mut random = Random::new(1, 1);
        for _ in 0..50 {
            let bytes = any_png(&mut random).expect("a PNG");
            assert!(png_is_readable(&bytes) && !png_is_readable(&bytes[..bytes.len() / 2]));
        }
        assert!(png_is_readable(BUMPS_PNG));
        let flat = flat_png(512);
        assert!(flat.len() < 20_000 && png_is_readable(&flat));
    }
}
