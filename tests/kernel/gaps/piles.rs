//! More than two sides, and many more.

use glam::{DVec2, DVec3};
use hairline::inspect::{EdgeKind, Inspection};
use hairline::kernel::nurbs::NurbsCurve2;
use hairline::scene::records::FaceRecord;

use super::pairs::*;

#[test]
fn nothing_and_one_face() {
    assert_eq!(Inspection::of(&[]).edges().len(), 0);
    let inspection = Inspection::of(&[face(hills(0), vec![])]);
    assert_eq!(of_kind(&inspection, EdgeKind::Naked).len(), 4);
}

#[test]
fn pages_of_a_book_share_one_edge() {
    let page = |k: usize| {
        let turn = DVec2::from_angle(0.3 * k as f64);
        let mut page = face(plane(10.0, 0.0), vec![]);
        page.surface = page.surface.map_points(|p| DVec3::new(p.x * turn.x, p.y, p.x * turn.y));
        page
    };
    let pages: Vec<FaceRecord> = (0..5).map(page).collect();
    let inspection = Inspection::of(&pages);
    let spine = of_kind(&inspection, EdgeKind::NonManifold);
    assert_eq!((spine.len(), spine[0].uses.len()), (1, 5));
    assert_eq!(of_kind(&inspection, EdgeKind::Naked).len(), 15);
    // A page half as high: the spine falls into two edges.
    let mut pages = pages;
    pages[2].surface = pages[2].surface.map_points(|p| DVec3::new(p.x, 0.5 * p.y, p.z));
    let inspection = Inspection::of(&pages);
    let mut uses: Vec<usize> =
        of_kind(&inspection, EdgeKind::NonManifold).iter().map(|e| e.uses.len()).collect();
    uses.sort_unstable();
    assert_eq!(uses, [4, 5]);
    assert_complete(&inspection);
}

#[test]
fn blades_of_a_fan_share_their_hub_and_nothing_else() {
    // All of them meet in both ends of the hub, too: 180,000 pairs of curves that are told apart.
    const BLADES: usize = 300;
    let blade = |k: usize| {
        let turn = DVec2::from_angle(std::f64::consts::TAU * k as f64 / BLADES as f64);
        let mut blade = face(plane(10.0, 0.0), vec![]);
        blade.surface = blade.surface.map_points(|p| DVec3::new(p.x * turn.x, p.y, p.x * turn.y));
        blade
    };
    let blades: Vec<FaceRecord> = (0..BLADES).map(blade).collect();
    let inspection = Inspection::of(&blades);
    let hub = of_kind(&inspection, EdgeKind::NonManifold);
    assert_eq!((hub.len(), hub[0].uses.len()), (1, BLADES));
    assert!(hub[0].gap.is_some_and(|g| g.maximum < 1e-12));
    let naked: Vec<f64> = of_kind(&inspection, EdgeKind::Naked).iter().map(|e| e.length()).collect();
    assert_eq!(naked.len(), 3 * BLADES);
    assert!(naked.iter().all(|length| (length - 10.0).abs() < 1e-9));
}

#[test]
fn a_heap_of_equal_faces_takes_no_quadratic_time() {
    // Pairs of 10,000 would be 50 million; this test would not end in reasonable time.
    let faces = vec![face(plane(10.0, 0.0), vec![]); 10_000];
    let inspection = Inspection::of(&faces);
    let edges = of_kind(&inspection, EdgeKind::NonManifold);
    assert_eq!((edges.len(), edges[0].uses.len()), (4, 10_000));
    assert!(edges.iter().all(|e| e.gap.is_some_and(|g| g.maximum == 0.0)));
}

#[test]
fn faces_of_other_bodies_do_not_join_complete_edges() {
    let block = |part: usize, out: f64| {
        let mut faces = vec![face(plane(10.0, 0.0), vec![]), face(plane(10.0, 0.0), vec![])];
        faces[1].surface = faces[1].surface.map_points(|p| DVec3::new(p.x, 0.0, p.y * out));
        faces.iter_mut().for_each(|f| f.part = Some(part));
        faces
    };
    let faces: Vec<FaceRecord> = block(0, 1.0).into_iter().chain(block(1, -1.0)).collect();
    let inspection = Inspection::of(&faces);
    assert!(of_kind(&inspection, EdgeKind::Shared).iter().filter(|e| e.length() > 9.0).count() >= 2);
    assert_eq!(of_kind(&inspection, EdgeKind::NonManifold).len(), 0);
}

#[test]
fn broken_loops_are_classed_too() {
    // Open, of no length, crossing itself, without curves.
    let p = DVec2::new;
    let open = vec![NurbsCurve2::line(p(0.0, 0.0), p(1.0, 0.0)), NurbsCurve2::line(p(1.0, 0.0), p(1.0, 1.0))];
    let point = vec![NurbsCurve2::line(p(0.5, 0.5), p(0.5, 0.5))];
    let bow: Vec<NurbsCurve2> = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)]
        .windows(2)
        .map(|w| NurbsCurve2::line(p(w[0].0, w[0].1), p(w[1].0, w[1].1)))
        .collect();
    let collapsed = plane(0.0, 1.0);
    let faces = [
        face(hills(1), vec![open]),
        face(hills(1), vec![point]),
        face(hills(1), vec![bow]),
        face(hills(1), vec![vec![]]),
        face(collapsed, vec![]),
    ];
    let inspection = Inspection::of(&faces);
    assert_complete(&inspection);
    assert!(of_kind(&inspection, EdgeKind::Degenerate).len() >= 5, "the point and the collapsed plane");
}

#[test]
fn edges_of_the_model_decide_where_the_file_tells_them() {
    use hairline::kernel::trim::EdgeId;
    let square = |edge: u32, by: DVec3| {
        let mut square = face(plane(10.0, 0.0), vec![rectangle([0.0, 0.0], [1.0, 1.0])]);
        square.surface = square.surface.map_points(|p| p + by);
        square.loops[0].edges = vec![None, Some(EdgeId(edge)), None, None];
        square
    };
    // Further apart than geometry would look for; and the other square's right side is left of it.
    let faces = [square(7, DVec3::ZERO), square(7, DVec3::new(0.0, 0.0, 5.0))];
    let inspection = Inspection::of(&faces);
    let shared = of_kind(&inspection, EdgeKind::Shared);
    assert_eq!((shared.len(), shared[0].uses[1].curve.curve), (1, 1));
    assert!((shared[0].gap.expect("valid test data").maximum - 5.0).abs() < 1e-12);
    // Two pairs in the same place stay two edges.
    let pile: Vec<FaceRecord> = [1, 1, 2, 2].map(|edge| square(edge, DVec3::ZERO)).into();
    let inspection = Inspection::of(&pile);
    assert_eq!(of_kind(&inspection, EdgeKind::Shared).len(), 2);
}
