//! Random edits, undos and redos: the document is the one that the surviving edits make of the start.

use hairline::scene::operation::random::RandomOperations;
use hairline::scene::records::ModelRecord;
use hairline::scene::{Edit, History, SceneRecord, demo};

/// Three faces: a plate with holes, a seamed ring, and a sheet of high degree.
fn start() -> SceneRecord {
    let mut model = demo::model();
    let mut faces: Vec<_> = ["Ring", "Medal"]
        .iter()
        .filter_map(|name| model.faces.iter().find(|f| f.name.as_deref() == Some(*name)).cloned())
        .collect();
    faces.push(demo::holes(4));
    faces.iter_mut().for_each(|f| f.loops.truncate(6));
    model.faces = faces;
    let second = ModelRecord { faces: vec![demo::holes(3)], ..ModelRecord::default() };
    SceneRecord { models: vec![model, second], ..SceneRecord::default() }
}

#[test]
fn the_document_equals_the_one_rebuilt_from_its_edits() {
    const CAP: usize = 64 << 10;
    let mut base = start();
    let mut scene = base.clone();
    let mut history = History::new(CAP);
    // What the history dropped is applied to the base.
    let mut kept: std::collections::VecDeque<Edit> = std::collections::VecDeque::new();
    let mut random = RandomOperations::new(7, 4);
    let (mut done, mut refused) = (0, 0);
    for step in 0..3000 {
        match random.below(10) {
            0 | 1 => drop(history.undo(|e| e.apply(&mut scene)).expect("fits")),
            2 => drop(history.redo(|e| e.apply(&mut scene)).expect("fits")),
            _ => match random.next_operation(&scene).perform(&scene) {
                Err(_) => refused += 1,
                Ok(edit) => {
                    if edit.is_empty() {
                        continue;
                    }
                    edit.apply(&mut scene).expect("a performed edit fits");
                    let dropped = history.dropped();
                    kept.truncate(history.undo_count());
                    kept.push_back(edit.clone());
                    history.push(edit);
                    for edit in kept.drain(..history.dropped() - dropped) {
                        edit.apply(&mut base).expect("edits fit in their order");
                    }
                    done += 1;
                    assert!(history.bytes() <= CAP || history.undo_count() == 1);
                }
            },
        }
        if step % 500 == 0 {
            let mut rebuilt = base.clone();
            history.edits().for_each(|e| e.apply(&mut rebuilt).expect("edits fit in their order"));
            assert_eq!(rebuilt, scene, "after {step} steps");
            assert_eq!(format!("{rebuilt:?}"), format!("{scene:?}"), "bit for bit");
            for face in scene.models.iter().flat_map(|m| &m.faces) {
                assert!(face.derive().is_ok());
            }
        }
    }
    assert!(done > 1000 && refused < done, "{done} done, {refused} refused");
    assert!(history.dropped() > 100, "the cap was reached: {}", history.dropped());
}
