//! Options that Python names by strings.

use darboux::{Method, Mode, TangentOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

const METHODS: &[(&str, Method)] = &[
    ("mikktspace", Method::MikkTSpace),
    ("angle-area", Method::AngleArea),
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

/// The options of the core. Errors: unknown names; a threshold that is no number of degrees, or that the method does not have.
pub fn tangent_options(method: &str, mode: &str, threshold: f32) -> PyResult<TangentOptions> {
    let method = choice("method", method, METHODS)?;
    let mode = choice("mode", mode, MODES)?;
    if !threshold.is_finite() {
        return Err(PyValueError::new_err(format!(
            "threshold is {threshold}; it must be a number of degrees"
        )));
    }
    if method != Method::MikkTSpace && threshold != TangentOptions::default().threshold {
        return Err(PyValueError::new_err("threshold belongs to method='mikktspace'; leave one of them out"));
    }
    Ok(TangentOptions { method, mode, threshold })
}

/// Whether fans of many triangles may take their size squared.
pub fn is_slow(options: &TangentOptions) -> bool {
    options.method == Method::MikkTSpace && options.threshold < TangentOptions::default().threshold
}
