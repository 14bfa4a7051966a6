//! Recognises how the tangents of a mesh were made: computes them in every way that programs use, and compares.

mod compare;
mod definition;
mod recovered_quads;

use self::compare::{bits, compare, rounded};
pub use self::definition::{Recipe, RecipeMatch, RecipeRounding, RecipeWriting};
use self::recovered_quads::QuadMesh;
use crate::Context;
use crate::Error;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::mesh::Strided;
use crate::tangents::TangentOptions;
use crate::tangents::generate::run;
use crate::tangents::memory::TangentMemory;

/// The share of close corners from which on quads are not tried: another recipe explains the tangents.
const EXPLAINED: f64 = 0.99;

/// Ranks the recipes that could have made the tangents of a mesh, the best one first.
///
/// The order is by the sum of identical and close corners, then by the largest angle; then simpler recipes come first. Every method is listed;
/// a writing to vertices only where it changes the tangents of corners, and quads only where no other recipe is close at 99 % of the corners.
/// For several UV sets, call it once per set and compare the best matches. `tangents`: one per corner, unit xyz and sign as MikkTSpace has it for
/// the UVs as given ([`Convention::generated`](crate::Convention::generated)). Errors: another number of tangents than corners.
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
    let mut ranking = Ranking::new(mesh, tangents, limits);
    let mut candidate = vec![[0.0; 4]; tangents.len()];
    for recipe in Recipe::all(rounding) {
        compute(mesh, &recipe, limits, memory, &mut candidate)?;
        ranking.add(recipe, &candidate)?;
    }
    if !ranking.is_explained()
        && let Some(quads) = QuadMesh::recover(mesh, limits)?
    {
        compute_on_quads(mesh, &quads, limits, memory, &mut candidate)?;
        ranking.add(Recipe::quads(rounding), &candidate)?;
    }
    Ok(ranking.sorted())
}

/// The matches found so far.
struct Ranking<'a> {
    mesh: &'a Mesh<'a>,
    tangents: &'a [[f32; 4]],
    limits: RunLimits<'a>,
    writers: Option<Writers>,
    matches: Vec<RecipeMatch>,
    /// Reused: the tangents of a recipe after they were written to vertices.
    written: Vec<[f32; 4]>,
}

impl<'a> Ranking<'a> {
    fn new(mesh: &'a Mesh<'a>, tangents: &'a [[f32; 4]], limits: RunLimits<'a>) -> Self {
        let writers = Writers::new(mesh);
        let written = vec![[0.0; 4]; if writers.is_some() { tangents.len() } else { 0 }];
        Self { mesh, tangents, limits, writers, matches: Vec::new(), written }
    }

    /// Adds a recipe, and what becomes of its tangents when they are written to vertices.
    fn add(&mut self, recipe: Recipe, candidate: &[[f32; 4]]) -> Result<(), Error> {
        let Self { mesh, tangents, limits, writers, matches, written } = self;
        matches.push(compare(recipe, candidate, tangents, limits.width));
        for writing in [RecipeWriting::LastCorner, RecipeWriting::FirstCorner] {
            limits.check()?;
            if writers.as_ref().is_some_and(|writers| writers.write(mesh, candidate, writing, written)) {
                matches.push(compare(Recipe { writing, ..recipe }, written, tangents, limits.width));
            }
        }
        Ok(())
    }

    fn is_explained(&self) -> bool {
        self.matches.iter().any(|found| found.close as f64 >= EXPLAINED * found.corners as f64)
    }

    fn sorted(mut self) -> Vec<RecipeMatch> {
        // A few identical corners are chance, and many are worth more than many close ones.
        let score = |found: &RecipeMatch| (found.identical + found.close, found.identical);
        // The sort is stable.
        self.matches.sort_by(|a, b| score(b).cmp(&score(a)).then(a.worst.total_cmp(&b.worst)));
        self.matches
    }
}

/// Computes the tangents of all corners by a recipe, as floats and without writing to vertices.
fn compute(
    mesh: &Mesh<'_>,
    recipe: &Recipe,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Result<(), Error> {
    let options = TangentOptions::from(recipe.method);
    if recipe.flips_v {
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

/// Computes MikkTSpace's tangents on quads. `out`: the tangents of the corners of the triangles.
fn compute_on_quads(
    mesh: &Mesh<'_>,
    quads: &QuadMesh,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Result<(), Error> {
    let mut tangents = vec![[0.0; 4]; quads.corner_count()];
    run(&quads.mesh(mesh)?, &TangentOptions::default(), limits, memory, &mut tangents);
    limits.check()?;
    out.iter_mut().zip(&quads.corner_of_corner).for_each(|(out, &corner)| *out = tangents[corner as usize]);
    Ok(())
}

/// The corners whose tangents vertices get when tangents are written through the index list.
struct Writers {
    first_corner: Vec<u32>,
    last_corner: Vec<u32>,
}

impl Writers {
    /// None where every vertex has one corner at most, so that nothing is shared.
    fn new(mesh: &Mesh<'_>) -> Option<Self> {
        const NONE: u32 = u32::MAX;
        let none = || vec![NONE; mesh.vertex_count()];
        let mut writers = Self { first_corner: none(), last_corner: none() };
        let mut is_shared = false;
        for corner in 0..mesh.corner_count() {
            let vertex = mesh.vertex_of_corner(corner);
            let first = &mut writers.first_corner[vertex];
            is_shared |= *first != NONE;
            *first = if *first == NONE { corner as u32 } else { *first };
            writers.last_corner[vertex] = corner as u32;
        }
        is_shared.then_some(writers)
    }

    /// Writes the tangents of corners to vertices and back; false where that changes nothing.
    fn write(
        &self,
        mesh: &Mesh<'_>,
        tangents: &[[f32; 4]],
        writing: RecipeWriting,
        out: &mut [[f32; 4]],
    ) -> bool {
        let corner_of_vertex =
            if writing == RecipeWriting::FirstCorner { &self.first_corner } else { &self.last_corner };
        let mut differs = false;
        for (corner, (out, tangent)) in out.iter_mut().zip(tangents).enumerate() {
            *out = tangents[corner_of_vertex[mesh.vertex_of_corner(corner)] as usize];
            differs |= *out != *tangent && bits(*out) != bits(*tangent);
        }
        differs
    }
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
