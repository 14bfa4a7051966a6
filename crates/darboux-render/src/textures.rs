//! Images on the adapter.

use std::collections::HashMap;

use darboux_gpu::Gpu;
use darboux_io::gltf::{Document, TextureUse, Wrap};
use darboux_io::image::{DecodeLimits, RgbaImage};
use wgpu::{
    AddressMode, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor, TextureFormat, TextureView,
};

use crate::mipmaps::halved;

/// The texels of all images together: 1 GiB with their smaller versions.
const MOST_TEXELS: u64 = 200 << 20;

/// What a texture's texels are.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    Color,
    Normal,
}

impl Kind {
    fn format(self) -> TextureFormat {
        match self {
            Self::Color => TextureFormat::Rgba8UnormSrgb,
            Self::Normal => TextureFormat::Rgba8Unorm,
        }
    }

    /// The texel that changes nothing.
    fn neutral(self) -> [u8; 4] {
        match self {
            Self::Color => [255; 4],
            Self::Normal => [128, 128, 255, 255],
        }
    }
}

/// The images of a document, each sent once.
pub struct Textures<'a> {
    gpu: &'a Gpu,
    document: &'a Document,
    sent: HashMap<(Option<usize>, Kind), Option<TextureView>>,
    texels: u64,
    pub warnings: Vec<String>,
}

impl<'a> Textures<'a> {
    pub fn new(gpu: &'a Gpu, document: &'a Document) -> Self {
        Self { gpu, document, sent: HashMap::new(), texels: 0, warnings: Vec::new() }
    }

    /// The texture that a material uses, or none where it cannot be had, which then is a warning.
    pub fn view(&mut self, used: Option<&TextureUse>, kind: Kind) -> Option<TextureView> {
        let image = used?.image;
        if let Some(sent) = self.sent.get(&(image, kind)) {
            return sent.clone();
        }
        let view = match self.decode(image) {
            Ok(image) => Some(self.send(image, kind)),
            Err(problem) => {
                self.warnings.push(format!("{problem}; drawn without it"));
                None
            }
        };
        self.sent.insert((image, kind), view.clone());
        view
    }

    /// A texture that changes nothing.
    pub fn neutral(&self, kind: Kind) -> TextureView {
        self.send(RgbaImage { width: 1, height: 1, texels: vec![kind.neutral()] }, kind)
    }

    /// The error is a sentence.
    fn decode(&mut self, image: Option<usize>) -> Result<RgbaImage, String> {
        let image = image.ok_or("a texture has no image; export the file again")?;
        let bytes = self.document.image_bytes(image).map_err(|error| error.to_string())?;
        let told = |problem: String| format!("images[{image}] {problem}");
        let side = self.gpu.device.limits().max_texture_dimension_2d;
        let limits = DecodeLimits { side, ..DecodeLimits::default() };
        let decoded = RgbaImage::decode(&bytes, &limits).map_err(|error| told(error.to_string()))?;
        self.texels += decoded.texels.len() as u64;
        if self.texels > MOST_TEXELS {
            return Err(told("and others are larger than 200 million texels together".to_owned()));
        }
        Ok(decoded)
    }

    /// Sends an image and its smaller versions.
    fn send(&self, mut image: RgbaImage, kind: Kind) -> TextureView {
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
            let place = wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() };
            let RgbaImage { width, height, .. } = image;
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: None,
            };
            let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
            self.gpu.queue.write_texture(place, image.texels.as_flattened(), layout, size);
        }
        texture.create_view(&Default::default())
    }
}

/// The sampler that a material asks for.
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
        anisotropy_clamp: if is_nearest { 1 } else { 8 },
        ..Default::default()
    })
}
