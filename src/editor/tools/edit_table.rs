//! The rows of the command table that edit loops, curves and surfaces.

use bevy::input::keyboard::KeyCode;

use super::command::{Action, Command, Menu, command};
use super::edit_action::EditAction::{self, *};
use super::edit_action::Needs;
use super::key::Shortcut;
use super::situation::Situation;

const fn row(
    menu: Menu,
    action: EditAction,
    id: &'static str,
    label: &'static str,
    keys: &'static [Shortcut],
) -> Command {
    command(menu, Action::Edit(action), id, label, keys).when(enabled(action))
}

/// The rule for what an action needs.
const fn enabled(action: EditAction) -> fn(&Situation) -> bool {
    match action.needs() {
        Needs::Anything => |s| s.selection,
        Needs::Face => |s| s.face,
        Needs::Faces => |s| s.selection,
        Needs::Loops => |s| s.loops > 0,
        Needs::Curve => |s| s.curves == 1,
        Needs::Points => |s| s.points > 0,
        Needs::Point => |s| s.points == 1,
        Needs::Weights => |s| s.points > 0 || s.surface_points > 0,
        Needs::SurfacePoints => |s| s.surface_points > 0,
        Needs::Clipboard => |s| s.face && s.clipboard,
    }
}

const fn key(c: char) -> Shortcut {
    Shortcut::char(c)
}

/// The rows, menu by menu.
pub(super) const ROWS: [Command; 40] = [
    row(Menu::Edit, Cut, "edit.cut", "Cut loops", &[key('x').ctrl()]).separated(),
    row(Menu::Edit, Copy, "edit.copy", "Copy loops", &[key('c').ctrl()]),
    row(Menu::Edit, Paste, "edit.paste", "Paste loops", &[key('v').ctrl()]),
    row(Menu::Edit, Duplicate, "edit.duplicate", "Duplicate", &[key('d').ctrl().shift()]),
    row(Menu::Edit, Delete, "edit.delete", "Delete", &[Shortcut::code(KeyCode::Delete)]),
    row(Menu::Loop, AddRectangle, "loop.rectangle", "Add rectangle…", &[key('r').shift()]),
    row(Menu::Loop, AddCircle, "loop.circle", "Add circle…", &[key('c').shift()]),
    row(Menu::Loop, AddEllipse, "loop.ellipse", "Add ellipse…", &[key('e').shift()]),
    row(Menu::Loop, AddPolyline, "loop.polyline", "Add polyline…", &[key('l').shift()]),
    row(Menu::Loop, AddText, "loop.text", "Add text…", &[key('t').shift()]),
    row(Menu::Loop, MoveBy, "loop.move", "Move by…", &[key('m').shift()]).separated(),
    row(Menu::Loop, Rotate, "loop.rotate", "Rotate…", &[key('a').shift()]),
    row(Menu::Loop, Scale, "loop.scale", "Scale…", &[key('s').shift()]),
    row(Menu::Loop, MirrorU, "loop.mirror_u", "Mirror in u", &[key('u').alt()]),
    row(Menu::Loop, MirrorV, "loop.mirror_v", "Mirror in v", &[key('v').alt()]),
    row(Menu::Loop, ReverseLoop, "loop.reverse", "Reverse", &[key('r').ctrl()]).separated(),
    row(Menu::Loop, CloseLoop, "loop.close", "Close", &[key('o').shift()]),
    row(Menu::Loop, MakeHole, "loop.hole", "Make hole", &[key('h').alt()]),
    row(Menu::Loop, MakeOuter, "loop.outer", "Make island or outer loop", &[key('i').alt()]),
    row(Menu::Loop, Untrim, "loop.untrim", "Untrim face", &[key('t').ctrl()]).separated(),
    row(Menu::Curve, SetPoint, "curve.point", "Set coordinates…", &[key('q').shift()]),
    row(Menu::Curve, SetWeight, "curve.weight", "Set weight…", &[key('w')]),
    row(Menu::Curve, InsertKnot, "curve.insert_knot", "Insert knot…", &[key('k').shift()]).separated(),
    row(Menu::Curve, RemoveKnot, "curve.remove_knot", "Remove knot…", &[key('k').ctrl()]),
    row(Menu::Curve, Elevate, "curve.elevate", "Elevate degree", &[key('d')]),
    row(Menu::Curve, Reduce, "curve.reduce", "Reduce degree…", &[key('d').shift()]),
    row(Menu::Curve, Split, "curve.split", "Split…", &[key('b')]).separated(),
    row(Menu::Curve, Join, "curve.join", "Join with next", &[key('j')]),
    row(Menu::Surface, MoveSurfacePoints, "surface.move", "Move surface points by…", &[key('m').alt()]),
    row(Menu::Surface, InsertKnotU, "surface.insert_u", "Insert knot in u…", &[key('k').alt()]).separated(),
    row(Menu::Surface, InsertKnotV, "surface.insert_v", "Insert knot in v…", &[key('k').alt().shift()]),
    row(Menu::Surface, ElevateU, "surface.elevate_u", "Elevate degree in u", &[key('d').alt()]),
    row(Menu::Surface, ElevateV, "surface.elevate_v", "Elevate degree in v", &[key('d').alt().shift()]),
    row(Menu::Surface, ReverseU, "surface.reverse_u", "Reverse u", &[key('r').alt()]).separated(),
    row(Menu::Surface, ReverseV, "surface.reverse_v", "Reverse v", &[key('r').alt().shift()]),
    row(Menu::Surface, SwapUv, "surface.swap", "Swap u and v", &[key('x').alt()]),
    row(Menu::Surface, FlipNormal, "surface.flip", "Flip normal", &[key('n').alt()]),
    row(Menu::Surface, Rename, "surface.rename", "Rename…", &[Shortcut::code(KeyCode::F2)]).separated(),
    row(Menu::Surface, Colour, "surface.colour", "Colour…", &[key('c').alt()]),
    row(Menu::Surface, Layer, "surface.layer", "Layer…", &[key('l').alt()]),
];
