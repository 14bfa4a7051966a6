//! Healthy normal maps of known truth, and the mistakes that are made in maps.

use darboux::{MapVerdict, TexelLayout, judge_normal_map};
use darboux_check::Code;
use darboux_io::image::PngImage;
use darboux_tests::maps::damage::Storage;
use darboux_tests::maps::surfaces::Surface;
use darboux_tests::maps::truth::Truth;
use darboux_tests::maps::{Background, MapCase};

/// A square map, its texels and its PNG file.
#[derive(Clone)]
pub struct Map {
    pub case: MapCase,
    pub texels: Vec<[u8; 3]>,
    pub file: Vec<u8>,
}

/// Texels per row and column.
const SIDE: usize = 128;

/// A map of a generated height field, a third of it flat. Fields whose convention their texels do not show
/// are left out.
pub fn healthy_map(number: usize) -> Map {
    let mut maps = (0..).map(|attempt| generated_map(number + 1000 * attempt));
    let is_decided = |map: &Map| {
        let judged = judge_normal_map(&map.texels, [SIDE; 2], TexelLayout::RGB);
        judged.is_ok_and(|judgement| judgement.verdict == MapVerdict::OpenGl)
    };
    maps.find(is_decided).expect("most fields are decided")
}

/// A map of large dents, for pictures.
pub fn dents() -> Map {
    let mut map = generated_map(1);
    (map.case.surface, map.case.side) = (Surface::Dents, 256);
    (map.case.feature, map.case.slope) = (70.0, 0.45);
    let texels = map.case.texels(false);
    map.with_texels(texels)
}

fn generated_map(number: usize) -> Map {
    const SURFACES: [Surface; 5] =
        [Surface::Noise, Surface::Dents, Surface::Fabric, Surface::Tiles, Surface::Terrain];
    let mut case = MapCase::new(number as u64, 256);
    case.storage = Storage::Rounded;
    case.background = Background::Padded;
    case.surface = SURFACES[number % SURFACES.len()];
    (case.side, case.feature) = (SIDE, 20.0);
    (case.charts, case.noise, case.slope, case.stretch) = (1, 0.0, 0.3, 1.0);
    let mut texels = case.texels(false);
    texels[..SIDE / 3 * SIDE].fill([128, 128, 255]);
    Map { case, file: png(&texels), texels }
}

/// The PNG of a square map.
pub fn png(texels: &[[u8; 3]]) -> Vec<u8> {
    let side = texels.len().isqrt() as u32;
    let image = PngImage::from_rgb("map.png", [side, side], texels).expect("a square");
    image.to_bytes().expect("an image can be encoded")
}

impl Map {
    /// The same map with other texels.
    pub fn with_texels(&self, texels: Vec<[u8; 3]>) -> Self {
        Self { case: self.case.clone(), file: png(&texels), texels }
    }

    /// The same map after a function of red, green and blue, each from 0 to 1.
    pub fn through(&self, function: impl Fn([f32; 3]) -> [f32; 3]) -> Self {
        let change = |texel: &[u8; 3]| {
            function(texel.map(|byte| f32::from(byte) / 255.0)).map(|x| (255.0 * x).round() as u8)
        };
        self.with_texels(self.texels.iter().map(change).collect())
    }
}

/// A mistake in a map.
pub struct MapMistake {
    pub code: Code,
    /// How it was made.
    pub how: &'static str,
    pub make: fn(&Map) -> Map,
    /// The most that a repaired channel may differ from the healthy one, in codes; none where it is not
    /// repaired.
    pub tolerance: Option<u8>,
}

/// All mistakes in maps.
pub const MAP_MISTAKES: &[MapMistake] = &[
    MapMistake {
        code: Code::MapGreenFlipped,
        how: "green inverted",
        make: |map| map.through(|[r, g, b]| [r, 1.0 - g, b]),
        tolerance: Some(0),
    },
    MapMistake {
        code: Code::MapChannelsSwapped,
        how: "red and green exchanged",
        make: |map| map.through(|[r, g, b]| [g, r, b]),
        tolerance: Some(0),
    },
    MapMistake {
        code: Code::MapSrgb,
        how: "encoded as sRGB",
        make: |map| map.through(|texel| texel.map(|x| x.powf(1.0 / 2.2))),
        // A power of 2.2 is not the transfer function of sRGB: they differ by up to 0.008.
        tolerance: Some(3),
    },
    MapMistake {
        code: Code::MapSrgb,
        how: "decoded from sRGB",
        make: |map| map.through(|texel| texel.map(|x| x.powf(2.2))),
        // Decoding leaves few codes to dark values: all codes up to 14 become 0.
        tolerance: Some(14),
    },
    MapMistake {
        code: Code::MapHeight,
        how: "red in all channels",
        make: |map| map.through(|[r, ..]| [r; 3]),
        tolerance: None,
    },
    MapMistake {
        code: Code::MapObjectSpace,
        how: "the normals of a sphere",
        make: |map| map.with_texels(Truth::ObjectSpace.texels(&map.case)),
        tolerance: None,
    },
    MapMistake {
        code: Code::MapNotNormal,
        how: "a photograph",
        make: |map| {
            let texel = |i: usize| [(i % 251) as u8 / 3, (i / 7 % 241) as u8 / 2, (i / 256) as u8 / 2];
            map.with_texels((0..map.texels.len()).map(texel).collect())
        },
        tolerance: None,
    },
    MapMistake {
        code: Code::MapTwoChannel,
        how: "blue set to 0",
        make: |map| map.through(|[r, g, _]| [r, g, 0.0]),
        tolerance: Some(2),
    },
    MapMistake {
        code: Code::MapTwoChannel,
        how: "blue set to 255",
        make: |map| map.through(|[r, g, _]| [r, g, 1.0]),
        tolerance: Some(2),
    },
    MapMistake {
        code: Code::MapNotUnit,
        how: "vectors scaled to 80 %",
        make: |map| map.through(|texel| texel.map(|x| 0.5 + 0.8 * (x - 0.5))),
        tolerance: Some(2),
    },
    MapMistake {
        code: Code::MapNegativeZ,
        how: "blue lowered to 60 in specks",
        make: |map| {
            let mut texels = map.texels.clone();
            texels.iter_mut().step_by(900).for_each(|texel| texel[2] = 60);
            map.with_texels(texels)
        },
        tolerance: None,
    },
    MapMistake {
        code: Code::MapFlatOff,
        how: "red lowered by 4",
        make: |map| map.through(|[r, g, b]| [(r - 4.0 / 255.0).max(0.0), g, b]),
        tolerance: None,
    },
    MapMistake {
        code: Code::MapFlat,
        how: "one colour",
        make: |map| map.with_texels(vec![[128, 128, 255]; map.texels.len()]),
        tolerance: None,
    },
    MapMistake {
        code: Code::MapEnlarged,
        how: "half the size, enlarged with nearest-neighbour sampling",
        make: |map| {
            let side = map.texels.len().isqrt();
            let texel = |i: usize| map.texels[i / side / 2 * 2 * side + i % side / 2 * 2];
            map.with_texels((0..map.texels.len()).map(texel).collect())
        },
        tolerance: None,
    },
    MapMistake {
        code: Code::MapBanding,
        how: "stored as R5G6B5",
        make: |map| {
            let code = |byte: u8, bits: u32| byte >> (8 - bits) << (8 - bits) | byte >> bits & (0xFF >> bits);
            let texel = |[r, g, b]: &[u8; 3]| [code(*r, 5), code(*g, 6), code(*b, 5)];
            map.with_texels(map.texels.iter().map(texel).collect())
        },
        tolerance: None,
    },
    MapMistake {
        code: Code::MapBlocks,
        how: "waves, 70 % of the way to the means of blocks of 8 x 8 texels, as in a strongly compressed JPEG",
        make: |map| {
            let side = map.texels.len().isqrt();
            let wave = |i: usize| {
                let (x, y) = ((i % side) as f32 / 7.0, (i / side) as f32 / 9.0);
                let vector = [-0.4 * x.cos() * y.sin(), 0.31 * x.sin() * y.cos(), 1.0];
                let length = vector.iter().map(|x| x * x).sum::<f32>().sqrt();
                vector.map(|x| 127.5 + 127.5 * x / length)
            };
            let texel = |i: usize| {
                let (left, top) = (i % side / 8 * 8, i / side / 8 * 8);
                let block = (0..64).map(|k| wave((top + k / 8) * side + left + k % 8));
                let sums = block.fold([0.0; 3], |sum, texel| [0, 1, 2].map(|c| sum[c] + texel[c]));
                [0, 1, 2].map(|c| (0.3 * wave(i)[c] + 0.7 * sums[c] / 64.0).round() as u8)
            };
            map.with_texels((0..map.texels.len()).map(texel).collect())
        },
        tolerance: None,
    },
];
