//! What the numbers of a mesh and of its normal map mean, and the one place where a sign changes.
//!
//! docs/conventions.md derives the rules that stand here, and tabulates the presets.

mod presets;
mod text;

pub use text::ConventionError;

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
    const fn index(self) -> usize {
        match self {
            Self::X | Self::MinusX => 0,
            Self::Y | Self::MinusY => 1,
            Self::Z | Self::MinusZ => 2,
        }
    }

    const fn is_negative(self) -> bool {
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

    /// The change from this convention to another.
    pub fn to(self, other: Self) -> Conversion {
        Conversion::new(self, other)
    }
}

/// The change from one convention to another, as numbers. The surface, its texture and its light stay as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// Per new axis the old axis and a factor, 1 or -1.
    axes: [(usize, f32); 3],
    tangent: f32,
    sign: f32,
    flips_v: bool,
    reverses_faces: bool,
    inverts_red: bool,
    inverts_green: bool,
}

impl Conversion {
    fn new(from: Convention, to: Convention) -> Self {
        let inverts_red = from.tangent != to.tangent;
        let inverts_green = from.bitangent != to.bitangent;
        let other_hand = from.axes.handedness() != to.axes.handedness();
        // w = +-1 times the triple product of bitangent, normal and tangent in numbers: each of these four negates it.
        let negations = [other_hand, inverts_red, inverts_green, from.sign != to.sign];
        Self {
            axes: signed_permutation(from.axes, to.axes),
            tangent: factor(inverts_red),
            sign: negations.into_iter().map(factor).product(),
            flips_v: from.uv_origin != to.uv_origin,
            reverses_faces: from.winding != to.winding,
            inverts_red,
            inverts_green,
        }
    }

    /// A position, a normal or an offset. Exact.
    pub fn vector(&self, vector: [f32; 3]) -> [f32; 3] {
        self.axes.map(|(axis, factor)| factor * vector[axis])
    }

    /// A tangent xyz and its sign w. Exact.
    pub fn tangent(&self, [x, y, z, w]: [f32; 4]) -> [f32; 4] {
        let [x, y, z] = self.vector([x, y, z]).map(|component| self.tangent * component);
        [x, y, z, self.sign * w]
    }

    /// A UV: v becomes 1 - v where the origins differ. There and back is exact for multiples of 2^-24 in [0, 1], otherwise off by
    /// up to the spacing of floats at the larger of 1 and |v|.
    pub fn uv(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        [u, if self.flips_v { 1.0 - v } else { v }]
    }

    /// The corners of one face, its indices or whatever lies along them: reversed where fronts are wound the other way. The first stays.
    pub fn face<T>(&self, corners: &mut [T]) {
        if let (true, [_, others @ ..]) = (self.reverses_faces, corners) {
            others.reverse();
        }
    }

    /// True where red leans the other way: the texel's red changes, wherever it is stored.
    pub fn inverts_red(&self) -> bool {
        self.inverts_red
    }

    /// True where green leans the other way.
    pub fn inverts_green(&self) -> bool {
        self.inverts_green
    }
}

fn factor(negates: bool) -> f32 {
    if negates { -1.0 } else { 1.0 }
}

/// Per axis of `to` the axis of `from` that lies along the same line of the model, and whether it points the same way.
fn signed_permutation(from: Axes, to: Axes) -> [(usize, f32); 3] {
    let mut axes = [(0, 1.0); 3];
    for (old, new) in [(from.right, to.right), (from.up, to.up), (from.front, to.front)] {
        axes[new.index()] = (old.index(), factor(old.is_negative() != new.is_negative()));
    }
    axes
}
