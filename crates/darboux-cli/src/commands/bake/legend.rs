//! What the colours of maps stand for, as a JSON file beside the map.

use darboux::Choice;
use darboux_bake::{HighModel, IdColor, MapKind};
use darboux_io::Outputs;
use serde::Serialize;

use super::arguments::BakeArguments;
use super::outputs::maps_with_legends;

/// The colours of a map.
#[derive(Debug)]
pub struct Legend {
    /// The name of the map.
    pub map: &'static str,
    pub file: String,
    pub entries: Vec<LegendEntry>,
}

/// A colour, and what it stands for. json.txt documents the fields.
#[derive(Debug, Serialize)]
pub struct LegendEntry {
    /// `#rrggbb`.
    pub color: String,
    /// The number of the material, mesh, part or chart.
    pub id: u32,
    /// The name, if it has one.
    pub name: Option<String>,
    pub texels: u64,
}

/// Stages the legends. Errors are one sentence each.
pub fn stage_legends(
    arguments: &BakeArguments,
    legends: &[(MapKind, Vec<IdColor>)],
    highs: &[HighModel<'_>],
    outputs: &mut Outputs,
) -> Result<Vec<Legend>, String> {
    let names = HighModel::names_of_all(highs, arguments.content.id_from);
    let mut staged = Vec::new();
    for (map, path) in maps_with_legends(arguments) {
        let legend_path = path.with_extension("json");
        let colors = legends.iter().find(|(kind, _)| *kind == map).map(|(_, colors)| &colors[..]);
        let entry = |color: &IdColor| {
            let [red, green, blue] = color.color;
            let name = (map == MapKind::Id).then(|| names.get(color.id as usize).copied()).flatten();
            LegendEntry {
                color: format!("#{red:02x}{green:02x}{blue:02x}"),
                id: color.id,
                name: name.filter(|name| !name.is_empty()).map(str::to_owned),
                texels: color.texels,
            }
        };
        let entries: Vec<_> = colors.unwrap_or_default().iter().map(entry).collect();
        let text =
            serde_json::to_string_pretty(&entries).map_err(|error| format!("{}: {error}", path.display()))?;
        let options = arguments.save_options(&legend_path);
        let staged_legend = outputs.stage_bytes(&legend_path, format!("{text}\n").as_bytes(), &options);
        staged_legend.map_err(|error| error.to_string())?;
        staged.push(Legend { map: map.name(), file: legend_path.display().to_string(), entries });
    }
    Ok(staged)
}
