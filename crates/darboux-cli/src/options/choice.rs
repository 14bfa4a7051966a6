//! Options whose values are a list of the core: `--method`, `--mode`, `--weight`.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use darboux::Choice;

/// Accepts the names of a list; the help shows their descriptions.
pub fn choice<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(possible_values::<T>()).try_map(|name| T::from_name(&name))
}

/// The names of a list with their descriptions.
pub fn possible_values<T: Choice>() -> impl Iterator<Item = PossibleValue> {
    T::ALL.iter().map(|value| PossibleValue::new(value.name()).help(value.summary()))
}
