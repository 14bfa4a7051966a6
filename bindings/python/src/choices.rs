//! Parses the options that Python passes as strings.

use darboux::{Method, MikkTSpaceOptions, Mode, TangentOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

const METHODS: &[(&str, Method)] = &[
    ("mikktspace", Method::MikkTSpace(MikkTSpaceOptions::new())),
    ("angle-area", Method::AngleArea),
    ("angle-edge", Method::AngleEdge),
    ("lengyel", Method::Lengyel),
    ("lengyel-per-vertex", Method::LengyelPerVertex),
    ("average", Method::Average),
    ("area", Method::Area),
    ("face", Method::Face),
    ("from-normal", Method::FromNormal),
];

const MODES: &[(&str, Mode)] =
    &[("reference", Mode::Reference), ("repaired", Mode::Repaired), ("corrected", Mode::Corrected)];

/// The value of `name` among `choices`. `what` is the argument.
pub fn choice<T: Copy>(what: &str, name: &str, choices: &[(&str, T)]) -> PyResult<T> {
    let found = choices.iter().find(|(known, _)| *known == name);
    found.map(|&(_, value)| value).ok_or_else(|| {
        let names: Vec<String> = choices.iter().map(|(known, _)| format!("'{known}'")).collect();
        PyValueError::new_err(format!("{what} is '{name}'; it must be one of {}", names.join(", ")))
    })
}

/// The options of the core. Errors: an unknown name; a threshold that is not a number; a mode or threshold with another method than
/// MikkTSpace.
pub fn tangent_options(method: &str, mode: &str, threshold: f32) -> PyResult<TangentOptions> {
    let method = choice("method", method, METHODS)?;
    let mode = choice("mode", mode, MODES)?;
    if !threshold.is_finite() {
        return Err(PyValueError::new_err(format!(
            "threshold is {threshold}; it must be a number of degrees"
        )));
    }
    let defaults = MikkTSpaceOptions::new();
    let belongs_to_mikktspace =
        [("mode", mode != defaults.mode), ("threshold", threshold != defaults.threshold)];
    match (method, belongs_to_mikktspace.iter().find(|(_, is_set)| *is_set)) {
        (Method::MikkTSpace(_), _) => Ok(defaults.with_mode(mode).with_threshold(threshold).into()),
        (other, None) => Ok(other.into()),
        (_, Some((option, _))) => Err(PyValueError::new_err(format!(
            "{option} belongs to method='mikktspace'; leave one of them out"
        ))),
    }
}

/// True if a fan can take quadratic time in its number of triangles.
pub fn is_slow(options: &TangentOptions) -> bool {
    matches!(options.method, Method::MikkTSpace(mikkt) if mikkt.threshold < MikkTSpaceOptions::new().threshold)
}

/// The name of a method and, for MikkTSpace, that of its mode.
pub fn method_name(method: Method) -> (&'static str, Option<&'static str>) {
    let mode = match method {
        Method::MikkTSpace(options) => {
            MODES.iter().find(|(_, mode)| *mode == options.mode).map(|(name, _)| *name)
        }
        _ => None,
    };
    let is_same = |known: &Method| std::mem::discriminant(known) == std::mem::discriminant(&method);
    let name = METHODS.iter().find(|(_, known)| is_same(known)).map_or("unknown", |(name, _)| *name);
    (name, mode)
}
