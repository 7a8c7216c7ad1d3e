//! Operations of scenes keep what they promise: shapes that must not change do not, joints stay joined, bad
//! requests are refused with the place, and every edit can be taken back bit for bit.

use glam::{DVec2, DVec3};
use hairline::kernel::face::{Face, Side};
use hairline::kernel::nurbs::{Direction, NurbsCurve2};
use hairline::scene::operation::{CurveId, NetId, Operation, PointId, Shape, Transform};
use hairline::scene::records::{LoopRecord, LoopRole, ModelRecord};
use hairline::scene::{FaceId, SceneRecord, demo};

const FACE: FaceId = FaceId { model: 0, face: 0 };

/// A square with a round hole and a rosette of cubics.
fn scene() -> SceneRecord {
    let mut face = demo::holes(4);
    face.loops.truncate(2);
    let rosette = hairline::kernel::primitives::outline::rosette(5.0, 0.3, 0.1);
    let path = move |t: f64| DVec2::new(0.7, 0.6) + 0.15 * rosette(t);
    let curves = hairline::kernel::primitives::outline::smooth(path, 12);
    face.loops.push(LoopRecord::new(LoopRole::Inner, curves));
    SceneRecord::of_model(ModelRecord { faces: vec![face], ..ModelRecord::default() })
}

/// Performs and applies; checks that the inverse gives the old scene back and the edit the new one again.
fn perform(scene: &SceneRecord, operation: &Operation) -> SceneRecord {
    let edit = operation.perform(scene).unwrap_or_else(|e| panic!("{operation:?}: {e}"));
    let mut changed = scene.clone();
    edit.apply(&mut changed).expect("the edit fits");
    let mut back = changed.clone();
    edit.inverse().apply(&mut back).expect("the inverse fits");
    assert_eq!(back, *scene, "{operation:?}");
    edit.apply(&mut back).expect("the edit fits again");
    assert_eq!(back, changed, "{operation:?}");
    changed
}

fn refusal(scene: &SceneRecord, operation: &Operation) -> String {
    operation.perform(scene).expect_err("must be refused").to_string()
}

fn face(scene: &SceneRecord) -> Face {
    scene.models[0].faces[0].derive().expect("a face")
}

fn curves(scene: &SceneRecord, trim_loop: usize) -> &[NurbsCurve2] {
    &scene.models[0].faces[0].loops[trim_loop].curves
}

/// Whether both scenes' first faces have the same points, seen at `map` of the parameters in the second.
fn same_face(a: &SceneRecord, b: &SceneRecord, map: impl Fn(DVec2) -> DVec2) -> bool {
    let (fa, fb) = (face(a), face(b));
    let (sa, sb) = (&a.models[0].faces[0].surface, &b.models[0].faces[0].surface);
    (0..1600).all(|k| {
        let p = fa.domain.native(DVec2::new((k % 40) as f64 + 0.31, (k / 40) as f64 + 0.47) / 40.0);
        let q = map(p);
        let sides = (fa.classify_native(p.x, p.y), fb.classify_native(q.x, q.y));
        let near = sides.0 == sides.1 || sides.0 == Side::On || sides.1 == Side::On;
        near && sa.point(p.x, p.y).distance(sb.point(q.x, q.y)) < 1e-12
    })
}

fn curve(trim_loop: usize, curve: usize) -> CurveId {
    CurveId { trim_loop, curve }
}

#[test]
fn shapes_stay_where_they_must() {
    let scene = scene();
    let (face, id) = (FACE, curve(1, 0));
    let (at, times, by) = (1.3, 2, 2);
    let same = |p: DVec2| p;
    for operation in [
        Operation::InsertKnot { face, curve: id, at, times },
        Operation::ElevateDegree { face, curve: id, by },
        Operation::SplitCurve { face, curve: curve(2, 4), at: 0.4 },
        Operation::ReverseLoops { face, loops: vec![0, 1, 2] },
        Operation::SetRole { face, loops: vec![2], role: LoopRole::Unknown },
        Operation::InsertSurfaceKnot { face, direction: Direction::V, at: 0.3, times: 1 },
        Operation::ElevateSurface { face, direction: Direction::U, by: 3 },
    ] {
        let changed = perform(&scene, &operation);
        assert!(changed != scene, "{operation:?}");
        assert!(same_face(&scene, &changed, same), "{operation:?}");
    }
    let mirrored = perform(&scene, &Operation::ReverseSurface { face, direction: Direction::U });
    assert!(same_face(&scene, &mirrored, |p| DVec2::new(1.0 - p.x, p.y)));
    let swapped = perform(&scene, &Operation::SwapSurface { face });
    assert!(same_face(&scene, &swapped, |p| DVec2::new(p.y, p.x)));
    for changed in [mirrored, swapped] {
        assert!(changed.models[0].faces[0].reversed, "the normal stays where it was");
    }
}

#[test]
fn what_was_inserted_raised_or_split_can_be_taken_away_again() {
    let scene = scene();
    let (face, id) = (FACE, curve(1, 0));
    let near = |a: &SceneRecord| {
        let (old, new) = (&curves(&scene, 1)[0], &curves(a, 1)[0]);
        old.knots() == new.knots()
            && old.points().iter().zip(new.points()).all(|(p, q)| p.distance(*q) < 1e-14)
    };
    let more = perform(&scene, &Operation::InsertKnot { face, curve: id, at: 1.3, times: 1 });
    let less = perform(&more, &Operation::RemoveKnot { face, curve: id, at: 1.3, tolerance: None });
    assert!(near(&less));
    let higher = perform(&scene, &Operation::ElevateDegree { face, curve: id, by: 1 });
    let lower = perform(&higher, &Operation::ReduceDegree { face, curve: id, tolerance: None });
    assert!(near(&lower));
    let parts = perform(&scene, &Operation::SplitCurve { face, curve: id, at: 1.3 });
    assert_eq!(curves(&parts, 1).len(), 2);
    let whole = perform(&parts, &Operation::JoinCurves { face, curve: id, tolerance: None });
    assert!(near(&whole));
    // The last curve with the first: the loop begins elsewhere, the face is the same.
    let around = perform(&parts, &Operation::JoinCurves { face, curve: curve(1, 1), tolerance: None });
    assert_eq!(curves(&around, 1).len(), 1);
    assert!(same_face(&scene, &around, |p| p));
    let message = refusal(&scene, &Operation::RemoveKnot { face, curve: id, at: 2.0, tolerance: Some(1e-9) });
    assert!(message.contains("would change the shape by"), "{message}");
    let message = refusal(&scene, &Operation::ReduceDegree { face, curve: id, tolerance: None });
    assert!(message.starts_with("face 1, loop 2, curve 1: reducing the degree"), "{message}");
}

#[test]
fn loops_are_added_copied_closed_and_deleted() {
    let scene = scene();
    let face = FACE;
    let shapes = [
        Shape::Rectangle { from: DVec2::new(0.9, 0.2), to: DVec2::new(0.8, 0.1) },
        Shape::Circle { centre: DVec2::new(0.5, 0.2), radius: 0.1 },
        Shape::Ellipse { centre: DVec2::new(0.5, 0.2), radii: DVec2::new(0.1, 0.05), degrees: 30.0 },
        Shape::Polyline { points: vec![DVec2::new(0.1, 0.8), DVec2::new(0.2, 0.8), DVec2::new(0.2, 0.9)] },
    ];
    for shape in shapes {
        let added = perform(&scene, &Operation::AddLoop { face, shape, role: LoopRole::Inner });
        assert!(face_area(&added) < face_area(&scene));
        let loops = vec![3];
        assert_eq!(perform(&added, &Operation::DeleteLoops { face, loops: loops.clone() }), scene);
        let open = perform(&added, &Operation::DeleteCurves { face, curves: vec![curve(3, 0)] });
        if curves(&added, 3).len() > 1 {
            let closed = perform(&open, &Operation::CloseLoops { face, loops });
            assert!(face_area(&closed) <= face_area(&scene));
            assert_eq!(curves(&closed, 3).len(), curves(&added, 3).len());
        } else {
            assert_eq!(open, scene, "a loop without curves goes");
        }
    }
    let by = DVec2::new(0.0, 0.25);
    let copied = perform(&scene, &Operation::DuplicateLoops { face, loops: vec![1], by });
    let loops = vec![scene.models[0].faces[0].loops[1].clone()];
    let pasted = perform(&scene, &Operation::PasteLoops { face, loops, by });
    assert_eq!(copied, pasted);
    let untrimmed = perform(&copied, &Operation::Untrim { face });
    assert!((face_area(&untrimmed) - 1.0).abs() < 1e-12);
    assert!(refusal(&untrimmed, &Operation::Untrim { face }).contains("no trim loops"));
    assert!(refusal(&scene, &Operation::CloseLoops { face, loops: vec![1] }).contains("closed already"));
}

fn face_area(scene: &SceneRecord) -> f64 {
    hairline::kernel::query::area::face_area(&face(scene)).value
}

#[test]
fn transforms_turn_scale_and_mirror_about_the_middle() {
    let scene = scene();
    let (face, loops, beyond) = (FACE, vec![1], false);
    let do_it = |scene: &SceneRecord, transform| {
        perform(scene, &Operation::TransformLoops { face, loops: loops.clone(), transform, beyond })
    };
    let centre =
        |scene: &SceneRecord| 0.5 * (curves(scene, 1)[0].point(0.0) + curves(scene, 1)[0].point(2.0));
    let turned = do_it(&scene, Transform::Rotate { degrees: 90.0, about: None });
    assert!(same_face(&scene, &turned, |p| p), "a circle turned about its middle");
    assert!(centre(&turned).distance(centre(&scene)) < 1e-15);
    let four = (0..4).fold(scene.clone(), |s, _| do_it(&s, Transform::Rotate { degrees: 90.0, about: None }));
    assert!(
        curves(&four, 1)[0]
            .points()
            .iter()
            .zip(curves(&scene, 1)[0].points())
            .all(|(a, b)| a.distance(*b) < 1e-15)
    );
    let mirrored =
        do_it(&scene, Transform::Mirror { along: DVec2::new(0.0, 3.0), about: Some(DVec2::splat(0.5)) });
    assert!((centre(&mirrored).x - (1.0 - centre(&scene).x)).abs() < 1e-15);
    let half = do_it(&scene, Transform::Scale { by: DVec2::splat(0.5), about: None });
    let radius = |s: &SceneRecord| curves(s, 1)[0].point(0.0).distance(centre(s));
    assert!((radius(&half) / radius(&scene) - 0.5).abs() < 1e-14);
    let moved = do_it(&scene, Transform::Move { by: DVec2::new(100.0, 0.0) });
    let right = curves(&moved, 1)[0].points().iter().map(|p| p.x).fold(0.0, f64::max);
    assert!((right - 1.0).abs() < 1e-15, "stops at the border of the domain, whole: {right}");
}

#[test]
fn drags_stop_at_the_border_and_typed_points_are_refused_there() {
    let scene = scene();
    let face = FACE;
    let point = PointId { trim_loop: 0, curve: 0, point: 1 };
    let by = DVec2::new(5.0, -0.5);
    let moved = perform(&scene, &Operation::MovePoints { face, points: vec![point], by, beyond: false });
    assert_eq!(curves(&moved, 0)[0].points()[1], DVec2::new(1.0, 0.0));
    let free = perform(&scene, &Operation::MovePoints { face, points: vec![point], by, beyond: true });
    assert_eq!(curves(&free, 0)[0].points()[1], DVec2::new(6.0, -0.5));
    assert_eq!(curves(&free, 0)[1].points()[0], DVec2::new(6.0, -0.5), "the neighbour follows");
    let message =
        refusal(&scene, &Operation::SetPoint { face, point, to: DVec2::new(2.0, 0.5), beyond: false });
    assert_eq!(
        message,
        "face 1, loop 1, curve 1, point 2: (2, 0.5) is outside the surface's domain: u from 0 to 1, v from 0 to 1"
    );
}

#[test]
fn bad_requests_name_the_place() {
    let scene = scene();
    let face = FACE;
    let point = |point| PointId { trim_loop: 1, curve: 0, point };
    let nowhere = FaceId { model: 0, face: 7 };
    let weight = |weight| Operation::SetWeight { face, points: vec![point(1)], weight };
    let by = |by| Operation::MovePoints { face, points: vec![point(1)], by, beyond: true };
    for (operation, expected) in [
        (Operation::Untrim { face: nowhere }, "there is no face 8; there are 1"),
        (Operation::DeleteLoops { face, loops: vec![3] }, "face 1: there is no loop 4; there are 3"),
        (
            Operation::SplitCurve { face, curve: curve(2, 12), at: 0.5 },
            "face 1, loop 3: there is no curve 13; there are 12",
        ),
        (weight(0.0), "face 1, loop 2, curve 1, point 2: weight 0 is not positive and finite"),
        (weight(-1.0), "face 1, loop 2, curve 1, point 2: weight -1 is not positive and finite"),
        (weight(f64::NAN), "face 1, loop 2, curve 1, point 2: weight NaN is not positive and finite"),
        (weight(f64::INFINITY), "face 1, loop 2, curve 1, point 2: weight inf is not positive and finite"),
        (by(DVec2::new(f64::NAN, 0.0)), "face 1: by u is NaN; it must be finite"),
        (by(DVec2::new(0.0, 1e300)), "face 1, loop 2, curve 1, point 2: v would be"),
        (Operation::SetWeight { face, points: vec![], weight: 1.0 }, "face 1: nothing is named"),
        (
            Operation::SetWeight { face, points: vec![point(9)], weight: 1.0 },
            "face 1, loop 2, curve 1: there is no point 10; there are 9",
        ),
        (
            Operation::InsertKnot { face, curve: curve(1, 0), at: 4.0, times: 1 },
            "face 1, loop 2, curve 1: knot 4 is not inside the domain from 0 to 4",
        ),
        (
            Operation::InsertKnot { face, curve: curve(1, 0), at: 1.5, times: 3 },
            "face 1, loop 2, curve 1: knot 1.5 is there 0 times",
        ),
        (
            Operation::ElevateDegree { face, curve: curve(1, 0), by: 100 },
            "face 1, loop 2, curve 1: knots in t: degree",
        ),
        (
            Operation::SetSurfacePoint { face, point: NetId { i: 2, j: 0 }, to: DVec3::ZERO },
            "face 1: there is no surface control point 3 1",
        ),
        (
            Operation::MoveSurfacePoints {
                face,
                points: vec![NetId { i: 0, j: 0 }],
                by: DVec3::splat(1e300),
            },
            "face 1, surface point 1 1: x would be",
        ),
        (
            Operation::SetColour { faces: vec![face], colour: Some([0.0, 2.0, 0.0]) },
            "a part of the colour is 2; it must be between 0 and 1",
        ),
        (
            Operation::JoinCurves { face, curve: curve(1, 0), tolerance: None },
            "face 1, loop 2, curve 1: it is the only curve",
        ),
    ] {
        let message = refusal(&scene, &operation);
        assert!(message.starts_with(expected), "{message}");
    }
}

#[test]
fn faces_are_named_coloured_copied_and_deleted_and_hidden_ones_stay_hidden() {
    let mut scene = scene();
    let extra = scene.models[0].faces[0].clone();
    scene.models[0].faces.push(extra);
    scene.hidden = vec![FaceId { model: 0, face: 1 }];
    let faces = vec![FACE];
    let named = perform(&scene, &Operation::SetName { faces: faces.clone(), name: Some("Lid".into()) });
    assert_eq!(named.models[0].faces[0].name.as_deref(), Some("Lid"));
    let coloured =
        perform(&scene, &Operation::SetColour { faces: faces.clone(), colour: Some([1.0, 0.0, 0.5]) });
    assert_eq!(coloured.models[0].faces[0].colour, Some([1.0, 0.0, 0.5]));
    let copied = perform(&scene, &Operation::DuplicateFaces { faces: faces.clone(), by: DVec3::Z });
    assert_eq!(copied.models[0].faces.len(), 3);
    assert_eq!(copied.hidden, scene.hidden);
    let less = perform(&scene, &Operation::DeleteFaces { faces });
    assert_eq!(less.models[0].faces.len(), 1);
    assert_eq!(less.hidden, vec![FACE], "the hidden face has moved up");
}
