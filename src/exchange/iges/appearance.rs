//! Names (label, name property 406 form 15), colours (numbers and 314) and levels of an entity.

use super::parameter::Args;
use super::store::Reader;

/// The eight standard colours, red, green, blue in percent (IGES 5.3, table 2): number 1 is black.
pub(crate) const STANDARD: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [100.0, 0.0, 0.0],
    [0.0, 100.0, 0.0],
    [0.0, 0.0, 100.0],
    [100.0, 100.0, 0.0],
    [100.0, 0.0, 100.0],
    [0.0, 100.0, 100.0],
    [100.0, 100.0, 100.0],
];

/// The name among the properties that follow an entity's own parameters.
pub(crate) fn name_property(reader: &mut Reader<'_, '_>, args: &mut Args) -> Option<String> {
    let associations = args.count("number of associations", 1).ok()?;
    args.skip(associations);
    for _ in 0..args.count("number of properties", 1).ok()? {
        let Ok(Some(pointer)) = args.pointer("property") else { continue };
        let name = reader.open(pointer, "property", |_, mut opened| {
            if opened.entry.kind != 406 || opened.entry.form != 15 {
                return Ok(String::new());
            }
            opened.args.skip(1);
            Ok(opened.args.text())
        });
        if let Ok(name) = name
            && !name.is_empty()
        {
            return Some(name);
        }
    }
    None
}

/// Linear RGB of a directory entry's colour field; `None` for "no colour".
pub(crate) fn colour(reader: &mut Reader<'_, '_>, field: i64) -> Option<[f32; 3]> {
    let percent = match field {
        0 => return None,
        1..=8 => STANDARD[usize::try_from(field - 1).ok()?],
        _ if field < 0 => {
            let read = reader.open(field.checked_neg()?, "colour", |_, mut opened| {
                let values = opened.args.reals("colour component", 3)?;
                Ok((opened.entry.kind == 314).then(|| [values[0], values[1], values[2]]))
            });
            read.ok()??
        }
        _ => return None,
    };
    Some(percent.map(|c| linear((c / 100.0).clamp(0.0, 1.0)) as f32))
}

/// From the nonlinear values that files hold to linear light (sRGB).
pub(crate) fn linear(c: f64) -> f64 {
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}
