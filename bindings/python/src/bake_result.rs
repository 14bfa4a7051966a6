//! Makes the named tuples of a bake.

use darboux::Choice;
use darboux_bake::{BakeReport, Baked, IdColor, MapKind};
use numpy::PyArray1;
use numpy::prelude::*;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

use crate::results::named;

/// What a result tells beside the images and the counts.
#[derive(Default)]
pub struct Setup {
    /// How far outside rays began and how far inside they ended.
    pub distance: [f32; 2],
    /// What was left out, one sentence each.
    pub warnings: Vec<String>,
    /// Of what the colours of [`MapKind::Id`] stand for.
    pub id_names: Vec<String>,
}

/// The maps before the states and the counts, in BakedMaps; the others stand behind.
const FIRST_MAPS: usize = 5;

/// The images as arrays, the counts, and what they mean.
pub fn baked_maps(py: Python<'_>, baked: Baked, setup: Setup) -> PyResult<Bound<'_, PyAny>> {
    let legends = legends(py, &baked, &setup.id_names)?;
    let mut images = baked.images;
    let [width, height] = images.size.map(|side| side as usize);
    let mut image = |kind: MapKind| -> PyResult<Option<Bound<'_, PyAny>>> {
        let Some(numbers) = images.take(kind) else { return Ok(None) };
        let array = PyArray1::from_vec(py, numbers);
        Ok(Some(match kind.channels() {
            1 => array.reshape([height, width])?.into_any(),
            channels => array.reshape([height, width, channels])?.into_any(),
        }))
    };
    let mut fields = Vec::new();
    for &kind in MapKind::ALL {
        fields.push(image(kind)?);
    }
    let states: Vec<u8> = images.states.iter().map(|state| state.number()).collect();
    let states = PyArray1::from_vec(py, states).reshape([height, width])?.into_any();
    let later = fields.split_off(FIRST_MAPS);
    fields.push(Some(states));
    fields.push(Some(report(py, &baked.report)?));
    fields.extend(later);
    fields.push(Some(legends.into_any()));
    fields.push(Some(PyTuple::new(py, setup.distance)?.into_any()));
    fields.push(Some(PyList::new(py, setup.warnings)?.into_any()));
    named(py, "BakedMaps", PyTuple::new(py, fields)?)
}

fn report<'py>(py: Python<'py>, report: &BakeReport) -> PyResult<Bound<'py, PyAny>> {
    let fields = [
        report.charted_texels,
        report.missed_texels,
        report.back_facing_texels,
        report.overlapping_texels,
        report.chart_area,
        report.inverted_texels,
        report.frameless_texels,
        report.below_horizon_texels,
        report.rays,
        report.degenerate_triangles,
        report.oversized_triangles,
        report.non_finite_low_triangles,
        report.non_finite_triangles,
    ];
    named(py, "BakeReport", PyTuple::new(py, fields)?)
}

/// What the colours of maps stand for, by the names of the maps.
fn legends<'py>(py: Python<'py>, baked: &Baked, id_names: &[String]) -> PyResult<Bound<'py, PyDict>> {
    let legends = PyDict::new(py);
    for (kind, colors) in &baked.legends {
        let names = if *kind == MapKind::Id { id_names } else { &[] };
        let entries = colors.iter().map(|color| legend_entry(py, color, names)).collect::<PyResult<Vec<_>>>();
        legends.set_item(kind.name(), entries?)?;
    }
    Ok(legends)
}

fn legend_entry<'py>(py: Python<'py>, color: &IdColor, names: &[String]) -> PyResult<Bound<'py, PyAny>> {
    let name = names.get(color.id as usize).filter(|name| !name.is_empty());
    named(py, "LegendEntry", (color.id, name, PyTuple::new(py, color.color)?, color.texels))
}
