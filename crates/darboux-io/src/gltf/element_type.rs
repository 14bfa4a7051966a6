//! The types of components and elements of accessors.

use serde::Deserialize;

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "u32")]
pub enum ComponentType {
    /// 5120: signed, 8 bits.
    I8,
    /// 5121: unsigned, 8 bits.
    U8,
    /// 5122: signed, 16 bits.
    I16,
    /// 5123: unsigned, 16 bits.
    U16,
    /// 5125: unsigned, 32 bits.
    U32,
    /// 5126: float, 32 bits.
    F32,
}

impl ComponentType {
    /// Bytes per component.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The constant of glTF.
    pub fn code(self) -> u32 {
        match self {
            Self::I8 => 5120,
            Self::U8 => 5121,
            Self::I16 => 5122,
            Self::U16 => 5123,
            Self::U32 => 5125,
            Self::F32 => 5126,
        }
    }
}

impl TryFrom<u32> for ComponentType {
    type Error = String;

    fn try_from(code: u32) -> Result<Self, String> {
        [Self::I8, Self::U8, Self::I16, Self::U16, Self::U32, Self::F32]
            .into_iter()
            .find(|kind| kind.code() == code)
            .ok_or_else(|| format!("{code} is not a component type: use 5120 to 5123, 5125 or 5126"))
    }
}

/// The number and arrangement of an element's components.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum ElementType {
    /// One component.
    Scalar,
    /// Two components.
    Vec2,
    /// Three components.
    Vec3,
    /// Four components.
    Vec4,
    /// A matrix of two columns.
    Mat2,
    /// A matrix of three columns.
    Mat3,
    /// A matrix of four columns.
    Mat4,
}

impl ElementType {
    /// The name in glTF.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "SCALAR",
            Self::Vec2 => "VEC2",
            Self::Vec3 => "VEC3",
            Self::Vec4 => "VEC4",
            Self::Mat2 => "MAT2",
            Self::Mat3 => "MAT3",
            Self::Mat4 => "MAT4",
        }
    }

    /// The number of columns, and of components per column.
    pub(super) fn shape(self) -> (usize, usize) {
        match self {
            Self::Scalar => (1, 1),
            Self::Vec2 => (1, 2),
            Self::Vec3 => (1, 3),
            Self::Vec4 => (1, 4),
            Self::Mat2 => (2, 2),
            Self::Mat3 => (3, 3),
            Self::Mat4 => (4, 4),
        }
    }

    /// The number of components.
    pub fn components(self) -> usize {
        let (columns, rows) = self.shape();
        columns * rows
    }

    /// Bytes per element. The columns of matrices start at multiples of four bytes.
    pub fn size(self, component: ComponentType) -> usize {
        let (columns, rows) = self.shape();
        let column = rows * component.size();
        if columns == 1 { column } else { columns * column.next_multiple_of(4) }
    }
}
