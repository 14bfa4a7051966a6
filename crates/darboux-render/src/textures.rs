//! Decodes the images of a document and uploads them as textures with mip levels.

use std::collections::HashMap;

use darboux_gpu::{AdapterKind, Gpu};
use darboux_io::gltf::{Document, TextureUse, Wrap};
use darboux_io::image::{DecodeLimits, RgbaImage};
use wgpu::{
    AddressMode, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor, TextureFormat, TextureView,
};

use crate::mipmaps::halved;

/// The most texels of all images together. With mip levels they take 1 GiB.
const MAX_TEXELS: u64 = 200 << 20;

/// What a texel takes of the memory limit: four channels of 8 bits.
const BYTES_PER_TEXEL: u64 = 4;

/// The most samples along the longer side of a pixel's footprint. Software adapters do without: they visit
/// every texel below a pixel, which takes minutes where UVs grow to thousands, or where a triangle is seen so
/// nearly edge-on that its interpolated UVs overflow.
const MAX_ANISOTROPY: u16 = 8;

/// The meaning of a texture's texels.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// In sRGB.
    Color,
    /// Numbers from 0 to 1: roughness, metal, occlusion.
    Data,
    Normal,
}

impl Kind {
    fn format(self) -> TextureFormat {
        match self {
            Self::Color => TextureFormat::Rgba8UnormSrgb,
            Self::Data | Self::Normal => TextureFormat::Rgba8Unorm,
        }
    }

    /// The texel that has no effect.
    fn neutral(self) -> [u8; 4] {
        match self {
            Self::Color | Self::Data => [255; 4],
            Self::Normal => [128, 128, 255, 255],
        }
    }
}

/// The textures of a document. Each image is uploaded once.
pub struct Textures<'a> {
    gpu: &'a Gpu,
    document: &'a Document,
    /// By image and kind; none for images that cannot be decoded.
    uploaded: HashMap<(Option<usize>, Kind), Option<TextureView>>,
    /// The texels of all images so far, and the sizes of their files.
    texels: u64,
    bytes: usize,
    pub warnings: Vec<String>,
}

impl<'a> Textures<'a> {
    pub fn new(gpu: &'a Gpu, document: &'a Document) -> Self {
        Self { gpu, document, uploaded: HashMap::new(), texels: 0, bytes: 0, warnings: Vec::new() }
    }

    /// The texture that a material uses. If it cannot be decoded, the result is none, and there is a warning.
    pub fn view(&mut self, used: Option<&TextureUse>, kind: Kind) -> Option<TextureView> {
        let image = used?.image;
        if let Some(view) = self.uploaded.get(&(image, kind)) {
            return view.clone();
        }
        let view = match self.decode(image) {
            Ok(image) => Some(self.upload(image, kind)),
            Err(problem) => {
                self.warnings.push(format!("{problem}; the model is drawn without it"));
                None
            }
        };
        self.uploaded.insert((image, kind), view.clone());
        view
    }

    /// A texture of one texel that has no effect.
    pub fn neutral(&self, kind: Kind) -> TextureView {
        self.upload(RgbaImage { width: 1, height: 1, texels: vec![kind.neutral()] }, kind)
    }

    /// Decodes an image. Errors: one sentence.
    fn decode(&mut self, image: Option<usize>) -> Result<RgbaImage, String> {
        let image = image.ok_or("a texture has no image; export the file again")?;
        let bytes = self.document.image_bytes(image).map_err(|error| error.to_string())?;
        let message = |problem: String| format!("images[{image}] {problem}");
        let document = self.document;
        let texels = |size, bytes_per_texel: u64| document.memory_limit_of(size) / bytes_per_texel;
        let side = self.gpu.device.limits().max_texture_dimension_2d;
        let limits =
            DecodeLimits::of_file(bytes.len(), document.load_options().memory_limit).with_max_side(side);
        let decoded = RgbaImage::decode(&bytes, &limits).map_err(|error| message(error.to_string()))?;
        self.texels += decoded.texels.len() as u64;
        self.bytes += bytes.len();
        if self.texels > MAX_TEXELS.min(texels(self.bytes, BYTES_PER_TEXEL)) {
            return Err(message(
                "and the other images have too many texels together; make them smaller, or raise the memory \
                 limit"
                    .to_owned(),
            ));
        }
        Ok(decoded)
    }

    /// Uploads an image with its mip levels.
    fn upload(&self, mut image: RgbaImage, kind: Kind) -> TextureView {
        let RgbaImage { width, height, .. } = image;
        let levels = width.max(height).ilog2() + 1;
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("image"),
            size,
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: kind.format(),
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for level in 0..levels {
            if level > 0 {
                image = halved(&image);
            }
            let destination = wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() };
            let RgbaImage { width, height, .. } = image;
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: None,
            };
            let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
            self.gpu.queue.write_texture(destination, image.texels.as_flattened(), layout, size);
        }
        texture.create_view(&Default::default())
    }
}

/// The sampler of a material's texture.
pub fn sampler(gpu: &Gpu, used: Option<&TextureUse>) -> Sampler {
    let (wrap, is_nearest) = used.map_or(([Wrap::Repeat; 2], false), |used| (used.wrap, used.is_nearest));
    let [u, v] = wrap.map(|wrap| match wrap {
        Wrap::Repeat => AddressMode::Repeat,
        Wrap::Mirror => AddressMode::MirrorRepeat,
        Wrap::Clamp => AddressMode::ClampToEdge,
    });
    gpu.device.create_sampler(&SamplerDescriptor {
        address_mode_u: u,
        address_mode_v: v,
        mag_filter: if is_nearest { FilterMode::Nearest } else { FilterMode::Linear },
        min_filter: FilterMode::Linear,
        mipmap_filter: MipmapFilterMode::Linear,
        anisotropy_clamp: if is_nearest || gpu.kind() == AdapterKind::Software { 1 } else { MAX_ANISOTROPY },
        ..Default::default()
    })
}
