//! Options, which JavaScript passes as numbers: each is a position in a list of names in `lib`.

use darboux::{Method, MikkTSpaceOptions, Mode, TangentOptions};

pub fn tangent_options(mode: u32, threshold: f32, method: u32) -> TangentOptions {
    match self::method(method) {
        Method::MikkTSpace(_) => mikkt_options(mode, threshold).into(),
        other => other.into(),
    }
}

pub fn mikkt_options(mode: u32, threshold: f32) -> MikkTSpaceOptions {
    let mode = match mode {
        0 => Mode::Reference,
        1 => Mode::Repaired,
        _ => Mode::Corrected,
    };
    MikkTSpaceOptions::new().with_mode(mode).with_threshold(threshold)
}

#[cfg(feature = "full")]
fn method(code: u32) -> Method {
    match code {
        0 => Method::default(),
        1 => Method::AngleArea,
        2 => Method::Lengyel,
        3 => Method::LengyelPerVertex,
        4 => Method::Average,
        5 => Method::Area,
        6 => Method::Face,
        7 => Method::FromNormal,
        _ => Method::AngleEdge,
    }
}

/// The small module has one method, so that the code of the others is not linked.
#[cfg(not(feature = "full"))]
fn method(_code: u32) -> Method {
    Method::default()
}
