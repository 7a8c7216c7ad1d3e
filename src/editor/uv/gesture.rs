//! What the mouse does in the panel, as transitions of a small machine without any Bevy in it.
//!
//! A press notes what is under the pointer; beyond a few pixels it becomes a drag of that, a box around
//! elements or a new shape; a release without that is a click. A drag asks for previews relative to the state at its
//! beginning, so that the way the mouse took does not matter, and ends as one step or not at all.

use std::collections::BTreeSet;

use glam::DVec2;

use super::draw_shape;
use super::geometry::UvGeometry;
use super::hit::{self, UvHit};
use super::moving::{self, Moved};
use super::panel::UvPanel;
use super::snap::{SnapScene, Snapped};
use super::tool::Tool;
use crate::editor::editing::EditRequest;
use crate::editor::elements::{Element, ElementRequest, ElementSelection, FaceInHand, PointAddress};
use crate::editor::selection::SelectMode;
use crate::editor::tools::Modifiers;

/// Farther than this, logical pixels, a press is a drag.
const CLICK_SLOP_PX: f64 = 3.0;

/// What is under way.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Gesture {
    /// Nothing.
    #[default]
    None,
    /// The view is being moved.
    Pan {
        /// Where the pointer was last.
        last: DVec2,
        /// Whether it has moved at all: if not, it was a click for the menu.
        moved: bool,
    },
    /// The left button went down.
    Press {
        /// Where.
        at: DVec2,
        /// On what.
        hit: Option<UvHit>,
        /// Keys held then.
        keys: Modifiers,
        /// Whether it is the second of a double click.
        double: bool,
    },
    /// Elements are dragged.
    Drag(Drag),
    /// A box around elements is drawn.
    Box {
        /// Where it began.
        from: DVec2,
        /// Where the pointer is.
        to: DVec2,
        /// Keys held at the beginning.
        keys: Modifiers,
    },
    /// A rectangle or circle is drawn, native parameters.
    Shape {
        /// Corner or centre.
        from: DVec2,
        /// Opposite corner or point of the circle.
        to: DVec2,
    },
    /// A polyline is drawn, native parameters.
    Polyline {
        /// Its corners so far.
        corners: Vec<DVec2>,
    },
    /// A freehand line is drawn, native parameters.
    Freehand {
        /// Its points so far.
        points: Vec<DVec2>,
    },
}

/// A drag of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct Drag {
    /// The place of the element that was gripped.
    pub grip: DVec2,
    /// Parameters under the pointer when it was gripped.
    pub from: DVec2,
    /// What moves.
    pub what: Moved,
    /// Control points that move, joined neighbours included.
    pub moving: BTreeSet<PointAddress>,
    /// How far it has moved.
    pub by: DVec2,
}

/// What the panel asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum Asked {
    /// A change of the selected elements.
    Elements(ElementRequest),
    /// A change of the face.
    Edit(EditRequest),
}

/// The hand at work on one face.
pub struct Hand<'a> {
    /// The panel.
    pub panel: &'a mut UvPanel,
    /// The face.
    pub face: &'a FaceInHand,
    /// Its loops as polylines.
    pub geometry: &'a UvGeometry,
    /// Its selected elements.
    pub selection: &'a ElementSelection,
    /// Keys held now.
    pub keys: Modifiers,
    /// What is asked for.
    pub asked: &'a mut Vec<Asked>,
}

impl Hand<'_> {
    /// What is at a window position.
    pub fn hit(&self, at: DVec2) -> Option<UvHit> {
        let panel = &self.panel;
        hit::at(at, self.face, self.geometry, &panel.view, self.selection, &panel.shown)
    }

    pub(super) fn ask(&mut self, request: EditRequest) {
        self.asked.push(Asked::Edit(request));
    }

    fn select(&mut self, elements: Vec<Element>, mode: SelectMode) {
        self.asked.push(Asked::Elements(ElementRequest { elements, mode }));
    }

    /// Where a point being placed goes; shown as snapped.
    pub(super) fn snap(
        &mut self,
        raw: DVec2,
        origin: Option<DVec2>,
        moving: &BTreeSet<PointAddress>,
    ) -> DVec2 {
        let mut settings = self.panel.snapping;
        settings.on ^= self.keys.ctrl;
        let (face, geometry) = (self.face, self.geometry);
        let snapped =
            SnapScene { face, geometry, view: &self.panel.view, moving, settings }.snap(raw, origin);
        self.panel.snapped = Some(snapped).filter(|s: &Snapped| s.kind.is_some());
        snapped.uv
    }

    /// The left button went down.
    pub fn press(&mut self, at: DVec2, double: bool) {
        let tool = self.panel.tool;
        if tool.draws() {
            return draw_shape::press(self, at, double);
        }
        if tool.takes_place() {
            return draw_shape::click_on_curve(self, at);
        }
        let hit = self.hit(at);
        self.panel.gesture = Gesture::Press { at, hit, keys: self.keys, double };
    }

    /// The pointer moved.
    pub fn moved(&mut self, to: DVec2) {
        match std::mem::take(&mut self.panel.gesture) {
            Gesture::Pan { last, moved } => {
                let moved = moved || (to - last).length() > CLICK_SLOP_PX;
                if moved {
                    self.panel.view.pan(to - last);
                }
                self.panel.gesture = Gesture::Pan { last: if moved { to } else { last }, moved };
            }
            Gesture::Press { at, hit, keys, double } => {
                if (to - at).length() <= CLICK_SLOP_PX {
                    self.panel.gesture = Gesture::Press { at, hit, keys, double };
                } else if let Some(hit) = hit {
                    self.begin_drag(at, hit, keys);
                    self.drag(to);
                } else {
                    self.panel.gesture = Gesture::Box { from: at, to, keys };
                }
            }
            Gesture::Box { from, keys, .. } => self.panel.gesture = Gesture::Box { from, to, keys },
            drag @ Gesture::Drag(_) => {
                self.panel.gesture = drag;
                self.drag(to);
            }
            other => {
                self.panel.gesture = other;
                draw_shape::moved(self, to);
            }
        }
    }

    /// The left button went up.
    pub fn release(&mut self, at: DVec2) {
        match std::mem::take(&mut self.panel.gesture) {
            Gesture::Press { hit, keys, double, .. } => self.click(hit, keys, double),
            Gesture::Box { from, to, keys } => {
                let panel = &self.panel;
                let found = hit::in_box((from, to), self.face, self.geometry, &panel.view, &panel.shown);
                self.select(found, mode_of(keys));
            }
            Gesture::Drag(_) => {
                self.panel.snapped = None;
                self.ask(EditRequest::Commit);
            }
            other => {
                self.panel.gesture = other;
                draw_shape::release(self, at);
            }
        }
    }

    fn click(&mut self, hit: Option<UvHit>, keys: Modifiers, double: bool) {
        match hit.map(|h| h.element) {
            Some(element) if double && element.trim_loop().is_some() => {
                let trim_loop = element.trim_loop().unwrap_or_default();
                self.select(vec![Element::Loop { trim_loop }], mode_of(keys));
            }
            Some(element) => self.select(vec![element], mode_of(keys)),
            None if keys == Modifiers::default() => self.select(Vec::new(), SelectMode::Replace),
            None => {}
        }
    }

    /// Takes what was hit, or the whole selection if it belongs to it.
    fn begin_drag(&mut self, at: DVec2, hit: UvHit, keys: Modifiers) {
        let mut elements: Vec<Element> = vec![hit.element];
        if self.selection.covers(hit.element) {
            elements = self.selection.elements().collect();
        } else if keys.shift || keys.ctrl {
            elements.extend(self.selection.elements());
            self.select(vec![hit.element], SelectMode::Add);
        } else {
            self.select(elements.clone(), SelectMode::Replace);
        }
        let what = Moved::of(&elements, self.face);
        let moving = moving::with_joined(self.face, &what);
        let from = self.panel.view.to_uv(at);
        self.panel.gesture = Gesture::Drag(Drag { grip: hit.uv, from, what, moving, by: DVec2::ZERO });
        self.ask(EditRequest::Begin);
    }

    /// Goes on with the drag under way.
    pub fn drag(&mut self, to: DVec2) {
        let Gesture::Drag(mut drag) = std::mem::take(&mut self.panel.gesture) else { return };
        let raw = drag.grip + (self.panel.view.to_uv(to) - drag.from);
        let to = self.snap(raw, self.keys.shift.then_some(drag.grip), &drag.moving);
        let by = to - drag.grip;
        if by != drag.by && by.is_finite() {
            drag.by = by;
            let met = self.panel.snapped.is_some().then_some(to);
            self.ask(EditRequest::Preview(drag.what.operation_to(self.face.id, by, met)));
        }
        self.panel.gesture = Gesture::Drag(drag);
    }

    /// Esc: ends what is under way, else drops the tool, else clears the selection. Whether it did anything.
    pub fn escape(&mut self) -> bool {
        self.panel.snapped = None;
        match std::mem::take(&mut self.panel.gesture) {
            Gesture::None if self.panel.tool != Tool::Select => self.panel.tool = Tool::Select,
            Gesture::None if !self.selection.is_empty() => self.select(Vec::new(), SelectMode::Replace),
            Gesture::None => return false,
            Gesture::Drag(_) => self.ask(EditRequest::Cancel),
            _ => {}
        }
        true
    }

    /// Moves what is selected.
    pub fn nudge(&mut self, by: DVec2) {
        if self.panel.is_busy() || self.selection.is_empty() {
            return;
        }
        let elements: Vec<Element> = self.selection.elements().collect();
        let what = Moved::of(&elements, self.face);
        if !what.is_empty() {
            self.ask(EditRequest::Perform(what.operation(self.face.id, by)));
        }
    }

    /// Selects all curves.
    pub fn select_all(&mut self) {
        let loops = (0..self.face.loops.len()).map(|trim_loop| Element::Loop { trim_loop }).collect();
        self.select(loops, SelectMode::Replace);
    }
}

/// Shift adds, Ctrl toggles.
pub fn mode_of(keys: Modifiers) -> SelectMode {
    match (keys.shift, keys.ctrl) {
        (true, _) => SelectMode::Add,
        (_, true) => SelectMode::Toggle,
        _ => SelectMode::Replace,
    }
}
