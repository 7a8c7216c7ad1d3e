//! Every classified point of the ground truth against the grid, P1's structure and the oracle.

use std::collections::BTreeMap;

use hairline::kernel::face::Side;
use hairline::kernel::trim::{BruteForce, FillRule, PackedSegments, TrimStructure, oracle};

use crate::truth;

#[test]
fn all_truth_points_are_classified_right() {
    let Some(models) = truth::models() else {
        println!("not run: no shared/models here");
        return;
    };
    let (mut total, mut wrong) = (0, Vec::new());
    for name in truth::names(&models) {
        let faces: BTreeMap<usize, truth::Face> =
            truth::model(&models, &name).faces.into_iter().map(|f| (f.id, f)).collect();
        let mut by_face: BTreeMap<usize, Vec<truth::Point>> = BTreeMap::new();
        for point in truth::points(&models, &name) {
            by_face.entry(point.face).or_default().push(point);
        }
        for (id, points) in by_face {
            let record = match faces[&id].record() {
                Ok(record) => record,
                Err(reason) => {
                    wrong.push(format!("{name} face {id}: {reason}"));
                    continue;
                }
            };
            let face = match record.derive() {
                Ok(face) => face,
                Err(reason) => {
                    wrong.push(format!("{name} face {id}: {reason}"));
                    continue;
                }
            };
            let lists = face.interval_lists();
            let packed = PackedSegments::new(&face.pieces, &face.segments).expect("as in the face");
            let brute = BruteForce::new(packed, FillRule::EvenOdd);
            let mut bad = [0; 4];
            for point in &points {
                let p = face.domain.normalise(point.uv);
                assert_eq!(
                    brute.classify(p.as_vec2()),
                    face.grid.classify(p.as_vec2()),
                    "{name} face {id}: {p:?}"
                );
                let answers = [
                    face.grid.classify(p.as_vec2()),
                    lists.classify(p.as_vec2()),
                    oracle::inside(&face.pieces, p, FillRule::EvenOdd),
                    face.classify_native(point.uv.x, point.uv.y) == Side::In,
                ];
                for (count, answer) in bad.iter_mut().zip(answers) {
                    *count += usize::from(answer != point.inside);
                }
            }
            total += points.len();
            if bad != [0; 4] {
                wrong.push(format!(
                    "{name} face {id} (nurbform {}): grid, P1, oracle, native wrong {bad:?} of {}; {:?} domain {:?}",
                    faces[&id].nurbform,
                    points.len(),
                    face.remarks,
                    face.domain
                ));
            }
        }
    }
    println!("{total} points");
    assert!(wrong.is_empty(), "{} faces:\n{}", wrong.len(), wrong.join("\n"));
    assert!(total > 300_000, "{total}");
}
