//! Compares the stated confidence with the share of right signs.

use super::outcome::Outcome;

/// A range of stated confidences.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// The lower and upper end.
    pub ends: [f32; 2],
    /// The number of maps.
    pub maps: usize,
    /// The mean confidence.
    pub stated: f64,
    /// The share of right signs.
    pub right: f64,
    /// Two standard errors of that share.
    pub uncertainty: f64,
}

/// The bins of the outcomes that have a sign.
pub fn bins<'a>(outcomes: impl IntoIterator<Item = &'a Outcome> + Clone) -> Vec<Bin> {
    const ENDS: [f32; 8] = [0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 0.995, 1.0];
    let bin = |ends: &[f32]| {
        let is_inside = |confidence: f32| confidence >= ends[0] && (confidence < ends[1] || ends[1] == 1.0);
        let (mut maps, mut stated, mut right) = (0, 0.0, 0.0);
        for outcome in outcomes.clone() {
            if let Some(is_right) = outcome.has_right_sign().filter(|_| is_inside(outcome.confidence)) {
                maps += 1;
                stated += f64::from(outcome.confidence);
                right += f64::from(u8::from(is_right));
            }
        }
        let count = f64::from(maps).max(1.0);
        let (stated, right) = (stated / count, right / count);
        // With the rule of succession, so that the uncertainty of all or none is not zero.
        let share = (right * count + 1.0) / (count + 2.0);
        let uncertainty = 2.0 * (share * (1.0 - share) / (count + 2.0)).sqrt();
        Bin { ends: [ends[0], ends[1]], maps: maps as usize, stated, right, uncertainty }
    };
    ENDS.windows(2).map(bin).collect()
}

/// The bins as a Markdown table.
pub fn table(bins: &[Bin]) -> String {
    let head =
        "| stated confidence | maps | mean stated | right | two standard errors |\n|---|--:|--:|--:|--:|\n";
    bins.iter().filter(|bin| bin.maps > 0).fold(head.to_owned(), |text, bin| {
        let percent = |share: f64| 100.0 * share;
        text + &format!(
            "| {:.1} to {:.1} % | {} | {:.2} % | {:.2} % | {:.2} % |\n",
            100.0 * bin.ends[0],
            100.0 * bin.ends[1],
            bin.maps,
            percent(bin.stated),
            percent(bin.right),
            percent(bin.uncertainty)
        )
    })
}
