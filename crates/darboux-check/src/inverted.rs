//! [`Inverted`]: which channels of a map are inverted, and what the user says in their place.

use darboux::BitangentDirection;

use crate::check_options::AssumedMap;

/// The channels of a map that are inverted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inverted {
    None,
    Green,
    Red,
    Both,
}

/// All of them.
pub const ALL: [Inverted; 4] = [Inverted::None, Inverted::Green, Inverted::Red, Inverted::Both];

/// Which channels of an assumed map are inverted where green should point in a direction.
pub fn relative(assumed: AssumedMap, wanted: BitangentDirection) -> Inverted {
    let (is_left, is_down) = match assumed {
        AssumedMap::OpenGl => (false, false),
        AssumedMap::DirectX => (false, true),
        AssumedMap::RedInverted => (true, false),
        AssumedMap::BothInverted => (true, true),
    };
    match (is_left, is_down != (wanted == BitangentDirection::Down)) {
        (false, false) => Inverted::None,
        (false, true) => Inverted::Green,
        (true, false) => Inverted::Red,
        (true, true) => Inverted::Both,
    }
}

/// What a map is assumed to be that has some channels inverted where green should point in a direction: the
/// inverse of [`relative`].
pub fn assumption(inverted: Inverted, wanted: BitangentDirection) -> AssumedMap {
    let is_left = matches!(inverted, Inverted::Red | Inverted::Both);
    let is_green_inverted = matches!(inverted, Inverted::Green | Inverted::Both);
    match (is_left, is_green_inverted != (wanted == BitangentDirection::Down)) {
        (false, false) => AssumedMap::OpenGl,
        (false, true) => AssumedMap::DirectX,
        (true, false) => AssumedMap::RedInverted,
        (true, true) => AssumedMap::BothInverted,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assumptions_name_the_inverted_channels() {
        for wanted in [BitangentDirection::Up, BitangentDirection::Down] {
            for inverted in ALL {
                assert_eq!(relative(assumption(inverted, wanted), wanted), inverted);
            }
        }
        assert_eq!(assumption(Inverted::Green, BitangentDirection::Up), AssumedMap::DirectX);
        assert_eq!(assumption(Inverted::Both, BitangentDirection::Down), AssumedMap::RedInverted);
    }
}
