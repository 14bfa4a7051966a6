//! Why an image cannot be decoded, in the words of its format: what the decoders say is meant for their
//! developers.

use png::DecodingError;

/// A clause whose subject is the image.
pub fn of_png(error: &DecodingError) -> &'static str {
    let text = match error {
        DecodingError::IoError(_) => return "it ends too early",
        DecodingError::LimitsExceeded => return "a chunk takes too much memory",
        other => other.to_string(),
    };
    match text.as_str() {
        text if text.starts_with("CRC") => "the checksum of a chunk is wrong",
        text if text.starts_with("Corrupt deflate") => "its compressed texels are damaged",
        text if text.contains("enough data") || text.contains("is missing") => "texels are missing",
        text if text.contains("palette") => "it has no palette, or one that is too short",
        text if text.contains("dimensions") => "it has no texels",
        text if text.contains("depth") || text.contains("color type") => "its kind of texels does not exist",
        _ => "its chunks break the rules of PNG",
    }
}

/// A clause whose subject is the image.
#[cfg(feature = "textures")]
pub fn of_jpeg(error: &zune_jpeg::errors::DecodeErrors) -> &'static str {
    use zune_jpeg::errors::DecodeErrors as Jpeg;
    match error {
        Jpeg::Unsupported(_) => "its kind of JPEG has no decoder here",
        Jpeg::ExhaustedData | Jpeg::IoErrors(_) => "it ends too early",
        Jpeg::ZeroError => "it has no texels",
        Jpeg::HuffmanDecode(_) => "its Huffman tables (DHT) are damaged",
        Jpeg::DqtError(_) => "its quantisation tables (DQT) are damaged",
        Jpeg::SosError(_) => "its start of scan (SOS) is damaged",
        Jpeg::SofError(_) | Jpeg::LargeDimensions(_) => "its start of frame (SOF) is damaged",
        _ => "its texels are damaged",
    }
}

/// A clause whose subject is the image.
#[cfg(feature = "textures")]
pub fn of_webp(error: &image_webp::DecodingError) -> &'static str {
    use image_webp::DecodingError as WebP;
    match error {
        WebP::IoError(_) | WebP::NotEnoughInitData => "it ends too early",
        WebP::UnsupportedFeature(_) => "its kind of WebP has no decoder here",
        WebP::ChunkMissing | WebP::ChunkHeaderInvalid(_) => "its chunks break the rules of WebP",
        WebP::ImageTooLarge | WebP::InconsistentImageSizes | WebP::FrameOutsideImage => {
            "its sizes contradict each other"
        }
        _ => "its texels are damaged",
    }
}
