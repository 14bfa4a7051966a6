//! Parses the options that Python passes as strings.

use darboux::{Choice, Method, MikkTSpaceOptions, Mode, TangentOptions};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The value of a name of a list of the core. Errors: a name that is not in it.
pub fn named_choice<T: Choice>(name: &str) -> PyResult<T> {
    T::from_name(name).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// The value of `name` among `choices`. `what` is the argument.
pub fn choice<T: Copy>(what: &str, name: &str, choices: &[(&str, T)]) -> PyResult<T> {
    let found = choices.iter().find(|(known, _)| *known == name);
    found.map(|&(_, value)| value).ok_or_else(|| {
        let names: Vec<String> = choices.iter().map(|(known, _)| format!("'{known}'")).collect();
        PyValueError::new_err(format!("{what} is '{name}'; it must be one of {}", names.join(", ")))
    })
}

/// The options of the core. Errors: an unknown name; a threshold that is not a number; a mode or threshold
/// with another method than MikkTSpace.
pub fn tangent_options(method: &str, mode: &str, threshold: f32) -> PyResult<TangentOptions> {
    let method = named_choice::<Method>(method)?;
    let mode = named_choice::<Mode>(mode)?;
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
