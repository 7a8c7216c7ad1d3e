//! Faces derived and packed after an edit against faces derived and packed anew, bit for bit.

use glam::{DVec2, DVec3};
use hairline::commands::bench::shapes::{Random, Shape, circle};
use hairline::encoding::{FaceShape, PackedScene};
use hairline::kernel::bezier::BezierCurve2;
use hairline::kernel::face::Face;
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use hairline::kernel::trim::grid::layout::CELL_REFINED;
use hairline::kernel::trim::{LoopRecord, LoopRole};

fn spline(curve: &BezierCurve2) -> NurbsCurve2 {
    let knots = KnotVector::bezier(curve.degree(), 0.0, 2.0).expect("a degree");
    NurbsCurve2::new(knots, curve.points.clone(), curve.weights.clone()).expect("counts fit")
}

fn loop_of(curves: &[BezierCurve2]) -> LoopRecord {
    LoopRecord::new(LoopRole::Unknown, curves.iter().map(spline).collect())
}

fn plane(corner: f64) -> NurbsSurface {
    let knots = || KnotVector::bezier(1, -1.0, 2.0).expect("degree 1");
    let points = vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::new(1.0, 1.0, corner)];
    NurbsSurface::new(knots(), knots(), points, vec![1.0; 4]).expect("counts fit")
}

fn with_point(curve: &NurbsCurve2, at: usize, by: DVec2) -> NurbsCurve2 {
    let mut points = curve.points().to_vec();
    points[at] += by;
    NurbsCurve2::new(curve.knots().clone(), points, curve.weights().to_vec()).expect("finite")
}

/// One random edit of the loops.
fn edit(loops: &mut [LoopRecord], random: &mut Random) {
    let pick = |n: usize, random: &mut Random| (random.bits() % n.max(1) as u64) as usize;
    let index = pick(loops.len(), random);
    let curves = &mut loops[index].curves;
    let at = pick(curves.len(), random);
    let size = curves[at].points()[0].distance(*curves[at].points().last().expect("a point"));
    let by = (random.point() - 0.5) * size * 10f64.powf(1.0 - 3.0 * random.unit());
    match pick(12, random) {
        // An inner control point, or a corner shared by two curves.
        0..6 => {
            let inner = pick(curves[at].points().len(), random);
            curves[at] = with_point(&curves[at], inner, by);
        }
        6 | 7 => {
            let (last, next) = (curves[at].points().len() - 1, (at + 1) % curves.len());
            curves[at] = with_point(&curves[at], last, by);
            curves[next] = with_point(&curves[next], 0, by);
        }
        8 => {
            let weights: Vec<f64> = curves[at].weights().iter().map(|w| w * (0.5 + random.unit())).collect();
            let changed = NurbsCurve2::new(curves[at].knots().clone(), curves[at].points().to_vec(), weights);
            curves[at] = changed.expect("positive weights");
        }
        // A curve more, one less, a whole loop of no extent and back.
        9 => {
            let p = curves[at].points()[0];
            curves.insert(at, NurbsCurve2::line(p, p + by));
        }
        10 if curves.len() > 2 => drop(curves.remove(at)),
        _ => {
            let centre = random.point();
            let radius = if random.bits() & 1 == 0 { 0.0 } else { 0.05 * random.unit() };
            *curves = circle(centre, radius, 0.3, true).iter().map(spline).collect();
        }
    }
}

#[test]
fn a_face_derived_after_edits_equals_one_derived_anew() {
    let mut random = Random(11);
    let (mut refined, mut resumed) = (0, 0);
    for (shape, curves, edits) in [
        (Shape::Holes, 4, 60),
        (Shape::Holes, 40, 150),
        (Shape::RationalHoles, 400, 60),
        (Shape::Blob, 100, 60),
        (Shape::Blob, 4000, 12),
        (Shape::Hair, 400, 40),
    ] {
        let mut loops: Vec<LoopRecord> = shape.loops(curves).iter().map(|l| loop_of(l)).collect();
        // A frame, so that the domain stays; small enough for some edits to reach out of it.
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let sides = (0..4).map(|i| NurbsCurve2::line(square[i], square[(i + 1) % 4])).collect();
        loops.push(LoopRecord::new(LoopRole::Outer, sides));
        let mut surface = plane(0.3);
        let mut face = Face::derive(&surface, &loops).expect("a face");
        let mut scene = PackedScene::from_faces((0..2).map(|_| FaceShape::of(&face, None, false)));
        let slot = scene.slots().next().expect("two faces");
        let original = loops.clone();
        for step in 0..edits {
            if step % 17 == 16 {
                surface = plane(random.unit());
            }
            match step % 9 {
                7 => loops = original.clone(),
                8 => (0..3).for_each(|_| edit(&mut loops, &mut random)),
                _ => edit(&mut loops, &mut random),
            }
            let fresh = Face::derive(&surface, &loops);
            let after = Face::derive_after(&face, &surface, &loops);
            assert!(after == fresh, "{} {curves}, step {step}", shape.name());
            let Ok(after) = after else { continue };
            refined += after.grid.cells.iter().filter(|c| *c & CELL_REFINED != 0).count();
            resumed += usize::from(after.domain == face.domain);
            face = after;
            let packed = FaceShape::of(&face, None, false);
            scene.replace(slot, &packed);
            let anew = PackedScene::from_faces([packed]);
            let first = anew.slots().next().expect("a face");
            assert!(scene.is_packed_like(slot, &anew, first), "{} {curves}, step {step}", shape.name());
            assert!(scene.room().is_some(), "ranges overlap or leak");
        }
    }
    assert!(refined > 100 && resumed > 200, "{refined} refined cells, {resumed} edits in the same domain");
}

#[test]
fn a_random_walk_of_edits_leaves_nothing_behind_and_leads_back() {
    let walk = hairline::commands::bench::walk::walk(3000, 500, 5, &|_| ());
    assert_eq!(walk.compared[1], 0, "{walk:?}");
    assert!(walk.came_back && walk.steps.iter().all(|n| *n > 200), "{walk:?}");
    let (size, free) = walk.room[2];
    assert!(size > 0 && free < size / 2, "{walk:?}");
}
