//! Points (116) and directions (123), where other entities refer to them.

use glam::DVec3;

use super::error::EntityError;
use super::parameter::Args;
use super::store::Reader;
use super::transform124;

/// The point that the next parameter refers to, in model space.
pub(crate) fn point(
    reader: &mut Reader<'_, '_>,
    args: &mut Args,
    what: &'static str,
) -> Result<DVec3, EntityError> {
    let pointer = args.required(what)?;
    reader.open(pointer, what, |reader, mut opened| {
        expect(opened.entry.kind, 116, "a point (116)", pointer)?;
        let scale = reader.millimetres();
        let place = transform124::transform(reader, opened.entry.transform, scale)?;
        Ok(place.transform_point3(opened.args.point("coordinate", scale)?))
    })
}

/// The unit direction that the next parameter refers to; `None` when it is left out.
pub(crate) fn direction(
    reader: &mut Reader<'_, '_>,
    args: &mut Args,
    what: &'static str,
) -> Result<Option<DVec3>, EntityError> {
    let Some(pointer) = args.pointer(what)? else { return Ok(None) };
    reader.open(pointer, what, |reader, mut opened| {
        expect(opened.entry.kind, 123, "a direction (123)", pointer)?;
        let place = transform124::transform(reader, opened.entry.transform, 1.0)?;
        let vector = place.transform_vector3(opened.args.point("component", 1.0)?);
        let unit = vector.try_normalize();
        unit.map(Some).ok_or_else(|| EntityError::Degenerate("the direction has no length".into()))
    })
}

/// Checks an entity type.
pub(crate) fn expect(
    kind: u32,
    wanted: u32,
    expected: &'static str,
    pointer: i64,
) -> Result<(), EntityError> {
    if kind == wanted {
        return Ok(());
    }
    Err(EntityError::Kind { expected, kind, target: pointer.unsigned_abs() })
}
