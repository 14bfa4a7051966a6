//! Tangents on a GPU.

use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, OnceLock, PoisonError};

use darboux::{Mesh, TangentOptions, Tangents};
use darboux_gpu::{AdapterKind, Generated, Gpu, MikkTSpace};

use crate::devices::Adapter;

/// What there is to say where no adapter is listed.
pub const NO_ADAPTERS: &str = "no GPU adapter was found";

/// The fastest adapter, with everything compiled.
pub struct Opened {
    pub name: String,
    /// Whether it is a CPU after all, and nobody was told yet.
    pub is_secretly_software: AtomicBool,
    /// One mesh at a time: several may be more than the adapter's memory holds.
    kernels: Mutex<MikkTSpace>,
}

/// Opens the fastest adapter, once for all files. Errors: there is none, or it cannot be used.
pub fn open() -> Result<&'static Opened, String> {
    static OPENED: OnceLock<Result<Opened, String>> = OnceLock::new();
    let open = || {
        let gpu = pollster::block_on(Gpu::open())?;
        let kernels = Mutex::new(MikkTSpace::new(&gpu)?);
        let is_secretly_software = AtomicBool::new(gpu.kind() == AdapterKind::Software);
        Ok(Opened { name: gpu.name, is_secretly_software, kernels })
    };
    let opened = OPENED.get_or_init(|| open().map_err(|error: darboux_gpu::GpuError| error.to_string()));
    opened.as_ref().map_err(Clone::clone)
}

impl Opened {
    /// One whose device is lost; none without an adapter.
    #[cfg(test)]
    pub fn lost() -> Option<Self> {
        let gpu = pollster::block_on(Gpu::open()).ok()?;
        let kernels = Mutex::new(MikkTSpace::new(&gpu).ok()?);
        gpu.device.destroy();
        Some(Self { name: gpu.name, is_secretly_software: AtomicBool::new(false), kernels })
    }

    /// Computes the tangents of a mesh; gives the number of corners that the CPU did. Errors: what stops the adapter.
    pub fn generate(
        &self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        out: &mut Tangents,
    ) -> Result<usize, String> {
        let kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        let made = kernels.generate_tangents(mesh, options).map_err(|error| error.to_string())?;
        let Generated { tangents, corners_of_cpu, .. } = made;
        *out = tangents;
        Ok(corners_of_cpu)
    }
}

/// All adapters, each tried out.
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
    pollster::block_on(Gpu::list()).into_iter().map(describe).collect()
}
