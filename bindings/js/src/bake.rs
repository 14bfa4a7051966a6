//! `bakeModels` of `darboux/bake`: maps of a low model from the detail of high ones; and what its other
//! functions share with it.

use std::collections::BTreeMap;
use std::mem::take;

use darboux::{Choice, Context};
use darboux_bake::{BakeProgress, BakeReport, Baked, IdColor, MapKind};
use serde::Serialize;

use crate::arena::with_arena;
use crate::bake_arrays::BakeArrays;
use crate::bake_settings::{Options, Setup, Surfaces, bake_settings, read_options, text};
use crate::inputs::resized;
use crate::options::choice;
use crate::prepared_models::PreparedModels;

#[cfg(target_family = "wasm")]
#[link(wasm_import_module = "darboux")]
unsafe extern "C" {
    /// Receives the rows of blocks that are finished, and all rows.
    safe fn progress(done: usize, total: usize);
}

/// Receives the rows of blocks that are finished, and all rows. Only JavaScript has a receiver.
#[cfg(not(target_family = "wasm"))]
fn progress(_done: usize, _total: usize) {}

/// Forgets the models of the call before.
#[unsafe(no_mangle)]
pub extern "C" fn begin_bake() {
    with_arena(|arena| arena.bake.clear_models());
}

/// The bytes of the next file: the low model, then the high ones, then a cage, of which the options tell.
#[unsafe(no_mangle)]
pub extern "C" fn model_bytes(bytes: usize) -> *mut u8 {
    with_arena(|arena| {
        let files = &mut arena.bake.files;
        files.push(Vec::new());
        files.last_mut().map_or(std::ptr::null_mut(), |file| resized(file, bytes))
    })
}

/// The options, as the JSON of [`Options`].
#[unsafe(no_mangle)]
pub extern "C" fn bake_options(bytes: usize) -> *mut u8 {
    with_arena(|arena| resized(&mut arena.bake.options, bytes))
}

/// The number of bytes of the last report.
#[unsafe(no_mangle)]
pub extern "C" fn json_length() -> usize {
    with_arena(|arena| arena.bake.json.len())
}

/// The address of an image, by the code of its [`MapKind`]; null where it was not chosen.
#[unsafe(no_mangle)]
pub extern "C" fn baked_image(kind: u32) -> *const f32 {
    with_arena(|arena| {
        let numbers = arena.bake.images.numbers(choice(kind));
        numbers.map_or(std::ptr::null(), <[f32]>::as_ptr)
    })
}

/// The address of the states of all texels.
#[unsafe(no_mangle)]
pub extern "C" fn baked_states() -> *const u8 {
    with_arena(|arena| arena.bake.states.as_ptr())
}

/// What a bake reports beside its images.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Report {
    pub counts: BakeReport,
    pub diagonal: f64,
    pub distance: [f32; 2],
    pub warnings: Vec<String>,
    /// What the colours of maps stand for, by the names of the maps.
    pub legends: BTreeMap<&'static str, Vec<LegendEntry>>,
}

/// A colour of a map, and what it stands for.
#[derive(Serialize)]
pub struct LegendEntry {
    id: u32,
    name: Option<String>,
    color: [u8; 3],
    texels: u64,
}

impl Report {
    pub fn new(baked: &Baked, setup: Setup) -> Self {
        let Setup { diagonal, distance, mut warnings, misfit, id_names, .. } = setup;
        warnings.extend(baked.report.warning_of_misses(misfit.as_deref()));
        let legends = legends(baked, &id_names);
        Self { counts: baked.report, diagonal, distance, warnings, legends }
    }
}

/// The legends of a bake. `names`: of what the colours of [`MapKind::Id`] stand for.
fn legends(baked: &Baked, names: &[String]) -> BTreeMap<&'static str, Vec<LegendEntry>> {
    let entry = |kind: MapKind, color: &IdColor| LegendEntry {
        id: color.id,
        name: names.get(color.id as usize).filter(|_| kind == MapKind::Id).cloned(),
        color: color.color,
        texels: color.texels,
    };
    let of_map = |(kind, colors): &(MapKind, Vec<IdColor>)| {
        (kind.name(), colors.iter().map(|color| entry(*kind, color)).collect())
    };
    baked.legends.iter().map(of_map).collect()
}

/// A report, or one sentence why there is none.
#[derive(Serialize)]
pub enum Outcome<R> {
    #[serde(rename = "report")]
    Report(R),
    #[serde(rename = "error")]
    Error(String),
}

/// Bakes the models in the arena. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn bake_models() -> *const u8 {
    with_arena(|arena| {
        let arrays = &mut arena.bake;
        let files = take(&mut arrays.files);
        let result = with_models(files, &arrays.options, &mut arena.context, bake_surfaces);
        put_baked(arrays, result)
    })
}

/// Reads and keeps the models in the arena, in place of those that were kept. Returns the address of the
/// JSON.
#[unsafe(no_mangle)]
pub extern "C" fn prepare_models() -> *const u8 {
    with_arena(|arena| {
        let arrays = &mut arena.bake;
        let files = take(&mut arrays.files);
        let result = read_options(&arrays.options)
            .and_then(|options| PreparedModels::read(files, &options, &arena.context));
        let outcome = match result {
            Ok(prepared) => {
                arrays.prepared = Some(prepared);
                Outcome::Report(())
            }
            Err(sentence) => Outcome::Error(sentence),
        };
        arrays.put_json(&outcome)
    })
}

/// Bakes the models that were kept. Returns the address of the JSON.
#[unsafe(no_mangle)]
pub extern "C" fn bake_prepared_models() -> *const u8 {
    with_arena(|arena| {
        let arrays = &mut arena.bake;
        let mut files = take(&mut arrays.files);
        let result = read_options(&arrays.options).and_then(|options| {
            let cage = cage_among(&mut files, &options);
            let prepared = arrays.prepared.as_ref().ok_or("no models were prepared")?;
            prepared.with_surfaces(cage, &options, &mut arena.context, bake_surfaces)
        });
        put_baked(arrays, result)
    })
}

/// Bakes surfaces. Errors: one sentence.
pub fn bake_surfaces(surfaces: Surfaces<'_>, context: &mut Context) -> Result<Baked, String> {
    surfaces.prepared.bake(surfaces.settings, context, &mut tell).map_err(text)
}

/// Keeps the images and the report of a bake, or the sentence why there is none. Returns the address of the
/// JSON.
pub fn put_baked(arrays: &mut BakeArrays, result: Result<(Baked, Setup), String>) -> *const u8 {
    let outcome = match result {
        Ok((baked, setup)) => {
            let report = Report::new(&baked, setup);
            arrays.states = baked.images.states.iter().map(|state| state.number()).collect();
            arrays.images = baked.images;
            Outcome::Report(report)
        }
        Err(sentence) => Outcome::Error(sentence),
    };
    arrays.put_json(&outcome)
}

/// Tells JavaScript how much is done.
pub fn tell(BakeProgress { done, total }: BakeProgress) {
    progress(done, total);
}

/// Takes the last of the files, if the options say that it is a cage.
fn cage_among(files: &mut Vec<Vec<u8>>, options: &Options) -> Option<Vec<u8>> {
    if options.has_cage { files.pop() } else { None }
}

/// Reads the models and works on their surfaces. Errors: one sentence.
pub fn with_models<T>(
    mut files: Vec<Vec<u8>>,
    options: &[u8],
    context: &mut Context,
    work: impl FnOnce(Surfaces<'_>, &mut Context) -> Result<T, String>,
) -> Result<(T, Setup), String> {
    let options = read_options(options)?;
    let cage = cage_among(&mut files, &options);
    // Wrong options are told before the work on the models.
    let origin = options.ray_origin()?;
    origin.check().map_err(text)?;
    bake_settings(&options, origin.distance(1.0))?.check().map_err(text)?;
    options.high_options()?;
    PreparedModels::read(files, &options, context)?.with_surfaces(cage, &options, context, work)
}
