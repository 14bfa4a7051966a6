//! The part of a file's report that only `darboux tangents` has. json.txt documents its fields.

use darboux_io::gltf::{PrimitiveNormals, TangentsSummary};
use indicatif::HumanCount;
use serde::Serialize;

/// The report of a file.
#[derive(Default, Serialize)]
pub struct TangentsFileSummary {
    #[serde(flatten)]
    pub tangents: TangentsSummary,
    /// What `--normals` did; `None` for `--normals keep`.
    pub normals: Option<Vec<PrimitiveNormals>>,
    /// Which device computed the tangents.
    pub device: Option<DeviceReport>,
}

/// Which device computed how many corners of a file.
#[derive(Serialize)]
pub struct DeviceReport {
    pub kind: &'static str,
    pub adapter: Option<String>,
    pub corners: usize,
    pub cpu_corners: usize,
}

impl DeviceReport {
    /// One line for a terminal; `None` if the CPU computed everything.
    pub fn line(&self) -> Option<String> {
        let (of_cpu, all) = (HumanCount(self.cpu_corners as u64), HumanCount(self.corners as u64));
        (self.corners > 0).then_some(())?;
        Some(format!("on {}; {of_cpu} of {all} corners on the CPU", self.adapter.as_ref()?))
    }
}
