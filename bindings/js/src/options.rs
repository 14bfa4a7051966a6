//! Options, which JavaScript passes as codes: positions in the lists of `lib/core/choices.ts`, which are
//! those of the core.

use darboux::{Choice, Method, MikkTSpaceOptions, Mode, TangentOptions};

pub fn tangent_options(mode: u32, threshold: f32, method: u32) -> TangentOptions {
    match self::method(method) {
        Method::MikkTSpace(_) => mikkt_options(mode, threshold).into(),
        other => other.into(),
    }
}

pub fn mikkt_options(mode: u32, threshold: f32) -> MikkTSpaceOptions {
    MikkTSpaceOptions::new().with_mode(choice::<Mode>(mode)).with_threshold(threshold)
}

/// The value of a code. Panics beyond the list, whose names and codes are generated from it.
pub fn choice<T: Choice>(code: u32) -> T {
    T::from_code(code).unwrap_or_else(|| panic!("{code} is not the code of a {}", T::WHAT))
}

/// A value by its name in JSON. Errors: no value has it.
#[cfg(feature = "bake")]
#[derive(Clone, Copy, serde::Deserialize)]
#[serde(try_from = "String", bound = "T: Choice")]
pub struct Named<T>(pub T);

#[cfg(feature = "bake")]
impl<T: Choice> TryFrom<String> for Named<T> {
    type Error = darboux::UnknownName;

    fn try_from(name: String) -> Result<Self, Self::Error> {
        T::from_name(&name).map(Self)
    }
}

#[cfg(feature = "full")]
fn method(code: u32) -> Method {
    choice(code)
}

/// The small module has one method, so that the code of the others is not linked.
#[cfg(not(feature = "full"))]
fn method(_code: u32) -> Method {
    Method::default()
}
