//! Compares the tangents of a surface with those that MikkTSpace gives, and says in one word how they differ.
//!
//! The rules about tangents that follow other directions or signs exclude each other, so one measurement decides among them.

use darboux::CornerDifference;

use crate::surface::{Surface, cross, dot, uv_area, xyz};

/// How the tangents of a file differ from MikkTSpace's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Difference {
    /// They point the same way, up to the differences between methods.
    None,
    /// The signs of all corners are flipped.
    SignFlipped,
    /// The signs are flipped on mirrored parts only, or on unmirrored parts only.
    SignFlippedWhereMirrored,
    /// They point along the bitangents.
    Rotated,
    /// They point the opposite way.
    Negated,
    /// They follow another UV set.
    OtherUvSet(usize),
    /// None of these.
    Unknown,
}

/// The measurement.
pub struct Fit {
    pub difference: Difference,
    /// The measured corners: usable tangents of vertices that do not lie on mirrored seams.
    pub corners: usize,
    /// The corners that support the difference.
    pub supporting: usize,
}

/// The smallest share of the corners that decides.
const MIN_SHARE: f64 = 0.9;

/// The largest share of corners whose sign may contradict the others.
const MAX_SIGN_ERRORS: f64 = 0.01;

/// Corners by the direction that is nearest to the file's tangent, and by sign.
#[derive(Default)]
struct Counts {
    corners: usize,
    along: usize,
    against: usize,
    across: usize,
    /// Corners within one degree and with the same sign.
    close: usize,
    /// Per orientation (unmirrored, mirrored): corners, and those whose sign differs.
    signs: [[usize; 2]; 2],
}

/// Measures; none where the surface has no tangents, normals or UVs.
pub fn measure(surface: &Surface) -> Option<Fit> {
    let tangents = surface.corner_tangents()?;
    let own = count(surface, &tangents, surface.uv_set)?;
    let share = |part: usize| part as f64 / own.corners.max(1) as f64;
    let flips = own.signs[0][1] + own.signs[1][1];
    let fit = |difference, supporting| Fit { difference, corners: own.corners, supporting };
    if own.corners == 0 {
        return Some(fit(Difference::Unknown, 0));
    }
    let others = surface.uv_sets.keys().filter(|&&set| set != surface.uv_set && share(own.close) < MIN_SHARE);
    for &set in others {
        if let Some(other) = count(surface, &tangents, set).filter(|other| share(other.close) >= MIN_SHARE) {
            return Some(fit(Difference::OtherUvSet(set), other.close));
        }
    }
    if share(own.along) >= MIN_SHARE {
        let difference = by_signs(&own);
        let supporting = if difference == Difference::None { own.along } else { flips };
        return Some(fit(difference, supporting));
    }
    Some(match () {
        () if share(own.against) >= MIN_SHARE => fit(Difference::Negated, own.against),
        () if share(own.across) >= MIN_SHARE => fit(Difference::Rotated, own.across),
        () => fit(Difference::Unknown, 0),
    })
}

fn by_signs(counts: &Counts) -> Difference {
    let is_flipped = |[corners, flips]: [usize; 2]| {
        corners > 0 && flips as f64 >= (1.0 - MAX_SIGN_ERRORS) * corners as f64
    };
    let is_kept =
        |[corners, flips]: [usize; 2]| corners > 0 && flips as f64 <= MAX_SIGN_ERRORS * corners as f64;
    let [unmirrored, mirrored] = counts.signs;
    let is_absent = |[corners, _]: [usize; 2]| corners == 0;
    match () {
        () if (is_flipped(unmirrored) || is_absent(unmirrored))
            && (is_flipped(mirrored) || is_absent(mirrored)) =>
        {
            Difference::SignFlipped
        }
        () if is_kept(unmirrored) && is_flipped(mirrored) => Difference::SignFlippedWhereMirrored,
        () if is_flipped(unmirrored) && is_kept(mirrored) => Difference::SignFlippedWhereMirrored,
        () => Difference::None,
    }
}

/// Compares with MikkTSpace's tangents of a UV set.
fn count(surface: &Surface, tangents: &[[f32; 4]], uv_set: usize) -> Option<Counts> {
    let (mut expected, normals) = (surface.expected_tangents(uv_set)?, surface.normals.as_ref()?);
    // MikkTSpace's sign is that of the UV area, which changes with the order of the corners; what is lit depends on the normal alone.
    if surface.is_wound_against_normals() {
        expected.iter_mut().for_each(|tangent| tangent[3] = -tangent[3]);
    }
    let is_shared = on_mirrored_seams(surface, uv_set, &expected);
    let uvs = surface.uv_sets.get(&uv_set)?;
    // Faces without area in the UV set show no bumps, and their tangents are those of any neighbour.
    let is_measured: Vec<bool> = surface.triangles().map(|triangle| uv_area(uvs, triangle) != 0.0).collect();
    let mut counts = Counts::default();
    for (corner, (&ours, &theirs)) in expected.iter().zip(tangents).enumerate() {
        let vertex = surface.vertex_of_corner[corner] as usize;
        let difference = CornerDifference::between(ours, theirs);
        let is_counted = is_measured[corner / 3] && !is_shared[vertex];
        let Some(angle) = difference.angle.filter(|_| is_counted) else { continue };
        counts.corners += 1;
        let across = dot(cross(normals[vertex], xyz(ours)), xyz(theirs)).abs();
        let along = dot(xyz(ours), xyz(theirs));
        match () {
            () if across > along.abs() => counts.across += 1,
            () if along > 0.0 => counts.along += 1,
            () => counts.against += 1,
        }
        counts.close += usize::from(angle < 1.0 && !difference.flips_sign);
        let of_orientation = &mut counts.signs[usize::from(ours[3] < 0.0)];
        of_orientation[0] += 1;
        of_orientation[1] += usize::from(difference.flips_sign);
    }
    Some(counts)
}

/// Per vertex whether its corners have both signs. Triangles without area in the UV set do not count: they show no bumps, and their sign is that of
/// any neighbour.
pub fn on_mirrored_seams(surface: &Surface, uv_set: usize, expected: &[[f32; 4]]) -> Vec<bool> {
    let mut seen = vec![[false; 2]; surface.positions.len()];
    let Some(uvs) = surface.uv_sets.get(&uv_set) else { return vec![false; seen.len()] };
    for (triangle, tangents) in surface.triangles().zip(expected.as_chunks::<3>().0) {
        if uv_area(uvs, triangle) == 0.0 {
            continue;
        }
        for (vertex, tangent) in triangle.into_iter().zip(tangents) {
            seen[vertex][usize::from(tangent[3] < 0.0)] = true;
        }
    }
    seen.into_iter().map(|[positive, negative]| positive && negative).collect()
}
