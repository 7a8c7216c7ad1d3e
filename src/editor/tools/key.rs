//! Keys of commands: how they are matched and how they are written in menus.

use std::fmt;

use bevy::input::ButtonState;
use bevy::input::keyboard::{Key as LogicalKey, KeyCode};

/// The key itself. Letters go by what is printed on them (so they follow the keyboard layout), digits
/// and function keys by their place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum KeyCap {
    /// A letter or sign.
    Char(char),
    /// Any other key.
    Code(KeyCode),
}

/// A key with its modifiers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Shortcut {
    /// The key.
    pub cap: KeyCap,
    /// Whether Ctrl (Cmd on a Mac) is held.
    pub ctrl: bool,
    /// Whether Shift is held. Not looked at for signs like `?`.
    pub shift: bool,
    /// Whether Alt is held.
    pub alt: bool,
}

/// Modifier keys held down.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Ctrl, or Cmd on a Mac.
    pub ctrl: bool,
    /// Shift.
    pub shift: bool,
    /// Alt.
    pub alt: bool,
}

impl Modifiers {
    /// Takes note of a key that went down or up.
    pub fn follow(&mut self, key: KeyCode, state: ButtonState) {
        let down = state.is_pressed();
        match key {
            KeyCode::ControlLeft | KeyCode::ControlRight | KeyCode::SuperLeft | KeyCode::SuperRight => {
                self.ctrl = down;
            }
            KeyCode::ShiftLeft | KeyCode::ShiftRight => self.shift = down,
            KeyCode::AltLeft | KeyCode::AltRight => self.alt = down,
            _ => {}
        }
    }
}

impl Shortcut {
    /// A letter or sign without modifiers.
    pub const fn char(c: char) -> Self {
        Self { cap: KeyCap::Char(c), ctrl: false, shift: false, alt: false }
    }

    /// Any other key without modifiers.
    pub const fn code(code: KeyCode) -> Self {
        Self { cap: KeyCap::Code(code), ctrl: false, shift: false, alt: false }
    }

    /// The same with Ctrl.
    pub const fn ctrl(self) -> Self {
        Self { ctrl: true, ..self }
    }

    /// The same with Shift.
    pub const fn shift(self) -> Self {
        Self { shift: true, ..self }
    }

    /// The same with Alt.
    pub const fn alt(self) -> Self {
        Self { alt: true, ..self }
    }

    /// Whether a key press means this shortcut.
    pub fn matches(&self, logical: &LogicalKey, code: KeyCode, held: Modifiers) -> bool {
        let (cap, sign) = match self.cap {
            KeyCap::Char(c) => match logical {
                LogicalKey::Character(text) => {
                    (text.chars().flat_map(char::to_lowercase).eq([c]), !c.is_alphabetic())
                }
                _ => (false, false),
            },
            KeyCap::Code(wanted) => (wanted == code, false),
        };
        cap && held.ctrl == self.ctrl && held.alt == self.alt && (sign || held.shift == self.shift)
    }
}

impl fmt::Display for Shortcut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (held, name) in [(self.ctrl, "Ctrl+"), (self.alt, "Alt+"), (self.shift, "Shift+")] {
            if held {
                f.write_str(name)?;
            }
        }
        match self.cap {
            KeyCap::Char(c) => write!(f, "{}", c.to_uppercase()),
            KeyCap::Code(KeyCode::Escape) => f.write_str("Esc"),
            KeyCap::Code(code) => {
                let name = format!("{code:?}");
                match name.strip_prefix("Numpad") {
                    Some(digit) => write!(f, "Num {digit}"),
                    None => f.write_str(name.strip_prefix("Digit").unwrap_or(&name)),
                }
            }
        }
    }
}
