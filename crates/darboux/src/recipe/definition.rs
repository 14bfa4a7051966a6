//! [`Recipe`]: a way of making tangents; and how well one explains those of a file.

use crate::choice;
use crate::choice::Choice;
use crate::tangents::{Method, MikkTSpaceOptions, Mode};

/// A way of making the tangents of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Recipe {
    /// How the tangents were computed.
    pub method: Method,
    /// True where they were computed with 1 - v instead of v, and the sign negated. Only rounding differs.
    pub flips_v: bool,
    /// True where they were computed before quads were cut into triangles, as Unity and other importers do.
    /// Which triangles were quads is an estimate from their shapes.
    pub from_quads: bool,
    /// How corners share the tangents of vertices.
    pub writing: RecipeWriting,
    /// How the tangents were rounded.
    pub rounding: RecipeRounding,
}

/// How the tangents of corners became tangents of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RecipeWriting {
    /// Every corner has its own tangent: vertices were split where needed.
    Corners,
    /// Every vertex has the tangent of its last corner, as a loop has it that writes through the index list.
    /// Mirrored seams break.
    LastCorner,
    /// Every vertex has the tangent of its first corner.
    FirstCorner,
}

choice! {
    RecipeWriting, "writing",
    Corners => "corners", "every corner has its own tangent: vertices were split where needed";
    LastCorner => "last-corner", "every vertex has the tangent of its last corner";
    FirstCorner => "first-corner", "every vertex has the tangent of its first corner";
}

/// How the components of tangents were rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RecipeRounding {
    /// They are 32-bit floats.
    Floats,
    /// To multiples of 1/127: signed normalised 8-bit integers.
    Bits8,
    /// To multiples of 1/32767: signed normalised 16-bit integers.
    Bits16,
}

impl RecipeRounding {
    /// The bits of a component: 32, 16 or 8.
    pub fn bits(self) -> u32 {
        match self {
            Self::Floats => 32,
            Self::Bits8 => 8,
            Self::Bits16 => 16,
        }
    }
}

/// How well a recipe explains tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecipeMatch {
    /// The recipe.
    pub recipe: Recipe,
    /// The number of corners that were compared: all, or those of a sample of a large mesh.
    pub corners: usize,
    /// Corners whose four components are equal, after the recipe's rounding.
    pub identical: usize,
    /// Corners whose xyz differ by at most 0.1 degrees (1 degree for 8 bits) and whose signs are equal.
    pub close: usize,
    /// Corners whose signs differ.
    pub sign_flips: usize,
    /// The largest angle in degrees; 180 where a tangent is zero or not finite in one of the sets only.
    pub worst: f64,
}

impl Recipe {
    /// The mode of MikkTSpace; none for other methods.
    pub fn mode(&self) -> Option<Mode> {
        match self.method {
            Method::MikkTSpace(options) => Some(options.mode),
            _ => None,
        }
    }

    /// A method on the triangles as they are.
    const fn new(method: Method, rounding: RecipeRounding) -> Self {
        let writing = RecipeWriting::Corners;
        Self { method, flips_v: false, from_quads: false, writing, rounding }
    }

    /// The recipes in the order of preference among equals: MikkTSpace's, the one of meshoptimizer, and the
    /// other methods that follow UVs.
    pub(crate) fn all(rounding: RecipeRounding) -> Vec<Self> {
        let of = |method| Self::new(method, rounding);
        let mode = |mode| of(MikkTSpaceOptions::new().with_mode(mode).into());
        let repaired = mode(Mode::Repaired);
        let first = [
            repaired,
            mode(Mode::Reference),
            mode(Mode::Corrected),
            Self { flips_v: true, ..repaired },
            of(Method::AngleEdge),
        ];
        let is_other = |method: &Method| {
            !matches!(method, Method::MikkTSpace(_) | Method::AngleEdge | Method::FromNormal)
        };
        first.into_iter().chain(Method::ALL.iter().copied().filter(is_other).map(of)).collect()
    }

    /// Whether this is MikkTSpace with its default mode on the mesh as it is.
    pub(super) fn is_default(&self) -> bool {
        self.method == Method::default() && !self.flips_v && !self.from_quads
    }

    /// MikkTSpace on quads.
    pub(crate) fn quads(rounding: RecipeRounding) -> Self {
        Self { from_quads: true, ..Self::new(Method::default(), rounding) }
    }
}
