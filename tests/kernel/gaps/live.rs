//! After a change of one face the inspection is what it would be made anew.

use glam::DVec3;
use hairline::inspect::{Edge, EdgeKey, Inspection};
use hairline::scene::records::FaceRecord;

use super::pairs::*;

fn all(inspection: &Inspection) -> Vec<(EdgeKey, Edge)> {
    inspection.edges().map(|(k, e)| (*k, e.clone())).collect()
}

/// A wall of bricks: each side of a brick is a T-junction with two others.
fn wall(rows: usize, columns: usize) -> Vec<FaceRecord> {
    let brick = |k: usize| {
        let (row, column) = (k / columns, k % columns);
        let shift = 0.5 * (row % 2) as f64;
        let origin = DVec3::new(column as f64 + shift, row as f64, 0.0) * 10.0;
        let mut brick = face(plane(10.0, 0.0), vec![]);
        brick.surface = brick.surface.map_points(|p| p + origin);
        brick
    };
    (0..rows * columns).map(brick).collect()
}

#[test]
fn moving_a_brick_out_and_in_again() {
    let mut faces = wall(5, 6);
    let mut inspection = Inspection::of(&faces);
    let whole = all(&inspection);
    for k in [0, 7, 14, 29, 8] {
        for by in [DVec3::new(0.0, 1e-4, 0.0), DVec3::new(3.0, 0.0, 0.0), DVec3::Z * 50.0] {
            let old = faces[k].clone();
            faces[k].surface = old.surface.map_points(|p| p + by);
            inspection.update(k, &faces[k]);
            assert_eq!(all(&inspection), all(&Inspection::of(&faces)), "brick {k} by {by}");
            faces[k] = old;
            inspection.update(k, &faces[k]);
        }
    }
    assert_eq!(all(&inspection), whole);
}

#[test]
fn faces_come_and_go() {
    let faces = wall(3, 3);
    let mut inspection = Inspection::of(&faces[..8]);
    inspection.update(8, &faces[8]);
    assert_eq!(all(&inspection), all(&Inspection::of(&faces)));
    inspection.clear(4);
    let kept = |e: &Edge| e.uses.iter().any(|u| u.curve.face == 4);
    assert!(!inspection.edges().any(|e| kept(e.1)));
    assert_complete(&inspection);
    inspection.update(4, &faces[4]);
    assert_eq!(all(&inspection), all(&Inspection::of(&faces)));
    // No such face: nothing happens.
    inspection.update(100, &faces[0]);
    assert_eq!(inspection.face_count(), 9);
}

#[test]
fn many_updates_leave_no_litter() {
    let mut faces = wall(4, 4);
    let mut inspection = Inspection::of(&faces);
    for k in 0..1500_u32 {
        let at = k as usize % faces.len();
        let by = DVec3::Z * (if k % 32 < 16 { 1e-3 } else { -1e-3 });
        faces[at].surface = faces[at].surface.map_points(|p| p + by);
        inspection.update(at, &faces[at]);
    }
    assert_eq!(all(&inspection), all(&Inspection::of(&faces)));
}
