//! The verdict on a normal map and the counts behind it.

use crate::choice;

/// The smallest absolute z score that decides between OpenGL and DirectX.
pub(super) const MIN_Z_SCORE: f32 = 4.0;

/// What the texels of a normal map say about its green channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapVerdict {
    /// Green points up, as glTF and OpenGL want it (or red and green are both inverted).
    OpenGl,
    /// Green points down, as DirectX wants it (or red is inverted).
    DirectX,
    /// The texels are not the slope of a surface: a height or colour map, a map in object space, exchanged
    /// channels, noise.
    NoGradient,
    /// All texels are the same but for rounding.
    Flat,
    /// There is too little evidence.
    CannotTell,
}

choice! {
    MapVerdict, "verdict",
    OpenGl => "opengl", "green points up, as glTF and OpenGL want it";
    DirectX => "directx", "green points down, as DirectX wants it";
    NoGradient => "no_gradient", "the texels are not the slope of a surface";
    Flat => "flat", "all texels are the same but for rounding";
    CannotTell => "cannot_tell", "there is too little evidence";
}

impl MapVerdict {
    /// Whether the map is in one of the two conventions.
    pub(super) fn is_direction(self) -> bool {
        matches!(self, Self::OpenGl | Self::DirectX)
    }
}

/// The verdict on a normal map and the counts behind it.
///
/// Counts leave out the background: black, white and middle grey texels, and what black ones of two channels
/// become once z is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapJudgement {
    /// The verdict.
    pub verdict: MapVerdict,
    /// An estimate of the probability that the verdict is right, at least 0.5, as if red and green were
    /// exchanged in one of 91 maps; for `CannotTell` that of the likelier of OpenGL and DirectX, at most
    /// 0.97; for `Flat` 1. It was fitted to blocks of real maps: docs/notes/real-normal-maps.md compares
    /// it with the share of right verdicts.
    pub confidence: f32,
    /// The mean correlation of the tiles, from -1 (DirectX) to 1 (OpenGL), of the map or of one of its
    /// halvings: of those whose mean has the sign of `z_score`, the one whose mean is largest in units
    /// of its standard error. Each tile counts alike. Where that contradicts the verdict, and in maps of
    /// few tiles, `relief_correlation`.
    pub correlation: f32,
    /// That mean divided by its standard error; or, where it is larger, such quotients of the map and of its
    /// halvings, added and divided by the square root of their number. The halvings depend on each
    /// other, so large values are less certain than those of a normal distribution. Where `correlation`
    /// is `relief_correlation`, `shift_score`.
    pub z_score: f32,
    /// The mean correlation of the tiles of the map and of its halvings, weighted by the energy of their
    /// slopes above that of rounding.
    pub relief_correlation: f32,
    /// How much better a height field explains the slopes in OpenGL's convention than in DirectX's, in units
    /// of the root mean square of the same number over all shifts of green against red. 0 for maps with
    /// fewer than 16 texels along a side.
    pub shift_score: f32,
    /// The shares of the energy of the slopes that no height field explains: in OpenGL's convention and in
    /// DirectX's. Both are 0.5 for maps with fewer than 16 texels along a side.
    pub residuals: [f32; 2],
    /// Whether most tiles are in another convention than the relief: faint detail that was overlaid.
    pub has_opposed_detail: bool,
    /// Half the natural logarithm of the energy of the unmixed derivatives over that of the mixed ones.
    /// Negative for exchanged channels.
    pub log_energy_ratio: f32,
    /// Whether that is certain enough.
    pub(super) is_exchanged: bool,
    /// The texels of the map.
    pub texels: usize,
    /// Black, white and middle grey texels, and those with z = 0 whose x and y are beyond the unit circle.
    pub background: usize,
    /// Texels whose length is not in [0.9, 1.1].
    pub not_unit: usize,
    /// Texels with z below -1/100. 0 where the layout stores no z.
    pub negative_z: usize,
    /// Texels whose three channels differ by at most 3/255. 0 where the layout stores no z.
    pub grey: usize,
    /// Texels that cannot be normals of a tangent-space map, however it was filtered: the length is not in
    /// [0.5, 1.2], or z is below -0.1.
    pub not_normal: usize,
    /// Whether the layout stores z.
    pub has_z: bool,
    /// Texels whose z differs by more than 4/255 from that of the unit vector with their x and y. 0 where
    /// the layout stores no z.
    pub wrong_z: usize,
    /// The mean length of the texels.
    pub mean_length: f32,
    /// The mean of the texels.
    pub mean: [f32; 3],
    /// The smallest and the largest z; where the layout stores no z, of the unit vectors with the texels' x
    /// and y.
    pub z_range: [f32; 2],
    /// The commonest x and y, each as an 8-bit code.
    pub commonest: [u8; 2],
    /// The number of texels with the commonest x and y.
    pub commonest_count: usize,
    /// The commonest x and y among the codes from 120 to 136; none where no texel has such codes.
    pub near_flat: Option<[u8; 2]>,
}

/// The tiles of a normal map and how each of them votes between OpenGL and DirectX, at the size of the map
/// whose mean is [`MapJudgement::correlation`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapTiles {
    /// The texels of the map along a side of a tile.
    pub side: usize,
    /// The tiles of a row. Tile i begins `side * (i % columns)` texels from the left and `side * (i /
    /// columns)` from the top.
    pub columns: usize,
    /// The correlation of each tile, from -1 (DirectX) to 1 (OpenGL), the top row first; none where a tile
    /// has no vote, because it has one value, or mostly background or borders of charts.
    pub correlations: Vec<Option<f32>>,
}

/// A mistake in the handling of the transfer function of sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SrgbMistake {
    /// Linear values were encoded: the flat texel is near 188.
    Encoded,
    /// Values were decoded that were linear already: the flat texel is near 55.
    Decoded,
}

impl MapJudgement {
    fn share(&self, count: usize) -> f64 {
        count as f64 / (self.texels - self.background).max(1) as f64
    }

    /// True for grey maps, such as height maps: 99 % of the texels are grey.
    pub fn is_grey(&self) -> bool {
        self.texels > self.background && self.share(self.grey) >= 0.99
    }

    /// True for maps in object space: unit vectors, of which more than a tenth have a negative z. A steep map
    /// in tangent space can have them, too: then the vectors still point along z on average, or against
    /// it where blue was inverted, and are slopes of a surface.
    pub fn is_object_space(&self) -> bool {
        let is_steep = self.mean[2].abs() > 0.5 && self.relief_correlation.abs() >= 0.3;
        let is_turned = self.share(self.negative_z) > 0.1 && !is_steep;
        !self.is_grey() && is_turned && self.share(self.not_unit) < 0.5
    }

    /// True where the layout stores z, but that channel has one value, which is wrong for more than 1 % of
    /// the texels. A map of gentle slopes has nearly one value, too, and it is right.
    pub fn is_two_channel(&self) -> bool {
        let [low, high] = self.z_range;
        let is_constant = self.has_z && high - low <= 1.0 / 255.0;
        is_constant && self.share(self.wrong_z) > 0.01 && self.verdict != MapVerdict::Flat && !self.is_grey()
    }

    /// True where more than half of the texels cannot be normals.
    pub fn holds_no_normals(&self) -> bool {
        self.share(self.not_normal) > 0.5
    }

    /// True where red and green seem to be exchanged: mixed derivatives have more energy than unmixed ones.
    pub fn has_exchanged_channels(&self) -> bool {
        self.verdict == MapVerdict::NoGradient && self.is_exchanged
    }

    /// The transfer function that was applied once too often, judged by the commonest texel and by the mean:
    /// maps do not lean on average.
    pub fn srgb_mistake(&self) -> Option<SrgbMistake> {
        let is_common = self.share(self.commonest_count) >= 0.01;
        let [x, y, z] = self.mean.map(|x| (x + 1.0) * 127.5);
        let is_near = |code: u8| {
            let mean_is_near = [x, y].iter().all(|mean| (mean - f32::from(code)).abs() <= 3.0);
            let commonest_is_near = self.commonest.iter().all(|&channel| channel.abs_diff(code) <= 3);
            is_common && commonest_is_near || mean_is_near && z > 192.0
        };
        if self.is_grey() {
            None
        } else if is_near(188) {
            Some(SrgbMistake::Encoded)
        } else if is_near(55) {
            Some(SrgbMistake::Decoded)
        } else {
            None
        }
    }
}
