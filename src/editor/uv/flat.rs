//! Trim curves as polylines that no eye can tell from them at the present zoom.
//!
//! Each Bezier piece is halved until its control points are within a tolerance of the chord, measured on the
//! screen. Parts whose control points are all off the screen are left as chords, so that a zoom of a million
//! costs no more than the whole view. Every vertex lies on the curve and knows its parameter.

use glam::DVec2;

use super::view::UvView;
use crate::kernel::bezier::BezierCurve2;
use crate::kernel::nurbs::NurbsCurve2;
use crate::kernel::trim::UvRect;

/// Farthest a polyline may be from its curve, logical pixels.
const TOLERANCE_PX: f64 = 0.08;
/// Most halvings of one Bezier piece.
const MOST_HALVINGS: u32 = 14;

/// For what zoom and which part of the plane polylines are made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatteningKey {
    scale: DVec2,
    region: UvRect,
}

impl FlatteningKey {
    /// For `view` and its surroundings.
    pub fn of(view: &UvView) -> Self {
        let scale = DVec2::new(power_above(view.scale.x), power_above(view.scale.y));
        Self { scale, region: view.visible(1.0) }
    }

    /// Whether polylines made for this are good enough for `view`, and not much too good.
    pub fn serves(&self, view: &UvView) -> bool {
        let visible = view.visible(0.02);
        self.scale == Self::of(view).scale
            && visible.min.cmpge(self.region.min).all()
            && visible.max.cmple(self.region.max).all()
    }
}

fn power_above(x: f64) -> f64 {
    x.log2().ceil().exp2()
}

/// A curve as a polyline.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatCurve {
    /// Vertices, native parameters of the surface.
    pub points: Vec<DVec2>,
    /// Parameter of the curve at each vertex.
    pub parameters: Vec<f64>,
    /// Box around the vertices.
    pub bounds: UvRect,
}

/// Where a polyline is nearest to a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The point of the polyline.
    pub uv: DVec2,
    /// Parameter of the curve there, between those of the vertices in proportion.
    pub parameter: f64,
    /// Distance on the screen, logical pixels.
    pub distance_px: f64,
}

impl FlatCurve {
    /// The polyline of a curve.
    pub fn of(curve: &NurbsCurve2, key: &FlatteningKey) -> Self {
        let mut flat = Self { points: Vec::new(), parameters: Vec::new(), bounds: UvRect::EMPTY };
        for (piece, (from, to)) in curve.to_bezier() {
            if flat.points.is_empty() {
                flat.push(piece.start(), from);
            }
            flat.halve(&piece, (from, to), key, MOST_HALVINGS);
        }
        flat
    }

    /// The polyline of a Bezier piece over the parameters 0..1.
    pub fn of_piece(piece: &BezierCurve2, key: &FlatteningKey) -> Self {
        let mut flat = Self { points: Vec::new(), parameters: Vec::new(), bounds: UvRect::EMPTY };
        flat.push(piece.start(), 0.0);
        flat.halve(piece, (0.0, 1.0), key, MOST_HALVINGS);
        flat
    }

    fn push(&mut self, point: DVec2, parameter: f64) {
        self.points.push(point);
        self.parameters.push(parameter);
        self.bounds.include(point);
    }

    fn halve(&mut self, piece: &BezierCurve2, (from, to): (f64, f64), key: &FlatteningKey, left: u32) {
        if left == 0 || piece.degree() == 1 && !piece.is_rational() || is_flat(piece, key) {
            self.push(piece.end(), to);
            return;
        }
        let (a, b) = piece.split(0.5);
        let middle = 0.5 * (from + to);
        self.halve(&a, (from, middle), key, left - 1);
        self.halve(&b, (middle, to), key, left - 1);
    }

    /// Where it comes nearest to `target` on the screen; `None` when that is farther than `reach_px`.
    pub fn nearest(&self, target: DVec2, view: &UvView, reach_px: f64) -> Option<Nearest> {
        let reach = reach_px / view.scale;
        let (low, high) = (self.bounds.min - reach, self.bounds.max + reach);
        if target != target.clamp(low, high) {
            return None;
        }
        let mut best: Option<Nearest> = None;
        for (k, ends) in self.points.windows(2).enumerate() {
            let (low, high) = (ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach);
            if target.cmplt(low).any() || target.cmpgt(high).any() {
                continue;
            }
            let along = (ends[1] - ends[0]) * view.scale;
            let offset = (target - ends[0]) * view.scale;
            let length = along.length_squared();
            let t = if length > 0.0 { (offset.dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
            let distance_px = (offset - along * t).length();
            if distance_px <= best.map_or(reach_px, |b| b.distance_px) {
                let (a, b) = (self.parameters[k], self.parameters[k + 1]);
                let uv = ends[0].lerp(ends[1], t);
                best = Some(Nearest { uv, parameter: a + (b - a) * t, distance_px });
            }
        }
        best
    }
}

/// Whether the control points are close to the chord, or nothing of the piece can be seen.
fn is_flat(piece: &BezierCurve2, key: &FlatteningKey) -> bool {
    let (low, high) = piece.hull();
    if low.cmpgt(key.region.max).any() || high.cmplt(key.region.min).any() {
        return true;
    }
    let start = piece.start() * key.scale;
    let chord = piece.end() * key.scale - start;
    let length = chord.length();
    piece.points[1..piece.points.len() - 1].iter().all(|p| {
        let offset = *p * key.scale - start;
        if length <= TOLERANCE_PX {
            return offset.length() <= TOLERANCE_PX;
        }
        let along = offset.dot(chord) / length;
        (offset.perp_dot(chord) / length).abs() <= TOLERANCE_PX
            && along >= -TOLERANCE_PX
            && along <= length + TOLERANCE_PX
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::nurbs::KnotVector;

    fn quarter() -> NurbsCurve2 {
        let knots = KnotVector::bezier(2, 0.0, 2.0).expect("valid");
        let points = vec![DVec2::X, DVec2::ONE, DVec2::Y];
        NurbsCurve2::new(knots, points, vec![1.0, std::f64::consts::FRAC_1_SQRT_2, 1.0]).expect("valid")
    }

    fn view(scale: f64, centre: DVec2) -> UvView {
        UvView { scale: DVec2::splat(scale), centre, size_px: DVec2::new(800.0, 600.0), ..UvView::default() }
    }

    #[test]
    fn polylines_stay_near_their_curve_at_every_zoom() {
        let curve = quarter();
        for exponent in 0..9 {
            let scale = 30.0 * 10f64.powi(exponent);
            let on_curve = DVec2::splat(std::f64::consts::FRAC_1_SQRT_2);
            let view = view(scale, on_curve);
            let flat = FlatCurve::of(&curve, &FlatteningKey::of(&view));
            let visible = view.visible(0.0);
            for (p, t) in flat.points.iter().zip(&flat.parameters) {
                assert!((curve.point(*t) - *p).length() < 1e-12);
            }
            for ends in flat.points.windows(2) {
                let middle = 0.5 * (ends[0] + ends[1]);
                if visible.contains(middle) {
                    assert!((middle.length() - 1.0).abs() * scale < TOLERANCE_PX, "zoom {scale}");
                }
            }
            assert!(flat.points.len() < 400, "{} vertices at zoom {scale}", flat.points.len());
        }
    }

    #[test]
    fn the_nearest_point_is_on_the_curve_within_reach() {
        let view = view(200.0, DVec2::ZERO);
        let flat = FlatCurve::of(&quarter(), &FlatteningKey::of(&view));
        let target = DVec2::from_angle(0.6) * 1.02;
        let near = flat.nearest(target, &view, 6.0).expect("4 pixels away");
        assert!((near.distance_px - 4.0).abs() < 0.2, "{near:?}");
        assert!((quarter().point(near.parameter) - near.uv).length() * 200.0 < 0.5);
        assert_eq!(flat.nearest(target, &view, 3.0), None);
    }
}
