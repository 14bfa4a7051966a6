//! The conversion from one convention to another: the only place where a sign changes.

use crate::convention::rules::{Axes, Convention};

impl Convention {
    /// The conversion from this convention to another.
    pub fn to(self, other: Self) -> Conversion {
        Conversion::new(self, other)
    }
}

/// The conversion from one convention to another. The numbers change; the surface, its texture and its
/// shading stay the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conversion {
    /// For each new axis: the old axis and a factor, 1 or -1.
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
        // w is +1 or -1 times the triple product of bitangent, normal and tangent. Each of these four changes
        // negates it.
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

    /// Converts a position, a normal or an offset. Exact.
    pub fn vector(&self, vector: [f32; 3]) -> [f32; 3] {
        self.axes.map(|(axis, factor)| factor * vector[axis])
    }

    /// Converts a tangent: xyz and sign w. Exact.
    pub fn tangent(&self, [x, y, z, w]: [f32; 4]) -> [f32; 4] {
        let [x, y, z] = self.vector([x, y, z]).map(|component| self.tangent * component);
        [x, y, z, self.sign * w]
    }

    /// Converts a UV: v becomes 1 - v where the origins differ. A round trip is exact for multiples of 2^-24
    /// in [0, 1]; its error for other values is at most one ulp of the larger of 1 and |v|.
    pub fn uv(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        [u, if self.flips_v { 1.0 - v } else { v }]
    }

    /// Converts the corners of one face: reverses their order where the winding differs. The first corner
    /// stays first.
    ///
    /// `corners`: the indices of the face, or any values in their order.
    pub fn face<T>(&self, corners: &mut [T]) {
        if let (true, [_, others @ ..]) = (self.reverses_faces, corners) {
            others.reverse();
        }
    }

    /// True when the x component of normal maps is inverted.
    pub fn inverts_red(&self) -> bool {
        self.inverts_red
    }

    /// True when the y component of normal maps is inverted.
    pub fn inverts_green(&self) -> bool {
        self.inverts_green
    }
}

fn factor(negates: bool) -> f32 {
    if negates { -1.0 } else { 1.0 }
}

/// For each axis of `to`: the parallel axis of `from`, and the factor 1 or -1.
fn signed_permutation(from: Axes, to: Axes) -> [(usize, f32); 3] {
    let mut axes = [(0, 1.0); 3];
    for (old, new) in [(from.right(), to.right()), (from.up(), to.up()), (from.front(), to.front())] {
        axes[new.index()] = (old.index(), factor(old.is_negative() != new.is_negative()));
    }
    axes
}
