//! Conventions on the command line, such as `unity` or `gltf,green=down`.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use darboux::Convention;

/// A convention and the text that named it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedConvention {
    pub name: String,
    pub convention: Convention,
}

impl NamedConvention {
    /// The convention of glTF.
    pub fn gltf() -> Self {
        Self { name: "gltf".to_owned(), convention: Convention::GLTF }
    }
}

/// Parses conventions; help and completions list the presets.
#[derive(Clone)]
pub struct ConventionParser;

impl TypedValueParser for ConventionParser {
    type Value = NamedConvention;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<NamedConvention, clap::Error> {
        let named = |name: String| name.parse().map(|convention| NamedConvention { name, convention });
        StringValueParser::new().try_map(named).parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(Convention::PRESETS.into_iter().map(|(name, _)| PossibleValue::new(name))))
    }
}
