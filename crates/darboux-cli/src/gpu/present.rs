//! Opens the fastest adapter once per process and computes MikkTSpace tangents on it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use darboux::{Context, Mesh, TangentOptions, Tangents};
use darboux_gpu::{AdapterKind, Gpu, GpuTangents, MikkTSpace};

use super::adapter::Adapter;
use super::driver_messages::without_driver_messages;

/// The fastest adapter, with its compute pipelines compiled.
pub struct OpenGpu {
    name: String,
    /// True until the warning that this adapter is software was taken; false for hardware.
    is_software_unreported: AtomicBool,
    /// Locked for each mesh: several meshes at once may need more memory than the adapter has.
    pipelines: Mutex<MikkTSpace>,
}

/// Opens the fastest adapter; later calls return the same one. Errors: no adapter exists, or the adapter
/// cannot be used.
pub fn open() -> Result<&'static OpenGpu, String> {
    static OPENED: OnceLock<Result<OpenGpu, String>> = OnceLock::new();
    let open = || {
        let gpu = without_driver_messages(|| pollster::block_on(Gpu::open()))?;
        let pipelines = Mutex::new(MikkTSpace::new(&gpu)?);
        let is_software_unreported = AtomicBool::new(gpu.kind() == AdapterKind::Software);
        Ok(OpenGpu { name: gpu.name, is_software_unreported, pipelines })
    };
    let opened = OPENED.get_or_init(|| open().map_err(|error: darboux_gpu::GpuError| error.to_string()));
    opened.as_ref().map_err(Clone::clone)
}

/// Opens the adapter before other threads print, because standard error is redirected meanwhile. [`open`]
/// returns the errors.
pub fn open_early() -> Result<(), String> {
    let _returned_by_open = open();
    Ok(())
}

impl OpenGpu {
    /// A GPU whose device was lost; `None` without an adapter.
    #[cfg(test)]
    pub fn lost() -> Option<Self> {
        let gpu = pollster::block_on(Gpu::open()).ok()?;
        let pipelines = Mutex::new(MikkTSpace::new(&gpu).ok()?);
        gpu.device.destroy();
        Some(Self { name: gpu.name, is_software_unreported: AtomicBool::new(false), pipelines })
    }

    /// The name of the adapter.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The warning that the adapter is software: once per process, and never for hardware.
    pub fn take_software_warning(&self) -> Option<String> {
        let is_due = self.is_software_unreported.swap(false, Ordering::Relaxed);
        is_due.then(|| {
            format!("{} is a software adapter; --device cpu gives the same bits in less time", self.name)
        })
    }

    /// Computes the tangents of a mesh and returns the number of corners that the CPU computed. Errors: the
    /// adapter fails; the context's token was cancelled.
    pub fn generate(
        &self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
        out: &mut Tangents,
    ) -> Result<usize, String> {
        let pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        let generated = pipelines.generate_tangents_with(mesh, options, context);
        let GpuTangents { tangents, cpu_corners, .. } = generated.map_err(|error| error.to_string())?;
        *out = tangents;
        Ok(cpu_corners)
    }
}

/// Lists all adapters; each is opened to find out whether it can be used.
pub fn adapters() -> Vec<Adapter> {
    let describe = |(summary, gpu): (darboux_gpu::AdapterSummary, Result<Gpu, _>)| Adapter {
        triangle_limit: MikkTSpace::triangle_limit(&summary),
        problem: gpu.and_then(|gpu| MikkTSpace::new(&gpu)).err().map(|error| error.to_string()),
        kind: summary.kind.to_string(),
        name: summary.name,
        backend: summary.backend,
        driver: summary.driver,
        largest_binding: summary.largest_binding,
    };
    let list = || Ok::<_, std::convert::Infallible>(pollster::block_on(Gpu::list()));
    let Ok(adapters) = without_driver_messages(list);
    adapters.into_iter().map(describe).collect()
}
