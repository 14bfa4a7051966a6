//! The text of an OBJ as lists: elements, and faces that refer to them.

use std::ops::{Index, IndexMut, Range};

/// The text as lists.
#[derive(Debug, Default)]
pub struct ObjText {
    pub positions: Vec<[f32; 3]>,
    /// Linear RGBA of positions with a colour, which follow without gaps where all have one.
    pub colors: Vec<[f32; 4]>,
    /// The positions with a colour, in whatever order.
    pub colored_positions: usize,
    /// Linear RGBA of positions, as ZBrush writes them in comments.
    pub zbrush_colors: Vec<[f32; 4]>,
    pub uvs: Vec<[f32; 2]>,
    pub normals: Vec<[f32; 3]>,
    pub corners: Vec<Corner>,
    /// The faces: their sizes, materials and smoothing groups.
    pub sizes: Vec<u32>,
    pub materials: Vec<Option<u32>>,
    pub smoothing: Vec<u32>,
    /// The objects and groups with faces.
    pub runs: Vec<Run>,
    pub has_smoothing: bool,
    pub lines_and_points: usize,
    pub curves: usize,
    /// What the next face belongs to.
    pub name: String,
    pub kind: &'static str,
    pub material: Option<u32>,
    pub group: u32,
    /// The first corner and face of the current object or group.
    pub start: (usize, usize),
}

/// The indices of a corner's position, UV and normal, [`NONE`] for those it lacks.
#[derive(Clone, Copy, Debug)]
pub struct Corner([u32; 3]);

/// The kinds of elements that a corner refers to, in the order of its indices.
pub const KINDS: [&str; 3] = ["position", "UV", "normal"];

/// No UV or normal.
pub const NONE: u32 = u32::MAX;

impl Default for Corner {
    fn default() -> Self {
        Self([NONE; 3])
    }
}

impl Index<usize> for Corner {
    type Output = u32;

    fn index(&self, kind: usize) -> &u32 {
        &self.0[kind]
    }
}

impl IndexMut<usize> for Corner {
    fn index_mut(&mut self, kind: usize) -> &mut u32 {
        &mut self.0[kind]
    }
}

/// An object or group with faces.
#[derive(Clone, Debug)]
pub struct Run {
    pub name: String,
    /// The statement: `o`, `g`, or nothing before the first.
    pub kind: &'static str,
    pub corners: Range<usize>,
    pub faces: Range<usize>,
}
