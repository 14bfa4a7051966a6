//! Models that are read once, with the hierarchies over the high ones: for one bake, or for several with
//! other options.

use darboux::Context;
use darboux_bake::{
    Cages, HighModel, LowModel, LowModelOptions, LowSurface, ModelSurfaces, Models, PreparedSurfaces,
    cage_of, with_cages,
};
use darboux_io::gltf::{Document, PrimitiveCorners};
use self_cell::self_cell;

use crate::bake_settings::{Options, Setup, Surfaces, bake_settings, sentence, text};
use crate::reading::load_options;

type Corners<'a> = Vec<Vec<PrimitiveCorners<'a>>>;

struct Prepared<'a> {
    /// Without cages, which depend on the distance of rays.
    low: Vec<LowSurface<'a>>,
    surfaces: PreparedSurfaces<'a>,
}

self_cell! {
    struct ReadFiles {
        owner: Vec<Document>,
        #[covariant]
        dependent: Corners,
    }
}

self_cell! {
    struct ReadModels {
        owner: ReadFiles,
        #[covariant]
        dependent: Models,
    }
}

self_cell! {
    struct ReadSurfaces {
        owner: ReadModels,
        #[covariant]
        dependent: Prepared,
    }
}

/// Models, with all that does not depend on the options of a bake but the choice of the maps, of the material
/// and UVs of the low model, and of what counts on the high ones.
pub struct PreparedModels {
    surfaces: ReadSurfaces,
    /// What was left out.
    warnings: Vec<String>,
}

impl PreparedModels {
    /// Reads the low model, then the high ones. Errors: one sentence.
    pub fn read(files: Vec<Vec<u8>>, options: &Options, context: &Context) -> Result<Self, String> {
        let read = ReadFiles::try_new(open_all(files)?, |documents| {
            documents.iter().map(Document::corners).collect::<Result<_, _>>().map_err(sentence)
        })?;
        let models = ReadModels::try_new(read, |read| read_models(read, options))?;
        let mut warnings = models.borrow_dependent().warnings();
        let surfaces = ReadSurfaces::try_new(models, |models| {
            prepare(models.borrow_dependent(), options, &mut warnings, context)
        })?;
        Ok(Self { surfaces, warnings })
    }

    /// Works on the surfaces, with the cage and the settings of a bake. `cage`: the bytes of a given one.
    /// Errors: one sentence.
    pub fn with_surfaces<T>(
        &self,
        cage: Option<Vec<u8>>,
        options: &Options,
        context: &mut Context,
        work: impl FnOnce(Surfaces<'_>, &mut Context) -> Result<T, String>,
    ) -> Result<(T, Setup), String> {
        let models = self.surfaces.borrow_owner().borrow_dependent();
        let Models { low, highs } = models;
        let Prepared { low: without_cage, surfaces } = self.surfaces.borrow_dependent();
        let id_names = HighModel::names_of_all(highs, options.id_from.0);
        let origin = options.ray_origin()?;
        bake_settings(options, origin.distance(low.diagonal()))?.check().map_err(text)?;
        let cages = match cage {
            Some(file) => {
                let positions = cage_of(&open("the cage", file)?, without_cage).map_err(sentence)?;
                Cages { positions, distance: origin.distance(low.diagonal()) }
            }
            None => origin.cages(low.diagonal(), without_cage, surfaces, context).map_err(text)?,
        };
        let setup = Setup {
            diagonal: low.diagonal(),
            distance: cages.distance,
            warnings: self.warnings.clone(),
            misfit: models.misfit(),
            id_names: id_names.into_iter().map(str::to_owned).collect(),
            part_names: low.names().map(str::to_owned).collect(),
        };
        let settings = &bake_settings(options, setup.distance)?;
        let caged = with_cages(without_cage, &cages.positions).map_err(text)?;
        let caged = options.straightened(caged)?;
        let surfaces = &surfaces.with_low(&caged, context).map_err(text)?;
        Ok((work(Surfaces { prepared: surfaces, settings }, context)?, setup))
    }
}

fn read_models<'a>(files: &'a ReadFiles, options: &Options) -> Result<Models<'a>, String> {
    let no_model = || "there is no model to bake";
    let (low, highs) = files.borrow_owner().split_first().ok_or_else(no_model)?;
    let (low_corners, high_corners) = files.borrow_dependent().split_first().ok_or_else(no_model)?;
    Models::read((low, low_corners), (highs, high_corners), &low_options(options), &options.high_options()?)
        .map_err(sentence)
}

/// Groups parts by name if that was chosen; `warnings` receives those without a partner.
fn prepare<'a>(
    models: &'a Models<'a>,
    options: &Options,
    warnings: &mut Vec<String>,
    context: &Context,
) -> Result<Prepared<'a>, String> {
    let surfaces = models.surfaces(options.part_match.0).map_err(|error| error.to_string())?;
    let ModelSurfaces { low, highs, warnings: of_names } = surfaces;
    warnings.extend(of_names);
    let surfaces = PreparedSurfaces::new(&low, &highs, None, context).map_err(text)?;
    Ok(Prepared { low, surfaces })
}

/// Reads the low model and works on its surfaces. Errors: one sentence.
pub fn with_low_model<T>(
    file: Vec<u8>,
    options: &Options,
    work: impl FnOnce(&[LowSurface<'_>]) -> Result<T, String>,
) -> Result<T, String> {
    let document = open("the model", file)?;
    let corners = document.corners().map_err(sentence)?;
    let low = LowModel::read(&document, &corners, &low_options(options)).map_err(sentence)?;
    work(&low.surfaces().map_err(sentence)?)
}

fn low_options(options: &Options) -> LowModelOptions {
    LowModelOptions::default().with_uv_set(options.uv_set).with_material(options.material)
}

fn open_all(files: Vec<Vec<u8>>) -> Result<Vec<Document>, String> {
    let name = |place| if place == 0 { "the low model" } else { "the high model" };
    files.into_iter().enumerate().map(|(place, file)| open(name(place), file)).collect()
}

fn open(name: &str, file: Vec<u8>) -> Result<Document, String> {
    Document::from_bytes(name, file, None, &load_options()).map_err(sentence)
}
