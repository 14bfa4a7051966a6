//! Nodes: the boxes of four children.

use super::ray::PreparedRay;

/// What a child of a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    Node(u32),
    Leaf(u32),
}

/// The bit of leaves in stored children.
const LEAF: u32 = 1 << 31;

/// The far end of a box is moved by this factor, which exceeds the rounding errors of its distance (T. Ize,
/// "Robust BVH Ray Traversal", JCGT 2(2), 2013, section 3): no ray misses a box that contains its hit.
pub const FAR_FACTOR: f32 = 1.000_000_4;

/// The boxes of up to four children, by axis and child.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// The least and the greatest coordinate: `bounds[side][axis][child]`. Absent children have boxes that
    /// no ray hits.
    bounds: [[[f32; 4]; 3]; 2],
    children: [u32; 4],
}

impl Node {
    pub const EMPTY: Self =
        Self { bounds: [[[f32::INFINITY; 4]; 3], [[f32::NEG_INFINITY; 4]; 3]], children: [0; 4] };

    pub fn set(&mut self, place: usize, [least, greatest]: [[f32; 3]; 2], child: Child) {
        for axis in 0..3 {
            self.bounds[0][axis][place] = least[axis];
            self.bounds[1][axis][place] = greatest[axis];
        }
        self.children[place] = match child {
            Child::Node(index) => index,
            Child::Leaf(index) => index | LEAF,
        };
    }

    pub fn child(&self, place: usize) -> Child {
        match self.children[place] {
            stored if stored & LEAF != 0 => Child::Leaf(stored & !LEAF),
            stored => Child::Node(stored),
        }
    }

    /// The box of a child.
    pub fn bounds_of(&self, place: usize) -> [[f32; 3]; 2] {
        self.bounds.map(|side| side.map(|of_axis| of_axis[place]))
    }

    /// Whether there is no child at a place.
    pub fn is_absent(&self, place: usize) -> bool {
        self.bounds[0][0][place] == f32::INFINITY
    }

    /// The coordinates along an axis at which rays enter and leave the boxes of the children.
    pub fn sides(&self, axis: usize, is_negative: bool) -> [&[f32; 4]; 2] {
        let entry = usize::from(is_negative);
        [&self.bounds[entry][axis], &self.bounds[1 - entry][axis]]
    }

    /// The box around all children.
    pub fn bounds(&self) -> [[f32; 3]; 2] {
        let [least, greatest] = &self.bounds;
        [
            least.map(|of_axis| of_axis.into_iter().fold(f32::INFINITY, f32::min)),
            greatest.map(|of_axis| of_axis.into_iter().fold(f32::NEG_INFINITY, f32::max)),
        ]
    }

    /// Adds to the indices of children: where the lists of subtrees are joined.
    pub fn shift(&mut self, nodes: u32, leaves: u32) {
        for stored in &mut self.children {
            *stored += if *stored & LEAF != 0 { leaves } else { nodes };
        }
    }

    /// The distances at which a ray enters the boxes; infinity for boxes that it misses before `limit`.
    #[inline(always)]
    pub fn entries(&self, ray: &PreparedRay, limit: f32) -> [f32; 4] {
        let mut near = [0f32; 4];
        let mut far = [limit; 4];
        for axis in 0..3 {
            let is_negative = usize::from(ray.is_negative[axis]);
            let ([near_origin, far_origin], inverse) =
                (ray.origins.map(|origin| origin[axis]), ray.inverse[axis]);
            let entry = &self.bounds[is_negative][axis];
            let exit = &self.bounds[1 - is_negative][axis];
            for child in 0..4 {
                let from = (entry[child] - near_origin) * inverse;
                let to = (exit[child] - far_origin) * inverse * FAR_FACTOR;
                // A NaN, which arises from 0 * infinity on the plane of a face, leaves the interval as it is.
                near[child] = if from > near[child] { from } else { near[child] };
                far[child] = if to < far[child] { to } else { far[child] };
            }
        }
        std::array::from_fn(|child| if near[child] <= far[child] { near[child] } else { f32::INFINITY })
    }
}
