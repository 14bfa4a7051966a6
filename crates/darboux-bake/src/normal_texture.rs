//! [`NormalTexture`]: a normal map as a renderer reads it.

use std::sync::Arc;

use darboux::{Convention, TexelLayout, UvOrigin};
use darboux_io::gltf::Wrap;
use darboux_io::image::RgbCodes;

use crate::BakeError;
use crate::texture_wrap::Mix;
use crate::vector::{Place, Vector};

/// A tangent-space normal map, read with a bilinear filter.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalTexture {
    size: [usize; 2],
    texels: Texels,
    /// The factors of x and y that bring texels into frames of the surface, as its generated tangents have
    /// them.
    signs: [f32; 2],
    wrap: [Wrap; 2],
    scale: f32,
    flips_v: bool,
}

/// Texels, which textures share that differ in how they are read.
#[derive(Clone, Debug, PartialEq)]
enum Texels {
    Codes(Arc<RgbCodes>),
    Vectors(Arc<Vec<[f32; 3]>>),
}

impl Texels {
    fn len(&self) -> usize {
        match self {
            Self::Vectors(vectors) => vectors.len(),
            Self::Codes(codes) => match &**codes {
                RgbCodes::Bytes(codes) => codes.len(),
                RgbCodes::Words(codes) => codes.len(),
            },
        }
    }

    fn at(&self, index: usize) -> [f32; 3] {
        match self {
            Self::Vectors(vectors) => vectors[index],
            Self::Codes(codes) => match &**codes {
                RgbCodes::Bytes(codes) => TexelLayout::RGB.vector(codes[index]),
                RgbCodes::Words(codes) => TexelLayout::RGB.vector(codes[index]),
            },
        }
    }
}

impl NormalTexture {
    /// A texture that repeats.
    ///
    /// `size`: texels per row, and rows; `texels`: row after row, the top row first, as
    /// [`darboux::TexelLayout::vector`] decodes them; `map_convention`: the directions of red and green;
    /// `surface_convention`: that of the surface that has the map. Errors: another number of texels.
    pub fn new(
        size: [u32; 2],
        texels: Vec<[f32; 3]>,
        map_convention: Convention,
        surface_convention: Convention,
    ) -> Result<Self, BakeError> {
        Self::of_texels(size, Texels::Vectors(Arc::new(texels)), map_convention, surface_convention)
    }

    /// As [`NormalTexture::new`], of the codes of a map of glTF on a surface of glTF.
    pub(crate) fn of_codes(size: [u32; 2], codes: RgbCodes) -> Result<Self, BakeError> {
        Self::of_texels(size, Texels::Codes(Arc::new(codes)), Convention::GLTF, Convention::GLTF)
    }

    fn of_texels(
        size: [u32; 2],
        texels: Texels,
        map_convention: Convention,
        surface_convention: Convention,
    ) -> Result<Self, BakeError> {
        let size = size.map(|side| side as usize);
        if size[0].checked_mul(size[1]) != Some(texels.len()) || texels.len() == 0 {
            let expected = size[0].saturating_mul(size[1]);
            return Err(BakeError::Texels { expected, found: texels.len() });
        }
        let conversion = map_convention.to(surface_convention.generated());
        let sign = |inverts| if inverts { -1.0 } else { 1.0 };
        let signs = [conversion.inverts_red(), conversion.inverts_green()].map(sign);
        let flips_v = surface_convention.uv_origin == UvOrigin::BottomLeft;
        Ok(Self { size, texels, signs, wrap: [Wrap::Repeat; 2], scale: 1.0, flips_v })
    }

    /// This texture with other modes outside [0, 1], along u and v.
    #[must_use]
    pub fn with_wrap(self, wrap: [Wrap; 2]) -> Self {
        Self { wrap, ..self }
    }

    /// This texture with x and y scaled, as glTF's `normalTexture.scale` does.
    #[must_use]
    pub fn with_scale(self, scale: f32) -> Self {
        Self { scale, ..self }
    }

    /// Texels per row, and rows.
    pub fn size(&self) -> [u32; 2] {
        self.size.map(|side| side as u32)
    }

    /// The vector at a UV, not normalised.
    pub(crate) fn at_uv(&self, [u, v]: [f64; 2]) -> Vector {
        let v = if self.flips_v { 1.0 - v } else { v };
        self.at_place([u * self.size[0] as f64, v * self.size[1] as f64])
    }

    /// The vector at a place in texels from the upper left corner, not normalised.
    pub(crate) fn at_place(&self, place: Place) -> Vector {
        if !place.iter().all(|x| x.is_finite()) {
            return [0.0, 0.0, 1.0];
        }
        let [columns, rows] = [0, 1].map(|i| Mix::of(place[i], self.size[i], self.wrap[i]));
        let texel = |row: usize, column: usize| {
            let [x, y, z] = self.texels.at(row * self.size[0] + column);
            [self.signs[0] * x, self.signs[1] * y, z].map(f64::from)
        };
        let row = |row: usize| columns.mixed(columns.texels.map(|column| texel(row, column)));
        let [x, y, z] = rows.mixed(rows.texels.map(row));
        [f64::from(self.scale) * x, f64::from(self.scale) * y, z]
    }
}

/// The four texels that a bilinear filter mixes at a place of a repeated image, as indices.
pub fn filter_texels(place: Place, size: [usize; 2]) -> [usize; 4] {
    let [columns, rows] = [0, 1].map(|i| Mix::of(place[i], size[i], Wrap::Repeat));
    let at = |row: usize, column: usize| rows.texels[row] * size[0] + columns.texels[column];
    [at(0, 0), at(0, 1), at(1, 0), at(1, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(wrap: Wrap) -> NormalTexture {
        let texels = [0.0, 0.25, 0.5, 0.75].map(|x| [x, 0.0, 1.0]).to_vec();
        let generated = Convention::GLTF.generated();
        let texture = NormalTexture::new([4, 1], texels, generated, Convention::GLTF).expect("four texels");
        texture.with_wrap([wrap; 2])
    }

    #[test]
    fn filters_and_wraps() {
        let x = |wrap, place: f64| row(wrap).at_place([place, 0.5])[0];
        assert_eq!([0.5, 1.0, 1.25].map(|place| x(Wrap::Repeat, place)), [0.0, 0.125, 0.1875]);
        // Between the last texel and the next one: the first, the last again, the last for ever.
        let modes = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
        assert_eq!(modes.map(|wrap| x(wrap, 4.0)), [0.375, 0.75, 0.75]);
        assert_eq!(modes.map(|wrap| x(wrap, 5.5)), [0.25, 0.5, 0.75]);
        assert_eq!(modes.map(|wrap| x(wrap, -1.5)), [0.5, 0.25, 0.0]);
    }

    #[test]
    fn scale_and_conventions_change_x_and_y() {
        let texture =
            |map, surface| NormalTexture::new([1, 1], vec![[0.5, 0.25, 1.0]], map, surface).expect("a texel");
        let up = texture(Convention::OPENGL, Convention::GLTF);
        let down = texture(Convention::UNREAL, Convention::GLTF);
        let ([_, a, _], [_, b, _]) = (up.at_uv([0.0; 2]), down.at_uv([0.0; 2]));
        assert_eq!([a.abs(), a], [0.25, -b]);
        let [x, y, z] = up.with_scale(2.0).at_uv([0.3, 7.0]);
        assert_eq!([x, y, z], [1.0, 2.0 * a, 1.0]);
    }

    #[test]
    fn other_numbers_of_texels_are_refused() {
        let refused = |size, count| {
            NormalTexture::new(size, vec![[0.0; 3]; count], Convention::GLTF, Convention::GLTF)
                .expect_err("refused")
        };
        assert_eq!(refused([2, 2], 3), BakeError::Texels { expected: 4, found: 3 });
        assert_eq!(refused([0, 2], 0), BakeError::Texels { expected: 0, found: 0 });
    }
}
