//! What must hold for every answer, whatever the mesh.

use darboux::{Frame, Mode};

use crate::OwnedMesh;

/// Where the reference's own result is good enough to keep: finite, of unit length, not along a normal that is not zero.
pub fn usable(frame: &Frame, normal: [f32; 3]) -> bool {
    let unit = (length(frame.tangent) - 1.0).abs() < 1e-3;
    unit && (is_zero(normal) || cosine(frame.tangent, normal).abs() < 0.999)
}

/// The first thing wrong with `frames` (one per corner, unsupported faces included), if any.
///
/// In every mode signs are +1 or -1; but for [`Mode::Reference`] tangents are usable; in [`Mode::Corrected`] a face has one
/// sign. `reference`, where given, are the reference's frames: what is usable there must come out unchanged in
/// [`Mode::Repaired`], and what is not must be perpendicular to its normal.
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
        if !kept && !keepable && is_direction(normal) && cosine(frame.tangent, normal).abs() > 1e-3 {
            return wrong("a repair that is not perpendicular");
        }
    }
    if mode == Mode::Corrected { one_sign_per_face(mesh, frames) } else { Ok(()) }
}

/// [`usable`], but for what rounding may do to a value at the limit.
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
