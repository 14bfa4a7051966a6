//! The errors of `--verify`: by place, by part of the low model, and over the UV layout.

use darboux_bake::ErrorStatistics;
use darboux_io::words::Count;

use super::super::verified::{PartErrors, Verified};
use super::shared::figure;
use crate::html_page::escaped;
use crate::text::counted;

/// The parts that are listed: those with the greatest mean error.
const PARTS: usize = 40;

/// The tables and the picture.
pub fn tables(verified: &Verified) -> Result<String, String> {
    let rows: String = verified.rows().map(|(what, errors)| row(what, errors)).collect();
    let mut html = table("error in degrees", &rows);
    if verified.parts.len() > 1 {
        html += &of_parts(&verified.parts);
    }
    for (count, what) in [
        (verified.errors.points_without_hit, "have no high surface to compare with"),
        (verified.errors.points_without_frame, "have no tangent frame"),
    ] {
        if count > 0 {
            html += &format!("<p>{} further points {what}.</p>\n", Count(count));
        }
    }
    let picture = figure(&verified.picture(), "The errors over the UV layout", "")?;
    Ok(format!("<div class=\"pair-of-columns\">\n<div>\n{html}</div>\n{picture}</div>\n"))
}

fn of_parts(parts: &[PartErrors]) -> String {
    let mut compared: Vec<&PartErrors> = parts.iter().filter(|part| part.errors.points > 0).collect();
    compared.sort_by(|a, b| b.errors.mean.total_cmp(&a.errors.mean));
    let name = |part: &PartErrors| match part.name.is_empty() {
        true => "a part without a name".to_owned(),
        false => part.name.clone(),
    };
    let rows: String = compared.iter().take(PARTS).map(|part| row(&name(part), &part.errors)).collect();
    let rest = match compared.len().saturating_sub(PARTS) {
        0 => String::new(),
        count => format!("<p>{} with smaller errors.</p>\n", counted(count, "further part", "further parts")),
    };
    table("by part of the low model", &rows) + &rest
}

fn table(first: &str, rows: &str) -> String {
    let columns: String = ["points", "median", "mean", "95 %", "99 %", "worst"]
        .map(|column| format!("<th class=\"number\" scope=\"col\">{column}</th>"))
        .concat();
    format!("<table>\n<tr><th scope=\"col\">{first}</th>{columns}</tr>\n{rows}</table>\n")
}

/// A row; names that begin with a space are parts of the row above.
fn row(what: &str, errors: &ErrorStatistics) -> String {
    let class = if what.starts_with(' ') { " class=\"inner\"" } else { "" };
    let ErrorStatistics { points, median, mean, p95, p99, worst, .. } = errors;
    let angles: String =
        [median, mean, p95, p99, worst].map(|angle| format!("<td class=\"number\">{angle:.4}</td>")).concat();
    format!(
        "<tr><td{class}>{}</td><td class=\"number\">{}</td>{angles}</tr>\n",
        escaped(what.trim()),
        Count(points)
    )
}
