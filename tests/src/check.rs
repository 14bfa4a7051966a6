//! Invariants that must hold for every result on every mesh.

use std::collections::HashSet;

use darboux::internal::stage_arrays;
use darboux::{
    CornerTangents, Frame, Frames, MikkTSpaceOptions, Mode, Plan, TangentOptions, generate_frames,
    generate_tangents, split_vertices,
};

use crate::{Case, OwnedMesh, engine, first_difference};

/// Checks all modes on a case and returns the first violation.
pub fn all_modes(case: &Case) -> Result<(), String> {
    let Case { mesh, threshold } = case;
    let reference = engine::reference(mesh, *threshold);
    let supported = mesh.supported_corners();
    let distinct = |frames: &mut dyn Iterator<Item = Frame>| {
        let corners = (0..).zip(&supported).filter(|(_, supported)| **supported).map(|(corner, _)| corner);
        let key = |(corner, frame): (usize, Frame)| (mesh.vertex_of_corner(corner), tangent_bits(&frame));
        corners.zip(frames).map(key).collect::<HashSet<_>>().len()
    };
    let splits = distinct(&mut reference.iter().copied().flatten());
    for mode in [Mode::Reference, Mode::Repaired, Mode::Corrected] {
        let mikkt = MikkTSpaceOptions::new().with_mode(mode).with_threshold(*threshold);
        let options = TangentOptions::from(mikkt);
        let Frames { corners, report } = generate_frames(&mesh.view(), &options);
        let tangents = generate_tangents(&mesh.view(), &options);
        if tangents.report != report {
            return Err(format!("{mode:?}: tangents report {:?}, frames {report:?}", tangents.report));
        }
        let general = stage_arrays::frames(&mesh.view(), &mikkt);
        if report != general.report {
            return Err(format!("{mode:?}: report {report:?}, of all stages {:?}", general.report));
        }
        let of_all_stages: Vec<_> = general.corners.into_per_corner().into_iter().map(Some).collect();
        let of_fast_path: Vec<_> = corners.clone().into_per_corner().into_iter().map(Some).collect();
        if let Some(difference) = first_difference(&of_all_stages, &of_fast_path) {
            return Err(format!("{mode:?}, frames of all stages: {difference}"));
        }
        if !same_bits(&tangents.corners, &corners.tangents()) {
            return Err(format!("{mode:?}: tangents and frames differ"));
        }
        let frames = corners.into_per_corner();
        check_frames(mesh, &frames, mode, Some(&reference))
            .map_err(|broken| format!("{mode:?}: {broken}"))?;
        let mut of_supported = frames.iter().zip(&supported).filter(|(_, is)| **is).map(|(frame, _)| *frame);
        if mode == Mode::Repaired && distinct(&mut of_supported) > splits {
            return Err("a repair added a split".into());
        }
    }
    Ok(())
}

/// Checks splitting and plans on a case and returns the first violation.
pub fn split_and_plan(case: &Case) -> Result<(), String> {
    let mesh = case.mesh.view();
    let options = TangentOptions::from(MikkTSpaceOptions::new().with_threshold(case.threshold));
    let tangents = generate_tangents(&mesh, &options);
    let (split, corners) = (split_vertices(&mesh, &tangents.corners), tangents.corners.per_corner());
    let split = split.map_err(|error| error.to_string())?;
    let (old, new) = (mesh.vertex_count(), split.source_of_vertex.len());
    let mut wanted: HashSet<(usize, [u32; 4])> = HashSet::new();
    for (corner, tangent) in corners.iter().enumerate() {
        let (vertex, bits) = (split.indices[corner] as usize, tangent.map(f32::to_bits));
        if split.source_of_vertex[vertex] as usize != mesh.vertex_of_corner(corner) {
            return Err(format!("corner {corner} changed its vertex"));
        }
        if split.tangent_of_vertex[vertex].map(f32::to_bits) != bits {
            return Err(format!("corner {corner} changed its tangent"));
        }
        wanted.insert((mesh.vertex_of_corner(corner), bits));
    }
    let used: HashSet<usize> = wanted.iter().map(|(vertex, _)| *vertex).collect();
    if new != old + wanted.len() - used.len() || split.indices.len() != corners.len() {
        return Err(format!("{new} vertices where {} are needed", old + wanted.len() - used.len()));
    }
    if (0..old).any(|vertex| split.source_of_vertex[vertex] as usize != vertex) {
        return Err("an old vertex changed its place".into());
    }
    let copied: HashSet<u32> = split.source_of_vertex[old..].iter().copied().collect();
    if copied.len() != tangents.report.split_vertices {
        return Err(format!("{} vertices split, {} reported", copied.len(), tangents.report.split_vertices));
    }
    let planned = Plan::new(&mesh, &options).evaluate(&mesh).map_err(|error| error.to_string())?;
    let pairs = planned.per_corner().iter().zip(corners);
    match pairs.into_iter().position(|(a, b)| a.map(f32::to_bits) != b.map(f32::to_bits)) {
        None => Ok(()),
        Some(corner) => Err(format!("a plan gives its own base another tangent at corner {corner}")),
    }
}

fn same_bits(a: &CornerTangents, b: &CornerTangents) -> bool {
    let bits = |tangent: &[f32; 4]| tangent.map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits());
    a.per_corner().iter().map(bits).eq(b.per_corner().iter().map(bits))
}

fn tangent_bits(frame: &Frame) -> [u32; 4] {
    frame.tangent_and_sign().map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits())
}

/// True if the reference's result is usable: finite, unit length, and not along the normal (unless that is
/// zero).
pub fn usable(frame: &Frame, normal: [f32; 3]) -> bool {
    let unit = (length(frame.tangent) - 1.0).abs() < 1e-3;
    unit && (is_zero(normal) || cosine(frame.tangent, normal).abs() < 0.999)
}

/// Checks `frames` (one per corner, unsupported faces included) and returns the first violation.
///
/// In every mode signs are +1 or -1; but for [`Mode::Reference`] tangents are usable; in [`Mode::Corrected`]
/// a face has one sign. `reference`, where given, are the reference's frames: what is usable there must come
/// out unchanged in [`Mode::Repaired`], and what is not must be perpendicular to its normal.
pub fn check_frames(
    mesh: &OwnedMesh,
    frames: &[Frame],
    mode: Mode,
    reference: Option<&[Option<Frame>]>,
) -> Result<(), String> {
    if frames.len() != mesh.corner_count() {
        return Err(format!("{} frames for {} corners", frames.len(), mesh.corner_count()));
    }
    for (corner, frame) in frames.iter().enumerate() {
        let normal = mesh.normals[mesh.vertex_of_corner(corner)];
        let wrong = |what: &str| Err(format!("corner {corner}: {what}: {frame:?}, normal {normal:?}"));
        if frame.sign.abs() != 1.0 {
            return wrong("the sign is not 1 or -1");
        }
        if mode == Mode::Reference {
            continue;
        }
        if !almost_usable(frame, normal) {
            return wrong("not usable");
        }
        let Some(Some(original)) = reference.map(|all| all[corner]) else { continue };
        let kept = crate::compare::bits(&original) == crate::compare::bits(frame);
        let keepable = usable(&original, normal);
        if mode == Mode::Repaired && keepable && !kept && !at_the_limit(&original, normal) {
            return wrong("a usable result was changed");
        }
        if mode == Mode::Repaired && frame.sign != original.sign {
            return wrong("a repair changed the sign");
        }
        // In `Corrected` a corner may have another corner's frame, which is as perpendicular as the reference
        // made it.
        let repaired = mode == Mode::Repaired && !keepable;
        if repaired && is_direction(normal) && cosine(frame.tangent, normal).abs() > 1e-3 {
            return wrong("a repair that is not perpendicular");
        }
    }
    if mode == Mode::Corrected { one_sign_per_face(mesh, frames) } else { Ok(()) }
}

/// [`usable`] with a margin for rounding at the limits.
fn almost_usable(frame: &Frame, normal: [f32; 3]) -> bool {
    let unit = (length(frame.tangent) - 1.0).abs() < 1.001e-3;
    unit && (!is_direction(normal) || cosine(frame.tangent, normal).abs() < 0.99901)
}

fn at_the_limit(frame: &Frame, normal: [f32; 3]) -> bool {
    let near = |value: f64, limit: f64| (value - limit).abs() < 1e-6;
    near((length(frame.tangent) - 1.0).abs(), 1e-3) || near(cosine(frame.tangent, normal).abs(), 0.999)
}

fn one_sign_per_face(mesh: &OwnedMesh, frames: &[Frame]) -> Result<(), String> {
    let mut corner = 0;
    for (face, size) in mesh.face_sizes().into_iter().enumerate() {
        let signs = &frames[corner..corner + size as usize];
        if signs.windows(2).any(|pair| pair[0].sign != pair[1].sign) {
            return Err(format!("face {face}: both signs"));
        }
        corner += size as usize;
    }
    Ok(())
}

fn is_zero(v: [f32; 3]) -> bool {
    v.iter().all(|x| x.abs() <= f32::MIN_POSITIVE)
}

fn is_direction(v: [f32; 3]) -> bool {
    v.iter().all(|x| x.is_finite()) && !is_zero(v)
}

fn length(v: [f32; 3]) -> f64 {
    dot(v, v).sqrt()
}

fn cosine(a: [f32; 3], b: [f32; 3]) -> f64 {
    dot(a, b) / (length(a) * length(b))
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f64 {
    (0..3).map(|i| f64::from(a[i]) * f64::from(b[i])).sum()
}
