//! Words of sentences.

use std::fmt;

/// A number of things, an unsigned integer, with commas between groups of three digits: 3,983.
#[derive(Clone, Copy, Debug)]
pub struct Count<T>(pub T);

impl<T: fmt::Display> fmt::Display for Count<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = self.0.to_string();
        for (place, digit) in digits.char_indices() {
            let separator = if place > 0 && (digits.len() - place).is_multiple_of(3) { "," } else { "" };
            write!(f, "{separator}{digit}")?;
        }
        Ok(())
    }
}

/// A probability in percent, rounded down to a tenth: 0.99902 is `99.9 %`. Nothing is 100 % sure, so that 1
/// is `99.9 %`, too.
#[derive(Clone, Copy, Debug)]
pub struct Sure(pub f64);

impl Sure {
    /// The number before the sign.
    pub fn percent(self) -> f64 {
        const MOST: f64 = 999.0;
        // What single precision makes of 0.9 is a little less than 0.9.
        (1000.0 * self.0 + 1e-3).floor().clamp(0.0, MOST) / 10.0
    }
}

impl fmt::Display for Sure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1} %", self.percent())
    }
}

/// A number with what is said of one thing, or of several.
pub fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{} {}", Count(count), if count == 1 { one } else { several })
}

/// The first three of some names, and the number of the others: `A, B, C and 2 more`.
pub fn listed(names: &[&str]) -> String {
    const MOST: usize = 3;
    let (shown, others) = names.split_at(names.len().min(MOST));
    match (shown, others.len()) {
        ([all @ .., last], 0) if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        (_, 0) => shown.concat(),
        (_, others) => format!("{} and {} more", shown.join(", "), Count(others)),
    }
}

/// As [`counted`]; none for none.
pub fn counted_if_any(count: usize, one: &str, several: &str) -> Option<String> {
    (count > 0).then(|| counted(count, one, several))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_sure_is_rounded_down() {
        let said =
            [0.0, 0.5, 0.98, f64::from(0.9_f32), 0.99902, 0.99999, 1.0].map(|sure| Sure(sure).to_string());
        assert_eq!(said, ["0.0 %", "50.0 %", "98.0 %", "90.0 %", "99.9 %", "99.9 %", "99.9 %"]);
    }

    #[test]
    fn names_are_listed_to_a_limit() {
        let said = (0..6).map(|count| listed(&["A", "B", "C", "D", "E"][..count.min(5)])).collect::<Vec<_>>();
        assert_eq!(said, ["", "A", "A and B", "A, B and C", "A, B, C and 1 more", "A, B, C and 2 more"]);
    }

    #[test]
    fn commas_stand_between_groups_of_three_digits() {
        let written =
            [0, 7, 999, 1000, 3983, 65_536, 100_000, 1_234_567].map(|count| Count(count).to_string());
        assert_eq!(written, ["0", "7", "999", "1,000", "3,983", "65,536", "100,000", "1,234,567"]);
        assert_eq!(
            counted(1, "face", "faces") + &counted(1200, " and face", "and faces"),
            "1 face1,200 and faces"
        );
    }
}
