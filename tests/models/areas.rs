//! Areas and boxes of real trimmed faces against independent truth.

use hairline::kernel::face::Face;
use hairline::kernel::query::{face_area, face_bounds};

use crate::truth;

/// Relative difference allowed.
const ALLOWED: f64 = 1e-4;

/// Models whose trims in the truth file do not bound what OpenCASCADE measured; with the largest relative
/// difference and the number of faces that exceed [`ALLOWED`]. Sums over 1500 x 1500 points of these
/// surfaces and trims agree with our areas, not with those of the file.
const EXCEPTIONS: [(&str, f64, usize); 3] = [
    // The file's own trims leave gaps of 1.3e-4 of the face near the pole.
    ("ap203_near_degenerate_nurbs_pole.stp", 5e-4, 1),
    // Curves of intersection with spheres, converted to three control points each: the trims leave the
    // native face's bounding box.
    ("axom_boxed_sphere.step", 0.31, 40),
    // One cubic with 113 control points cuts the corners of the rectangle that was measured.
    ("pygem_test_pipe_deformed.step", 5e-4, 4),
];

/// All faces of all models that can be derived.
fn each_face(mut check: impl FnMut(&str, &truth::Face, &Face)) -> bool {
    let Some(folder) = truth::models() else {
        println!("not run: no shared/models here");
        return false;
    };
    for name in truth::names(&folder) {
        for face in truth::model(&folder, &name).faces {
            let record = face.record().unwrap_or_else(|e| panic!("{name} face {}: {e}", face.id));
            let derived = record.derive().unwrap_or_else(|e| panic!("{name} face {}: {e}", face.id));
            check(&name, &face, &derived);
        }
    }
    true
}

#[test]
fn areas_agree_with_truth() {
    let mut off: Vec<(String, usize, f64)> = Vec::new();
    let mut measured = 0;
    let ran = each_face(|name, truth, face| {
        let area = face_area(face);
        assert!(area.error <= 1e-8 * area.value, "{name} face {}: {area:?}", truth.id);
        let Some(expected) = truth.area else { return };
        measured += 1;
        let difference = (area.value - expected).abs() / expected.abs();
        if difference > ALLOWED {
            off.push((name.to_owned(), truth.id, difference));
        }
    });
    if !ran {
        return;
    }
    assert!(measured > 6_500, "only {measured} faces with an area");
    for (name, largest, faces) in EXCEPTIONS {
        let of_model = off.iter().filter(|o| o.0 == name);
        assert!(of_model.clone().count() <= faces, "{:?}", of_model.collect::<Vec<_>>());
        assert!(of_model.clone().all(|o| o.2 <= largest), "{:?}", of_model.collect::<Vec<_>>());
    }
    off.retain(|o| EXCEPTIONS.iter().all(|e| e.0 != o.0));
    assert!(off.is_empty(), "{off:?}");
}

#[test]
fn boxes_lie_in_those_of_truth_and_mostly_fill_them() {
    let (mut all, mut filled) = (0, 0);
    let mut outside = Vec::new();
    let ran = each_face(|name, truth, face| {
        let [x0, y0, z0, x1, y1, z1] = truth.bbox[..] else { return };
        if EXCEPTIONS.iter().any(|e| e.0 == name) {
            return;
        }
        let bounds = face_bounds(face);
        let size = bounds.diagonal();
        let (min, max) = (
            (bounds.min - glam::DVec3::new(x0, y0, z0)) / size,
            (glam::DVec3::new(x1, y1, z1) - bounds.max) / size,
        );
        all += 1;
        filled += usize::from(min.max(max).max_element() < 1e-4);
        // OpenCASCADE samples curved faces; by this much it misses four of them.
        if min.min(max).min_element() < -5e-4 {
            outside.push((name.to_owned(), truth.id, min, max));
        }
    });
    if ran {
        assert!(outside.is_empty(), "{} of {all}: {outside:?}", outside.len());
        assert!(filled * 20 > all * 17, "{filled} of {all} boxes are as tight as OpenCASCADE's");
    }
}
