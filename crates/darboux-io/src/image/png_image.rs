//! Normal maps in PNG files: texels change, every other chunk stays as it is.

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use png::{BitDepth, ColorType, Decoder, Encoder, Transformations};

use super::channels;
use super::chunks::{self, Chunk, Chunks};
use crate::error::Fault;
use crate::staging::Staging;
use crate::{Error, SaveOptions, paths};

/// A PNG of 8 or 16 bits per channel: grey with alpha, RGB or RGBA.
#[derive(Debug)]
pub struct PngImage {
    name: String,
    file: Vec<u8>,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) color: ColorType,
    pub(super) texels: Texels,
    pub(super) is_changed: bool,
}

/// The channels of all texels, row after row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Texels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

/// The greatest ratio of deflate (RFC 1951): 258 bytes for two bits.
const DEFLATE_RATIO: usize = 1032;

/// Chunks whose content depends on the channels of texels and on their bits.
const OF_TEXELS: [&[u8; 4]; 3] = [b"tRNS", b"bKGD", b"sBIT"];

/// Chunks that are for colours, or for greys, alone: palettes and profiles (PNG specification, third edition, 11.2.2 and 11.3.2.3).
const OF_COLOURS: [&[u8; 4]; 4] = [b"PLTE", b"sPLT", b"hIST", b"iCCP"];

impl PngImage {
    /// Reads a PNG. Errors: a file that cannot be read; anything but a whole PNG of a supported kind.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = paths::readable(path)?;
        let bytes = fs::read(file).map_err(|source| Error::Read { file: path.to_owned(), source })?;
        Self::from_bytes(&path.display().to_string(), bytes)
    }

    /// Reads a PNG from memory; `name` stands for the file in messages. Errors: as [`PngImage::open`].
    pub fn from_bytes(name: &str, bytes: Vec<u8>) -> Result<Self, Error> {
        Self::decode(name, bytes).map_err(|fault| fault.in_file(name))
    }

    /// An image of 8-bit RGB texels, row after row. Errors: another number of texels than `width` times `height`.
    pub fn from_rgb(name: &str, [width, height]: [u32; 2], texels: &[[u8; 3]]) -> Result<Self, Error> {
        let texels = Texels::Bytes(texels.as_flattened().to_vec());
        let file = encoded([width, height], ColorType::Rgb, &texels).map_err(|fault| fault.in_file(name))?;
        let (name, color) = (name.to_owned(), ColorType::Rgb);
        Ok(Self { name, file, width, height, color, texels, is_changed: false })
    }

    /// Whether these are the first bytes of a PNG.
    pub fn is_png(bytes: &[u8]) -> bool {
        bytes.starts_with(&chunks::SIGNATURE)
    }

    fn decode(name: &str, file: Vec<u8>) -> Result<Self, Fault> {
        let broken = |error: png::DecodingError| {
            Fault::invalid("", format!("is no whole PNG: {error}; save it again"))
        };
        let chunks = Chunks::split(&file)?;
        let mut decoder = Decoder::new(Cursor::new(&file));
        decoder.set_transformations(Transformations::IDENTITY);
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        let mut reader = decoder.read_info().map_err(broken)?;
        let info = reader.info();
        let (width, height, color, depth) = (info.width, info.height, info.color_type, info.bit_depth);
        refuse_unsupported(color, depth, &chunks)?;
        let length = reader.output_buffer_size().unwrap_or(usize::MAX);
        if length / DEFLATE_RATIO > chunks.total_of(b"IDAT") {
            let problem = format!("its data is too short for {width} x {height} texels; save it again");
            return Err(Fault::invalid("", problem));
        }
        let mut bytes = Vec::new();
        if bytes.try_reserve_exact(length).is_err() {
            return Err(Fault::unsupported("", format!("{width} x {height} texels do not fit the memory")));
        }
        bytes.resize(length, 0);
        reader.next_frame(&mut bytes).map_err(broken)?;
        let texels = match depth {
            BitDepth::Sixteen => {
                let words = bytes.as_chunks().0.iter();
                Texels::Words(words.map(|&word| u16::from_be_bytes(word)).collect())
            }
            _ => Texels::Bytes(bytes),
        };
        drop(reader);
        Ok(Self { name: name.to_owned(), file, width, height, color, texels, is_changed: false })
    }

    /// The name in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Texels across and down.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Bits per channel: 8 or 16.
    pub fn bits(&self) -> u32 {
        match self.texels {
            Texels::Bytes(_) => 8,
            Texels::Words(_) => 16,
        }
    }

    /// The letters of its channels: `la`, `rgb` or `rgba`.
    pub fn channels(&self) -> &'static str {
        channels::letters(self.color)
    }

    /// Whether texels differ from those that were read.
    pub fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// The file: as it was read if nothing changed; otherwise new texels, all other chunks as they were read, but for those that describe another kind of texels.
    ///
    /// Interlaced images become plain ones. Errors: none but those of memory.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        self.encode().map_err(|fault| fault.in_file(&self.name))
    }

    fn encode(&self) -> Result<Vec<u8>, Fault> {
        if !self.is_changed {
            return Ok(self.file.clone());
        }
        let encoded = encoded(self.size(), self.color, &self.texels)?;
        Ok(self.spliced(&Chunks::split(&self.file)?, &Chunks::split(&encoded)?))
    }

    /// The chunks that were read, with header and texels of `new`.
    fn spliced(&self, old: &Chunks<'_>, new: &Chunks<'_>) -> Vec<u8> {
        let [before, after] =
            [old, new].map(|chunks| chunks.of(b"IHDR").next().and_then(Chunk::kind_of_texels));
        let has_colours = |kind: Option<[u8; 2]>| kind.map(|[_, colour_type]| colour_type & 2);
        let (of_same_kind, of_same_colours) = (before == after, has_colours(before) == has_colours(after));
        let mut out = chunks::SIGNATURE.to_vec();
        let mut texels = new.of(b"IDAT").peekable();
        for chunk in &old.chunks {
            match chunk.kind {
                b"IHDR" => new.of(b"IHDR").for_each(|header| out.extend(header.bytes)),
                b"IDAT" => texels.by_ref().for_each(|chunk| out.extend(chunk.bytes)),
                kind if !of_same_kind && OF_TEXELS.contains(&kind) => {}
                kind if !of_same_colours && OF_COLOURS.contains(&kind) => {}
                _ => out.extend(chunk.bytes),
            }
        }
        out.extend(old.rest);
        out
    }

    /// Writes the image. Errors: an existing file without `force`, or one that is no regular file; a place that cannot be written.
    /// After an error nothing is left.
    pub fn save(&self, path: &Path, options: &SaveOptions) -> Result<PathBuf, Error> {
        let target = paths::writable(path, options.force, |_| None)?;
        let bytes = self.to_bytes()?;
        let mut staging = Staging::of_run(options.run);
        staging.stage(&target, options.force, |file| file.write_all(&bytes))?;
        staging.commit()?;
        Ok(path.to_owned())
    }
}

/// Errors: a PNG that is no normal map that could be converted to the bit.
fn refuse_unsupported(color: ColorType, depth: BitDepth, chunks: &Chunks<'_>) -> Result<(), Fault> {
    let refused = |problem: &str| Err(Fault::unsupported("", problem));
    match (color, depth) {
        (ColorType::Indexed, _) => refused("has a palette; save it as RGB"),
        (ColorType::Grayscale, _) => {
            refused("has one channel, but a normal map has two or more; is it a bump map?")
        }
        (_, BitDepth::Eight | BitDepth::Sixteen) => {
            if chunks.of(b"acTL").next().is_some() {
                return refused("is an animation; save its frames one by one");
            }
            if chunks.of(b"tRNS").next().is_some() {
                return refused(
                    "has a transparent colour, which would be another one afterwards; save it without",
                );
            }
            Ok(())
        }
        _ => refused("has fewer than 8 bits per channel; save it with 8 or 16"),
    }
}

/// Texels as a PNG of nothing else.
fn encoded([width, height]: [u32; 2], color: ColorType, texels: &Texels) -> Result<Vec<u8>, Fault> {
    let mut encoded = Vec::new();
    let mut encoder = Encoder::new(&mut encoded, width, height);
    encoder.set_color(color);
    let written = match texels {
        Texels::Bytes(bytes) => {
            encoder.set_depth(BitDepth::Eight);
            encoder.write_header().and_then(|mut writer| writer.write_image_data(bytes))
        }
        Texels::Words(words) => {
            encoder.set_depth(BitDepth::Sixteen);
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
            encoder.write_header().and_then(|mut writer| writer.write_image_data(&bytes))
        }
    };
    written.map_err(|error| Fault::unsupported("", format!("cannot be encoded: {error}")))?;
    Ok(encoded)
}
