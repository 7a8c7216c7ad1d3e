//! Pixels of wide gaps: the strip between the two exact curves of an edge is walked through, and beyond its ends the wedge
//! up to the face that closes the gap there.

use glam::{DVec2, DVec3};

use super::HoleScene;
use super::screen::Screen;
use crate::encoding::View;
use crate::inspect::lifted::LiftedCurve;
use crate::inspect::nearest::nearest;
use crate::inspect::{Edge, EdgeUse};
use crate::reference::holes::{HoleCandidate, z_of};
use crate::reference::visibility::VisibilityBuffer;

/// Gaps of more pixels than this are walked through; narrower ones are found by neighbours.
const WIDE_PX: f64 = 1.5;
/// Pixels across that are looked at of one gap.
const MOST_PX: f64 = 5e3;
/// What lies beyond the end of an edge, and no farther behind it than this many times the distance from it, belongs to
/// the faces that meet there.
const CLEAR: f64 = 3.0;
/// A surface beside an edge is taken to fall by no more pixels per pixel.
const STEEPEST: f64 = 30.0;
/// Halvings of an edge at most on the way to a pixel.
const MOST_HALVINGS: u32 = 30;

/// A candidate found from an edge.
#[derive(Clone, Copy)]
pub(super) struct Suspect {
    pub(super) candidate: HoleCandidate,
    /// Whether it lies beyond the end of the edge, between its sides and the face that closes the gap.
    pub(super) beyond: bool,
}

/// Pixels in the strip between the first two sides of an edge that show something behind it.
pub(super) fn wide_holes(
    scene: &HoleScene,
    buffer: &VisibilityBuffer,
    view: &View,
    screen: &Screen,
    edge: &Edge,
) -> Vec<Suspect> {
    let (Some(gap), [first, rest @ ..]) = (edge.gap, edge.uses.as_slice()) else { return Vec::new() };
    let mut found = Vec::new();
    for second in rest {
        let (Some(a), Some(b)) =
            (scene.inspection.curve(&first.curve), scene.inspection.curve(&second.curve))
        else {
            continue;
        };
        let walk = Walk { buffer, view, screen, a, b, uses: [first, second], gap: gap.maximum };
        walk.along(first.interval, MOST_HALVINGS, &mut found);
    }
    found
}

struct Walk<'a> {
    buffer: &'a VisibilityBuffer,
    view: &'a View,
    screen: &'a Screen,
    a: &'a LiftedCurve,
    b: &'a LiftedCurve,
    uses: [&'a EdgeUse; 2],
    gap: f64,
}

impl Walk<'_> {
    fn along(&self, (from, to): (f64, f64), halvings: u32, found: &mut Vec<Suspect>) {
        let middle = self.a.at(0.5 * (from + to)).point;
        let reach = 0.6 * (self.a.length_to(to) - self.a.length_to(from)) + self.gap;
        let z = self.screen.depth(middle);
        let width = self.screen.width((z - reach).max(1e-3 * z.abs()));
        if self.gap < WIDE_PX * width || self.screen.is_off(middle, reach) {
            return;
        }
        // With the eye in the gap itself there is nothing to tell pixels by.
        let length = reach - self.gap;
        let width = self.screen.width((z - length).max(0.25 * z.abs()).max(0.05 * self.gap));
        if length > 0.4 * width && halvings > 0 {
            let half = 0.5 * (from + to);
            self.along((from, half), halvings - 1, found);
            self.along((half, to), halvings - 1, found);
            return;
        }
        let ends = self.uses[0].interval;
        let other = nearest(self.b, middle, self.uses[1].interval).at.point;
        self.across([middle, other], DVec2::ZERO, found);
        for end in [from, to].into_iter().filter(|t| *t == ends.0 || *t == ends.1) {
            let point = self.a.at(end).point;
            let other = nearest(self.b, point, self.uses[1].interval).at.point;
            let (Some(p), Some(q)) = (self.screen.project(point), self.screen.project(middle)) else {
                continue;
            };
            let outward = (p - q).normalize_or_zero();
            if outward != DVec2::ZERO {
                self.across([point, other], outward, found);
            }
        }
    }

    /// The pixels between the two sides, one point of each; and beyond the end of the edge those farther `outward` (unit,
    /// pixels) up to the face that closes the gap there.
    fn across(&self, points: [DVec3; 2], outward: DVec2, found: &mut Vec<Suspect>) {
        let [Some(p), Some(q)] = points.map(|point| self.screen.project(point)) else { return };
        let length = (q - p).length().min(MOST_PX);
        let steps = (2.0 * length).ceil().max(1.0) as u32;
        let gap_px = self.gap / self.screen.width(self.screen.depth(points[0]));
        let rows = if outward == DVec2::ZERO { 0 } else { (3.0 * gap_px.min(MOST_PX)).ceil() as u32 };
        let faces = self.uses.map(|u| u.curve.face as u32);
        // A strip that is open to one side is the outline of the part.
        let along = (q - p).normalize_or_zero();
        let beyond = gap_px.min(MOST_PX).ceil() as u32 + 3;
        let [z_p, z_q] = points.map(|point| self.screen.depth(point));
        if !(self.is_bounded(p, -along, z_p, beyond) && self.is_bounded(q, along, z_q, beyond)) {
            return;
        }
        for k in 0..=steps {
            let s = f64::from(k) / f64::from(steps);
            let z = self.screen.depth(points[0].lerp(points[1], s));
            let first = found.len();
            let mut closed = rows == 0;
            for row in 0..=rows {
                let at = p.lerp(q, s) + outward * (0.5 * f64::from(row));
                if at.min_element() < 0.0 || (at - self.screen.size).max_element() >= 0.0 {
                    break;
                }
                let off = 0.5 * f64::from(row) + s.min(1.0 - s) * length;
                if self.shows_behind(at, z, if rows > 0 { CLEAR * off } else { 0.0 }) {
                    let pixel = [at.x as u32, at.y as u32];
                    let candidate = HoleCandidate { pixel, faces, z: z as f32 };
                    found.push(Suspect { candidate, beyond: rows > 0 });
                } else if row > 0 {
                    closed = true;
                    break;
                }
            }
            if !closed {
                found.truncate(first);
            }
        }
    }

    /// Whether the picture shows a surface about as deep as `z`, or goes on, up to `most` pixels from `from` along `direction`.
    fn is_bounded(&self, from: DVec2, direction: DVec2, z: f64, most: u32) -> bool {
        direction == DVec2::ZERO
            || (1..=most).map(f64::from).any(|k| {
                let at = from + direction * k;
                let outside = at.min_element() < 0.0 || (at - self.screen.size).max_element() >= 0.0;
                outside || !self.shows_behind(at, z, STEEPEST * (k + 1.0) + f64::from(most))
            })
    }

    /// Whether a place of the picture shows something behind the edge, by a pixel and by more than `clear` pixels.
    fn shows_behind(&self, at: DVec2, z: f64, clear: f64) -> bool {
        let here = self.buffer.at(at.x as i32, at.y as i32);
        let least = self.screen.width(z) * clear.max(1.0);
        here.words[0] == 0 || f64::from(z_of(self.view, &here)) > z + least
    }
}
