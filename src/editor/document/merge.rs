//! Several models as one, for formats that hold one.

use crate::scene::records::ModelRecord;

/// All parts and faces under one name. Lengths keep their unit, which all models must share.
///
/// # Errors
/// In words, when units differ.
pub(super) fn to_one_model(models: &[ModelRecord]) -> Result<ModelRecord, String> {
    let Some((first, rest)) = models.split_first() else { return Ok(ModelRecord::default()) };
    let mut whole = first.clone();
    for model in rest {
        if model.unit.millimetres != first.unit.millimetres {
            let (a, b) = (&first.unit.name, &model.unit.name);
            return Err(format!("the models have different units ({a} and {b}), an IGES file has one"));
        }
        let offset = whole.parts.len();
        whole.parts.extend(model.parts.iter().cloned().map(|mut part| {
            part.parent = part.parent.map(|p| p + offset);
            part
        }));
        whole.faces.extend(model.faces.iter().cloned().map(|mut face| {
            face.part = face.part.map(|p| p + offset);
            face
        }));
    }
    Ok(whole)
}
