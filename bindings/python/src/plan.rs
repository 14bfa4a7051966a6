//! Plans: compute the topology once, evaluate tangents often.

use std::sync::Mutex;

use darboux::{Context, Indices, Mesh};
use pyo3::prelude::*;

use crate::arrays::{Rows, rows_array};
use crate::choices::{is_slow, tangent_options};
use crate::mesh::{FaceSizes, MeshArrays, owned, value_error};
use crate::numbers::{Threads, degrees};
use crate::out::Target;
use crate::results;
use crate::threads::cancellable;

/// The weld, groups and subgroups of one mesh, kept to evaluate tangents again after its vertices moved.
///
/// Methods other than 'mikktspace', 'angle-area' and 'angle-edge' keep only the signs and compute everything
/// else again. The plan keeps copies of UVs and indices, and no reference to the arrays. Several threads may
/// use a plan at the same time.
///
/// Parameters
/// ----------
/// positions, normals, uvs, indices, faces, method, mode, threshold, threads
///     As for generate_tangents.
#[pyclass(frozen, module = "darboux")]
pub struct Plan {
    plan: darboux::Plan,
    uvs: Vec<[f32; 2]>,
    indices: Option<Vec<u32>>,
    faces: FaceSizes,
    is_slow: bool,
    /// Memory that evaluations reuse. Simultaneous evaluations do not share it.
    context: Mutex<Context>,
}

/// The vertices of a moved mesh.
struct MovedVertices<'py> {
    positions: Rows<'py, 3>,
    normals: Rows<'py, 3>,
}

impl<'py> MovedVertices<'py> {
    fn new(positions: &Bound<'py, PyAny>, normals: &Bound<'py, PyAny>) -> PyResult<Self> {
        let positions = Rows::new("positions", "V", positions)?;
        Ok(Self { positions, normals: Rows::new("normals", "V", normals)? })
    }
}

impl Plan {
    /// The mesh with these positions and normals. Errors: the arrays do not fit.
    fn moved<'a>(&'a self, moved: &'a MovedVertices<'_>) -> PyResult<Mesh<'a>> {
        let indices = self.indices.as_ref().map_or(Indices::Unindexed, Indices::from);
        let (positions, normals) = (moved.positions.view()?, moved.normals.view()?);
        Mesh::with_faces(positions, normals, &self.uvs, indices, self.faces.view()).map_err(value_error)
    }

    fn corner_count(&self) -> usize {
        self.plan.base().corners.len()
    }
}

#[pymethods]
impl Plan {
    #[new]
    #[pyo3(signature = (positions, normals, uvs, indices=None, *, faces=None, method="mikktspace", mode="repaired", threshold=180.0, threads=None))]
    #[expect(clippy::too_many_arguments, reason = "Python passes them by name")]
    fn new(
        py: Python<'_>,
        positions: &Bound<'_, PyAny>,
        normals: &Bound<'_, PyAny>,
        uvs: &Bound<'_, PyAny>,
        indices: Option<&Bound<'_, PyAny>>,
        faces: Option<&Bound<'_, PyAny>>,
        method: &str,
        mode: &str,
        #[pyo3(from_py_with = degrees)] threshold: f32,
        threads: Option<Threads>,
    ) -> PyResult<Self> {
        let options = tangent_options(method, mode, threshold)?;
        let arrays = MeshArrays::new(positions, normals, uvs, indices, faces)?;
        let mesh = arrays.view()?;
        let size = (mesh.corner_count(), is_slow(&options));
        let plan = cancellable(py, threads, size, &mut Context::new(), |context| {
            darboux::Plan::new_with(&mesh, &options, context)
        })?;
        let (uvs, indices) = (arrays.uvs.packed()?.into_owned(), owned(mesh.indices()));
        let is_slow = is_slow(&options);
        Ok(Self { plan, uvs, indices, faces: arrays.faces, is_slow, context: Mutex::default() })
    }

    /// The tangents of the plan's own mesh: a new (C, 4) float32 array, the same as from generate_tangents.
    #[getter]
    fn base<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let tangents = py.detach(|| self.plan.base().corners.per_corner().to_vec());
        Ok(rows_array(py, tangents)?.into_any())
    }

    /// The report on the plan's own mesh.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        results::report(py, &self.plan.base().report)
    }

    /// Compute the tangents of the moved mesh with the groups, subgroups and signs of the plan.
    ///
    /// Parameters
    /// ----------
    /// positions, normals : (V, 3) array_like
    ///     Of the moved vertices, in the same order.
    /// threads, out
    ///     As for generate_tangents. With `out`, nothing is allocated unless some vertices need the exact
    ///     stages.
    ///
    /// Returns
    /// -------
    /// (C, 4) float32 array
    ///
    /// Raises
    /// ------
    /// TypeError, ValueError
    ///     As for generate_tangents; the number of vertices differs.
    #[pyo3(signature = (positions, normals, *, threads=None, out=None))]
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
        normals: &Bound<'py, PyAny>,
        threads: Option<Threads>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let moved = MovedVertices::new(positions, normals)?;
        let mesh = self.moved(&moved)?;
        let size = (self.corner_count(), self.is_slow);
        let filled = Target::new(py, out, self.corner_count())?.fill(py, |out| {
            let (mut own, mut kept) = (Context::new(), self.context.try_lock().ok());
            let context = kept.as_deref_mut().unwrap_or(&mut own);
            cancellable(py, threads, size, context, |context| self.plan.write_tangents(&mesh, context, out))
        });
        filled.map(|(tangents, ())| tangents)
    }

    /// Count the corners for which a new run on the moved mesh gives other bits than evaluate.
    fn count_regrouped(
        &self,
        py: Python<'_>,
        positions: &Bound<'_, PyAny>,
        normals: &Bound<'_, PyAny>,
    ) -> PyResult<usize> {
        let moved = MovedVertices::new(positions, normals)?;
        let mesh = self.moved(&moved)?;
        let size = (self.corner_count(), self.is_slow);
        let count = |context: &mut Context| self.plan.count_regrouped_with(&mesh, context);
        cancellable(py, None, size, &mut Context::new(), count)
    }
}
