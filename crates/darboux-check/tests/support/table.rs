//! Makes every mistake on every model, checks and repairs it, and counts what came out.

use std::collections::BTreeSet;

use darboux_check::{
    AssumedMap, CheckOptions, Code, Finding, FixOptions, Severity, check_document, check_map,
    check_map_on_model, check_model_of_maps, fix_document, fix_map_on_model,
};
use darboux_io::LoadOptions;
use darboux_io::gltf::{Document, pair_tangents};

use super::maps::{MAP_MISTAKES, Map, MapMistake};
use super::mistakes::{MISTAKES, Mistake};
use super::models::{Model, healthy_models};

/// What came out for one mistake.
pub struct Row {
    pub code: Code,
    pub how: &'static str,
    /// The models that the mistake was made on.
    pub models: usize,
    /// Models where the check named the mistake.
    pub named: usize,
    /// Models where the check named another error.
    pub with_other_errors: usize,
    /// Models that the repair made equal to the healthy model; none where the repair leaves the mistake.
    pub repaired: Option<usize>,
    /// What went wrong, one sentence each.
    pub failures: Vec<String>,
}

/// The codes of findings of some severities.
pub fn codes(findings: &[Finding], is_wanted: impl Fn(Severity) -> bool) -> BTreeSet<Code> {
    findings.iter().filter(|finding| is_wanted(finding.severity)).map(|finding| finding.code).collect()
}

/// The check of everything but texels, which takes longest.
pub fn without_maps() -> CheckOptions {
    CheckOptions::default().with_maps(false)
}

/// The user says that maps with one inverted channel are DirectX's: the faces say nothing about maps that
/// were not baked for them.
pub fn assuming_directx() -> FixOptions {
    FixOptions::default().with_check(CheckOptions::default().with_assumed_map(Some(AssumedMap::DirectX)))
}

/// The table of all mistakes but those in baked maps.
pub fn table() -> Vec<Row> {
    let models = healthy_models();
    let in_models = MISTAKES.iter().map(|mistake| row(mistake, &models));
    let in_maps = MAP_MISTAKES.iter().map(|mistake| map_row(mistake, &models));
    in_models.chain(in_maps).collect()
}

fn row(mistake: &Mistake, models: &[Model]) -> Row {
    let Mistake { code, how, make } = *mistake;
    let mut row = Row::new(code, how);
    for healthy in models {
        let mut model = healthy.clone();
        if !make(&mut model) {
            continue;
        }
        row.models += 1;
        let options = if code == Code::MapPadding { CheckOptions::default() } else { without_maps() };
        let findings = check_document(&model.document(), &options).expect("a valid document");
        row.count(&healthy.name, &findings);
        if row.repaired.is_none() {
            continue;
        }
        let options = FixOptions::default().with_check(without_maps());
        match repaired_model(&model, findings, healthy, &options) {
            Ok(()) => *row.repaired.get_or_insert(0) += 1,
            Err(problem) => row.failures.push(format!("{code} on {}: {problem}", healthy.name)),
        }
    }
    row
}

/// Repairs a model, and compares it with the healthy one.
pub fn repaired_model(
    model: &Model,
    findings: Vec<Finding>,
    healthy: &Model,
    options: &FixOptions,
) -> Result<(), String> {
    let repair = |glb: Vec<u8>, findings| {
        let mut document = Document::from_bytes("repaired", glb, None, &LoadOptions::default())?;
        fix_document(&mut document, findings, options)?;
        document.to_glb()
    };
    let once = repair(model.glb(), findings).map_err(|error| error.to_string())?;
    let mut document =
        Document::from_bytes("repaired", once.clone(), None, &LoadOptions::default()).expect("a valid GLB");
    let left = check_document(&document, &without_maps()).expect("a valid document");
    if let Some(finding) = left.iter().find(|finding| finding.is_fixable()) {
        return Err(format!("{} is still there: {}", finding.code, finding.text));
    }
    if repair(once.clone(), left).map_err(|error| error.to_string())? != once {
        return Err("a second repair changes the file".to_owned());
    }
    equal(&mut healthy.document(), &mut document)
}

/// Whether two documents of one model have the same tangents, bit for bit, and the same normals to rounding.
fn equal(healthy: &mut Document, repaired: &mut Document) -> Result<(), String> {
    for pair in pair_tangents(healthy, repaired).map_err(|error| error.to_string())? {
        let corners = pair.corners.map_err(|unpaired| unpaired.reason)?;
        let tangents = (0..corners.len()).map(|corner| corners.tangents(corner));
        let differing = tangents.filter(|[a, b]| a.map(f32::to_bits) != b.map(f32::to_bits));
        match (corners.moved, differing.count()) {
            (0, 0) => {}
            (moved, tangents) => return Err(format!("{moved} corners moved, {tangents} tangents differ")),
        }
    }
    let normals = |document: &Document| -> Vec<[f32; 3]> {
        let corners = document.corners().expect("valid indices");
        corners
            .iter()
            .flat_map(|corners| corners.vectors("NORMAL").expect("normals").unwrap_or_default())
            .collect()
    };
    let [ours, theirs] = [normals(healthy), normals(repaired)];
    let distance = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
    // A normal that is scaled and normalised again is off by a rounding of each step.
    let worst = ours.iter().zip(&theirs).map(distance).fold(0.0, f32::max);
    let is_equal = ours.len() == theirs.len() && worst <= 2.0 * f32::EPSILON;
    if is_equal { Ok(()) } else { Err(format!("normals differ by {worst}")) }
}

fn map_row(mistake: &MapMistake, models: &[Model]) -> Row {
    let MapMistake { code, how, make, tolerance } = *mistake;
    let mut row = Row::new(code, how);
    assert_eq!(row.repaired.is_some(), tolerance.is_some(), "{code}");
    for healthy in models {
        row.models += 1;
        let map = make(&healthy.map);
        let findings = check_map(&map.file, &CheckOptions::default()).findings;
        row.count(&healthy.name, &findings);
        let Some(tolerance) = tolerance else { continue };
        match repaired_map(&map, healthy, tolerance) {
            Ok(()) => *row.repaired.get_or_insert(0) += 1,
            Err(problem) => row.failures.push(format!("{code} on the map of {}: {problem}", healthy.name)),
        }
    }
    row
}

/// Repairs a map on its model, and compares its texels with the healthy ones.
fn repaired_map(map: &Map, healthy: &Model, tolerance: u8) -> Result<(), String> {
    let model = check_model_of_maps(&healthy.document()).expect("a valid document");
    let (loading, options) = (LoadOptions::default(), assuming_directx());
    let fixed = fix_map_on_model("map.png", &map.file, &model, &loading, &options);
    let fixed = fixed.map_err(|error| error.to_string())?;
    let image = fixed.image.ok_or("nothing was repaired")?;
    let file = image.to_bytes().map_err(|error| error.to_string())?;
    let left = check_map_on_model(&file, &model, &options.check).findings;
    if let Some(finding) = left.iter().find(|finding| finding.is_fixable()) {
        return Err(format!("{} is still there: {}", finding.code, finding.text));
    }
    let texels = rgb(&file);
    let difference = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0);
    let worst = texels.iter().zip(&healthy.map.texels).map(difference).max().unwrap_or(0);
    let is_equal = texels.len() == healthy.map.texels.len() && worst <= tolerance;
    if is_equal { Ok(()) } else { Err(format!("texels differ by up to {worst}, more than {tolerance}")) }
}

/// The texels of a PNG.
pub fn rgb(file: &[u8]) -> Vec<[u8; 3]> {
    let image = darboux_io::image::RgbaImage::decode(file, &Default::default()).expect("an image");
    image.texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()
}

impl Row {
    pub fn new(code: Code, how: &'static str) -> Self {
        // All models have tangents, beside which normals in other axes are left (tests/cures.rs repairs
        // them), and tangents of a known method are made again only where their code is named.
        let are_left = [Code::NormalOtherAxes, Code::TangentOtherRecipe];
        let is_repaired = code.repair().is_some() && !are_left.contains(&code);
        let repaired = is_repaired.then_some(0);
        Self { code, how, models: 0, named: 0, with_other_errors: 0, repaired, failures: Vec::new() }
    }

    /// Notes the findings of a check that state no number.
    pub fn require_evidence(&mut self, model: &str, findings: &[Finding]) {
        let is_without = |finding: &&Finding| {
            finding.evidence.is_empty() || finding.evidence.iter().any(|number| !number.value.is_finite())
        };
        let without = findings.iter().filter(is_without);
        self.failures.extend(without.map(|finding| format!("{} on {model} has no evidence", finding.code)));
    }

    /// Counts a check of a model.
    fn count(&mut self, model: &str, findings: &[Finding]) {
        let code = self.code;
        self.require_evidence(model, findings);
        let (all, errors) =
            (codes(findings, |_| true), codes(findings, |severity| severity == Severity::Error));
        self.named += usize::from(all.contains(&code));
        if !all.contains(&code) {
            self.failures.push(format!("{code} on {model} is not named: {findings:?}"));
        }
        let others: Vec<&Code> = errors.iter().filter(|other| **other != code).collect();
        self.with_other_errors += usize::from(!others.is_empty());
        if !others.is_empty() {
            self.failures.push(format!("{code} on {model} also gives {others:?}"));
        }
    }
}
