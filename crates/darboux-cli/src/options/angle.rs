//! Angles on the command line.

use std::str::FromStr;

/// Parses an angle of 0 to 180 degrees.
pub fn degrees<T: FromStr + PartialOrd + From<u8>>(text: &str) -> Result<T, String> {
    match text.parse() {
        Ok(degrees) if (T::from(0)..=T::from(180)).contains(&degrees) => Ok(degrees),
        _ => Err("expected a number of degrees from 0 to 180".into()),
    }
}
