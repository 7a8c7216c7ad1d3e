//! Curves (126, and 110 for straight lines) and surfaces (128), number by number as they are.

use glam::DVec3;

use super::deck::{Batch, Entity, Status};
use super::list::{Field, Link};
use crate::kernel::nurbs::{NurbsCurve2, NurbsCurve3, NurbsSurface};

/// Adds a pcurve.
pub(crate) fn pcurve(batch: &mut Batch, curve: &NurbsCurve2) -> Link {
    let flat = curve.map_points(|p| p.extend(0.0));
    add(batch, &flat, Status::ParameterPart, 1.0)
}

/// Adds a curve in space; lengths are divided by `unit` (millimetres).
pub(crate) fn space_curve(batch: &mut Batch, curve: &NurbsCurve3, unit: f64) -> Link {
    add(batch, curve, Status::Part, unit)
}

fn add(batch: &mut Batch, curve: &NurbsCurve3, status: Status, unit: f64) -> Link {
    let entity = match curve.points() {
        // What 110 says and no more: parameters from 0 to 1, equal weights.
        [a, b] if curve.degree() == 1 && curve.domain() == (0.0, 1.0) && curve.weights() == [1.0, 1.0] => {
            let mut fields = Vec::with_capacity(6);
            point(&mut fields, *a, unit);
            point(&mut fields, *b, unit);
            Entity::new(110, status, fields)
        }
        _ => Entity::new(126, status, spline126(curve, status == Status::ParameterPart, unit)),
    };
    batch.push(entity)
}

fn spline126(curve: &NurbsCurve3, planar: bool, unit: f64) -> Vec<Field> {
    let (start, end) = curve.domain();
    let points = curve.points();
    let mut fields = Vec::with_capacity(12 + curve.knots().as_slice().len() + 4 * points.len());
    fields.extend([
        integer(points.len() - 1),
        integer(curve.degree()),
        flag(planar),
        flag(curve.point(start) == curve.point(end)),
        flag(!curve.is_rational()),
        flag(false),
    ]);
    fields.extend(curve.knots().as_slice().iter().copied().map(Field::Real));
    fields.extend(curve.weights().iter().copied().map(Field::Real));
    for p in points {
        point(&mut fields, *p, unit);
    }
    fields.extend([Field::Real(start), Field::Real(end)]);
    point(&mut fields, if planar { DVec3::Z } else { DVec3::ZERO }, 1.0);
    fields
}

/// Adds a surface. Ours is u-major; IGES lists u first (`i` runs fastest).
pub(crate) fn surface128(surface: &NurbsSurface, unit: f64) -> Vec<Field> {
    let (nu, nv) = surface.counts();
    let (du, dv) = surface.degrees();
    let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
    let tolerance = 1e-9 * surface.bounds().diagonal();
    let order = (0..nv).flat_map(|j| (0..nu).map(move |i| i * nv + j));
    let mut fields = Vec::with_capacity(20 + nu + nv + du + dv + 4 * nu * nv);
    fields.extend([
        integer(nu - 1),
        integer(nv - 1),
        integer(du),
        integer(dv),
        flag(surface.is_closed_u(tolerance)),
        flag(surface.is_closed_v(tolerance)),
        flag(!surface.is_rational()),
        flag(false),
        flag(false),
    ]);
    for knots in [surface.knots_u(), surface.knots_v()] {
        fields.extend(knots.as_slice().iter().copied().map(Field::Real));
    }
    fields.extend(order.clone().map(|k| Field::Real(surface.weights()[k])));
    for k in order {
        point(&mut fields, surface.points()[k], unit);
    }
    fields.extend([u0, u1, v0, v1].map(Field::Real));
    fields
}

fn integer(value: usize) -> Field {
    Field::Integer(value as i64)
}

fn flag(value: bool) -> Field {
    Field::Integer(i64::from(value))
}

fn point(fields: &mut Vec<Field>, p: DVec3, unit: f64) {
    // Division by one changes nothing: millimetres are written bit for bit.
    fields.extend((p / unit).to_array().map(Field::Real));
}
