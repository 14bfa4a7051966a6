//! Chooses the UV set that tangents follow, and applies texture transforms.

use crate::gltf::schema::{Material, TextureInfo, TextureTransform};
use crate::source::UnreadMap;

/// The UVs that a primitive's tangents follow.
#[derive(Clone, Debug)]
pub struct UvChoice {
    /// The UV set n of `TEXCOORD_n`.
    pub set: usize,
    /// The texture that uses the set, or that none does.
    pub reason: String,
    /// The transform of that texture.
    pub transform: Option<TextureTransform>,
}

impl UvChoice {
    /// The choice for the material with an index; none if no texture of it uses tangents.
    pub fn of(material: &Material, index: usize) -> Option<Self> {
        let (texture, info) = tangent_texture(material)?;
        let transform = info.extensions.transform.clone();
        let set = transform.as_ref().and_then(|transform| transform.tex_coord).unwrap_or(info.tex_coord);
        Some(Self { set, reason: format!("{texture} of materials[{index}]"), transform })
    }

    /// The choice for a normal map that was not read.
    pub fn of_unread(map: &UnreadMap) -> Self {
        let reason = format!("the normal map of materials[{}], which was not read", map.material);
        Self { set: map.uv_set, reason, transform: None }
    }
}

impl Default for UvChoice {
    fn default() -> Self {
        Self { set: 0, reason: "no texture with tangents names a set".to_owned(), transform: None }
    }
}

/// The texture whose UVs the tangents of a material follow, and its name: the normal map (glTF 2.0, 3.9.3),
/// or else the textures of extensions.
fn tangent_texture(material: &Material) -> Option<(&'static str, &TextureInfo)> {
    let extensions = material.extensions.as_deref();
    let clearcoat = || extensions?.clearcoat.as_ref()?.clearcoat_normal_texture.as_ref();
    let anisotropy = || extensions?.anisotropy.as_ref()?.anisotropy_texture.as_ref();
    let normal = material.normal_texture.as_deref().map(|info| ("normalTexture", info));
    normal
        .or_else(|| clearcoat().map(|info| ("clearcoatNormalTexture", info)))
        .or_else(|| anisotropy().map(|info| ("anisotropyTexture", info)))
}

/// Whether a material uses tangents.
pub fn needs_tangents(material: &Material) -> bool {
    let anisotropic =
        material.extensions.as_deref().is_some_and(|extensions| extensions.anisotropy.is_some());
    anisotropic || tangent_texture(material).is_some()
}

/// Whether a transform changes the directions of tangents.
pub fn changes_directions(transform: &TextureTransform) -> bool {
    transform.rotation != 0.0 || transform.scale.iter().any(|&scale| scale < 0.0)
}

/// A `KHR_texture_transform` ready to apply: uv' = offset + rotation * scale * uv.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    offset: [f32; 2],
    cos: f32,
    sin: f32,
    scale: [f32; 2],
}

impl UvTransform {
    /// The transform; none if it is the identity.
    pub fn new(transform: &TextureTransform) -> Option<Self> {
        let TextureTransform { offset, rotation, scale, .. } = *transform;
        let (sin, cos) = f64::from(rotation).sin_cos();
        let identity = offset == [0.0; 2] && rotation == 0.0 && scale == [1.0; 2];
        (!identity).then_some(Self { offset, cos: cos as f32, sin: sin as f32, scale })
    }

    /// The offset and the scale; none for a transform that rotates, but for half turns, which negative scales
    /// are. In single precision the sine of half a turn is not exactly 0.
    pub fn without_rotation(&self) -> Option<([f32; 2], [f32; 2])> {
        (self.sin.abs() < 1e-6).then(|| (self.offset, self.scale.map(|scale| scale * self.cos.signum())))
    }

    /// Scales, then rotates, then offsets, each in f32.
    ///
    /// The rotation is counter-clockwise with v pointing down the image, as in the text of the extension and
    /// in renderers. The sign in the extension's GLSL listing is wrong (KhronosGroup/glTF, issue 1563).
    pub fn apply(&self, uv: [f32; 2]) -> [f32; 2] {
        let (u, v) = (self.scale[0] * uv[0], self.scale[1] * uv[1]);
        let rotated = [self.cos * u + self.sin * v, self.cos * v - self.sin * u];
        [rotated[0] + self.offset[0], rotated[1] + self.offset[1]]
    }

    /// The bits of all numbers, for exact comparison.
    pub fn bits(&self) -> [u32; 6] {
        let Self { offset, cos, sin, scale } = *self;
        [offset[0], offset[1], cos, sin, scale[0], scale[1]].map(f32::to_bits)
    }
}
