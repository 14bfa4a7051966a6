//! Computes the tangents of one file on the CPU or on a GPU, as `--device` asks.

use std::sync::atomic::Ordering;

use darboux::{Context, Mesh, Method, TangentOptions, Tangents, generate_tangents_with};

use super::arguments::Device;
use super::summary::DeviceReport;
use crate::gpu::{self, OpenGpu};

/// What computes the tangents of one file.
pub struct TangentDevice {
    device: Device,
    /// The GPU, once it is wanted.
    opened: Option<Result<&'static OpenGpu, String>>,
    /// From this many triangles on [`Device::Auto`] wants it.
    least_for_gpu: usize,
    corners_of_gpu: usize,
    /// Why the CPU did what the GPU was to do.
    fault: Option<String>,
}

/// Set by those who have measured from how many triangles on their GPU is the quicker one.
const LEAST_FOR_GPU: &str = "DARBOUX_GPU_TRIANGLES";

impl TangentDevice {
    /// Errors: there is no GPU, and one is asked for; the environment has no number where there is to be one.
    pub fn new(device: Device) -> Result<Self, String> {
        let opened = (device == Device::Gpu).then(gpu::open);
        if let Some(Err(why)) = opened {
            return Err(why);
        }
        Ok(Self { device, opened, least_for_gpu: least_for_gpu()?, corners_of_gpu: 0, fault: None })
    }

    /// As [`generate_tangents_with`]. Errors: what stops the GPU, where that is asked for; else the CPU does the work.
    pub fn generate(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
    ) -> Result<Tangents, String> {
        if self.wants_gpu(mesh, options) {
            match self.generate_on_gpu(mesh, options) {
                Err(why) if self.device == Device::Auto => self.fault = Some(why),
                done => return done,
            }
        }
        generate_tangents_with(mesh, options, context).map_err(|error| error.to_string())
    }

    fn wants_gpu(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> bool {
        let is_mikktspace = matches!(options.method, Method::MikkTSpace(_));
        let is_large = mesh.face_count() >= self.least_for_gpu;
        match self.device {
            Device::Cpu => false,
            Device::Gpu => true,
            Device::Auto => is_mikktspace && is_large && self.fault.is_none(),
        }
    }

    fn generate_on_gpu(&mut self, mesh: &Mesh<'_>, options: &TangentOptions) -> Result<Tangents, String> {
        let opened = self.opened.get_or_insert_with(gpu::open).as_ref().map_err(Clone::clone)?;
        let mut tangents = Tangents::default();
        self.corners_of_gpu += mesh.corner_count() - opened.generate(mesh, options, &mut tangents)?;
        Ok(tangents)
    }

    /// What a user should know of it, in a sentence: why the CPU did the GPU's work; that the GPU is software, once for all files.
    pub fn warning(&self) -> Option<String> {
        if let Some(why) = &self.fault {
            return Some(format!("the CPU computed what the GPU was to compute: {why}"));
        }
        let Some(Ok(OpenGpu { name, is_software_unreported, .. })) = &self.opened else { return None };
        is_software_unreported
            .swap(false, Ordering::Relaxed)
            .then(|| format!("{name} is software: --device cpu gives the same bits sooner"))
    }

    /// `corners`: all that were computed, those of morphed meshes, which the CPU does, included.
    pub fn report(&self, corners: usize) -> DeviceReport {
        match &self.opened {
            Some(Ok(opened)) => DeviceReport {
                kind: "gpu",
                adapter: Some(opened.name.clone()),
                corners,
                corners_of_cpu: corners - self.corners_of_gpu,
            },
            _ => DeviceReport { kind: "cpu", adapter: None, corners, corners_of_cpu: corners },
        }
    }
}

/// Errors: the environment has something else than a number.
fn least_for_gpu() -> Result<usize, String> {
    let Some(given) = std::env::var_os(LEAST_FOR_GPU) else { return Ok(usize::MAX) };
    let number = given.to_str().and_then(|text| text.parse().ok());
    number.ok_or_else(|| {
        let given = given.display();
        format!("{LEAST_FOR_GPU} is {given}: set it to a number of triangles, or to nothing")
    })
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;

    /// A GPU that has just been lost; none without an adapter.
    fn lost() -> Option<&'static OpenGpu> {
        Some(Box::leak(Box::new(OpenGpu::lost()?)))
    }

    fn tangent_device(device: Device, opened: &'static OpenGpu) -> TangentDevice {
        TangentDevice { device, opened: Some(Ok(opened)), least_for_gpu: 1, corners_of_gpu: 0, fault: None }
    }

    #[test]
    fn where_a_gpu_is_lost_auto_takes_the_cpu_and_says_so() {
        let Some(opened) = lost() else { return };
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let uvs = positions.map(|[x, y, _]| [x, y]);
        let mesh = Mesh::triangles(&positions, &[[0.0, 0.0, 1.0]; 3], &uvs, &[0u32, 1, 2]).expect("a mesh");
        let options = TangentOptions::default();
        let run = |device: &mut TangentDevice| device.generate(&mesh, &options, &mut Context::new());
        let mut auto = tangent_device(Device::Auto, opened);
        let made = run(&mut auto).expect("tangents of the CPU");
        assert_eq!(made.corners.per_corner(), [[1.0, 0.0, 0.0, 1.0]; 3]);
        let warning = auto.warning().expect("a sentence");
        assert!(
            warning.starts_with("the CPU computed what the GPU was to compute: the GPU was lost"),
            "{warning}"
        );
        assert_eq!(auto.report(3).corners_of_cpu, 3);
        let asked = run(&mut tangent_device(Device::Gpu, opened)).err();
        assert!(asked.is_some_and(|why| why.starts_with("the GPU was lost")));
    }
}
