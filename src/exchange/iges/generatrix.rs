//! A curve that sweeps out a surface: one NURBS curve in OpenCASCADE's parametrisation, and the map from
//! the parameters that IGES gives the same curve.

use glam::DAffine3;

use super::curve::{self, Space};
use super::error::EntityError;
use super::store::Reader;
use crate::exchange::boundary::parameter_map::AxisMap;
use crate::kernel::nurbs::{KnotVector, NurbsCurve3};
use crate::kernel::primitives::Profile;

/// The curve, and native parameter from IGES parameter.
pub(crate) struct Generatrix {
    pub profile: Profile,
    pub native_from_iges: AxisMap,
}

/// Reads the curve that `pointer` means. Lines run over their length (IGES: 0 to 1), arcs over their
/// angles, polylines over the length of their chords, splines over their knots; composites over the sum
/// of their pieces.
pub(crate) fn read(reader: &mut Reader<'_, '_>, pointer: i64) -> Result<Generatrix, EntityError> {
    let kind = reader.kind(pointer, "curve")?;
    let mut pieces = Vec::new();
    curve::read(reader, pointer, Space::Model, DAffine3::IDENTITY, &mut pieces)?;
    let lengths = if kind == 110 { AxisMap::scaling(line_length(&pieces[0])) } else { AxisMap::IDENTITY };
    for piece in &mut pieces {
        if piece.degree() == 1 && piece.points().len() == 2 && piece.domain() == (0.0, 1.0) {
            *piece = over_length(piece)?;
        } else if kind == 106 {
            *piece = over_chords(piece)?;
        }
    }
    let curve = if pieces.len() == 1 { pieces.swap_remove(0) } else { joined(&pieces)? };
    let profile = match kind {
        100 | 104 => ellipse(&curve).unwrap_or(Profile::Spline(curve)),
        _ => Profile::Spline(curve),
    };
    let native_from_iges = AxisMap { arc: profile.arc(), ..lengths };
    Ok(Generatrix { profile, native_from_iges })
}

/// The arc of which `curve` is the spline: found again from its nodes, since transformations have been
/// applied to them. `None` for parabolas and hyperbolas.
fn ellipse(curve: &NurbsCurve3) -> Option<Profile> {
    let weight = curve.weights()[1];
    if !(curve.is_rational() && weight < 1.0) {
        return None;
    }
    let (start, end) = curve.domain();
    let (p, q, half) = (curve.points(), curve.degree(), weight.acos());
    debug_assert_eq!(q, 2);
    // Ends are centre + e(a), centre + e(a + 2h); the middle node is centre + e(a + h) / cos h.
    let chord = 0.5 * (p[0] + p[2]);
    let middle = p[1] - chord;
    // chord = centre + cos(h) e, node = centre + e / cos(h), with e at the middle of the span.
    let sin2 = 1.0 - weight * weight;
    let e = middle * (weight / sin2);
    let f = (p[2] - p[0]) * (0.5 / half.sin());
    let centre = chord - e * weight;
    let (sin, cos) = (start + half).sin_cos();
    Some(Profile::Arc { centre, x: e * cos - f * sin, y: e * sin + f * cos, start, end })
}

fn line_length(line: &NurbsCurve3) -> f64 {
    let points = line.points();
    (points[points.len() - 1] - points[0]).length()
}

/// A line over `[0, length]`.
fn over_length(line: &NurbsCurve3) -> Result<NurbsCurve3, EntityError> {
    let knots = KnotVector::bezier(1, 0.0, line_length(line)).map_err(EntityError::knots("t"))?;
    Ok(NurbsCurve3::new(knots, line.points().to_vec(), line.weights().to_vec())?)
}

/// A polyline with its knots at the lengths of its chords added up.
fn over_chords(polyline: &NurbsCurve3) -> Result<NurbsCurve3, EntityError> {
    let mut at = 0.0;
    let mut knots = vec![0.0, 0.0];
    for chord in polyline.points().windows(2) {
        at += (chord[1] - chord[0]).length();
        knots.push(at);
    }
    knots.push(at);
    let knots = KnotVector::new(1, knots).map_err(EntityError::knots("t"))?;
    Ok(NurbsCurve3::new(knots, polyline.points().to_vec(), polyline.weights().to_vec())?)
}

/// The pieces as one curve of one degree; each piece keeps the length of its domain.
fn joined(pieces: &[NurbsCurve3]) -> Result<NurbsCurve3, EntityError> {
    let degree = pieces.iter().map(NurbsCurve3::degree).max().unwrap_or(1);
    let (mut knots, mut points, mut weights) = (Vec::new(), Vec::new(), Vec::new());
    let mut at = 0.0;
    for piece in pieces {
        let piece = piece.elevated(degree - piece.degree())?.clamped();
        let (start, end) = piece.domain();
        let own = piece.knots().as_slice();
        // Weights of a piece may be scaled as a whole, so that the shared end has one weight.
        let factor = weights.last().map_or(1.0, |w: &f64| w / piece.weights()[0]);
        let skip = usize::from(!points.is_empty());
        if points.is_empty() {
            knots.extend(own[..=degree].iter().map(|k| k - start + at));
        }
        knots.extend(own[degree + 1..own.len() - 1].iter().map(|k| k - start + at));
        points.extend(&piece.points()[skip..]);
        weights.extend(piece.weights()[skip..].iter().map(|w| w * factor));
        at += end - start;
    }
    knots.push(at);
    let knots = KnotVector::new(degree, knots).map_err(EntityError::knots("t"))?;
    Ok(NurbsCurve3::new(knots, points, weights)?)
}
