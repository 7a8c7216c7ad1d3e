//! Keys as egui gets them, with the modifier keys that were held when they were pressed.
//!
//! bevy_egui gives all keys of a frame the modifiers held at its end. In a slow frame Ctrl may be down and up again
//! before it is over, and Ctrl+A would type an "a" into the field. Messages are followed one by one instead, as
//! everywhere in the editor.

use bevy::input::keyboard::KeyboardInput;
use bevy::prelude::*;
use bevy::window::WindowFocused;
use bevy_egui::egui::{Event, Key, Modifiers as Held};
use bevy_egui::{EguiInput, helpers};

use crate::editor::tools::Modifiers;

/// A key that went down or up, and what was held then.
type Stroke = (Key, bool, Modifiers);

/// Corrects the keys of this frame before panels see them.
pub(super) fn correct(
    mut messages: MessageReader<KeyboardInput>,
    mut focus: MessageReader<WindowFocused>,
    mut held: Local<Modifiers>,
    mut inputs: Query<&mut EguiInput>,
) {
    if focus.read().any(|f| !f.focused) {
        *held = Modifiers::default();
    }
    let mut strokes: Vec<Stroke> = Vec::new();
    for message in messages.read() {
        held.follow(message.key_code, message.state);
        let key = helpers::bevy_to_egui_key(&message.logical_key);
        let key = key.or_else(|| helpers::bevy_to_egui_physical_key(&message.key_code));
        strokes.extend(key.map(|key| (key, message.state.is_pressed(), *held)));
    }
    if !strokes.is_empty() {
        inputs.iter_mut().for_each(|mut input| apply(&mut input.events, &strokes));
    }
}

fn apply(events: &mut Vec<Event>, strokes: &[Stroke]) {
    let mut strokes = strokes.iter();
    let mut corrected = Vec::with_capacity(events.len());
    for event in events.drain(..) {
        let Event::Key { key, physical_key, pressed, repeat, modifiers } = event else {
            corrected.push(event);
            continue;
        };
        let stroke = strokes.find(|(k, p, _)| (*k, *p) == (key, pressed));
        let now = stroke.map_or(modifiers, |(.., held)| Held {
            alt: held.alt,
            ctrl: held.ctrl,
            shift: held.shift,
            mac_cmd: modifiers.mac_cmd,
            command: held.ctrl,
        });
        // The text of a key comes before it. With Ctrl and Alt it is a letter of some keyboards.
        if pressed && now.ctrl && !now.alt && matches!(corrected.last(), Some(Event::Text(_))) {
            corrected.pop();
        }
        corrected.push(Event::Key { key, physical_key, pressed, repeat, modifiers: now });
        if pressed && now.command && !modifiers.command {
            match key {
                Key::C => corrected.push(Event::Copy),
                Key::X => corrected.push(Event::Cut),
                _ => {}
            }
        }
    }
    *events = corrected;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(key: Key, pressed: bool, modifiers: Held) -> Event {
        Event::Key { key, physical_key: None, pressed, repeat: false, modifiers }
    }

    #[test]
    fn keys_get_the_modifiers_held_when_they_went_down() {
        let ctrl = Modifiers { ctrl: true, ..Modifiers::default() };
        let text = |t: &str| Event::Text(t.into());
        // Ctrl+A, let go, then 5: all in one frame at whose end nothing is held.
        let mut events = vec![
            text("a"),
            event(Key::A, true, Held::NONE),
            event(Key::A, false, Held::NONE),
            text("5"),
            event(Key::Num5, true, Held::NONE),
        ];
        apply(
            &mut events,
            &[(Key::A, true, ctrl), (Key::A, false, ctrl), (Key::Num5, true, Modifiers::default())],
        );
        let command = Held { ctrl: true, command: true, ..Held::NONE };
        let expected = [
            event(Key::A, true, command),
            event(Key::A, false, command),
            text("5"),
            event(Key::Num5, true, Held::NONE),
        ];
        assert_eq!(events, expected);
        // Copying is told apart too.
        let mut events = vec![text("c"), event(Key::C, true, Held::NONE)];
        apply(&mut events, &[(Key::C, true, ctrl)]);
        assert_eq!(events, [event(Key::C, true, command), Event::Copy]);
    }
}
