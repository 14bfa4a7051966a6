//! Two mistakes on one model, in both orders: what the check names, and what the repair leaves.

use std::collections::BTreeSet;

use darboux_check::{CheckOptions, Code, FixOptions, Severity, check_document, fix_document};
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;

use super::maps::{MAP_MISTAKES, MapMistake};
use super::mistakes::{MISTAKES, Mistake};
use super::models::{Model, healthy_models};
use super::table::codes;

/// A mistake in a model or in its map.
#[derive(Clone, Copy)]
pub enum Made {
    InModel(&'static Mistake),
    InMap(&'static MapMistake),
}

impl Made {
    pub fn code(self) -> Code {
        match self {
            Self::InModel(mistake) => mistake.code,
            Self::InMap(mistake) => mistake.code,
        }
    }

    pub fn how(self) -> &'static str {
        match self {
            Self::InModel(mistake) => mistake.how,
            Self::InMap(mistake) => mistake.how,
        }
    }

    /// The model with the mistake; none where it cannot be made.
    fn make(self, model: &Model) -> Option<Model> {
        let mut model = model.clone();
        match self {
            Self::InModel(mistake) => (mistake.make)(&mut model).then_some(model),
            Self::InMap(mistake) => {
                model.map = (mistake.make)(&model.map);
                Some(model)
            }
        }
    }
}

/// What came out for two mistakes.
pub enum Outcome {
    /// Both are named.
    BothNamed,
    /// The file has the bits of a healthy model, or of one with a single mistake, which is given; nothing of
    /// the other is left in it.
    SameFile(Option<Made>),
    /// One is not named, or none; which are, and what is named instead.
    Missed { named: [bool; 2], instead: BTreeSet<Code> },
}

/// Two mistakes, the second made after the first.
pub struct PairRow {
    pub made: [Made; 2],
    pub outcome: Outcome,
    /// What is wrong with the repair.
    pub failure: Option<String>,
}

/// All pairs in both orders: of mistakes in models, and of one in the model and one in the map, whose order
/// makes no difference.
pub fn all_pairs() -> Vec<[Made; 2]> {
    let in_models: Vec<Made> =
        MISTAKES.iter().filter(|mistake| is_paired(mistake)).map(Made::InModel).collect();
    let of_models = in_models.iter().enumerate().flat_map(|(number, &first)| {
        let others = in_models.iter().enumerate().filter(move |(other, _)| *other != number);
        others.map(move |(_, &second)| [first, second])
    });
    let with_maps = in_models
        .iter()
        .flat_map(|&first| MAP_MISTAKES.iter().map(move |second| [first, Made::InMap(second)]));
    of_models.chain(with_maps).collect()
}

/// Mistakes that are repaired make pairs; those that remove data leave nothing for another one, and normals
/// in other axes are left on models with tangents.
fn is_paired(mistake: &Mistake) -> bool {
    let others = [Code::TangentMissing, Code::NormalMissing, Code::NormalOtherAxes];
    mistake.code.repair().is_some() && !others.contains(&mistake.code)
}

/// Makes pairs, checks and repairs them, each on the first of two curved models with two UV sets, mirrored
/// and closed, on which both mistakes can be made; pairs that can be made on neither are left out.
pub fn rows(pairs: &[[Made; 2]]) -> Vec<PairRow> {
    let models = healthy_models();
    let models = ["mirrored sheared wavy grid", "wavy sphere"].map(|name| {
        let named = models.iter().find(|model| model.name == name && model.uv_set > 0);
        named.expect("a healthy model of that name")
    });
    let alone = models.map(singles);
    let row = |made: &[Made; 2]| {
        models.iter().zip(&alone).find_map(|(healthy, alone)| {
            let model = made[1].make(&made[0].make(healthy)?)?;
            Some(outcome(*made, &model, alone))
        })
    };
    pairs.iter().filter_map(row).collect()
}

/// The files with no mistake and with one.
fn singles(healthy: &Model) -> Vec<(Option<Made>, Vec<u8>)> {
    let in_models = MISTAKES.iter().map(Made::InModel);
    let one = in_models.filter_map(|made| Some((Some(made), made.make(healthy)?.glb())));
    [(None, healthy.glb())].into_iter().chain(one).collect()
}

fn outcome(made: [Made; 2], model: &Model, alone: &[(Option<Made>, Vec<u8>)]) -> PairRow {
    let glb = model.glb();
    let with_map = made.iter().any(|made| matches!(made, Made::InMap(_)));
    let options = CheckOptions::default().with_maps(with_map);
    let findings = check_document(&model.document(), &options).expect("a valid document");
    let all = codes(&findings, |_| true);
    let pair = made.map(Made::code);
    let failure = repair(&glb, &options).err();
    let same = alone.iter().find(|(_, file)| *file == glb).map(|(same, _)| *same);
    let named = pair.map(|code| all.contains(&code));
    let outcome = match same {
        Some(same) => Outcome::SameFile(same),
        None if named == [true; 2] => Outcome::BothNamed,
        None => {
            let above_info = codes(&findings, |severity| severity > Severity::Info);
            let instead = above_info.into_iter().filter(|code| !pair.contains(code)).collect();
            Outcome::Missed { named, instead }
        }
    };
    PairRow { made, outcome, failure }
}

/// Repairs a file twice. What is left must have a reason, and the second repair must change nothing.
fn repair(glb: &[u8], options: &CheckOptions) -> Result<(), String> {
    let once = repaired(glb, options)?;
    let document = read(&once)?;
    let left = check_document(&document, options).map_err(|error| error.to_string())?;
    if let Some(finding) = left.iter().find(|finding| finding.is_fixable()) {
        return Err(format!("{} is still there, without a reason: {}", finding.code, finding.text));
    }
    if repaired(&once, options)? != once {
        return Err("a second repair changes the file".to_owned());
    }
    Ok(())
}

fn read(glb: &[u8]) -> Result<Document, String> {
    let document = Document::from_bytes("pair", glb.to_vec(), None, &LoadOptions::default());
    document.map_err(|error| error.to_string())
}

fn repaired(glb: &[u8], options: &CheckOptions) -> Result<Vec<u8>, String> {
    let mut document = read(glb)?;
    let findings = check_document(&document, options).map_err(|error| error.to_string())?;
    let fixing = FixOptions::default().with_check(*options);
    fix_document(&mut document, findings, &fixing).map_err(|error| error.to_string())?;
    document.to_glb().map_err(|error| error.to_string())
}
