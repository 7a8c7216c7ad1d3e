//! Every editing command of the table does something that can be taken back, or says why not.

use bevy::prelude::*;
use hairline::editor::editing::{Editing, Prompt, RunEdit};
use hairline::editor::elements::{Element, ElementRequest, ElementSelection};
use hairline::editor::object::Scene;
use hairline::editor::panels::Notices;
use hairline::editor::selection::{SelectMode, SelectRequest};
use hairline::editor::tools::{Action, COMMANDS, CurrentSituation, EditAction, Needs};

use hairline::scene::records::FaceRecord;

use crate::editing::{holed, records};
use crate::world::{command, demo_app};

/// What has to be selected for a command.
fn elements(action: EditAction) -> Vec<Element> {
    match action.needs() {
        Needs::Loops | Needs::Anything => vec![Element::Loop { trim_loop: 1 }],
        Needs::Curve => vec![Element::Curve { trim_loop: 1, curve: 0 }],
        Needs::Point | Needs::Points | Needs::Weights => {
            vec![Element::Point { trim_loop: 1, curve: 0, point: 1 }]
        }
        Needs::SurfacePoints => vec![Element::SurfacePoint { point: 0 }],
        Needs::Face | Needs::Faces | Needs::Clipboard => Vec::new(),
    }
}

/// Values for what is asked, from those offered.
fn values(action: EditAction, offered: &[String]) -> Vec<String> {
    let texts: &[&str] = match action {
        EditAction::MoveBy => &["0.001", "0.002"],
        EditAction::SetWeight => &["2.5"],
        EditAction::MoveSurfacePoints => &["1", "0", "0"],
        EditAction::Rename => &["another name"],
        EditAction::Colour => &["#ff8000"],
        EditAction::Layer => &["7"],
        EditAction::Rotate => &["10"],
        EditAction::Scale => &["0.5", "0.5"],
        EditAction::SetPoint => &["0.5", "0.5"],
        EditAction::Reduce => &["1e9"],
        EditAction::RemoveKnot => &[offered[0].as_str(), "1e9"],
        _ => return offered.to_vec(),
    };
    texts.iter().map(|t| (*t).to_owned()).collect()
}

#[test]
fn every_command_can_be_taken_back_or_is_refused_in_words() {
    let mut app = demo_app();
    let id = holed(&mut app);
    let face = app.world().resource::<Scene>().face(id.model, id.face).expect("a face");
    app.world_mut().write_message(SelectRequest { faces: vec![face], mode: SelectMode::Replace });
    app.update();
    app.update();
    let before = records(&mut app);
    // Copied first, so that there is something to paste.
    let actions = COMMANDS.iter().filter_map(|c| match c.action {
        Action::Edit(action) => Some((action, c)),
        _ => None,
    });
    let mut refused = Vec::new();
    for (action, row) in actions {
        app.world_mut()
            .write_message(ElementRequest { elements: elements(action), mode: SelectMode::Replace });
        app.update();
        app.update();
        let situation = app.world().resource::<CurrentSituation>().0;
        assert!((row.enabled)(&situation), "{} {situation:?}", row.id);
        command(&mut app, Action::Edit(action));
        let prompt = app.world().resource::<Prompt>();
        assert_eq!(prompt.is_open(), !action.fields().is_empty(), "{}", row.id);
        if prompt.is_open() {
            assert_eq!(prompt.values.len(), action.fields().len(), "{}", row.id);
            let values = values(action, &prompt.values);
            app.world_mut().write_message(RunEdit { action, values });
            app.update();
            app.update();
        }
        let done = app.world().resource::<Editing>().history().undo_count();
        if done == 0 {
            assert!(records(&mut app) == before, "{}", row.id);
            if action != EditAction::Copy {
                refused.push(row.id);
            }
        } else {
            assert_eq!(done, 1, "{}", row.id);
            assert!(records(&mut app) != before, "{}", row.id);
            command(&mut app, Action::Undo);
            assert!(records(&mut app) == before, "{}", row.id);
        }
        app.world_mut().resource_mut::<Prompt>().close();
    }
    // The hole is closed, marked as one, and its curve is what it is.
    // A knot offered in the middle of the domain may be full already.
    let may = [
        "loop.close",
        "loop.hole",
        "loop.outer",
        "curve.remove_knot",
        "curve.reduce",
        "curve.join",
        "surface.insert_u",
        "surface.insert_v",
    ];
    assert!(refused.iter().all(|id| may.contains(id)), "{refused:?}");
}

#[test]
fn bad_values_are_refused_where_they_were_typed() {
    let mut app = demo_app();
    let id = holed(&mut app);
    let face = app.world().resource::<Scene>().face(id.model, id.face).expect("a face");
    app.world_mut().write_message(SelectRequest { faces: vec![face], mode: SelectMode::Replace });
    app.update();
    app.update();
    let before = records(&mut app);
    let action = EditAction::AddCircle;
    for bad in [["0.5", "x", "1"], ["", "0.5", "1"], ["0.5", "0.5", "NaN"]] {
        command(&mut app, Action::Edit(action));
        app.world_mut().write_message(RunEdit { action, values: bad.map(str::to_owned).to_vec() });
        app.update();
        let prompt = app.world().resource::<Prompt>();
        assert!(prompt.is_open() && prompt.refusal().is_some(), "{bad:?}");
        assert!(records(&mut app) == before);
    }
    // A number that is one, but makes no circle, is refused by the operation.
    app.world_mut()
        .write_message(RunEdit { action, values: ["0.5", "0.5", "-1"].map(str::to_owned).to_vec() });
    app.update();
    app.update();
    assert!(app.world().resource::<Notices>().list().iter().any(|n| n.text.contains("radius")));
    assert!(records(&mut app) == before);
}

#[test]
fn delete_takes_elements_first_and_faces_else() {
    let mut app = demo_app();
    let id = holed(&mut app);
    let face = app.world().resource::<Scene>().face(id.model, id.face).expect("a face");
    let before = records(&mut app);
    app.world_mut().write_message(SelectRequest { faces: vec![face], mode: SelectMode::Replace });
    app.update();
    app.update();
    let both = vec![Element::Loop { trim_loop: 1 }, Element::Curve { trim_loop: 0, curve: 0 }];
    app.world_mut().write_message(ElementRequest { elements: both, mode: SelectMode::Replace });
    app.update();
    app.update();
    command(&mut app, Action::Edit(EditAction::Delete));
    let now = records(&mut app);
    let (old, new) = (&before[0].faces[id.face], &now[0].faces[id.face]);
    // A loop goes with its only curve.
    let curves = |face: &FaceRecord| face.loops.iter().map(|l| l.curves.len()).sum::<usize>();
    assert_eq!(curves(new), curves(old) - old.loops[1].curves.len() - 1);
    assert!(!new.loops.contains(&old.loops[1]) && new.loops.contains(&old.loops[2]));
    command(&mut app, Action::Edit(EditAction::Delete));
    let now = records(&mut app);
    assert_eq!(now[0].faces.len() + 1, before[0].faces.len());
    command(&mut app, Action::Undo);
    command(&mut app, Action::Undo);
    assert!(records(&mut app) == before);
}

#[test]
fn loops_that_are_added_are_selected() {
    let mut app = demo_app();
    let id = holed(&mut app);
    let face = app.world().resource::<Scene>().face(id.model, id.face).expect("a face");
    app.world_mut().write_message(SelectRequest { faces: vec![face], mode: SelectMode::Replace });
    app.update();
    app.update();
    let selected = |app: &App| app.world().resource::<ElementSelection>().loops();
    let count = |app: &mut App| records(app)[0].faces[id.face].loops.len();
    for (action, typed) in [
        (EditAction::AddCircle, vec!["0.5", "0.5", "0.001"]),
        (EditAction::AddText, vec!["A1", "0.5", "0.5", "0.01"]),
        (EditAction::Duplicate, vec![]),
    ] {
        let before = count(&mut app);
        let values = typed.into_iter().map(str::to_owned).collect();
        app.world_mut().write_message(RunEdit { action, values });
        app.update();
        app.update();
        let after = count(&mut app);
        assert!(after > before, "{action:?}");
        assert_eq!(selected(&app), (before..after).collect::<Vec<_>>(), "{action:?}");
    }
}
