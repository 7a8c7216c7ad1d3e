//! One stretch of a boundary: pcurves and space curves as the file gives them, and the choice between them.
//!
//! Pcurves are used as they are when their image agrees with the space curve (or there is none).
//! Otherwise the space curve is laid on the surface and the report says so.

use glam::{DAffine3, DVec2, DVec3};

use super::curve::{self, Space};
use super::error::EntityError;
use super::store::Reader;
use super::surface::Surface;
use crate::exchange::boundary::{Piece, RawLoop, assembly, end, start};
use crate::exchange::report::Severity;
use crate::kernel::nurbs::{NurbsCurve2, NurbsCurve3};
use crate::kernel::query::{Carrier, project};
use crate::kernel::view::Bounds;
use crate::scene::records::{EdgeId, LoopRole};

/// Parts of a boundary's size that pcurves and space curves may differ by and still be the same curve.
const AGREE: f64 = 2e-3;
/// The same, where the file prefers the space curve.
const AGREE_CLOSELY: f64 = 1e-5;
/// Parts of a boundary's size that laying a curve on a surface may deviate by.
const FIT: f64 = 1e-7;

/// A stretch of boundary.
#[derive(Debug, Default)]
pub(crate) struct Segment {
    /// Curves in the file's parameters of the surface.
    pub uv: Vec<NurbsCurve2>,
    /// Curves in model space, in the direction of the boundary.
    pub space: Vec<NurbsCurve3>,
    /// Whether the file prefers the space curves.
    pub prefers_space: bool,
    /// The edge of the model that this stretch is, where the file says so.
    pub edge: Option<EdgeId>,
}

impl Segment {
    /// Reads the curves that `uv` and `space` mean. A bad curve is a remark as long as the other is sound.
    pub(crate) fn read(
        reader: &mut Reader<'_, '_>,
        index: usize,
        uv: &[i64],
        space: Option<i64>,
        outer: DAffine3,
    ) -> Result<Self, EntityError> {
        let mut segment = Self::default();
        let mut failure = None;
        let mut pieces = Vec::new();
        for pointer in uv {
            let result = curve::read(reader, *pointer, Space::Parameter, DAffine3::IDENTITY, &mut pieces);
            failure = failure.or(result.err());
        }
        if failure.is_none() {
            segment.uv = pieces.iter().map(|c| c.map_points(|p: DVec3| p.truncate())).collect();
        }
        if let Some(pointer) = space {
            let mut pieces = Vec::new();
            match curve::read(reader, pointer, Space::Model, outer, &mut pieces) {
                Ok(()) => segment.space = pieces,
                Err(error) => failure = failure.or(Some(error)),
            }
        }
        match failure {
            Some(error) if segment.uv.is_empty() && segment.space.is_empty() => return Err(error),
            Some(error) => {
                reader.remark(index, Severity::Warning, format!("{error}; the other curve is used"))
            }
            None if segment.uv.is_empty() && segment.space.is_empty() => {
                return Err(EntityError::Missing { index: 3, what: "boundary curve" });
            }
            None => {}
        }
        Ok(segment)
    }

    /// Turns the space curves round.
    pub(crate) fn reverse_space(&mut self) {
        self.space = self.space.iter().rev().map(NurbsCurve3::reversed).collect();
    }

    fn size(&self, carrier: &Carrier) -> f64 {
        let model = Bounds::of(self.space.iter().flat_map(|c| c.points().iter().copied()));
        if model.is_empty() {
            Bounds::of(self.uv.iter().flat_map(|c| [carrier.point(start(c)), carrier.point(end(c))]))
                .diagonal()
        } else {
            model.diagonal()
        }
    }
}

/// Lays the stretches of one boundary on `surface` and chains them to a loop. `index` is the entity
/// that remarks are made on.
pub(crate) fn boundary(
    reader: &mut Reader<'_, '_>,
    index: usize,
    surface: &Surface,
    segments: &[Segment],
    role: LoopRole,
) -> Result<RawLoop, EntityError> {
    let carrier = &surface.carrier;
    let mut pieces: Vec<Piece> = Vec::new();
    for segment in segments {
        match given(surface, segment) {
            Some(curves) => {
                pieces.extend(curves.into_iter().map(|curve| Piece { curve, edge: segment.edge }));
            }
            None => {
                if !segment.uv.is_empty() {
                    let surface_known = !surface.native_from_iges.is_empty();
                    if segment.space.is_empty() {
                        return Err(EntityError::Degenerate(
                            "the parameter curve lies outside of the surface".into(),
                        ));
                    }
                    if surface_known && !segment.prefers_space {
                        let message =
                            "parameter curve and space curve disagree; the space curve is used".to_string();
                        reader.remark(index, Severity::Warning, message);
                    }
                }
                lay(reader, index, carrier, segment, &mut pieces)?;
            }
        }
    }
    if pieces.is_empty() {
        return Err(EntityError::Degenerate("the boundary has no curves".into()));
    }
    let pieces = assembly::chain(carrier, pieces);
    if !pieces.iter().flat_map(|p| [p.start(), p.end()]).all(|p| reasonable(carrier, p)) {
        return Err(EntityError::Degenerate("the boundary leaves the surface".into()));
    }
    Ok(RawLoop { role, pieces })
}

/// The file's pcurves in native parameters, when they agree with the space curves.
fn given(surface: &Surface, segment: &Segment) -> Option<Vec<NurbsCurve2>> {
    if segment.uv.is_empty() {
        return None;
    }
    let carrier = &surface.carrier;
    let size = segment.size(carrier);
    let agree = size * if segment.prefers_space { AGREE_CLOSELY } else { AGREE };
    for map in &surface.native_from_iges {
        let mut distance = |a: DVec2, b: DVec2| (carrier.point(a) - carrier.point(b)).length();
        let curves: Option<Vec<NurbsCurve2>> =
            segment.uv.iter().map(|c| map.map(c, FIT * size, &mut distance)).collect();
        let Some(curves) = curves else { continue };
        let agrees = if segment.space.is_empty() {
            inside(carrier, &curves)
        } else {
            images_agree(carrier, &curves, segment, agree)
        };
        if agrees {
            return Some(curves);
        }
    }
    None
}

/// Whether curves without a model-space partner stay near the domain of a spline.
fn inside(carrier: &Carrier, curves: &[NurbsCurve2]) -> bool {
    let Carrier::Spline(spline) = carrier else { return true };
    let ((u0, u1), (v0, v1)) = (spline.surface().knots_u().domain(), spline.surface().knots_v().domain());
    let (min, max) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let margin = (max - min) * 0.05;
    curves.iter().flat_map(|c| [start(c), end(c)]).all(|p| {
        (0..2).all(|k| {
            carrier.periods()[k].is_some() || (p[k] >= min[k] - margin[k] && p[k] <= max[k] + margin[k])
        })
    })
}

/// Whether a point is not absurdly far outside of the surface's domain.
fn reasonable(carrier: &Carrier, p: DVec2) -> bool {
    const SPANS: f64 = 20.0;
    let Carrier::Spline(spline) = carrier else { return p.is_finite() };
    let ((u0, u1), (v0, v1)) = (spline.surface().knots_u().domain(), spline.surface().knots_v().domain());
    let (min, span) = (DVec2::new(u0, v0), DVec2::new(u1 - u0, v1 - v0));
    ((p - min).abs() / span).max_element() < SPANS
}

/// Whether ends and middles of the pcurves lie on the space curves, within `tolerance` and what the
/// samples of the space curves leave open.
fn images_agree(carrier: &Carrier, curves: &[NurbsCurve2], segment: &Segment, tolerance: f64) -> bool {
    let polyline: Vec<Vec<DVec3>> = segment.space.iter().map(samples).collect();
    curves.iter().all(|curve| {
        let (a, b) = curve.domain();
        [0.0, 0.5, 1.0].iter().all(|s| {
            let p = carrier.point(curve.point(a + s * (b - a)));
            polyline.iter().any(|line| near(line, p, tolerance))
        })
    })
}

/// Points along a curve, close enough for its bends.
fn samples(curve: &NurbsCurve3) -> Vec<DVec3> {
    if curve.degree() == 1 {
        return curve.points().to_vec();
    }
    let breaks = curve.knots().breaks();
    let each = (64 / (breaks.len() - 1)).clamp(4, 32);
    let mut points: Vec<DVec3> = breaks
        .windows(2)
        .flat_map(|w| (0..each).map(|k| curve.point(w[0] + (w[1] - w[0]) * k as f64 / each as f64)))
        .collect();
    points.push(curve.point(curve.domain().1));
    points
}

/// Whether `p` is within `tolerance` of a polyline, or of the arc that a chord of it stands for.
fn near(line: &[DVec3], p: DVec3, tolerance: f64) -> bool {
    line.windows(2).any(|w| {
        let chord = w[1] - w[0];
        let length = chord.length();
        let s = ((p - w[0]).dot(chord) / chord.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let sag = if line.len() > 2 { 0.03 * length * 4.0 * s * (1.0 - s) } else { 0.0 };
        (w[0] + chord * s - p).length() <= tolerance + sag
    })
}

/// Lays the space curves on the surface, each from where the last one ended.
fn lay(
    reader: &mut Reader<'_, '_>,
    index: usize,
    carrier: &Carrier,
    segment: &Segment,
    pieces: &mut Vec<Piece>,
) -> Result<(), EntityError> {
    let size = segment.size(carrier);
    let tolerance = (FIT * size).max(f64::MIN_POSITIVE);
    let mut off = 0.0_f64;
    for curve in &segment.space {
        // The last end is a hint only when this curve follows it; at a pole it says nothing about u.
        let at = curve.point(curve.domain().0);
        let near = pieces.last().map(Piece::end).filter(|uv| {
            (carrier.point(*uv) - at).length() <= 1e-4 * size && carrier.is_singular(*uv) == [false, false]
        });
        let projection = project(carrier, curve, near, tolerance)
            .ok_or_else(|| EntityError::Degenerate("the boundary cannot be laid on the surface".into()))?;
        off = off.max(projection.distance);
        // A curve that shrinks to one point (at a pole, say) bounds nothing.
        let points = projection.curve.points();
        if points.iter().any(|p| *p != points[0]) {
            pieces.push(Piece { curve: projection.curve, edge: segment.edge });
        }
    }
    if off > 1e-3 * size {
        let message = format!("the boundary lies up to {off:.3e} mm off the surface it bounds");
        reader.remark(index, Severity::Warning, message);
    }
    Ok(())
}
