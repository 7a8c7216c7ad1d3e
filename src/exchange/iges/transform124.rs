//! Transformation matrix (124): `target = R * source + T`, chained through the matrix' own directory entry.

use glam::{DAffine3, DMat3, DVec3};

use super::error::EntityError;
use super::store::Reader;

/// The transformation that a directory entry's field `pointer` asks for; lengths times `scale`.
/// 0 is the identity.
pub(crate) fn transform(
    reader: &mut Reader<'_, '_>,
    pointer: i64,
    scale: f64,
) -> Result<DAffine3, EntityError> {
    if pointer == 0 {
        return Ok(DAffine3::IDENTITY);
    }
    reader.open(pointer, "transformation", |reader, mut opened| {
        if opened.entry.kind != 124 {
            let (kind, target) = (opened.entry.kind, pointer as u64);
            return Err(EntityError::Kind { expected: "a transformation (124)", kind, target });
        }
        let m = opened.args.reals("matrix", 12)?;
        let column = |k: usize| DVec3::new(m[k], m[k + 4], m[k + 8]);
        let matrix = DMat3::from_cols(column(0), column(1), column(2));
        let own = DAffine3 { matrix3: matrix, translation: column(3) * scale };
        if !(matrix.determinant().abs() > 1e-12) || !own.is_finite() {
            return Err(EntityError::Degenerate("the transformation matrix is singular".into()));
        }
        Ok(transform(reader, opened.entry.transform, scale)? * own)
    })
}
