//! Parses the JSON of a document.

use serde::de::DeserializeOwned;

use super::schema::{Root, VersionProbe};
use crate::error::{ContentError, shortened};

/// Parses the whole JSON of a document. Errors: it is not JSON, or not glTF 2.0.
pub fn parse_root(text: &str) -> Result<Root, ContentError> {
    // Tracking the path of a failure costs time, so only text that fails is parsed again for it.
    let parsed: Result<Root, _> = serde_json::from_str(text);
    let version = match &parsed {
        Ok(root) => Some(root.asset.version.clone()),
        Err(_) => version(text)?,
    };
    if let Some(version) = version.filter(|version| !version.starts_with("2.")) {
        let problem = format!("is {:?}; convert the file to glTF 2.0", shortened(&version));
        return Err(ContentError::invalid("asset.version", problem));
    }
    parsed.or_else(|_| parse(text))
}

/// The version in JSON of which other parts may be invalid; none if the JSON is too damaged to have one.
///
/// Errors: JSON without a version.
fn version(text: &str) -> Result<Option<String>, ContentError> {
    let Ok(probe) = serde_json::from_str::<VersionProbe>(text) else { return Ok(None) };
    match probe.asset.and_then(|asset| asset.version) {
        Some(version) => Ok(Some(version)),
        None => {
            let problem =
                "asset.version is missing, so this is not a glTF file; give a .gltf or .glb file of glTF 2.0";
            Err(ContentError::invalid("", problem))
        }
    }
}

/// Parses JSON text. Errors: it is not JSON, or not of the type `T`.
pub fn parse<T: DeserializeOwned>(text: &str) -> Result<T, ContentError> {
    let mut parser = serde_json::Deserializer::from_str(text);
    let parsed = serde_path_to_error::deserialize(&mut parser).map_err(json_error)?;
    parser.end().map_err(|error| not_json(&error))?;
    Ok(parsed)
}

fn json_error(error: serde_path_to_error::Error<serde_json::Error>) -> ContentError {
    let at = error.path().to_string();
    let problem = error.inner();
    if !problem.is_data() {
        return not_json(problem);
    }
    let at = if at == "." { String::new() } else { at };
    // The message may quote a string of any length.
    ContentError::invalid(at, format!("{}; export the file again", shortened(&problem.to_string())))
}

fn not_json(error: &serde_json::Error) -> ContentError {
    ContentError::invalid("", format!("is not JSON: {error}; export the file again"))
}
