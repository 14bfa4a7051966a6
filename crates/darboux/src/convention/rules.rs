//! The choices that make up a convention: axes, winding, UV origin, directions of tangent and bitangent,
//! meaning of the sign.

/// A direction along a coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Along x.
    X,
    /// Against x.
    MinusX,
    /// Along y.
    Y,
    /// Against y.
    MinusY,
    /// Along z.
    Z,
    /// Against z.
    MinusZ,
}

impl Axis {
    pub(super) const fn index(self) -> usize {
        match self {
            Self::X | Self::MinusX => 0,
            Self::Y | Self::MinusY => 1,
            Self::Z | Self::MinusZ => 2,
        }
    }

    pub(super) const fn is_negative(self) -> bool {
        matches!(self, Self::MinusX | Self::MinusY | Self::MinusZ)
    }
}

/// The axes of a model: where its right, its top and its front point. Three different axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    right: Axis,
    up: Axis,
    front: Axis,
}

/// The handedness of a coordinate system: thumb, index and middle finger along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handedness {
    /// Right-handed: with x to the right and y up, z points to the viewer.
    Right,
    /// Left-handed: with x to the right and y up, z points away from the viewer.
    Left,
}

impl Axes {
    /// The axes of a model. `None` where two of the three are parallel.
    pub const fn new(right: Axis, up: Axis, front: Axis) -> Option<Self> {
        let (r, u, f) = (right.index(), up.index(), front.index());
        if r == u || u == f || f == r { None } else { Some(Self { right, up, front }) }
    }

    /// The right of the model, which a viewer in front of the model sees on the left.
    pub const fn right(self) -> Axis {
        self.right
    }

    /// The top of the model.
    pub const fn up(self) -> Axis {
        self.up
    }

    /// The front of the model.
    pub const fn front(self) -> Axis {
        self.front
    }

    /// The handedness of the coordinate system. Right, up and front of a model are left-handed in space, so
    /// the coordinates are left-handed exactly when the determinant of the three axes is +1.
    pub const fn handedness(self) -> Handedness {
        let is_cyclic = (self.right.index() + 1) % 3 == self.up.index();
        let is_odd = self.right.is_negative() != (self.up.is_negative() != self.front.is_negative());
        if is_cyclic != is_odd { Handedness::Left } else { Handedness::Right }
    }
}

/// The winding of front faces, as seen on the screen from the side that the normal points to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// Counter-clockwise.
    CounterClockwise,
    /// Clockwise.
    Clockwise,
}

/// The origin of UVs in the image. u always points to the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UvOrigin {
    /// v = 0 is the bottom; v points up.
    BottomLeft,
    /// v = 0 is the top; v points down.
    TopLeft,
}

/// The direction of the tangent, as a direction in the texture image. More red tilts the normal in this
/// direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentDirection {
    /// To the right of the image.
    Right,
    /// To the left of the image.
    Left,
}

/// The direction of the bitangent that a shader rebuilds, as a direction in the texture image. More green
/// tilts the normal in this direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitangentDirection {
    /// To the top of the image ("OpenGL", Y+).
    Up,
    /// To the bottom of the image ("DirectX", Y-).
    Down,
}

/// The formula by which a shader rebuilds the bitangent from normal, tangent and sign, applied to coordinates
/// of either handedness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignRule {
    /// w * cross(normal, tangent).
    NormalCrossTangent,
    /// w * cross(tangent, normal).
    TangentCrossNormal,
}

/// The convention of a mesh and of its normal map: the meaning of their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// The axes of models.
    pub axes: Axes,
    /// The winding of front faces.
    pub winding: Winding,
    /// The origin of UVs.
    pub uv_origin: UvOrigin,
    /// The direction of tangents and of red.
    pub tangent: TangentDirection,
    /// The direction of bitangents and of green.
    pub bitangent: BitangentDirection,
    /// The formula of the bitangent.
    pub sign: SignRule,
}

impl Convention {
    /// The convention of the tangents that [`crate::generate_tangents`] returns for a mesh in this
    /// convention. Axes, winding and UV origin stay.
    ///
    /// The tangent points along u. The sign is that of the UV area, so w * cross(normal, tangent) points
    /// along v if front faces wind about the normal by the right-hand rule in coordinates, and against v
    /// otherwise.
    pub const fn generated(self) -> Self {
        let is_right = matches!(self.axes.handedness(), Handedness::Right);
        let is_counter_clockwise = matches!(self.winding, Winding::CounterClockwise);
        let follows_v = is_right == is_counter_clockwise;
        let v_is_up = matches!(self.uv_origin, UvOrigin::BottomLeft);
        let bitangent = if follows_v == v_is_up { BitangentDirection::Up } else { BitangentDirection::Down };
        Self { tangent: TangentDirection::Right, bitangent, sign: SignRule::NormalCrossTangent, ..self }
    }
}
