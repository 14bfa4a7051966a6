//! What a generated map is, and which verdict on it is right.

use darboux::MapVerdict;

use super::{MapCase, Relief};
use crate::Dice;

/// What a generated map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Green up.
    OpenGl,
    /// Green down.
    DirectX,
    /// Red and green exchanged.
    Exchanged,
    /// Vectors around z that have nothing to do with each other.
    Noise,
    /// Grey slopes in all channels.
    Grey,
    /// Vectors in all directions.
    ObjectSpace,
    /// One vector.
    Flat,
}

impl Truth {
    /// All kinds of maps.
    pub const ALL: [Self; 7] = [
        Self::OpenGl,
        Self::DirectX,
        Self::Exchanged,
        Self::Noise,
        Self::Grey,
        Self::ObjectSpace,
        Self::Flat,
    ];

    /// The kind with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|truth| format!("{truth:?}") == name)
    }

    /// 1 for green up, -1 for green down; none where the map is no gradient.
    pub fn green(self) -> Option<f32> {
        match self {
            Self::OpenGl => Some(1.0),
            Self::DirectX => Some(-1.0),
            _ => None,
        }
    }

    /// The verdict that is right.
    pub fn verdict(self) -> MapVerdict {
        match self {
            Self::OpenGl => MapVerdict::OpenGl,
            Self::DirectX => MapVerdict::DirectX,
            Self::Flat => MapVerdict::Flat,
            Self::Exchanged | Self::Noise | Self::Grey | Self::ObjectSpace => MapVerdict::NoGradient,
        }
    }

    /// The texels of a case.
    pub fn texels(self, case: &MapCase) -> Vec<[u8; 3]> {
        self.texels_of(&case.relief())
    }

    /// The texels of a case whose slopes are known.
    pub fn texels_of(self, relief: &Relief<'_>) -> Vec<[u8; 3]> {
        let case = relief.case();
        let code = |x: f32| ((x + 1.0) * 127.5).round().clamp(0.0, 255.0) as u8;
        let mut dice = Dice::from_seed(case.feature.to_bits().into());
        match self {
            Self::OpenGl => relief.texels(false),
            Self::DirectX => relief.texels(true),
            Self::Exchanged => relief.texels(false).into_iter().map(|[r, g, b]| [g, r, b]).collect(),
            Self::Grey => relief.texels(false).into_iter().map(|[r, ..]| [r; 3]).collect(),
            Self::Flat => vec![[128, 128, 255]; case.side * case.side],
            Self::Noise => {
                let mut slope = || 1.5 * case.slope * dice.uniform();
                let vector = |_| {
                    let (p, q) = (slope(), slope());
                    let length = (p * p + q * q + 1.0).sqrt();
                    [p, q, 1.0].map(|x| code(x / length))
                };
                (0..case.side * case.side).map(vector).collect()
            }
            Self::ObjectSpace => {
                let around = |i: usize| i as f32 / case.side as f32 * std::f32::consts::PI;
                let turned = |(i, [r, g, b]): (usize, [u8; 3])| {
                    let [x, y, z] = [r, g, b].map(|code| f32::from(code) / 127.5 - 1.0);
                    let (sin, cos) = (2.0 * around(i % case.side)).sin_cos();
                    let [x, z] = [x * cos + z * sin, z * cos - x * sin];
                    let (sin, cos) = (around(i / case.side) - 1.57).sin_cos();
                    [x, y * cos + z * sin, z * cos - y * sin].map(code)
                };
                relief.texels(false).into_iter().enumerate().map(turned).collect()
            }
        }
    }
}
