//! Shafts: intervals around the rays of neighbouring texels, which find where in the tree all of them may
//! begin.
//!
//! S. Boulos, I. Wald, P. Shirley, "Geometric and Arithmetic Culling Methods for Entire Ray Packets",
//! University of Utah, UUCS-06-10, 2006. Every bound is computed by the operations of a single ray at the
//! ends of the intervals. Rounding is monotone, so a shaft enters every box that one of its rays enters, and
//! hits are the same bit for bit.

use super::compare::{greater, lesser};
use super::node::{Child, FAR_FACTOR, Node};
use super::ray::PreparedRay;
use super::tree::Bvh;

/// The most children of a cut. Twice as many gained nothing.
pub const MOST: usize = 8;

/// The intervals of the values of some rays.
#[derive(Clone, Copy, Debug)]
pub struct Shaft {
    /// The least and the greatest coordinates of near and far origins.
    near_origins: [[f32; 3]; 2],
    far_origins: [[f32; 3]; 2],
    /// The least and the greatest inverse directions.
    inverses: [[f32; 3]; 2],
    /// The length of the longest ray.
    length: f32,
    /// Whether all directions are negative, per axis.
    is_negative: [bool; 3],
    /// Whether the directions have one sign, per axis. Other axes cannot be told apart.
    has_one_sign: [bool; 3],
}

impl Shaft {
    /// The shaft of some rays; `None` for no rays.
    pub fn of<'a>(rays: impl IntoIterator<Item = &'a PreparedRay>) -> Option<Self> {
        let mut rays = rays.into_iter();
        let first = rays.next()?;
        let mut shaft = Self {
            near_origins: [first.origins[0]; 2],
            far_origins: [first.origins[1]; 2],
            inverses: [first.inverse; 2],
            length: first.length,
            is_negative: first.is_negative,
            has_one_sign: [true; 3],
        };
        for ray in rays {
            widen(&mut shaft.near_origins, ray.origins[0]);
            widen(&mut shaft.far_origins, ray.origins[1]);
            widen(&mut shaft.inverses, ray.inverse);
            shaft.length = shaft.length.max(ray.length);
            for axis in 0..3 {
                shaft.has_one_sign[axis] &= ray.is_negative[axis] == shaft.is_negative[axis];
            }
        }
        Some(shaft)
    }

    /// Which boxes of a node's children some ray may enter.
    fn enters(&self, node: &Node) -> [bool; 4] {
        let mut near = [0f32; 4];
        let mut far = [self.length; 4];
        for axis in (0..3).filter(|&axis| self.has_one_sign[axis]) {
            let is_negative = self.is_negative[axis];
            let [entry, exit] = node.sides(axis, is_negative);
            // The rays that enter first and leave last begin where the difference, along their direction, is
            // least and greatest.
            let [ahead, behind] = if is_negative { [0, 1] } else { [1, 0] };
            for child in 0..4 {
                let from = entry[child] - self.near_origins[ahead][axis];
                let to = exit[child] - self.far_origins[behind][axis];
                let products = |x: f32| self.inverses.map(|inverse| x * inverse[axis]);
                let from = least(products(from));
                let to = greatest(products(to)) * FAR_FACTOR;
                // A NaN leaves the interval as it is.
                near[child] = if from > near[child] { from } else { near[child] };
                far[child] = if to < far[child] { to } else { far[child] };
            }
        }
        std::array::from_fn(|child| near[child] <= far[child] && !node.is_absent(child))
    }
}

/// A NaN does not widen the interval: it has no ray that hits anything. One that is a NaN stays one, which
/// culls nothing.
fn widen(interval: &mut [[f32; 3]; 2], value: [f32; 3]) {
    for axis in 0..3 {
        interval[0][axis] = lesser(value[axis], interval[0][axis]);
        interval[1][axis] = greater(value[axis], interval[1][axis]);
    }
}

/// The lesser number; NaN if one is, which culls nothing.
fn least([a, b]: [f32; 2]) -> f32 {
    if a.is_nan() || b.is_nan() { f32::NAN } else { a.min(b) }
}

/// The greater number; NaN if one is, which culls nothing.
fn greatest([a, b]: [f32; 2]) -> f32 {
    if a.is_nan() || b.is_nan() { f32::NAN } else { a.max(b) }
}

/// The parts of a tree that the rays of a shaft may hit: a few nodes, whose children are nodes and leaves
/// from anywhere below.
#[derive(Clone, Debug)]
pub struct Cut {
    nodes: [Node; MOST / 4],
    len: usize,
}

impl Cut {
    /// The nodes at which a traversal begins.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes[..self.len.div_ceil(4)]
    }

    fn push(&mut self, bounds: [[f32; 3]; 2], child: Child) {
        self.nodes[self.len / 4].set(self.len % 4, bounds, child);
        self.len += 1;
    }
}

impl Bvh {
    /// The cut of a shaft: nodes are replaced by the children that the shaft enters, upper nodes first, while
    /// there is room.
    pub fn cut(&self, shaft: &Shaft) -> Cut {
        let mut waiting = [([[0f32; 3]; 2], Child::Node(0)); MOST];
        let mut count = usize::from(!self.nodes.is_empty());
        let mut at = 0;
        while at < count {
            let Child::Node(index) = waiting[at].1 else {
                at += 1;
                continue;
            };
            let node = &self.nodes[index as usize];
            let enters = shaft.enters(node);
            let entered = enters.iter().filter(|&&enters| enters).count();
            if count - 1 + entered > MOST {
                break;
            }
            waiting.copy_within(at + 1..count, at);
            count -= 1;
            for place in (0..4).filter(|&place| enters[place]) {
                waiting[count] = (node.bounds_of(place), node.child(place));
                count += 1;
            }
        }
        let mut cut = Cut { nodes: [Node::EMPTY; MOST / 4], len: 0 };
        waiting[..count].iter().for_each(|(bounds, child)| cut.push(*bounds, *child));
        cut
    }
}
