//! The boundary of a face as it is after all repairs, lifted to model space.
//!
//! Every chain of trim pieces becomes runs: stretches that come from one curve of the loop record. Pieces are cut where
//! they cross the lines between patches, so that each lies on one patch, and lifted exactly ([`super::lift`]). A run is
//! parametrised by `s` from 0 to its number of pieces. Invariant: a run starts where the one before it in its chain ends.

use glam::{DVec2, DVec3};

use super::lift::{self, HIGHEST_DEGREE};
use crate::kernel::bezier::{BezierCurve2, BezierCurve3, BezierPatch, Tangents};
use crate::kernel::face::Face;
use crate::kernel::nurbs::surface::SurfaceJet;
use crate::kernel::query::Sheet;

/// A piece of a trim curve on one patch.
#[derive(Debug, Clone, PartialEq)]
pub struct LiftedPiece {
    /// The pcurve in native parameters.
    pub uv: BezierCurve2,
    /// Its image.
    pub space: BezierCurve3,
}

/// Part of a chain that comes from one trim curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Number of the curve in its loop record; `None` for lines that close gaps.
    pub source: Option<u32>,
    /// End to end.
    pub pieces: Vec<LiftedPiece>,
}

/// All chains of a face.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outline {
    /// Runs of each chain, end to end and closed.
    pub chains: Vec<Vec<Run>>,
}

/// A face's surface as patches, everywhere: points off the patches belong to the nearest one.
#[derive(Debug, Clone)]
pub struct Ground<'a> {
    /// The patches by their parameters.
    pub sheet: Sheet<'a>,
    patches: &'a [BezierPatch],
}

impl<'a> Ground<'a> {
    /// The surface of `face`.
    pub fn new(face: &'a Face) -> Self {
        Self { sheet: Sheet::new(&face.patches), patches: &face.patches }
    }

    /// The patches.
    pub fn patches(&self) -> &'a [BezierPatch] {
        self.patches
    }

    /// The patch for `uv` (native) and the parameters on it; `None` without any patches.
    pub fn locate(&self, uv: DVec2) -> Option<(&'a BezierPatch, DVec2)> {
        self.sheet.locate(uv).or_else(|| {
            let off = |p: &&BezierPatch| uv.clamp(p.uv_min, p.uv_max).distance_squared(uv);
            let nearest = self.patches.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
            Some((nearest, nearest.local(uv).clamp(DVec2::ZERO, DVec2::ONE)))
        })
    }

    /// The point at `uv`.
    pub fn point(&self, uv: DVec2) -> DVec3 {
        self.locate(uv).map_or(DVec3::NAN, |(patch, local)| patch.point(local.x, local.y))
    }

    /// Point, first and second derivatives in native parameters at `uv`.
    pub fn jet(&self, uv: DVec2) -> Option<SurfaceJet> {
        let (patch, local) = self.locate(uv)?;
        let at = patch.jet(local.x, local.y);
        let per = 1.0 / (patch.uv_max - patch.uv_min);
        Some(SurfaceJet {
            point: at.point,
            du: at.du * per.x,
            dv: at.dv * per.y,
            duu: at.duu * (per.x * per.x),
            duv: at.duv * (per.x * per.y),
            dvv: at.dvv * (per.y * per.y),
        })
    }

    /// Point and derivatives in native parameters at `uv`.
    pub fn tangents(&self, uv: DVec2) -> Tangents {
        let nothing = Tangents { point: DVec3::NAN, du: DVec3::ZERO, dv: DVec3::ZERO };
        self.locate(uv).map_or(nothing, |(patch, local)| {
            let at = patch.tangents(local.x, local.y);
            let size = patch.uv_max - patch.uv_min;
            Tangents { point: at.point, du: at.du / size.x, dv: at.dv / size.y }
        })
    }
}

impl Run {
    /// Number of pieces: the range of `s`.
    pub fn range(&self) -> f64 {
        self.pieces.len() as f64
    }

    fn at(&self, s: f64) -> (&LiftedPiece, f64) {
        let k = (s.max(0.0) as usize).min(self.pieces.len() - 1);
        (&self.pieces[k], s - k as f64)
    }

    /// Native parameters at `s`.
    pub fn uv(&self, s: f64) -> DVec2 {
        let (piece, t) = self.at(s);
        end_or(&piece.uv, t)
    }

    /// Point at `s`.
    pub fn point(&self, s: f64) -> DVec3 {
        let (piece, t) = self.at(s);
        end_or(&piece.space, t)
    }

    /// Parameter of a point of the run near `p`, found from `guess` within `from..to` going downhill.
    pub fn project(&self, p: DVec3, guess: f64, (from, to): (f64, f64)) -> f64 {
        /// Steps below this part of a piece are rounding.
        const ROUNDING: f64 = 1e-12;
        let mut s = guess.clamp(from, to);
        let mut here = self.tangent(s);
        let mut best = here.0.distance_squared(p);
        for _ in 0..24 {
            let mut step = self.downhill(s, here, p);
            let mut moved = false;
            for _ in 0..6 {
                if !(step.abs() > ROUNDING) {
                    break;
                }
                // Across a joint the speed may be another: steps end there.
                let floor = (s.ceil() - 1.0).max(from);
                let ceiling = (s.floor() + 1.0).min(to);
                let next = (s + step).clamp(floor, ceiling);
                if next == s {
                    break;
                }
                let there = self.tangent(next);
                let off = there.0.distance_squared(p);
                if off < best {
                    moved = (next - s).abs() > 1e-14 * self.range();
                    (s, here, best) = (next, there, off);
                    break;
                }
                step *= 0.3;
            }
            if !moved {
                break;
            }
        }
        s
    }

    /// Point and derivative at `s`.
    fn tangent(&self, s: f64) -> (DVec3, DVec3) {
        let (piece, t) = self.at(s);
        tangent(&piece.space, t)
    }

    /// The step from `s`, where the run has the point and derivative `here`, that brings it nearest to `p` as far as its tangent
    /// goes. Speeds differ on either side of a joint, so each side is asked for itself.
    fn downhill(&self, s: f64, here: (DVec3, DVec3), p: DVec3) -> f64 {
        let step = |(point, d): (DVec3, DVec3)| {
            let squared = d.length_squared();
            if squared > 0.0 { (p - point).dot(d) / squared } else { 0.0 }
        };
        let ahead = step(here);
        if ahead < 0.0 && s > 0.0 && s.fract() == 0.0 {
            let before = &self.pieces[(s as usize).min(self.pieces.len()) - 1];
            return step(tangent(&before.space, 1.0)).min(0.0);
        }
        ahead
    }

    /// Parameter of the point nearest to `p` and its distance, where the run comes within `reach`: the best of several starts
    /// on each piece (a helix comes by again and again, a piece that is closed at both of its ends), but for pieces whose
    /// control points keep away.
    pub fn nearest_within(&self, p: DVec3, reach: f64) -> Option<(f64, f64)> {
        const SAMPLES: usize = 8;
        /// Pieces that are gone down from, the nearest first.
        const MOST: usize = 6;
        let mut starts: Vec<(f64, f64)> = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            let (low, high) = piece.space.hull();
            if p.clamp(low, high).distance(p) > reach {
                continue;
            }
            let count = if is_even_line(&piece.space) { 1 } else { SAMPLES };
            let mut own = [(f64::INFINITY, 0.0); SAMPLES + 1];
            for (i, start) in own[..=count].iter_mut().enumerate() {
                let s = k as f64 + i as f64 / count as f64;
                *start = (self.point(s).distance_squared(p), s);
            }
            let off = |i: usize| own.get(i).map_or(f64::INFINITY, |start| start.0);
            let lowest = |i: usize| off(i) <= off(i.wrapping_sub(1)) && off(i) <= off(i + 1);
            starts.extend((0..=count).filter(|i| lowest(*i)).map(|i| own[i]));
        }
        starts.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let feet = starts.iter().take(MOST).map(|start| {
            let s = self.project(p, start.1, (0.0, self.range()));
            (s, self.point(s).distance(p))
        });
        feet.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|foot| foot.1 <= reach)
    }

    /// Whether the run is another one, or that backwards: the same points at the same parameters, to within about `reach`.
    pub fn is_like(&self, other: &Self, forward: bool, reach: f64) -> bool {
        /// Part of a weight that is rounding.
        const ROUNDING: f64 = 1e-10;
        let count = self.pieces.len();
        let alike = |k: usize| {
            let a = &self.pieces[k].space;
            let b = &other.pieces[if forward { k } else { count - 1 - k }].space;
            let degree = a.degree();
            let of = |i: usize| if forward { i } else { degree - i };
            let point = |i: usize| {
                let (x, y) = (a.weights[i] * b.weights[of(0)], a.weights[0] * b.weights[of(i)]);
                a.points[i].distance(b.points[of(i)]) <= reach && (x - y).abs() <= ROUNDING * x
            };
            degree == b.degree() && (0..=degree).all(point)
        };
        count == other.pieces.len() && (0..count).all(alike)
    }

    /// Whether the part between two parameters lies on one piece that is a line in parameters.
    pub fn is_straight(&self, from: f64, to: f64) -> bool {
        let k = from as usize;
        to <= (k + 1) as f64 && self.pieces.get(k).is_some_and(|piece| piece.uv.points.len() == 2)
    }

    /// The vector towards the centre of curvature at `s`, as long as the curvature.
    pub fn curvature(&self, s: f64) -> DVec3 {
        let (piece, t) = self.at(s);
        let jet = piece.space.jet(t);
        let squared = jet.d1.length_squared();
        if squared > 0.0 { (jet.d2 - jet.d1 * (jet.d2.dot(jet.d1) / squared)) / squared } else { DVec3::ZERO }
    }

    /// First and last point.
    pub fn ends(&self) -> [DVec3; 2] {
        [self.point(0.0), self.point(self.range())]
    }
}

impl Run {
    /// The part between two parameters as a run of its own, with the whole run's parameters of its joints.
    pub fn part(&self, from: f64, to: f64) -> (Self, Vec<f64>) {
        let (first, last) = (from as usize, (to.ceil() as usize).clamp(1, self.pieces.len()));
        let mut places = vec![from];
        let mut pieces = Vec::new();
        for k in first..last {
            let piece = &self.pieces[k];
            let (low, high) = ((from - k as f64).max(0.0), (to - k as f64).min(1.0));
            if !(high > low) {
                continue;
            }
            places.push(k as f64 + high);
            pieces.push(match (low, high) {
                (0.0, 1.0) => piece.clone(),
                _ => LiftedPiece { uv: piece.uv.restrict(low, high), space: piece.space.restrict(low, high) },
            });
        }
        (Self { source: self.source, pieces }, places)
    }
}

/// The curve at `t`, exactly its end points at the ends.
fn end_or<V: crate::kernel::vector::Vector>(curve: &crate::kernel::bezier::BezierCurve<V>, t: f64) -> V {
    match t {
        0.0 => curve.start(),
        1.0 => curve.end(),
        _ if is_even_line(curve) => curve.points[0] * (1.0 - t) + curve.points[1] * t,
        _ => curve.point(t),
    }
}

/// Point and derivative of the curve at `t`, exactly its end points at the ends.
fn tangent(curve: &BezierCurve3, t: f64) -> (DVec3, DVec3) {
    if is_even_line(curve) {
        return (end_or(curve, t), curve.points[1] - curve.points[0]);
    }
    let (point, d) = curve.tangent(t);
    match t {
        0.0 => (curve.start(), d),
        1.0 => (curve.end(), d),
        _ => (point, d),
    }
}

/// Whether the curve is a line run through at even speed, as most of a machine part's are.
fn is_even_line<V: crate::kernel::vector::Vector>(curve: &crate::kernel::bezier::BezierCurve<V>) -> bool {
    curve.points.len() == 2 && curve.weights[0] == curve.weights[1]
}

impl Outline {
    /// The outline of `face` over its `ground`. Where a degree is too high to be composed exactly the
    /// image is fitted to within `precision` (model units).
    pub fn new(face: &Face, ground: &Ground, precision: f64) -> Self {
        let chain = |index: usize| {
            let mut runs: Vec<Run> = Vec::new();
            for piece in &face.pieces.pieces()[face.pieces.chain(index)] {
                let points = face.pieces.points(piece).iter().map(|p| face.domain.native(*p)).collect();
                let curve = BezierCurve2 { points, weights: face.pieces.weights(piece).to_vec() };
                // Sides of the surface's rectangle and lines that close gaps come from no curve: they end at corners.
                let starts = |r: &Run| {
                    r.source != piece.source || piece.source.is_none() && turns(r, &curve, face.domain.size())
                };
                if runs.last().is_none_or(starts) {
                    runs.push(Run { source: piece.source, pieces: Vec::new() });
                }
                if let Some(run) = runs.last_mut() {
                    cut_and_lift(curve, ground, precision, &mut run.pieces);
                }
            }
            runs.iter_mut().for_each(|run| drop_crumbs(run, face.domain.size(), precision));
            runs.retain(|run| !run.pieces.is_empty());
            runs
        };
        Self { chains: (0..face.pieces.chain_count()).map(chain).collect() }
    }

    /// The outline with one run for each chain: what simplification of whole loops goes along.
    pub fn joined(self) -> Self {
        let join = |runs: Vec<Run>| {
            let pieces: Vec<LiftedPiece> = runs.into_iter().flat_map(|run| run.pieces).collect();
            if pieces.is_empty() { Vec::new() } else { vec![Run { source: None, pieces }] }
        };
        Self { chains: self.chains.into_iter().map(join).collect() }
    }

    /// All runs with the numbers of their chain and place in it.
    pub fn runs(&self) -> impl Iterator<Item = (usize, usize, &Run)> {
        let chains = self.chains.iter().enumerate();
        chains.flat_map(|(c, runs)| runs.iter().enumerate().map(move |(r, run)| (c, r, run)))
    }
}

/// Whether `next` goes off in another direction than the run ends in, parameters taken as parts of `domain`.
fn turns(run: &Run, next: &BezierCurve2, domain: DVec2) -> bool {
    let Some(last) = run.pieces.last() else { return false };
    let way = |c: &BezierCurve2| ((c.end() - c.start()) / domain).normalize_or_zero();
    way(&last.uv).dot(way(next)) < 0.999
}

/// Takes out pieces that are rounding: they would stall whoever walks along the run. Their neighbours close up, which must be
/// so long that this does not matter. What goes farther than `reach` in space is none, however little of the parameters it
/// takes.
fn drop_crumbs(run: &mut Run, domain: DVec2, reach: f64) {
    /// Part of the domain, and of a neighbour, that is rounding.
    const CRUMB: f64 = 1e-9;
    const OF_NEIGHBOUR: f64 = 1e-3;
    let size = |piece: &LiftedPiece| {
        let (low, high) = piece.uv.hull();
        ((high - low) / domain).max_element()
    };
    let is_crumb = |piece: &LiftedPiece| {
        let far = || piece.space.points.iter().any(|p| p.distance(piece.space.start()) > reach);
        size(piece) < CRUMB && !far()
    };
    if !run.pieces.iter().any(is_crumb) {
        return;
    }
    let mut kept: Vec<LiftedPiece> = Vec::with_capacity(run.pieces.len());
    let mut start: Option<(DVec2, DVec3)> = None;
    for mut piece in run.pieces.drain(..) {
        if is_crumb(&piece) {
            match kept.last_mut() {
                Some(before) if size(&piece) <= OF_NEIGHBOUR * size(before) => {
                    set_end(before, piece.uv.end(), piece.space.end());
                    continue;
                }
                Some(_) => {}
                None => {
                    start = start.or(Some((piece.uv.start(), piece.space.start())));
                    continue;
                }
            }
        }
        if let Some((uv, point)) = start.take() {
            piece.uv.points[0] = uv;
            piece.space.points[0] = point;
        }
        kept.push(piece);
    }
    run.pieces = kept;
}

fn set_end(piece: &mut LiftedPiece, uv: DVec2, point: DVec3) {
    if let (Some(last), Some(end)) = (piece.uv.points.last_mut(), piece.space.points.last_mut()) {
        (*last, *end) = (uv, point);
    }
}

/// Cuts a monotone curve at the lines between patches and lifts the parts.
fn cut_and_lift(curve: BezierCurve2, ground: &Ground, precision: f64, pieces: &mut Vec<LiftedPiece>) {
    let mut cuts = vec![0.0];
    for (axis, lines) in [(0, ground.sheet.u_lines()), (1, ground.sheet.v_lines())] {
        let (a, b) = (curve.start()[axis], curve.end()[axis]);
        let (low, high) = (a.min(b), a.max(b));
        // A line that hardly reaches across a border of a patch stays whole.
        let slack = 1e-9 * (high - low);
        let inside = lines.iter().filter(|x| **x > low + slack && **x < high - slack);
        cuts.extend(inside.map(|x| crossing(&curve, axis, *x)));
    }
    cuts.push(1.0);
    cuts.sort_unstable_by(f64::total_cmp);
    // Lines may be as near to each other as that; what is rounding is dropped later.
    cuts.dedup_by(|b, a| *b - *a < 1e-12);
    if let Some(last) = cuts.last_mut() {
        *last = 1.0;
    }
    let parts = cuts.len() - 1;
    if parts == 1 {
        return lift_part(curve, ground, precision, pieces);
    }
    let mut from = curve.start();
    for k in 0..parts {
        let mut part = curve.restrict(cuts[k], cuts[k + 1]);
        let last = part.points.len() - 1;
        part.points[0] = from;
        if k + 1 == parts {
            part.points[last] = curve.end();
        }
        from = part.points[last];
        lift_part(part, ground, precision, pieces);
    }
}

/// Where a monotone curve has the coordinate `x`.
fn crossing(curve: &BezierCurve2, axis: usize, x: f64) -> f64 {
    let (a, b) = (curve.start()[axis], curve.end()[axis]);
    if curve.degree() == 1 && !curve.is_rational() {
        return (x - a) / (b - a);
    }
    let rising = b > a;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..52 {
        let t = 0.5 * (low + high);
        if (curve.point(t)[axis] < x) == rising {
            low = t;
        } else {
            high = t;
        }
    }
    0.5 * (low + high)
}

fn lift_part(uv: BezierCurve2, ground: &Ground, precision: f64, pieces: &mut Vec<LiftedPiece>) {
    let middle = uv.point(0.5);
    let Some((patch, _)) = ground.locate(inward(ground, middle)) else { return };
    let local = lift::localised(&uv, patch);
    let mut space = Vec::new();
    if lift::lifted_degree(&local, patch) <= HIGHEST_DEGREE {
        space.push((uv, lift::lift(&local, patch)));
    } else {
        fit(&uv, patch, precision, 12, &mut space);
    }
    for (uv, mut space) in space {
        if let Some(before) = pieces.last() {
            space.points[0] = before.space.end();
        }
        pieces.push(LiftedPiece { uv, space });
    }
}

/// A place next to `uv` that has a patch: curves along the outside of the last patch needed are its border.
fn inward(ground: &Ground, uv: DVec2) -> DVec2 {
    if ground.sheet.locate(uv).is_some() {
        return uv;
    }
    let (us, vs) = (ground.sheet.u_lines(), ground.sheet.v_lines());
    let (Some(first), Some(last)) = (us.first().zip(vs.first()), us.last().zip(vs.last())) else { return uv };
    let step = 1e-9 * (DVec2::new(*last.0, *last.1) - DVec2::new(*first.0, *first.1));
    let around = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
    let near = around.map(|(x, y)| uv + step * DVec2::new(x, y));
    near.into_iter().find(|p| ground.sheet.locate(*p).is_some()).unwrap_or(uv)
}

/// Cubics that follow the image of `uv` to within `precision` at three points each.
fn fit(
    uv: &BezierCurve2,
    patch: &BezierPatch,
    precision: f64,
    depth: u32,
    out: &mut Vec<(BezierCurve2, BezierCurve3)>,
) {
    let jet = |t: f64| {
        let (point, d) = uv.tangent(t);
        let local = patch.local(point);
        let at = patch.tangents(local.x, local.y);
        let d = d / (patch.uv_max - patch.uv_min);
        (at.point, at.du * d.x + at.dv * d.y)
    };
    let cubic = lift::hermite(jet(0.0), jet(1.0));
    let off = [0.25, 0.5, 0.75].map(|t| cubic.point(t).distance(jet(t).0));
    if depth == 0 || off.iter().all(|d| *d <= precision) {
        out.push((uv.clone(), cubic));
        return;
    }
    let (left, right) = uv.split(0.5);
    fit(&left, patch, precision, depth - 1, out);
    fit(&right, patch, precision, depth - 1, out);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(points: &[DVec3]) -> Run {
        let piece = |p: &[DVec3]| LiftedPiece {
            uv: BezierCurve2::polynomial(p.iter().map(|p| p.truncate()).collect()),
            space: BezierCurve3::polynomial(p.to_vec()),
        };
        Run { source: None, pieces: points.windows(2).map(piece).collect() }
    }

    #[test]
    fn feet_are_found_across_pieces_of_very_different_speed() {
        let run = run(&[0.0, 1.0, 1.0 + 1e-8, 2.0].map(|x| DVec3::X * x));
        for (x, guess) in [(0.25, 2.0), (0.25, 3.0), (1.75, 1.0), (1.75, 0.0), (0.5, 1.5), (1.5, 1.5)] {
            let p = DVec3::new(x, 0.1, 0.0);
            let s = run.project(p, guess, (0.0, 3.0));
            assert!((run.point(s).x - x).abs() < 1e-12, "{x} from {guess}: {s}");
        }
    }

    #[test]
    fn feet_beside_the_joint_of_a_closed_piece_are_found_from_either_side() {
        // Round and round in one piece of degree 6, much the faster the farther from its joint.
        let points =
            [(3.0, 0.0), (3.0, 9.0), (-3.0, 9.0), (-9.0, 0.0), (-3.0, -9.0), (3.0, -9.0), (3.0, 0.0)];
        let space = BezierCurve3::polynomial(points.iter().map(|p| DVec3::new(p.0, p.1, 0.0)).collect());
        let uv = BezierCurve2::polynomial(vec![DVec2::ZERO, DVec2::X]);
        let run = Run { source: None, pieces: vec![LiftedPiece { uv, space }] };
        for k in 0..=200 {
            let s = f64::from(k) / 200.0;
            let (found, off) = run.nearest_within(run.point(s), 1e-6).expect("on the run");
            assert!(
                off < 1e-9 && ((found - s).abs() < 1e-6 || (found - s).abs() > 1.0 - 1e-6),
                "{s}: {found}"
            );
        }
    }

    #[test]
    fn the_right_turn_of_a_helix_is_found() {
        const TURNS: usize = 9;
        // Pieces as long as a turn: the samples of one are farther apart than the turns.
        let piece = |turn: usize| {
            let at = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / 12.0;
                DVec3::new(3.0 * angle.cos(), 3.0 * angle.sin(), turn as f64 + k as f64 / 12.0)
            };
            let space = BezierCurve3::polynomial((0..=12).map(at).collect());
            LiftedPiece { uv: BezierCurve2::polynomial(vec![DVec2::ZERO, DVec2::X]), space }
        };
        let run = Run { source: None, pieces: (0..TURNS).map(piece).collect() };
        for k in 0..100 {
            let s = (k as f64 + 0.37) / 100.0 * TURNS as f64;
            let (found, off) = run.nearest_within(run.point(s), 1e-6).expect("on the run");
            assert!((found - s).abs() < 1e-6 && off < 1e-9, "{s}: {found}");
        }
    }
}
