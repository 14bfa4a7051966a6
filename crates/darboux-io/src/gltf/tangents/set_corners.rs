//! [`Document::set_corner_tangents`].

use darboux::Context;

use super::compute::Generate;
use super::given::{GivenPlaces, GivenTangents};
use super::options::AddTangentsOptions;
use super::{TangentsOutcome, run};
use crate::Error;
use crate::gltf::{Document, PrimitiveName};

impl Document {
    /// Gives the corners of primitives tangents. Vertices whose corners get different ones are split;
    /// primitives that share vertices share the new ones. All other primitives keep what they have.
    ///
    /// `given`: the last tangents count of a primitive that is named twice. Errors: primitives without
    /// positions, normals or the UVs of their materials, with morph targets, or with another number of
    /// corners; more corners than the memory limit permits. After an error the document is unspecified:
    /// drop it.
    ///
    /// ```
    /// use darboux_io::gltf::{Document, GivenTangents, PrimitiveName};
    /// use darboux_io::{Error, LoadOptions};
    ///
    /// # fn main() -> Result<(), Error> {
    /// # let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/TwoSidedPlane/TwoSidedPlane.gltf");
    /// let mut document = Document::open(model.as_ref(), &LoadOptions::default())?;
    /// let primitives = [PrimitiveName { mesh: 0, mesh_name: None, primitive: 0 }];
    /// let tangents = [[1.0, 0.0, 0.0, 1.0]; 6];
    /// document.set_corner_tangents(&[GivenTangents { primitives: &primitives, tangents: &tangents }])?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_corner_tangents(&mut self, given: &[GivenTangents<'_>]) -> Result<(), Error> {
        let places = GivenPlaces::new(given);
        for name in given.iter().flat_map(|given| given.primitives) {
            if !self.primitive(name)?.targets.is_empty() {
                let sentence =
                    "has morph targets, whose offsets follow from computed tangents; compute its tangents";
                return Err(self.invalid(name.path(), sentence));
            }
        }
        let options = AddTangentsOptions::default().with_overwrite(true);
        let is_wanted = |name: &PrimitiveName| places.of(name).is_some();
        let by = (&mut Context::new(), Generate::OnCpu);
        let summary = run(self, &options, &is_wanted, &places, by, &mut |_| {})?;
        let skipped = summary.primitives.iter().find_map(|primitive| match &primitive.outcome {
            TangentsOutcome::Written(_) => None,
            TangentsOutcome::Kept { reason } | TangentsOutcome::Skipped { reason } => {
                Some((&primitive.name, reason))
            }
        });
        match skipped {
            Some((name, reason)) => Err(self.invalid(name.path(), format!("gets no tangents: {reason}"))),
            None => Ok(()),
        }
    }
}
