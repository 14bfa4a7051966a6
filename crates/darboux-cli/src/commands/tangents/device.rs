//! Computes the tangents of one file on the CPU or on a GPU, as `--device` asks.

use darboux::{Context, Mesh, Method, TangentOptions, Tangents, generate_tangents_with};

use super::arguments::Device;
use super::summary::DeviceReport;
use crate::gpu::{self, OpenGpu};

/// The device that computes the tangents of one file.
pub struct TangentDevice {
    device: Device,
    /// The GPU; `None` until it is first needed.
    opened: Option<Result<&'static OpenGpu, String>>,
    /// [`Device::Auto`] uses the GPU for meshes with at least this many triangles.
    gpu_threshold: usize,
    corners_of_gpu: usize,
    /// Why the CPU computed tangents instead of the GPU.
    gpu_error: Option<String>,
}

/// The environment variable with the number of triangles from which [`Device::Auto`] uses the GPU.
const THRESHOLD_VARIABLE: &str = "DARBOUX_GPU_TRIANGLES";

/// True if [`Device::Auto`] can choose a GPU in this process.
pub fn may_use_gpu() -> bool {
    std::env::var_os(THRESHOLD_VARIABLE).is_some()
}

impl TangentDevice {
    /// Errors: `device` is [`Device::Gpu`] and no GPU can be used; the environment variable is not a number.
    pub fn new(device: Device) -> Result<Self, String> {
        let opened = (device == Device::Gpu).then(gpu::open);
        if let Some(Err(why)) = opened {
            return Err(why);
        }
        Ok(Self { device, opened, gpu_threshold: gpu_threshold()?, corners_of_gpu: 0, gpu_error: None })
    }

    /// True if [`TangentDevice::generate`] can use the GPU for a mesh of any size.
    pub fn may_use_gpu(&self) -> bool {
        self.device == Device::Gpu || (self.device == Device::Auto && self.gpu_threshold < usize::MAX)
    }

    /// As [`generate_tangents_with`]. Errors: the GPU fails and `device` is [`Device::Gpu`]; otherwise the
    /// CPU takes over.
    pub fn generate(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
    ) -> Result<Tangents, String> {
        if self.wants_gpu(mesh, options) {
            match self.generate_on_gpu(mesh, options, context) {
                Err(why) if self.device == Device::Auto => self.gpu_error = Some(why),
                done => return done,
            }
        }
        generate_tangents_with(mesh, options, context).map_err(|error| error.to_string())
    }

    fn wants_gpu(&self, mesh: &Mesh<'_>, options: &TangentOptions) -> bool {
        let is_mikktspace = matches!(options.method, Method::MikkTSpace(_));
        let is_large = mesh.face_count() >= self.gpu_threshold;
        match self.device {
            Device::Cpu => false,
            Device::Gpu => true,
            Device::Auto => is_mikktspace && is_large && self.gpu_error.is_none(),
        }
    }

    fn generate_on_gpu(
        &mut self,
        mesh: &Mesh<'_>,
        options: &TangentOptions,
        context: &mut Context,
    ) -> Result<Tangents, String> {
        let opened = self.opened.get_or_insert_with(gpu::open).as_ref().map_err(Clone::clone)?;
        let mut tangents = Tangents::default();
        let cpu_corners = opened.generate(mesh, options, context, &mut tangents)?;
        self.corners_of_gpu += mesh.corner_count() - cpu_corners;
        Ok(tangents)
    }

    /// A warning if the CPU replaced the GPU, or, once per process, if the GPU is software.
    pub fn warning(&self) -> Option<String> {
        if let Some(why) = &self.gpu_error {
            return Some(format!("the CPU computed the tangents because the GPU failed: {why}"));
        }
        let Some(Ok(opened)) = &self.opened else { return None };
        opened.take_software_warning()
    }

    /// `corners`: the number of computed corners, including those of morphed meshes, which the CPU always
    /// computes.
    pub fn report(&self, corners: usize) -> DeviceReport {
        match &self.opened {
            Some(Ok(opened)) => DeviceReport {
                kind: "gpu",
                adapter: Some(opened.name().to_owned()),
                corners,
                cpu_corners: corners - self.corners_of_gpu,
            },
            _ => DeviceReport { kind: "cpu", adapter: None, corners, cpu_corners: corners },
        }
    }
}

/// Reads the environment variable. Errors: it is set and not a number.
fn gpu_threshold() -> Result<usize, String> {
    let Some(given) = std::env::var_os(THRESHOLD_VARIABLE) else { return Ok(usize::MAX) };
    let number = given.to_str().and_then(|text| text.parse().ok());
    number.ok_or_else(|| {
        let given = given.display();
        format!("{THRESHOLD_VARIABLE} is {given}: set it to a number of triangles, or unset it")
    })
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;

    /// A GPU whose device was lost; `None` without an adapter.
    fn lost() -> Option<&'static OpenGpu> {
        Some(Box::leak(Box::new(OpenGpu::lost()?)))
    }

    fn tangent_device(device: Device, opened: &'static OpenGpu) -> TangentDevice {
        TangentDevice {
            device,
            opened: Some(Ok(opened)),
            gpu_threshold: 1,
            corners_of_gpu: 0,
            gpu_error: None,
        }
    }

    #[test]
    fn auto_falls_back_to_the_cpu_with_a_warning() {
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
            warning.starts_with("the CPU computed the tangents because the GPU failed: the GPU was lost"),
            "{warning}"
        );
        assert_eq!(auto.report(3).cpu_corners, 3);
        let asked = run(&mut tangent_device(Device::Gpu, opened)).err();
        assert!(asked.is_some_and(|why| why.starts_with("the GPU was lost")));
    }
}
