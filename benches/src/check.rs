//! Compares every engine's result with the reference's before anything is timed.

use crate::engines::Method;
use crate::run::Tangent;

/// Compares a result with the reference's and returns the text for the table. Errors: the result is not what
/// the engine claims.
pub fn verdict(method: Method, expected: &[Tangent], found: &[Tangent]) -> Result<String, String> {
    if found.len() != expected.len() {
        return Err(format!("{} tangents for {} corners", found.len(), expected.len()));
    }
    match method {
        Method::Copy => Ok("none: a copy".into()),
        Method::Other => other(expected, found),
        Method::MikkTSpace => Ok(difference(expected, found)),
    }
}

/// "exact", or how many corners differ and by what angle.
fn difference(expected: &[Tangent], found: &[Tangent]) -> String {
    let pairs = || expected.iter().zip(found);
    let count = pairs().filter(|(a, b)| bits(a) != bits(b)).count();
    if count == 0 {
        return "exact".into();
    }
    let angle = pairs().map(|(a, b)| angle(a, b)).fold(0.0, f64::max);
    let percent = 100.0 * count as f64 / expected.len() as f64;
    let signs = pairs().filter(|(a, b)| a[3] != b[3]).count();
    let signs = if signs == 0 { String::new() } else { format!(", {signs} signs") };
    format!("{percent:.2} % of corners differ, at most {} degrees{signs}", rounded(angle))
}

/// Formats an angle with about two significant digits.
fn rounded(angle: f64) -> String {
    if angle == 0.0 || angle >= 0.1 { format!("{angle:.1}") } else { format!("{angle:.1e}") }
}

/// Another method need not agree, but most of its tangents must point the same way.
fn other(expected: &[Tangent], found: &[Tangent]) -> Result<String, String> {
    const NEAR: f64 = 20.0;
    let near = expected.iter().zip(found).filter(|(a, b)| angle(a, b) < NEAR).count();
    if 2 * near < expected.len() {
        return Err(format!("only {near} of {} tangents are within {NEAR} degrees", expected.len()));
    }
    Ok("other method".into())
}

fn bits(tangent: &Tangent) -> [u32; 4] {
    tangent.map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits())
}

/// Degrees between two tangents; 180 where just one of them has no direction.
fn angle(a: &Tangent, b: &Tangent) -> f64 {
    if bits(a) == bits(b) {
        return 0.0;
    }
    let [a, b] = [a, b].map(|v| [f64::from(v[0]), f64::from(v[1]), f64::from(v[2])]);
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot: f64 = (0..3).map(|i| a[i] * b[i]).sum();
    let sine = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    if sine == 0.0 && dot == 0.0 && a != b || !dot.is_finite() { 180.0 } else { sine.atan2(dot).to_degrees() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: Tangent = [1.0, 0.0, 0.0, 1.0];

    #[test]
    fn differences_are_told() {
        let told = |found: &[Tangent]| verdict(Method::MikkTSpace, &[X, X], found);
        assert_eq!(told(&[X, X]).as_deref(), Ok("exact"));
        let turned = told(&[X, [0.0, 1.0, 0.0, -1.0]]);
        assert_eq!(turned.as_deref(), Ok("50.00 % of corners differ, at most 90.0 degrees, 1 signs"));
        let none = told(&[X, [0.0, 0.0, 0.0, 1.0]]);
        assert_eq!(none.as_deref(), Ok("50.00 % of corners differ, at most 180.0 degrees"));
        assert!(told(&[X]).is_err());
    }

    #[test]
    fn another_method_must_point_the_same_way() {
        let found = [X, [-1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]];
        assert!(verdict(Method::Other, &[X; 3], &found).is_err());
        assert!(verdict(Method::Other, &[X; 3], &[X, X, found[1]]).is_ok());
    }
}
