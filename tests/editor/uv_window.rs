//! The uv panel in the real window: a loop is drawn with the mouse, a control point of it is dragged, the picture
//! of the model changes there and nowhere else, and undoing gives the same picture as before.

use std::time::Duration;

use hairline::scene::SceneRecord;
use hairline::scene::file::{self, SaveOptions};

use super::screen::{Input, Picture};
use super::window::{Editor, VIEWPORT};

// X keycodes of the keyboard that Xvfb has.
const TAB: u8 = 23;
const DIGIT_5: u8 = 14;
const R: u8 = 27;
const CONTROL: u8 = 37;
const F: u8 = 41;
const Z: u8 = 52;
const N: u8 = 57;

/// The viewport above the panel: left, top, right, bottom.
const MODEL: (u16, u16, u16, u16) = (300, 80, 900, 440);
/// Nothing lights up under the pointer here.
const ASIDE: (u16, u16) = (980, 470);

fn drag(editor: &mut Editor, from: (u16, u16), to: (u16, u16)) {
    editor.screen.move_to(from);
    editor.rest(Duration::from_millis(300));
    editor.screen.input(Input::ButtonDown, 1);
    for k in 1..=4u16 {
        let mix = |a: u16, b: u16| (u32::from(a) * u32::from(4 - k) + u32::from(b) * u32::from(k)) / 4;
        editor.screen.move_to((mix(from.0, to.0) as u16, mix(from.1, to.1) as u16));
        std::thread::sleep(Duration::from_millis(60));
    }
    editor.screen.input(Input::ButtonUp, 1);
}

/// The box around changed pixels.
fn extent(changed: &[(u16, u16)]) -> (u16, u16) {
    let side = |of: fn(&(u16, u16)) -> u16| {
        let (low, high) = (changed.iter().map(of).min(), changed.iter().map(of).max());
        high.unwrap_or_default() - low.unwrap_or_default()
    };
    (side(|p| p.0), side(|p| p.1))
}

#[test]
fn a_control_point_is_dragged_in_the_panel_and_the_picture_follows() {
    let settings = tempfile::tempdir().expect("a temporary folder");
    // The plate of the demo alone, with its outline only: it is drawn in no time.
    let mut model = hairline::scene::demo::model();
    model.faces.truncate(1);
    model.faces[0].loops.truncate(1);
    let file = settings.path().join("plate.hairline");
    file::save(&file, &SceneRecord::of_model(model), &SaveOptions::default()).expect("writable");
    let mut editor = Editor::start_with(settings.path(), &[&file]);
    let shown = editor.first_picture();
    editor.screen.key(DIGIT_5);
    let above = editor.changed("the view from above", &shown, 1000);
    let alone = editor.select_all(&above, 1000);
    editor.screen.key(TAB);
    let panel = editor.changed("the panel", &alone, 1000);
    editor.screen.key(F);
    editor.changed("the plate above the panel", &panel, 100);
    // Away from the tree: the row under the pointer lights up its face.
    editor.screen.move_to(ASIDE);
    let fitted = editor.rest(Duration::from_secs(1));

    // A rectangle in the middle of the domain, without snapping.
    editor.screen.move_to((640, 600));
    editor.rest(Duration::from_millis(300));
    editor.screen.key(N);
    editor.screen.key(R);
    editor.rest(Duration::from_millis(300));
    drag(&mut editor, (625, 640), (655, 662));
    editor.screen.move_to(ASIDE);
    editor.wait("a hole in the model", |editor| {
        let now = editor.screen.picture();
        (now.difference(&fitted, MODEL).len() > 20).then_some(())
    });
    let holed = editor.rest(Duration::from_secs(1));
    let hole = holed.difference(&fitted, MODEL);
    let (width, height) = extent(&hole);
    assert!(width < 120 && height < 120, "only the hole changed: {width} x {height}");

    // Its corner, by the mouse.
    drag(&mut editor, (655, 640), (700, 610));
    editor.screen.move_to(ASIDE);
    let dragged = changed_in_model(&mut editor, "the corner dragged", &holed);
    let corner = dragged.difference(&holed, MODEL);
    let (width, height) = extent(&corner);
    assert!(width < 200 && height < 160, "only near the corner: {width} x {height}");

    // Undone, it is as it was; undone again, there is no hole.
    undo(&mut editor);
    let undone = changed_in_model(&mut editor, "the corner back", &dragged);
    assert_eq!(undone.difference(&holed, VIEWPORT), [], "as before the drag");
    undo(&mut editor);
    let none = changed_in_model(&mut editor, "no hole", &undone);
    assert_eq!(none.difference(&fitted, MODEL), [], "as before the hole");
}

fn undo(editor: &mut Editor) {
    editor.key_with(CONTROL, Z);
}

fn changed_in_model(editor: &mut Editor, what: &str, before: &Picture) -> Picture {
    editor.wait(what, |editor| {
        let now = editor.screen.picture();
        (now.difference(before, MODEL).len() > 10).then_some(())
    });
    editor.rest(Duration::from_secs(1))
}
