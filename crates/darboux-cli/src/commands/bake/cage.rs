//! Where rays begin: at a distance along the normals, on a cage that is made here, or on one that is a file.

use darboux::Context;
use darboux_bake::{
    AutoCageOptions, BakeError, LowModel, LowSurface, PreparedSurfaces, auto_cage, cage_of,
    default_cage_offset, default_cage_reach, inflated_cage, inflated_cage_by, with_cages,
};
use darboux_io::gltf::Document;
use serde::Serialize;

use super::arguments::BakeArguments;

/// How rays are chosen. In the models' unit.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Rays {
    Normals {
        outwards: f32,
        inwards: f32,
    },
    Cage {
        offset: f32,
        is_default: bool,
    },
    CageFile {
        inwards: f32,
    },
    /// The cage is made for the models: `share` as of the command line, `reach` the largest offset, `least`
    /// and `most` those found.
    AutoCage {
        share: f32,
        reach: f32,
        least: f32,
        most: f32,
        inwards: f32,
    },
}

impl Rays {
    /// The choice of the command line; a distance from the model's size without one.
    pub fn choose(arguments: &BakeArguments, low: &LowModel<'_>) -> Self {
        let by_size = default_cage_offset(low.diagonal());
        if let Some(share) = arguments.auto_cage {
            let reach = arguments.cage_offset.unwrap_or(default_cage_reach(low.diagonal()));
            return Self::AutoCage { share, reach, least: 0.0, most: reach, inwards: reach };
        }
        let offset = arguments.cage_offset.unwrap_or(by_size);
        match (arguments.distance, &arguments.cage) {
            (Some([outwards, inwards]), _) => Self::Normals { outwards, inwards },
            (None, Some(_)) => Self::CageFile { inwards: offset },
            (None, None) => Self::Cage { offset, is_default: arguments.cage_offset.is_none() },
        }
    }

    /// The distances of the library.
    pub fn distance(&self) -> [f32; 2] {
        match *self {
            Self::Normals { outwards, inwards } => [outwards, inwards],
            Self::Cage { offset, .. } => [offset; 2],
            Self::CageFile { inwards } | Self::AutoCage { inwards, .. } => [0.0, inwards],
        }
    }

    /// A clause about the rays.
    pub fn describe(&self) -> String {
        match self {
            Self::Normals { outwards, inwards } => {
                let [outwards, inwards] = [outwards, inwards].map(|distance| rounded(*distance));
                format!("rays along normals from {outwards} outside to {inwards} inside")
            }
            Self::Cage { offset, is_default } => {
                let why = if *is_default { ", 2 % of the model's diagonal" } else { "" };
                format!("a cage at a distance of {}{why}", rounded(*offset))
            }
            Self::CageFile { inwards } => format!("a cage from a file, to {} inside", rounded(*inwards)),
            Self::AutoCage { share, least, most, inwards, .. } => {
                let [least, most, inwards] = [least, most, inwards].map(|distance| rounded(*distance));
                format!(
                    "a cage at {least} to {most}, which all but {share} of the rays allow, to {inwards} \
                     inside"
                )
            }
        }
    }
}

/// A distance with four significant digits.
fn rounded(distance: f32) -> f64 {
    format!("{distance:.3e}").parse().unwrap_or(f64::from(distance))
}

/// The positions of the cages of all surfaces; empty where rays follow normals.
pub struct CagePositions(pub Vec<Vec<[f32; 3]>>);

impl CagePositions {
    /// Makes or reads the cages; fills in what an automatic cage has found. `file`: of `--cage`; `low`: the
    /// low surfaces of `prepared`, without cages. Errors are one sentence each.
    pub fn read(
        arguments: &BakeArguments,
        file: Option<&Document>,
        rays: &mut Rays,
        model: &LowModel<'_>,
        low: &[LowSurface<'_>],
        prepared: &PreparedSurfaces<'_>,
        context: &mut Context,
    ) -> Result<Self, String> {
        match (rays, file) {
            (Rays::Normals { .. }, _) => Ok(Self(Vec::new())),
            (Rays::CageFile { .. }, Some(document)) => {
                cage_of(document, low).map(Self).map_err(|error| error.to_string())
            }
            (Rays::AutoCage { share, reach, least, most, inwards }, _) => {
                let cage = auto_cage(prepared, &AutoCageOptions::new(*share, *reach), context);
                let cage = cage.map_err(|error| error.to_string())?;
                ([*least, *most], *inwards) = (cage.offsets, cage.inwards);
                Ok(Self(cage.positions))
            }
            (rays, _) => Self::inflated(arguments, rays.distance()[0], model, low),
        }
    }

    fn inflated(
        arguments: &BakeArguments,
        offset: f32,
        model: &LowModel<'_>,
        low: &[LowSurface<'_>],
    ) -> Result<Self, String> {
        let cage = |(surface, colors): (&LowSurface<'_>, Option<&[[f32; 4]]>)| {
            let cage = match colors {
                Some(colors) if arguments.offset_colors => {
                    let offsets: Vec<f32> = colors.iter().map(|color| offset * color[0]).collect();
                    inflated_cage_by(surface.mesh(), &offsets)
                }
                None if arguments.offset_colors => {
                    return Err(format!(
                        "{}: has triangles without vertex colours, which --offset-colors needs; paint them, \
                         or leave the option out",
                        arguments.low.display()
                    ));
                }
                _ => inflated_cage(surface.mesh(), offset),
            };
            cage.map_err(|error| error.to_string())
        };
        low.iter().zip(model.colors()).map(cage).collect::<Result<_, String>>().map(Self)
    }

    /// A warning where a cage from a file lies far from the low model, as if its vertices were in another
    /// order. `diagonal`: of the low model.
    pub fn warning(&self, file: &Document, low: &[LowSurface<'_>], diagonal: f64) -> Option<String> {
        let moves = low.iter().zip(&self.0).flat_map(|(surface, cage)| {
            let positions = surface.mesh().positions();
            cage.iter().enumerate().map(move |(vertex, moved)| {
                let from = positions.get(vertex);
                let square = |axis: usize| (f64::from(moved[axis]) - f64::from(from[axis])).powi(2);
                square(0) + square(1) + square(2)
            })
        });
        let farthest = moves.fold(0.0, f64::max).sqrt();
        (farthest > 0.5 * diagonal).then(|| {
            format!(
                "{}: the cage moves vertices of the low model by up to {farthest:.4}, more than half of its \
                 diagonal, {diagonal:.4}; if that is not meant, its vertices are in another order: export both \
                 from one program in one format",
                file.name()
            )
        })
    }

    /// The surfaces with their cages.
    pub fn around<'a>(&'a self, low: Vec<LowSurface<'a>>) -> Result<Vec<LowSurface<'a>>, BakeError> {
        with_cages(&low, &self.0)
    }
}
