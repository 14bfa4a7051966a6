//! Recognises how the tangents of a mesh were made: computes them in every way that programs use, and
//! compares.

mod compare;
mod definition;
mod recovered_quads;
mod sample;

use self::compare::{bits, compare, rounded};
pub use self::definition::{Recipe, RecipeMatch, RecipeRounding, RecipeWriting};
use self::recovered_quads::QuadMesh;
use self::sample::Sample;
use crate::Context;
use crate::Error;
use crate::Mesh;
use crate::exec::limits::RunLimits;
use crate::mesh::Strided;
use crate::tangents::generate::run;
use crate::tangents::memory::TangentMemory;
use crate::tangents::{MikkTSpaceOptions, Mode, Report, TangentOptions};

/// The share of close corners from which on quads are not tried: another recipe explains the tangents.
const EXPLAINED: f64 = 0.99;

/// Ranks the recipes that could have made the tangents of a mesh, the best one first.
///
/// The order is by the sum of identical and close corners, then by the largest angle; then simpler recipes
/// come first. Every method is listed; a writing to vertices only where it changes the tangents of corners,
/// and quads only where no other recipe is close at 99 % of the corners. Meshes of 250,000 triangles and more
/// are sampled first; MikkTSpace's default mode is compared on all corners, other recipes only where the
/// sample does not tell the best one from the next. All else is compared on the corners of the sample, as
/// [`RecipeMatch::corners`] says. For several UV sets, call it once per set and compare the best matches.
/// `tangents`: one per corner, unit xyz and sign as MikkTSpace has it for the UVs as given
/// ([`Convention::generated`](crate::Convention::generated)). Errors: another number of tangents than
/// corners.
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
    let recipes = Recipe::all(rounding_of(tangents));
    let mut whole = Trial::new(mesh, tangents, None, limits);
    let sample = Sample::new(mesh, tangents);
    let sampled = sample.as_ref().and_then(Sample::mesh);
    let (Some(sample), Some(part)) = (&sample, &sampled) else {
        whole.add_all(&recipes, memory)?;
        return Ok(whole.sorted());
    };
    let mut sampled = Trial::new(part, &sample.tangents, Some(&sample.measured), limits);
    sampled.add_all(&recipes, memory)?;
    whole.add(&recipes[0], memory)?;
    // The best recipes of the sample are computed for the whole mesh where they are close to each other,
    // until the rest is clearly worse.
    while let Some(next) = whole.next_of(&sampled.matches) {
        // Of a large mesh, the buffers of one method are freed before those of the next are allocated.
        *memory = TangentMemory::default();
        whole.add(&next, memory)?;
    }
    let rest = sampled.matches.iter().filter(|found| !whole.has(&found.recipe));
    let rest: Vec<RecipeMatch> = rest.copied().collect();
    whole.matches.extend(rest);
    Ok(whole.sorted())
}

/// The tangents of all corners that a recipe gives, before they are rounded or written to vertices;
/// MikkTSpace's on the triangles where the recipe wants quads and there are none.
pub fn recipe_tangents(
    mesh: &Mesh<'_>,
    recipe: &Recipe,
    context: &mut Context,
) -> Result<Vec<[f32; 4]>, Error> {
    let (limits, memory) = context.limits_and_memory();
    let mut tangents = vec![[0.0; 4]; mesh.corner_count()];
    let on_quads = recipe.from_quads && compute_on_quads(mesh, limits, memory, &mut tangents)?.is_some();
    if !on_quads {
        compute(mesh, recipe, limits, memory, &mut tangents)?;
    }
    limits.check()?;
    Ok(tangents)
}

/// Recipes are close to each other if the score of one in the sample is at least this part of the other's.
const SAMPLE_MARGIN: f64 = 0.95;

/// The share of close corners of a sample below which a recipe is not computed for the whole mesh: it did not
/// make the tangents.
const LIKELY: f64 = 0.5;

/// The comparison of recipes with the tangents of one mesh.
struct Trial<'a> {
    mesh: &'a Mesh<'a>,
    /// The tangents of the measured corners.
    tangents: &'a [[f32; 4]],
    /// The corners that are compared; none: all.
    measured: Option<&'a [u32]>,
    limits: RunLimits<'a>,
    writers: Option<Writers>,
    matches: Vec<RecipeMatch>,
    /// Reused: the tangents of a recipe, and after they were written to vertices.
    candidate: Vec<[f32; 4]>,
    written: Vec<[f32; 4]>,
    /// Whether [`Mode::Repaired`] repaired nothing, so that [`Mode::Reference`] gives the same.
    is_unrepaired: bool,
}

impl<'a> Trial<'a> {
    fn new(
        mesh: &'a Mesh<'a>,
        tangents: &'a [[f32; 4]],
        measured: Option<&'a [u32]>,
        limits: RunLimits<'a>,
    ) -> Self {
        Self {
            mesh,
            tangents,
            measured,
            limits,
            writers: None,
            matches: Vec::new(),
            candidate: vec![[0.0; 4]; mesh.corner_count()],
            written: Vec::new(),
            is_unrepaired: false,
        }
    }

    /// Adds recipes, and MikkTSpace on quads unless one of them explains the tangents.
    fn add_all(&mut self, recipes: &[Recipe], memory: &mut TangentMemory) -> Result<(), Error> {
        recipes.iter().try_for_each(|recipe| self.add(recipe, memory))?;
        let is_explained = self.matches.iter().any(|found| close_share(found) >= EXPLAINED);
        let quads = recipes.first().map(|first| Recipe::quads(first.rounding));
        quads.filter(|_| !is_explained).map_or(Ok(()), |quads| self.add(&quads, memory))
    }

    /// Computes a recipe, and what becomes of its tangents when they are written to vertices. Quads are left
    /// out where there are none.
    fn add(&mut self, recipe: &Recipe, memory: &mut TangentMemory) -> Result<(), Error> {
        let reference = MikkTSpaceOptions::new().with_mode(Mode::Reference).into();
        if self.is_unrepaired && recipe.method == reference && !recipe.flips_v {
            let same: Vec<RecipeMatch> =
                self.matches.iter().filter(|found| found.recipe.is_default()).copied().collect();
            let renamed = |found: RecipeMatch| RecipeMatch {
                recipe: Recipe { method: recipe.method, ..found.recipe },
                ..found
            };
            self.matches.extend(same.into_iter().map(renamed));
            return Ok(());
        }
        let mut candidate = std::mem::take(&mut self.candidate);
        let report = match recipe.from_quads {
            false => Some(compute(self.mesh, recipe, self.limits, memory, &mut candidate)?),
            true => compute_on_quads(self.mesh, self.limits, memory, &mut candidate)?,
        };
        if let Some(report) = report {
            self.is_unrepaired |= recipe.is_default() && report.repaired_corners == 0;
            self.compare(*recipe, &candidate);
            // Quads share vertices, which the count of the report does not know of the triangles.
            if report.split_vertices > 0 || recipe.from_quads {
                self.compare_written(recipe, &candidate)?;
            }
        }
        self.candidate = candidate;
        self.limits.check()
    }

    fn compare(&mut self, recipe: Recipe, candidate: &[[f32; 4]]) {
        let width = self.limits.width;
        let found = match self.measured {
            None => compare(recipe, candidate, self.tangents, width),
            Some(measured) => {
                let measured: Vec<[f32; 4]> =
                    measured.iter().map(|&corner| candidate[corner as usize]).collect();
                compare(recipe, &measured, self.tangents, width)
            }
        };
        self.matches.push(found);
    }

    fn compare_written(&mut self, recipe: &Recipe, candidate: &[[f32; 4]]) -> Result<(), Error> {
        let writers = self.writers.take().unwrap_or_else(|| Writers::new(self.mesh));
        let mut written = std::mem::take(&mut self.written);
        written.resize(candidate.len(), [0.0; 4]);
        for writing in [RecipeWriting::LastCorner, RecipeWriting::FirstCorner] {
            self.limits.check()?;
            if writers.write(self.mesh, candidate, writing, &mut written) {
                self.compare(Recipe { writing, ..*recipe }, &written);
            }
        }
        (self.writers, self.written) = (Some(writers), written);
        Ok(())
    }

    fn has(&self, recipe: &Recipe) -> bool {
        let of = |recipe: &Recipe| (recipe.method, recipe.flips_v, recipe.from_quads);
        self.matches.iter().any(|found| of(&found.recipe) == of(recipe))
    }

    /// The best recipe of a sample that is not in the matches and may be better than they are; none if there
    /// is none, and if it is so much better than all others that the sample decides.
    fn next_of(&self, sampled: &[RecipeMatch]) -> Option<Recipe> {
        let known = self.matches.iter().map(score).fold(0.0, f64::max);
        let rest = sampled.iter().filter(|found| !self.has(&found.recipe));
        let best = rest.max_by(|a, b| score(a).total_cmp(&score(b)))?;
        let is_near = score(best) >= SAMPLE_MARGIN * known && close_share(best) >= LIKELY;
        let rivals = sampled.iter().filter(|found| found.recipe != best.recipe);
        let is_decided = rivals.map(score).fold(known, f64::max) < SAMPLE_MARGIN * score(best);
        (is_near && !is_decided).then_some(Recipe { writing: RecipeWriting::Corners, ..best.recipe })
    }

    fn sorted(mut self) -> Vec<RecipeMatch> {
        // Among recipes that were computed on the same corners, shares are in the order of counts. The sort
        // is stable.
        let share = |found: &RecipeMatch| found.identical as f64 / found.corners.max(1) as f64;
        self.matches.sort_by(|a, b| {
            let by_score = score(b).total_cmp(&score(a));
            by_score.then(share(b).total_cmp(&share(a))).then(a.worst.total_cmp(&b.worst))
        });
        self.matches
    }
}

fn close_share(found: &RecipeMatch) -> f64 {
    found.close as f64 / found.corners.max(1) as f64
}

/// The share of identical corners plus that of close ones: a few identical corners are chance, and many are
/// worth more than many close ones.
fn score(found: &RecipeMatch) -> f64 {
    (found.identical + found.close) as f64 / found.corners.max(1) as f64
}

/// Computes the tangents of all corners by a recipe, as floats and without writing to vertices.
fn compute(
    mesh: &Mesh<'_>,
    recipe: &Recipe,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Result<Report, Error> {
    let options = TangentOptions::from(recipe.method);
    if !recipe.flips_v {
        return Ok(run(mesh, &options, limits, memory, out));
    }
    let vertices = 0..mesh.vertex_count();
    let uvs: Vec<[f32; 2]> =
        vertices.map(|vertex| mesh.uvs().get(vertex)).map(|[u, v]| [u, 1.0 - v]).collect();
    let uvs = Strided::from(&uvs);
    let flipped = Mesh::with_faces(mesh.positions(), mesh.normals(), uvs, mesh.indices(), mesh.faces())?;
    let report = run(&flipped, &options, limits, memory, out);
    out.iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
    Ok(report)
}

/// Computes MikkTSpace's tangents on quads; none where there are none. `out`: the tangents of the corners of
/// the triangles.
fn compute_on_quads(
    mesh: &Mesh<'_>,
    limits: RunLimits<'_>,
    memory: &mut TangentMemory,
    out: &mut [[f32; 4]],
) -> Result<Option<Report>, Error> {
    let Some(quads) = QuadMesh::recover(mesh, limits)? else { return Ok(None) };
    let mut tangents = vec![[0.0; 4]; quads.corner_count()];
    let report = run(&quads.mesh(mesh)?, &TangentOptions::default(), limits, memory, &mut tangents);
    out.iter_mut().zip(&quads.corner_of_corner).for_each(|(out, &corner)| *out = tangents[corner as usize]);
    Ok(Some(report))
}

/// The corners whose tangents vertices get when tangents are written through the index list.
struct Writers {
    first_corner: Vec<u32>,
    last_corner: Vec<u32>,
}

impl Writers {
    fn new(mesh: &Mesh<'_>) -> Self {
        const NONE: u32 = u32::MAX;
        let none = || vec![NONE; mesh.vertex_count()];
        let mut writers = Self { first_corner: none(), last_corner: none() };
        for corner in 0..mesh.corner_count() {
            let vertex = mesh.vertex_of_corner(corner);
            let first = &mut writers.first_corner[vertex];
            *first = if *first == NONE { corner as u32 } else { *first };
            writers.last_corner[vertex] = corner as u32;
        }
        writers
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

/// The coarsest rounding that all tangents have. Floats where all components are 0, 1 or -1, which every
/// rounding keeps: they tell nothing, and floats are compared most strictly.
fn rounding_of(tangents: &[[f32; 4]]) -> RecipeRounding {
    if tangents.as_flattened().iter().all(|x| [0.0, 1.0].contains(&x.abs())) {
        return RecipeRounding::Floats;
    }
    let is_rounded =
        |rounding| tangents.iter().all(|&tangent| bits(rounded(tangent, rounding)) == bits(tangent));
    let coarser = [RecipeRounding::Bits8, RecipeRounding::Bits16];
    coarser.into_iter().find(|&rounding| is_rounded(rounding)).unwrap_or(RecipeRounding::Floats)
}
