//! The choices that make up a convention: axes, winding, UV origin, directions of tangent and bitangent, meaning of the sign.

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

/// Where a model's own right hand, head and face point: three different axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axes {
    right: Axis,
    up: Axis,
    front: Axis,
}

/// Which hand's thumb, index and middle finger lie along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handedness {
    /// z points to a viewer who sees x to the right and y up.
    Right,
    /// z points away from that viewer.
    Left,
}

impl Axes {
    /// The axes of a model that looks along `front`, or none where two of the three lie along one line.
    pub const fn new(right: Axis, up: Axis, front: Axis) -> Option<Self> {
        let (r, u, f) = (right.index(), up.index(), front.index());
        if r == u || u == f || f == r { None } else { Some(Self { right, up, front }) }
    }

    /// The model's right, which a viewer in front of it sees on the left.
    pub const fn right(self) -> Axis {
        self.right
    }

    /// Up.
    pub const fn up(self) -> Axis {
        self.up
    }

    /// Where the model looks.
    pub const fn front(self) -> Axis {
        self.front
    }

    /// Right, up and front are the fingers of a left hand, whatever the coordinates: the space is left-handed just where their
    /// determinant is +1.
    pub const fn handedness(self) -> Handedness {
        let is_cyclic = (self.right.index() + 1) % 3 == self.up.index();
        let is_odd = self.right.is_negative() != (self.up.is_negative() != self.front.is_negative());
        if is_cyclic != is_odd { Handedness::Left } else { Handedness::Right }
    }
}

/// The order of a face's corners, seen from the side that its normal points to, as the eye sees it and not as the numbers say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// Against the clock.
    CounterClockwise,
    /// With the clock.
    Clockwise,
}

/// Where in the picture v = 0 is. u always runs to the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UvOrigin {
    /// v runs up.
    BottomLeft,
    /// v runs down.
    TopLeft,
}

/// Where the tangent points on the surface, and more red leans the normal: a direction in the picture that lies on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentDirection {
    /// To the picture's right.
    Right,
    /// To the picture's left.
    Left,
}

/// Where the bitangent that a shader rebuilds points on the surface, and more green leans the normal: a direction in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitangentDirection {
    /// To the picture's top ("OpenGL", Y+).
    Up,
    /// To the picture's bottom ("DirectX", Y-).
    Down,
}

/// How a shader rebuilds the bitangent from normal, tangent and sign: by numbers, so that a left-handed space takes the left hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignRule {
    /// w * cross(normal, tangent).
    NormalCrossTangent,
    /// w * cross(tangent, normal).
    TangentCrossNormal,
}

/// What the numbers of a mesh and of its normal map mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// How a model stands in its space.
    pub axes: Axes,
    /// How fronts of faces are wound.
    pub winding: Winding,
    /// Where v = 0 is.
    pub uv_origin: UvOrigin,
    /// Where tangents, and red, point.
    pub tangent: TangentDirection,
    /// Where bitangents, and green, point.
    pub bitangent: BitangentDirection,
    /// What w means.
    pub sign: SignRule,
}

impl Convention {
    /// What [`crate::generate_tangents`] returns for a mesh in this convention: this one but for the frames.
    ///
    /// MikkTSpace knows no pictures. Its tangent follows u. Its sign is that of the UV area, so w * cross(normal, tangent) follows
    /// v where the numbers of front faces turn about the normal as the right hand does, and opposes v where they do not.
    pub const fn generated(self) -> Self {
        let is_right = matches!(self.axes.handedness(), Handedness::Right);
        let is_counter_clockwise = matches!(self.winding, Winding::CounterClockwise);
        let follows_v = is_right == is_counter_clockwise;
        let v_is_up = matches!(self.uv_origin, UvOrigin::BottomLeft);
        let bitangent = if follows_v == v_is_up { BitangentDirection::Up } else { BitangentDirection::Down };
        Self { tangent: TangentDirection::Right, bitangent, sign: SignRule::NormalCrossTangent, ..self }
    }
}
