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

#[cfg(feature = "full")]
fn method(code: u32) -> Method {
    choice(code)
}

/// The small module has one method, so that the code of the others is not linked.
#[cfg(not(feature = "full"))]
fn method(_code: u32) -> Method {
    Method::default()
}
