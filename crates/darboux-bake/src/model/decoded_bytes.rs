//! [`DecodedBytes`]: the decoded images of a document, normal maps and all others, share the document's
//! memory limit.

use std::borrow::Cow;

use darboux_io::gltf::Document;
use darboux_io::image::{DecodeLimits, PngImage};

/// The bytes of the images of a document that were decoded.
#[derive(Debug, Default)]
pub struct DecodedBytes {
    /// Of images that are files.
    files: usize,
    used: u64,
}

impl DecodedBytes {
    /// The bytes of an image, and the limits of its decoder. `per_texel`: the bytes that are kept of a texel
    /// with channels of 8 bits, and of 16 bits. The error is a clause.
    pub fn limits<'d>(
        &mut self,
        document: &'d Document,
        image: Option<usize>,
        per_texel: [u64; 2],
    ) -> Result<(Cow<'d, [u8]>, DecodeLimits), String> {
        let image = image.ok_or("its texture has no image; export it again with one")?;
        let bytes = document.image_bytes(image).map_err(|error| error.to_string())?;
        if matches!(bytes, Cow::Owned(_)) {
            self.files = self.files.saturating_add(bytes.len());
        }
        let per_texel = per_texel[usize::from(PngImage::is_deep(&bytes))];
        let left = document
            .memory_limit_of(document.source_size().saturating_add(self.files))
            .saturating_sub(self.used);
        let limits = DecodeLimits::default();
        let limits = limits.with_max_texels(limits.max_texels.min(left / per_texel));
        if let Some([width, height]) = PngImage::size_of(&bytes) {
            let texels = u64::from(width) * u64::from(height);
            if texels > limits.max_texels {
                return Err(format!(
                    "its {width} x {height} texels and those of the images before need more than the memory \
                     limit; make them smaller, or raise the limit ({})",
                    document.load_options().option_names.memory_limit
                ));
            }
            // Also where the rest of the file turns out to be damaged: trying takes as long.
            self.used = self.used.saturating_add(texels * per_texel);
        }
        Ok((bytes, limits))
    }

    /// Counts the texels of an image that is no PNG.
    pub fn add(&mut self, bytes: &[u8], [width, height]: [u32; 2], [per_texel, _]: [u64; 2]) {
        if PngImage::size_of(bytes).is_none() {
            self.used = self.used.saturating_add(u64::from(width) * u64::from(height) * per_texel);
        }
    }
}
