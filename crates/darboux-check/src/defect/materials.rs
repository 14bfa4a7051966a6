//! [`MaterialFault`]: what is wrong with how a material uses its normal map.

use crate::code::Code;

/// What is wrong with a normal texture.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialFault {
    TransformMirrors {
        /// Where the directions u and v of the texture go.
        axes: [[f64; 2]; 2],
        determinant: f64,
        /// Degrees.
        rotation: f64,
    },
    /// The negative scale.
    ScaleNegative(f64),
    /// The scale, which is nearly 0.
    ScaleZero(f64),
    /// The large scale.
    ScaleExtreme(f64),
}

impl MaterialFault {
    pub fn code(&self) -> Code {
        match self {
            Self::TransformMirrors { .. } => Code::TransformMirrors,
            Self::ScaleNegative(_) => Code::MapScaleNegative,
            Self::ScaleZero(_) => Code::MapScaleZero,
            Self::ScaleExtreme(_) => Code::MapScaleExtreme,
        }
    }
}
