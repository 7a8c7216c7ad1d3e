//! Proof of a suspect in f64: its ray passes the edge within the gap, between the two sides, and meets neither surface.

use glam::{DMat2, DVec2, DVec3};

use super::screen::Screen;
use super::walk::Suspect;
use super::{FINEST_PIXEL, HoleClass, HoleScene, PinHole};
use crate::inspect::lifted::LiftedCurve;
use crate::inspect::nearest::nearest;
use crate::inspect::{Edge, EdgeKey};
use crate::kernel::bezier::BezierPatch;
use crate::kernel::face::Face;
use crate::kernel::query::raycast::patch_hits;
use crate::kernel::trim::{FillRule, oracle};
use crate::kernel::view::Ray;

/// Where a line passes a curve.
struct Approach {
    t: f64,
    point: DVec3,
    /// From the line to the point, across the line.
    off: DVec3,
}

fn approach(curve: &LiftedCurve, range: (f64, f64), ray: &Ray) -> Approach {
    let off = |p: DVec3| {
        let d = p - ray.origin;
        d - ray.direction * d.dot(ray.direction)
    };
    let at = |t: f64| {
        let point = curve.at(t).point;
        Approach { t, point, off: off(point) }
    };
    let distance = |t: f64| off(curve.at(t).point).length_squared();
    let mut stations = vec![(range.0, off(curve.at(range.0).point))];
    let inner = curve.nodes().iter().filter(|n| n.t > range.0 && n.t < range.1);
    stations.extend(inner.map(|n| (n.t, off(n.point))));
    stations.push((range.1, off(curve.at(range.1).point)));
    // Distance of the line from each chord finds the piece; golden sections the point on it.
    let chord = |k: usize| {
        let (p, q) = (stations[k].1, stations[k + 1].1);
        let along = q - p;
        let s = (-p.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p + along * s).length_squared()
    };
    let best = (0..stations.len() - 1).min_by(|a, b| chord(*a).total_cmp(&chord(*b))).unwrap_or(0);
    let (mut low, mut high) =
        (stations[best.saturating_sub(1)].0, stations[(best + 2).min(stations.len() - 1)].0);
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    // A minimum is flat: more do not make it better.
    const GOLDEN_STEPS: usize = 36;
    let (mut c, mut d) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fc, mut fd) = (distance(c), distance(d));
    for _ in 0..GOLDEN_STEPS {
        if fc <= fd {
            (high, d, fd) = (d, c, fc);
            c = high - GOLDEN * (high - low);
            fc = distance(c);
        } else {
            (low, c, fc) = (c, d, fd);
            d = low + GOLDEN * (high - low);
            fd = distance(d);
        }
    }
    at(0.5 * (low + high))
}

/// What a pixel shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shown {
    /// Depth; infinite for the background.
    pub(super) z: f64,
    /// Position of the face in the model.
    pub(super) face: Option<usize>,
}

/// Proves a candidate, whose faces are positions in the model.
pub(super) fn prove(scene: &HoleScene, screen: &Screen, suspect: &Suspect, shown: Shown) -> Option<PinHole> {
    let candidate = &suspect.candidate;
    let ray = screen.ray(candidate.pixel);
    let [a, b] = candidate.faces.map(|f| f as usize);
    let sides = scene.pairs.between(a, b).iter().filter_map(|key| {
        let edge = scene.inspection.edge(key)?;
        let (i, j) = sides_of(edge, a, b)?;
        let side = |k: usize| {
            let used = &edge.uses[k];
            Some((
                scene.inspection.curve(&used.curve)?,
                approach(scene.inspection.curve(&used.curve)?, used.interval, &ray),
            ))
        };
        Some((*key, edge, j, side(i)?, side(j)?))
    });
    let nearest_side = sides.min_by(|p, q| {
        let off = |s: &(EdgeKey, &Edge, usize, (&LiftedCurve, Approach), (&LiftedCurve, Approach))| {
            s.3.1.off.length().min(s.4.1.off.length())
        };
        off(p).total_cmp(&off(q))
    })?;
    let (key, edge, j, (curve, first), (other, second)) = nearest_side;
    let width = screen.width(screen.depth(first.point));
    let gap = edge.gap.map_or(0.0, |g| g.maximum + g.error_bound);
    let off = first.off.length().min(second.off.length());
    // Half the diagonal of a pixel.
    if off > gap + 0.75 * width {
        return None;
    }
    let foot = nearest(other, first.point, edge.uses[j].interval);
    let mut hits = [(a, curve, &first), (b, other, &second)].into_iter().filter_map(|(face, curve, side)| {
        let depths = hits_near((scene.face)(face)?, &ray, curve.uv(side.t).0, side.point, gap + 4.0 * width);
        depths.into_iter().map(|t| screen.depth(ray.origin + ray.direction * t)).reduce(f64::min)
    });
    let hit = hits.next().map(|z| hits.fold(z, f64::min));
    if hit.is_some_and(|z| shown.z <= z + 8.0 * width + 1e-5 * z.abs()) {
        // The picture shows it.
        return None;
    }
    // Something as near as the sides, such as one of them where it is rounded, or what conceals the hole.
    let own = shown.face.is_some_and(|face| face == a || face == b);
    // Beyond the end of the edge it is the face that closes the corner, which bends away.
    let borders = |face: usize| [a, b].iter().any(|side| !scene.pairs.between(face, *side).is_empty());
    let closing = suspect.beyond && shown.face.is_some_and(borders);
    let behind = match (own, closing) {
        (_, true) => gap + 4.0 * width,
        (true, _) => 4.0 * width,
        _ => width,
    };
    if shown.z <= screen.depth(first.point).max(screen.depth(second.point)) + behind {
        return None;
    }
    // On both sides of the ray, within a small part of a pixel; beyond the end of the edge the picture told.
    let between = suspect.beyond || first.off.dot(second.off) <= (0.05 * width).powi(2);
    let finest = FINEST_PIXEL * curve.ground().size().max(other.ground().size());
    let class = if hit.is_some() {
        if width < finest { HoleClass::Rounding } else { HoleClass::Solver }
    } else if !between {
        return None;
    } else {
        let apart = foot.at.point - first.point;
        let inward = curve.inward(first.t).unwrap_or(DVec3::ZERO);
        if apart.dot(inward) > OVERLAP_RATIO * apart.length() { HoleClass::Overlap } else { HoleClass::Gap }
    };
    Some(PinHole {
        pixel: candidate.pixel,
        edge: key,
        faces: [a, b],
        point: first.point,
        gap: foot.distance,
        class,
    })
}

/// Sides overlap when at least this part of their distance lies across the edge.
const OVERLAP_RATIO: f64 = 0.3;

/// Uses of an edge by two faces.
fn sides_of(edge: &Edge, a: usize, b: usize) -> Option<(usize, usize)> {
    let i = edge.uses.iter().position(|u| u.curve.face == a)?;
    let j = edge.uses.iter().enumerate().position(|(k, u)| k != i && u.curve.face == b)?;
    Some((i, j))
}

/// Parameters nearer than this to a trim curve are on it, for exact surfaces.
const EXACT: f64 = 1e-12;

/// Where a line meets the kept part of a face near `point` on its border, at native parameters `uv`: within `reach` of it,
/// or more at a slant.
fn hits_near(face: &Face, ray: &Ray, uv: DVec2, point: DVec3, reach: f64) -> Vec<f64> {
    if let Some(only) = hit_beside(face, ray, uv) {
        return only.into_iter().collect();
    }
    let along = (point - ray.origin).dot(ray.direction);
    let near = |patch: &&BezierPatch| {
        let bounds = patch.bounds();
        let margin = DVec3::splat(reach);
        (point.cmpge(bounds.min - margin) & point.cmple(bounds.max + margin)).all()
    };
    let hits = face.patches.iter().filter(near).flat_map(|patch| patch_hits(patch, ray).hits);
    let kept = hits.filter(|hit| {
        let slant = hit.normal.normalize_or_zero().dot(ray.direction).abs().max(0.02);
        (hit.t - along).abs() <= reach / slant && is_kept(face, hit.uv)
    });
    kept.map(|hit| hit.t).collect()
}

/// Steps of Newton's method at most.
const STEPS: usize = 12;
/// How far beyond a patch its polynomials are followed, in its own parameters.
const BEYOND: f64 = 0.2;
/// Least cosine between line and normal: at a grazing look the surface may be met twice.
const STEEP: f64 = 0.2;

/// The same by Newton's method from the border on. The outer `None`: it does not tell, so that all hits have to be
/// looked for.
fn hit_beside(face: &Face, ray: &Ray, uv: DVec2) -> Option<Option<f64>> {
    let holds = |patch: &&BezierPatch| {
        let slack = 1e-9 * (patch.uv_max - patch.uv_min);
        (uv.cmpge(patch.uv_min - slack) & uv.cmple(patch.uv_max + slack)).all()
    };
    let patch = face.patches.iter().find(holds)?;
    let x_axis = ray.direction.any_orthonormal_vector();
    let y_axis = ray.direction.cross(x_axis);
    let flat = |p: DVec3| DVec2::new(p.dot(x_axis), p.dot(y_axis));
    let mut local = patch.local(uv);
    for _ in 0..STEPS {
        let t = patch.tangents(local.x, local.y);
        let normal = t.du.cross(t.dv).try_normalize()?;
        if normal.dot(ray.direction).abs() < STEEP {
            return None;
        }
        let (f, du, dv) = (flat(t.point - ray.origin), flat(t.du), flat(t.dv));
        let step = DMat2::from_cols(du, dv).inverse() * -f;
        if !step.is_finite() {
            return None;
        }
        local += step;
        if (local - local.clamp(DVec2::ZERO, DVec2::ONE)).abs().max_element() > BEYOND {
            return None;
        }
        if step.abs().max_element() < 1e-13 {
            let native = patch.native(local);
            let inside = (local.cmpge(DVec2::ZERO) & local.cmple(DVec2::ONE)).all();
            let domain = &face.domain;
            let within = (native.cmpgt(domain.min) & native.cmplt(domain.max)).all();
            if !inside && within {
                // On a neighbouring patch, which is another surface.
                return None;
            }
            let hit = patch.point(local.x, local.y);
            return Some(is_kept(face, native).then(|| (hit - ray.origin).dot(ray.direction)));
        }
    }
    None
}

fn is_kept(face: &Face, native: DVec2) -> bool {
    let p = face.domain.normalise(native);
    if p.min_element() < -EXACT || p.max_element() > 1.0 + EXACT {
        return false;
    }
    oracle::inside(&face.pieces, p, FillRule::EvenOdd) || oracle::is_on(&face.pieces, p, EXACT)
}
