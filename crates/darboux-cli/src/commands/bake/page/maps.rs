//! Pictures of the maps, with their files, bits, ranges and legends.

use super::super::legend::{Legend, LegendEntry};
use super::super::write::WrittenMap;
use super::shared::figure;
use crate::html_page::escaped;
use crate::html_page::raster::Raster;
use crate::text::counted;

/// The number of colours that a legend lists: the colours of the most texels.
const COLORS: usize = 24;

/// One figure per map.
pub fn figures(maps: &[(&WrittenMap, &Raster)], legends: &[Legend]) -> Result<String, String> {
    let figures = maps.iter().map(|(map, raster)| {
        let of_map = legends.iter().find(|legend| legend.map == map.map);
        let more = about(map) + &of_map.map(colors).unwrap_or_default();
        figure(raster, &map.map, &more)
    });
    Ok(format!("<div class=\"maps\">\n{}</div>\n", figures.collect::<Result<String, String>>()?))
}

/// The file, its bits, and what black and white mean.
fn about(map: &WrittenMap) -> String {
    let mut html = format!("<br><code>{}</code><br>{} bits per channel", escaped(&map.file), map.bits);
    for [from, to] in map.range.iter().filter(|range| **range != [0.0, 1.0]) {
        html += &format!("<br>black is {from}, white {to}");
    }
    html
}

/// What the colours stand for.
fn colors(legend: &Legend) -> String {
    let mut entries: Vec<&LegendEntry> = legend.entries.iter().collect();
    entries.sort_by_key(|entry| std::cmp::Reverse(entry.texels));
    let listed: String = entries.iter().take(COLORS).map(|entry| color(entry)).collect();
    let rest = match entries.len().saturating_sub(COLORS) {
        0 => String::new(),
        count => format!("<li>and {}: {}</li>", counted(count, "colour", "colours"), escaped(&legend.file)),
    };
    format!("<ul class=\"legend\">{listed}{rest}</ul>")
}

fn color(LegendEntry { color, id, name, texels }: &LegendEntry) -> String {
    let name = name.as_ref().map_or_else(|| format!("number {id}"), |name| escaped(name));
    let texels = counted(usize::try_from(*texels).unwrap_or(usize::MAX), "texel", "texels");
    format!(
        "<li><svg width=\"14\" height=\"14\" aria-hidden=\"true\"><rect width=\"14\" height=\"14\" \
         fill=\"{color}\"/></svg><span>{name} <span class=\"faint\">{color}, {texels}</span></span></li>"
    )
}
