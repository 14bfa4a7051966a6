//! PNG files whose texels can be changed. Every other chunk is kept as it was read.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use png::{BitDepth, ColorType, Decoder, Encoder, Transformations};

use super::channels;
use super::chunks::{self, Chunk, Chunks};
use super::palette::check_palette;
use super::reasons;
use crate::LoadOptions;
use crate::error::ContentError;
use crate::staging::Outputs;
use crate::{Error, SaveOptions, paths};

/// A PNG with 8 or 16 bits per channel: grey with alpha, RGB or RGBA, to which a palette is expanded; grey
/// alone where it is made here.
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

/// The channels of all texels, row after row, the top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Texels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

/// The type of a PNG's channels: `u8` or `u16`.
pub trait Sample: sealed::Sample {}

impl Sample for u8 {}
impl Sample for u16 {}

mod sealed {
    use super::Texels;

    pub trait Sample: Copy {
        fn texels(channels: &[Self]) -> Texels;
    }

    impl Sample for u8 {
        fn texels(channels: &[Self]) -> Texels {
            Texels::Bytes(channels.to_vec())
        }
    }

    impl Sample for u16 {
        fn texels(channels: &[Self]) -> Texels {
            Texels::Words(channels.to_vec())
        }
    }
}

/// The greatest compression ratio of deflate (RFC 1951): 258 bytes in two bits.
const DEFLATE_RATIO: usize = 1032;

/// Copies of the texels that a conversion holds at once.
const COPIES: usize = 3;

/// Chunks whose content depends on the channels of texels and their bit depth.
const CHUNKS_OF_TEXELS: [&[u8; 4]; 3] = [b"tRNS", b"bKGD", b"sBIT"];

/// Chunks that are valid for colours only, or for greys only: palettes and profiles (PNG specification, third
/// edition, 11.2.2 and 11.3.2.3).
const CHUNKS_OF_COLOURS: [&[u8; 4]; 4] = [b"PLTE", b"sPLT", b"hIST", b"iCCP"];

impl PngImage {
    /// Reads a PNG. Errors: a file that cannot be read; a file that is not a PNG of a supported kind, or is
    /// damaged; more texels than [`LoadOptions::memory_limit`] permits.
    pub fn open(path: &Path, options: &LoadOptions) -> Result<Self, Error> {
        let bytes = paths::read_regular(path)?;
        Self::from_bytes(&path.display().to_string(), bytes, options)
    }

    /// Reads a PNG from memory. `name` stands for the file in messages. Errors: as [`PngImage::open`].
    pub fn from_bytes(name: &str, bytes: Vec<u8>, options: &LoadOptions) -> Result<Self, Error> {
        Self::decode(name, bytes, options).map_err(|error| error.in_file(name))
    }

    /// An image of RGB texels, row after row, the top row first. Errors: the number of texels is not `width`
    /// times `height`.
    pub fn from_rgb<S: Sample>(name: &str, size: [u32; 2], texels: &[[S; 3]]) -> Result<Self, Error> {
        Self::from_channels(name, size, ColorType::Rgb, S::texels(texels.as_flattened()))
    }

    /// An image of grey texels, as [`PngImage::from_rgb`].
    pub fn from_grey<S: Sample>(name: &str, size: [u32; 2], texels: &[S]) -> Result<Self, Error> {
        Self::from_channels(name, size, ColorType::Grayscale, S::texels(texels))
    }

    /// An image of RGBA texels, as [`PngImage::from_rgb`].
    pub fn from_rgba<S: Sample>(name: &str, size: [u32; 2], texels: &[[S; 4]]) -> Result<Self, Error> {
        Self::from_channels(name, size, ColorType::Rgba, S::texels(texels.as_flattened()))
    }

    /// This image with texts in its file, by their keywords. Errors: a keyword or text that PNG cannot hold.
    pub fn with_texts(mut self, texts: &[(&str, String)]) -> Result<Self, Error> {
        // An image of one texel with these texts has their chunks.
        let encode = || -> Result<Vec<u8>, png::EncodingError> {
            let mut file = Vec::new();
            let mut encoder = Encoder::new(&mut file, 1, 1);
            for (keyword, text) in texts {
                encoder.add_text_chunk((*keyword).to_owned(), text.clone())?;
            }
            encoder.write_header()?.write_image_data(&[0])?;
            Ok(file)
        };
        let splice = |file: &[u8]| -> Result<Vec<u8>, ContentError> {
            let (ours, texts) = (Chunks::split(&self.file)?, Chunks::split(file)?);
            let mut out = chunks::SIGNATURE.to_vec();
            for chunk in &ours.chunks {
                out.extend(chunk.bytes);
                if chunk.kind == b"IHDR" {
                    texts.of(b"tEXt").for_each(|text| out.extend(text.bytes));
                }
            }
            Ok(out)
        };
        let refused = |error: png::EncodingError| {
            ContentError::unsupported("", format!("cannot hold its texts: {error}; choose others"))
        };
        let spliced = encode().map_err(refused).and_then(|file| splice(&file));
        self.file = spliced.map_err(|error| error.in_file(&self.name))?;
        Ok(self)
    }

    fn from_channels(
        name: &str,
        [width, height]: [u32; 2],
        color: ColorType,
        texels: Texels,
    ) -> Result<Self, Error> {
        let file = encoded([width, height], color, &texels).map_err(|error| error.in_file(name))?;
        Ok(Self { name: name.to_owned(), file, width, height, color, texels, is_changed: false })
    }

    /// Whether a file that begins with `bytes` is a PNG.
    pub fn is_png(bytes: &[u8]) -> bool {
        bytes.starts_with(&chunks::SIGNATURE)
    }

    /// The width and height in the header of a PNG; none for other files.
    pub fn size_of(file: &[u8]) -> Option<[u32; 2]> {
        let header = file.get(..24).filter(|header| Self::is_png(header) && &header[12..16] == b"IHDR")?;
        let number = |at: usize| header[at..].first_chunk().map(|&bytes| u32::from_be_bytes(bytes));
        Some([number(16)?, number(20)?])
    }

    /// Whether a file is a PNG whose channels have 16 bits, judged by its header.
    pub fn is_deep(file: &[u8]) -> bool {
        Self::size_of(file).is_some() && file.get(24) == Some(&16)
    }

    /// Why a file cannot be read as an image of this kind, judged by its header and the kinds of its chunks,
    /// as a clause whose subject is the image; none if it can, unless its texels are damaged.
    pub fn obstacle(file: &[u8]) -> Option<String> {
        let checked = || {
            let chunks = Chunks::split(file)?;
            let kind = chunks.of(b"IHDR").next().and_then(Chunk::kind_of_texels);
            let kind =
                kind.and_then(|[depth, color]| Some((ColorType::from_u8(color)?, BitDepth::from_u8(depth)?)));
            let (color, depth) =
                kind.ok_or_else(|| ContentError::invalid("", "is not a complete PNG; save it again"))?;
            refuse_unsupported(color, depth, &chunks)
        };
        checked().err().map(ContentError::into_clause)
    }

    fn decode(name: &str, file: Vec<u8>, options: &LoadOptions) -> Result<Self, ContentError> {
        let broken = |error: png::DecodingError| {
            ContentError::invalid(
                "",
                format!("is not a complete PNG: {}; save it again", reasons::of_png(&error)),
            )
        };
        let chunks = Chunks::split(&file)?;
        let mut decoder = Decoder::new(Cursor::new(&file));
        // A palette is expanded to the colours that it stands for, and nothing else is changed.
        let kind = chunks.of(b"IHDR").next().and_then(Chunk::kind_of_texels);
        let is_indexed = kind.is_some_and(|[_, color]| color == ColorType::Indexed as u8);
        decoder.set_transformations(if is_indexed {
            Transformations::EXPAND
        } else {
            Transformations::IDENTITY
        });
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        let mut reader = decoder.read_info().map_err(broken)?;
        let info = reader.info();
        check_palette(info)
            .map_err(|problem| ContentError::invalid("", format!("{problem}; save it again")))?;
        let (width, height) = (info.width, info.height);
        refuse_unsupported(info.color_type, info.bit_depth, &chunks)?;
        let (stored, (color, depth)) = (info.raw_bytes(), reader.output_color_type());
        let length = reader.output_buffer_size().unwrap_or(usize::MAX);
        if stored / DEFLATE_RATIO > chunks.total_of(b"IDAT") {
            let problem = format!("its data is too short for {width} x {height} texels; save it again");
            return Err(ContentError::invalid("", problem));
        }
        let limit = options.budget(file.len(), 0);
        if length.saturating_mul(COPIES) > limit.bytes {
            let what = format!("its {width} x {height} texels need");
            return Err(ContentError::unsupported("", limit.exceeded(&what)));
        }
        let mut bytes = vec![0; length];
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

    /// The name of the image in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Texels per row, and rows.
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

    /// The letters of the channels: `l`, `la`, `rgb` or `rgba`.
    pub fn channels(&self) -> &'static str {
        channels::letters(self.color)
    }

    /// Whether texels have changed since the image was read.
    pub fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// The file. Without changes it is the file that was read; otherwise it has new texels, and all other
    /// chunks are kept except those that are not valid for the new kind of texels.
    ///
    /// An interlaced image becomes one that is not. Errors: the texels cannot be encoded.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        self.encode().map_err(|error| error.in_file(&self.name))
    }

    fn encode(&self) -> Result<Vec<u8>, ContentError> {
        if !self.is_changed {
            return Ok(self.file.clone());
        }
        let encoded = encoded(self.size(), self.color, &self.texels)?;
        Ok(self.spliced(&Chunks::split(&self.file)?, &Chunks::split(&encoded)?))
    }

    /// The chunks of `old`, with the header and the texels of `new`.
    fn spliced(&self, old: &Chunks<'_>, new: &Chunks<'_>) -> Vec<u8> {
        let [before, after] =
            [old, new].map(|chunks| chunks.of(b"IHDR").next().and_then(Chunk::kind_of_texels));
        let has_colours = |kind: Option<[u8; 2]>| kind.map(|[_, colour_type]| colour_type & 2);
        let was_indexed = before.is_some_and(|[_, colour_type]| colour_type == ColorType::Indexed as u8);
        let (of_same_kind, of_same_colours) = (before == after, has_colours(before) == has_colours(after));
        let mut out = chunks::SIGNATURE.to_vec();
        let mut texels = new.of(b"IDAT").peekable();
        for chunk in &old.chunks {
            match chunk.kind {
                b"IHDR" => new.of(b"IHDR").for_each(|header| out.extend(header.bytes)),
                b"IDAT" => texels.by_ref().for_each(|chunk| out.extend(chunk.bytes)),
                kind if !of_same_kind && CHUNKS_OF_TEXELS.contains(&kind) => {}
                b"PLTE" | b"hIST" if was_indexed => {}
                kind if !of_same_colours && CHUNKS_OF_COLOURS.contains(&kind) => {}
                _ => out.extend(chunk.bytes),
            }
        }
        out.extend(old.rest);
        out
    }

    /// Writes the image. Errors: an existing file without [`SaveOptions::force`], or one that is not regular;
    /// a path that cannot be written. After an error, no file is left.
    pub fn save(&self, path: &Path, options: &SaveOptions) -> Result<PathBuf, Error> {
        let mut outputs = Outputs::new(options.run);
        self.stage(path, options, &mut outputs)?;
        outputs.commit()?;
        Ok(path.to_owned())
    }

    /// Stages the image as one of several outputs. Errors as of [`PngImage::save`].
    pub fn stage(&self, path: &Path, options: &SaveOptions, outputs: &mut Outputs) -> Result<(), Error> {
        outputs.stage_bytes(path, &self.to_bytes()?, options)
    }
}

/// Refuses a PNG that cannot hold a normal map, or not be converted without loss.
fn refuse_unsupported(color: ColorType, depth: BitDepth, chunks: &Chunks<'_>) -> Result<(), ContentError> {
    let refused = |problem: &str| Err(ContentError::unsupported("", problem));
    match (color, depth) {
        (ColorType::Grayscale, _) => refused(
            "has one channel, but a normal map has two or more; bake a normal map from it if it is a height \
             map",
        ),
        (ColorType::Indexed, _) | (_, BitDepth::Eight | BitDepth::Sixteen) => {
            if chunks.of(b"acTL").next().is_some() {
                return refused("is an animation; save its frames as single images");
            }
            if color != ColorType::Indexed && chunks.of(b"tRNS").next().is_some() {
                return refused(
                    "has a transparent colour, which a conversion would change; save it without one",
                );
            }
            Ok(())
        }
        _ => refused("has fewer than 8 bits per channel; save it with 8 or 16"),
    }
}

/// Encodes texels as a PNG without further chunks.
fn encoded([width, height]: [u32; 2], color: ColorType, texels: &Texels) -> Result<Vec<u8>, ContentError> {
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
    written.map_err(|_| ContentError::unsupported("", "cannot be encoded as PNG; check its size"))?;
    Ok(encoded)
}
