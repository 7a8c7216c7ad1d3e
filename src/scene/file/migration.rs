//! Bringing older scene files up to date: a table of pure functions on JSON, one for each format.
//!
//! Entry `n` turns format `n` into `n + 1`. A format gets a fixture in `tests/models/data` when it is left
//! behind, so that its files can be read for ever.

use serde_json::{Map, Value};

use super::FORMAT;

/// One step; entry `n` of the table reads format `n`.
type Step = fn(&mut Map<String, Value>);

const STEPS: [Step; FORMAT as usize] = [models_in_a_list];

/// The text in the present format.
///
/// # Errors
/// It is no JSON.
pub fn migrated(text: &str, version: u64) -> Result<String, serde_json::Error> {
    let mut scene: Map<String, Value> = serde_json::from_str(text)?;
    for (format, step) in STEPS.iter().enumerate().skip(version as usize) {
        step(&mut scene);
        scene.insert("version".into(), Value::from(format as u64 + 1));
    }
    serde_json::to_string(&Value::Object(scene))
}

/// Format 0, of the drafts of this program: one model, and colours under their American name.
fn models_in_a_list(scene: &mut Map<String, Value>) {
    let Some(mut model) = scene.remove("model") else { return };
    if let Some(faces) = model.get_mut("faces").and_then(Value::as_array_mut) {
        for face in faces.iter_mut().filter_map(Value::as_object_mut) {
            if let Some(colour) = face.remove("color") {
                face.insert("colour".into(), colour);
            }
        }
    }
    scene.insert("models".into(), Value::Array(vec![model]));
}
