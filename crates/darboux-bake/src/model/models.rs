//! [`Models`]: the low model and the high models of a bake, with their surfaces.

use std::fmt;

use darboux::choice;
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners};

use super::{HighModel, HighModelOptions, LowModel, LowModelOptions, group_by_name};
use crate::{BakeError, HighSurface, LowSurface};

/// Which high parts the rays of a low part can hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PartMatch {
    /// All of them.
    #[default]
    Nearest,
    /// Those of the same name.
    Name,
}

choice! { PartMatch, "match",
    Nearest => "nearest", "All of them: the first that a ray meets";
    Name => "name", "Those of the same name: crate_low gets the detail of crate_high and crate_high_bolts. \
         The names of nodes count, or else of meshes";
}

/// The low model and the high models of a bake.
#[derive(Debug)]
pub struct Models<'a> {
    /// Receives the detail.
    pub low: LowModel<'a>,
    /// Have the detail.
    pub highs: Vec<HighModel<'a>>,
}

/// The surfaces of [`Models`].
#[derive(Debug)]
pub struct ModelSurfaces<'a> {
    /// Of the low model.
    pub low: Vec<LowSurface<'a>>,
    /// Of all high models.
    pub highs: Vec<HighSurface<'a>>,
    /// What [`PartMatch::Name`] leaves without a partner, one sentence each.
    pub warnings: Vec<String>,
}

/// Why models were not baked.
#[derive(Debug)]
#[non_exhaustive]
pub enum ModelsError {
    /// A file cannot be read, or its data is invalid.
    File(Error),
    /// No part of the high models has the name of a part of the low model: one sentence.
    NoPartners(String),
    /// The bake itself failed.
    Bake(BakeError),
}

impl<'a> Models<'a> {
    /// Reads the models: documents, each with its [`Document::corners`]. Errors: as of [`LowModel::read`] and
    /// [`HighModel::read`].
    pub fn read(
        low: (&'a Document, &'a [PrimitiveCorners<'a>]),
        highs: (&'a [Document], &'a [Vec<PrimitiveCorners<'a>>]),
        low_options: &LowModelOptions,
        high_options: &HighModelOptions,
    ) -> Result<Self, Error> {
        let low = LowModel::read(low.0, low.1, low_options)?;
        Ok(Self { low, highs: HighModel::read_all(highs.0, highs.1, high_options)? })
    }

    /// The surfaces, in groups where names decide. Errors: an index out of range; no names match.
    pub fn surfaces(&self, part_match: PartMatch) -> Result<ModelSurfaces<'_>, ModelsError> {
        let mut low = self.low.surfaces()?;
        let mut highs = HighModel::surfaces_of_all(&self.highs)?;
        let mut warnings = Vec::new();
        if part_match == PartMatch::Name {
            warnings = group_by_name((&self.low, &mut low), (&self.highs, &mut highs)).warnings();
            if highs.is_empty() {
                return Err(ModelsError::NoPartners(warnings.join("; ")));
            }
        }
        Ok(ModelSurfaces { low, highs, warnings })
    }

    /// What was left out of the models, and what they share, one sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let Self { low, highs } = self;
        let mut warnings: Vec<String> = highs.iter().flat_map(HighModel::warnings).cloned().collect();
        if low.without_uvs > 0 {
            warnings.push(format!(
                "{} primitives of the low model have no UVs and are not baked",
                low.without_uvs
            ));
        }
        if low.materials.len() > 1 {
            let count = low.materials.len();
            warnings.push(format!(
                "the {count} materials of the low model share one map; where their charts \
                 overlap, the first triangle wins"
            ));
        }
        warnings
    }
}

impl From<Error> for ModelsError {
    fn from(error: Error) -> Self {
        Self::File(error)
    }
}

impl From<BakeError> for ModelsError {
    fn from(error: BakeError) -> Self {
        Self::Bake(error)
    }
}

impl fmt::Display for ModelsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => error.fmt(f),
            Self::NoPartners(sentence) => f.write_str(sentence),
            Self::Bake(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ModelsError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::File(error) => Some(error),
            Self::NoPartners(_) => None,
            Self::Bake(error) => Some(error),
        }
    }
}
