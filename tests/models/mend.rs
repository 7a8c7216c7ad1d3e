//! Closing the gaps of a real part makes none of its other edges worse.

use hairline::exchange::iges;
use hairline::inspect::mend::batch::close_all;
use hairline::inspect::{EdgeKind, Inspection};
use hairline::scene::document::SceneRecord;

use crate::iges_truth as truth;

#[test]
fn no_edge_of_a_real_part_gets_a_third_side_or_loses_one() {
    let Some(models) = truth::models() else { return };
    let bytes = std::fs::read(models.join("files/gpucast_part.igs")).unwrap();
    let (model, _) = iges::read_bytes(&bytes).unwrap();
    let mm = model.unit.millimetres;
    let before = Inspection::in_unit(&model.faces, mm);
    let mut scene = SceneRecord { models: vec![model], ..SceneRecord::default() };
    // At this tolerance two mends would bring a third face to a stretch of 3 um.
    let report = close_all(&mut scene, 0, 1e-3 / mm).unwrap();
    assert!(report.closed.len() >= 20, "{} closed", report.closed.len());
    let told = report.open.iter().filter(|(.., reason)| reason.starts_with("closing it would")).count();
    assert!(told > 0, "{:?}", report.open);
    let after = Inspection::in_unit(&scene.models[0].faces, mm);
    let count = |inspection: &Inspection, kind| inspection.edges().filter(|(_, e)| e.kind == kind).count();
    for kind in [EdgeKind::NonManifold, EdgeKind::Naked] {
        assert!(count(&after, kind) <= count(&before, kind), "{kind:?}");
    }
}
