//! Choices that have a name: one list of values for the command, the bindings, the documentation and tests.

use std::fmt;
use std::mem::discriminant;

/// A choice from a fixed list of values, each with a name and a line of description.
///
/// The position of a value in [`Choice::ALL`] is its code in C and WebAssembly, so new values are appended.
/// `name.parse()` gives the value of a name.
///
/// ```
/// use darboux::{Choice, Method};
///
/// let names: Vec<_> = Method::ALL.iter().map(|method| method.name()).collect();
/// assert!(names.starts_with(&["mikktspace", "angle-area"]));
/// assert_eq!("angle-area".parse(), Ok(Method::AngleArea));
/// assert!("angle".parse::<Method>().is_err());
/// ```
pub trait Choice: Copy + 'static {
    /// What is chosen, such as `method`.
    const WHAT: &'static str;

    /// All values, with default options where they have some.
    const ALL: &'static [Self];

    /// The name: lower case, words joined by hyphens, in verdicts by underscores.
    fn name(self) -> &'static str;

    /// What the value means, in a line without a full stop.
    fn summary(self) -> &'static str;

    /// The position in [`Choice::ALL`].
    fn code(self) -> u32 {
        let position = Self::ALL.iter().position(|known| discriminant(known) == discriminant(&self));
        position.unwrap_or_default() as u32
    }

    /// The value at a position in [`Choice::ALL`]; none beyond its end.
    fn from_code(code: u32) -> Option<Self> {
        Self::ALL.get(code as usize).copied()
    }

    /// The value of a name. Errors: no value has it.
    fn from_name(name: &str) -> Result<Self, UnknownName> {
        Self::ALL.iter().find(|value| value.name() == name).copied().ok_or_else(|| UnknownName {
            what: Self::WHAT,
            name: name.to_owned(),
            known: Self::ALL.iter().map(|value| value.name()).collect(),
        })
    }
}

/// A name that no value of a choice has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    what: &'static str,
    name: String,
    known: Vec<&'static str>,
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known: Vec<String> = self.known.iter().map(|name| format!("'{name}'")).collect();
        write!(f, "{} is '{}'; it must be one of {}", self.what, self.name, known.join(", "))
    }
}

impl std::error::Error for UnknownName {}

/// Implements [`Choice`] and `FromStr` for an enum, for all crates of Darboux. The compiler refuses a list
/// that lacks a variant. Each variant is `Name => "name", "summary";`; where some have fields, each is
/// `pattern = value => "name", "summary";`.
#[doc(hidden)]
#[macro_export]
macro_rules! choice {
    ($type:ident, $what:literal, $($variant:ident => $name:literal, $summary:literal;)+) => {
        $crate::choice! { $type, $what, $(Self::$variant = Self::$variant => $name, $summary;)+ }
    };
    ($type:ident, $what:literal, $($pattern:pat = $value:expr => $name:literal, $summary:literal;)+) => {
        impl $crate::Choice for $type {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &[$($value),+];

            fn name(self) -> &'static str {
                match self { $($pattern => $name),+ }
            }

            fn summary(self) -> &'static str {
                match self { $($pattern => $summary),+ }
            }
        }

        impl std::str::FromStr for $type {
            type Err = $crate::UnknownName;

            fn from_str(name: &str) -> Result<Self, Self::Err> {
                $crate::Choice::from_name(name)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::encode::Encoding;
    use crate::{MapVerdict, Method, Mode, NormalWeight, RecipeWriting, Shading, SmoothingSeams};

    fn check<T: Choice + PartialEq + fmt::Debug>() {
        for (code, &value) in T::ALL.iter().enumerate() {
            assert_eq!((value.code(), T::from_code(code as u32)), (code as u32, Some(value)));
            assert_eq!(T::from_name(value.name()), Ok(value));
            assert!(!value.summary().is_empty() && !value.summary().ends_with('.'), "{value:?}");
        }
        assert_eq!(T::from_code(T::ALL.len() as u32), None);
        let error = T::from_name("none").expect_err("no name").to_string();
        assert!(error.starts_with(T::WHAT) && error.contains(T::ALL[0].name()), "{error}");
    }

    #[test]
    fn names_and_codes_come_back() {
        check::<Method>();
        check::<Mode>();
        check::<Shading>();
        check::<NormalWeight>();
        check::<SmoothingSeams>();
        check::<Encoding>();
        check::<MapVerdict>();
        check::<RecipeWriting>();
    }

    #[test]
    fn options_do_not_change_the_name() {
        let strict = crate::MikkTSpaceOptions::new().with_mode(Mode::Reference);
        assert_eq!((Method::from(strict).name(), Method::from(strict).code()), ("mikktspace", 0));
    }
}
