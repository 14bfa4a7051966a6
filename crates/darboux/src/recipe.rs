//! Recognises how the tangents of a mesh were made: computes them in every way that programs use, and compares.

use crate::Context;
use crate::Error;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::mesh::Strided;
use crate::tangents::generate::run;
use crate::tangents::memory::TangentMemory;
use crate::tangents::{Method, MikkTSpaceOptions, Mode, TangentOptions};

/// A way of making the tangents of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Recipe {
    /// How the tangents were computed.
    pub method: Method,
    /// True where they were computed with 1 - v instead of v, and the sign negated. Only rounding differs.
    pub flips_v: bool,
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
    /// Every vertex has the tangent of its last corner, as a loop has it that writes through the index list. Mirrored seams break.
    LastCorner,
    /// Every vertex has the tangent of its first corner.
    FirstCorner,
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

/// How well a recipe explains tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecipeMatch {
    /// The recipe.
    pub recipe: Recipe,
    /// The number of corners.
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

/// The methods in the order of preference among equals, and whether v is flipped.
const METHODS: [(Method, bool); 11] = {
    const fn mode(mode: Mode) -> Method {
        Method::MikkTSpace(MikkTSpaceOptions::new().with_mode(mode))
    }
    [
        (mode(Mode::Repaired), false),
        (mode(Mode::Reference), false),
        (mode(Mode::Corrected), false),
        (mode(Mode::Repaired), true),
        (Method::AngleEdge, false),
        (Method::AngleArea, false),
        (Method::Lengyel, false),
        (Method::LengyelPerVertex, false),
        (Method::Average, false),
        (Method::Area, false),
        (Method::Face, false),
    ]
};

/// Ranks the recipes that could have made the tangents of a mesh, the best one first.
///
/// The order is by identical corners, then by close ones, then by the largest angle; then simpler recipes come first. Every method is listed;
/// a writing to vertices is listed only where it changes the tangents of corners. For several UV sets, call it once per set and compare the
/// best matches. `tangents`: one per corner, unit xyz and sign as MikkTSpace has it for the UVs as given
/// ([`Convention::generated`](crate::Convention::generated)). Errors: another number of tangents than corners.
///
/// ```
/// use darboux::{Mesh, Method, RecipeWriting, TangentOptions, generate_tangents, recognise_recipe};
///
/// # let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]];
/// # let (normals, uvs) = ([[0.0, 0.0, 1.0]; 4], [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
/// # let indices = [0u16, 1, 2, 0, 2, 3];
/// # let mesh = Mesh::triangles(&positions, &normals, &uvs, &indices)?;
/// let tangents = generate_tangents(&mesh, &TangentOptions::from(Method::Face)).corners;
/// let best = recognise_recipe(&mesh, tangents.per_corner())?[0];
/// assert_eq!((best.recipe.method, best.recipe.writing), (Method::Face, RecipeWriting::Corners));
/// assert_eq!(best.identical, 6);
/// # Ok::<(), darboux::Error>(())
/// ```
pub fn recognise_recipe(mesh: &Mesh<'_>, tangents: &[[f32; 4]]) -> Result<Vec<RecipeMatch>, Error> {
    recognise_recipe_with(mesh, tangents, &mut Context::new())
}

/// As [`recognise_recipe`], with a context. Further error: the context's token was cancelled.
pub fn recognise_recipe_with(
    mesh: &Mesh<'_>,
    tangents: &[[f32; 4]],
    context: &mut Context,
) -> Result<Vec<RecipeMatch>, Error> {
    Error::check_input("tangents", mesh.corner_count(), tangents.len())?;
    let (limits, memory) = context.limits_and_memory();
    let rounding = rounding_of(tangents);
    let mut matches = Vec::new();
    let mut candidate = vec![[0.0; 4]; tangents.len()];
    for (method, flips_v) in METHODS {
        compute(mesh, method, flips_v, limits, memory, &mut candidate)?;
        let recipe = Recipe { method, flips_v, writing: RecipeWriting::Corners, rounding };
        let of_corners = compare(recipe, &candidate, tangents);
        matches.push(of_corners);
        for writing in [RecipeWriting::LastCorner, RecipeWriting::FirstCorner] {
            let Some(written) = written_to_vertices(mesh, &candidate, writing) else { continue };
            limits.check()?;
            matches.push(compare(Recipe { writing, ..recipe }, &written, tangents));
        }
    }
    // The sort is stable.
    matches.sort_by(|a, b| {
        b.identical.cmp(&a.identical).then(b.close.cmp(&a.close)).then(a.worst.total_cmp(&b.worst))
    });
    Ok(matches)
}

/// Computes the tangents of all corners by a method, with v or with 1 - v.
fn compute(
    mesh: &Mesh<'_>,
    method: Method,
    flips_v: bool,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Result<(), Error> {
    let options = TangentOptions::from(method);
    if flips_v {
        let uvs: Vec<[f32; 2]> = (0..mesh.vertex_count())
            .map(|vertex| {
                let [u, v] = mesh.uvs().get(vertex);
                [u, 1.0 - v]
            })
            .collect();
        let flipped = Mesh::with_faces(
            mesh.positions(),
            mesh.normals(),
            Strided::from(&uvs),
            mesh.indices(),
            mesh.faces(),
        )?;
        run(&flipped, &options, limits, memory, out);
        out.iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
    } else {
        run(mesh, &options, limits, memory, out);
    }
    limits.check()
}

/// The tangents of corners after they were written through the index list. `None` where that changes nothing.
fn written_to_vertices(
    mesh: &Mesh<'_>,
    tangents: &[[f32; 4]],
    writing: RecipeWriting,
) -> Option<Vec<[f32; 4]>> {
    const NONE: u32 = u32::MAX;
    let mut corner_of_vertex = vec![NONE; mesh.vertex_count()];
    for corner in 0..tangents.len() {
        let slot = &mut corner_of_vertex[mesh.vertex_of_corner(corner)];
        if writing == RecipeWriting::LastCorner || *slot == NONE {
            *slot = corner as u32;
        }
    }
    let source = |corner| corner_of_vertex[mesh.vertex_of_corner(corner)] as usize;
    let is_same = |corner: usize| bits(tangents[source(corner)]) == bits(tangents[corner]);
    let differs = !(0..tangents.len()).all(is_same);
    differs.then(|| (0..tangents.len()).map(|corner| tangents[source(corner)]).collect())
}

/// The coarsest rounding that all tangents have. Floats where all components are 0, 1 or -1, which every rounding keeps: they tell nothing,
/// and floats are compared most strictly.
fn rounding_of(tangents: &[[f32; 4]]) -> RecipeRounding {
    if tangents.as_flattened().iter().all(|x| [0.0, 1.0].contains(&x.abs())) {
        return RecipeRounding::Floats;
    }
    let is_rounded =
        |rounding| tangents.iter().all(|&tangent| bits(rounded(tangent, rounding)) == bits(tangent));
    let coarser = [RecipeRounding::Bits8, RecipeRounding::Bits16];
    coarser.into_iter().find(|&rounding| is_rounded(rounding)).unwrap_or(RecipeRounding::Floats)
}

/// The nearest tangent whose components are multiples of 1/127 or 1/32767.
fn rounded(tangent: [f32; 4], rounding: RecipeRounding) -> [f32; 4] {
    let largest = match rounding {
        RecipeRounding::Floats => return tangent,
        RecipeRounding::Bits8 => 127.0,
        RecipeRounding::Bits16 => 32767.0,
    };
    tangent.map(|x| (x * largest).round() / largest)
}

/// The bits, with one zero and one NaN.
fn bits(tangent: [f32; 4]) -> [u32; 4] {
    tangent.map(|x| if x.is_nan() { f32::NAN.to_bits() } else { (x + 0.0).to_bits() })
}

fn compare(recipe: Recipe, candidate: &[[f32; 4]], tangents: &[[f32; 4]]) -> RecipeMatch {
    let close_degrees: f64 = if recipe.rounding == RecipeRounding::Bits8 { 1.0 } else { 0.1 };
    let limit = close_degrees.to_radians().sin().powi(2);
    let mut out =
        RecipeMatch { recipe, corners: tangents.len(), identical: 0, close: 0, sign_flips: 0, worst: 0.0 };
    let mut worst = 0.0f64;
    for (&ours, &theirs) in candidate.iter().zip(tangents) {
        let is_flipped = (ours[3] < 0.0) != (theirs[3] < 0.0);
        out.sign_flips += usize::from(is_flipped);
        let is_identical = bits(rounded(ours, recipe.rounding)) == bits(theirs);
        let turn = if is_identical { 0.0 } else { turn(ours, theirs) };
        out.identical += usize::from(is_identical);
        out.close += usize::from(turn <= limit && !is_flipped);
        worst = worst.max(turn);
    }
    out.worst = degrees(worst);
    out
}

/// A number that grows with the angle: the squared sine up to 90 degrees, 2 minus it above.
fn turn(a: [f32; 4], b: [f32; 4]) -> f64 {
    let [[ax, ay, az, _], [bx, by, bz, _]] = [a, b].map(|v| v.map(f64::from));
    let cross = [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
    let dot = ax * bx + ay * by + az * bz;
    let squares = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz);
    let sine = cross.iter().map(|x| x * x).sum::<f64>() / squares;
    match () {
        () if !sine.is_finite() => 2.0,
        () if dot >= 0.0 => sine,
        () => 2.0 - sine,
    }
}

fn degrees(turn: f64) -> f64 {
    if turn <= 1.0 {
        turn.sqrt().min(1.0).asin().to_degrees()
    } else {
        180.0 - (2.0 - turn).max(0.0).sqrt().asin().to_degrees()
    }
}
