//! The Python package: numpy arrays in, numpy arrays out, the GIL released in between.
//!
//! This crate becomes `darboux._darboux`. `python/darboux` re-exports it with the named tuples of results
//! and the adapters to other packages. Doc comments of functions are their Python docstrings.

mod arrays;
mod bake;
mod bake_maps;
mod bake_models;
mod bake_result;
mod bake_settings;
mod check;
mod choices;
mod command;
mod convention;
mod distributed;
mod document;
mod encode;
mod measure;
mod mesh;
mod normals;
mod numbers;
mod out;
mod plan;
mod results;
mod split;
mod tangents;
mod threads;
mod transform;

#[pyo3::pymodule]
mod _darboux {
    use darboux::Convention;
    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_export]
    use crate::bake::bake;
    #[pymodule_export]
    use crate::bake_maps::{auto_cage, convert_space, udim_tiles, verify};
    #[pymodule_export]
    use crate::bake_models::bake_models;
    #[pymodule_export]
    use crate::check::{check, fix, judge_normal_map, recognise_recipe};
    #[pymodule_export]
    use crate::command::run;
    #[pymodule_export]
    use crate::convention::{convert, convert_texels};
    #[pymodule_export]
    use crate::distributed::{DistributedBatch, DistributedJob, failed_task, run_task};
    #[pymodule_export]
    use crate::document::{Document, dumps, load, loads, save};
    #[pymodule_export]
    use crate::encode::{
        frame_from_quaternion, frame_to_quaternion, normal_from_octahedral, normal_to_octahedral,
        tangent_from_diamond, tangent_from_octahedral, tangent_from_snorm8, tangent_from_snorm10,
        tangent_from_snorm16, tangent_to_diamond, tangent_to_octahedral, tangent_to_snorm8,
        tangent_to_snorm10, tangent_to_snorm16,
    };
    #[pymodule_export]
    use crate::measure::{measure_tangents, measure_uv_fidelity};
    #[pymodule_export]
    use crate::normals::generate_normals;
    #[pymodule_export]
    use crate::plan::Plan;
    #[pymodule_export]
    use crate::split::{split_normals, split_vertices};
    #[pymodule_export]
    use crate::tangents::generate_tangents;
    #[pymodule_export]
    use crate::transform::{skin_frames, transform_frames};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("MODEL_ENDINGS", darboux_io::FileKind::model_endings())?;
        let names = Convention::PRESETS.map(|(name, _)| name);
        module.add("CONVENTIONS", PyTuple::new(module.py(), names)?)
    }
}
