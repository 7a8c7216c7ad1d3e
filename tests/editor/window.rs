//! The built program in a real window: the model is drawn, a click selects, nothing runs at rest, `Ctrl+Q` ends
//! it. What the screen shows decides.

use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::screen::{Input, Picture, SIZE, Screen};

/// Part of the screen that is viewport whatever the panels need: left, top, right, bottom.
pub const VIEWPORT: (u16, u16, u16, u16) = (300, 80, 900, 850);
/// Longest wait for anything: software drivers on busy machines take their time.
const PATIENCE: Duration = Duration::from_secs(300);
/// A key pressed at a window that has just opened may come before the model does: after this long it is pressed again.
const AGAIN: Duration = Duration::from_secs(10);

// X keycodes of the keyboard that Xvfb has.
const ESCAPE: u8 = 9;
const Q: u8 = 24;
pub const CONTROL: u8 = 37;
const A: u8 = 38;
const H: u8 = 43;
const SHIFT: u8 = 50;

/// The program in its window, on a screen of its own.
pub struct Editor {
    process: Child,
    pub screen: Screen,
}

impl Editor {
    pub fn start(settings: &Path) -> Self {
        Self::start_with(settings, &[])
    }

    /// On these files, with settings and copies to recover from in a folder.
    pub fn start_with(folder: &Path, files: &[&Path]) -> Self {
        let screen = Screen::start();
        let process = Command::new(env!("CARGO_BIN_EXE_hairline"))
            .args(files)
            .env("DISPLAY", &screen.name)
            .env("XDG_CONFIG_HOME", folder)
            .env("XDG_DATA_HOME", folder)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdin(Stdio::null())
            .spawn()
            .expect("the program starts");
        Self { process, screen }
    }

    /// Waits for the window and the demo scene in it.
    pub fn first_picture(&mut self) -> Picture {
        self.screen.move_to((SIZE.0 - 40, SIZE.1 - 60));
        self.wait("a window", |editor| editor.screen.focus().then_some(()));
        let black = self.screen.picture();
        let area = usize::from(VIEWPORT.2 - VIEWPORT.0) * usize::from(VIEWPORT.3 - VIEWPORT.1);
        self.changed("a first picture", &black, area / 2);
        // The demo scene is read while the window is open already: wait for it, not for the first frame.
        self.rest(Duration::from_secs(2))
    }

    /// Waits until `done`, looking again and again.
    pub fn wait<T>(&mut self, what: &str, mut done: impl FnMut(&mut Self) -> Option<T>) -> T {
        let started = Instant::now();
        loop {
            if let Some(found) = done(self) {
                return found;
            }
            let ended = self.process.try_wait().expect("its state can be asked");
            assert!(ended.is_none(), "the editor ended ({ended:?}) while waiting: {what}");
            if started.elapsed() >= PATIENCE {
                let shown = Path::new(env!("CARGO_TARGET_TMPDIR")).join("editor-window.png");
                self.screen.picture().save(&shown);
                panic!("not within {PATIENCE:?}: {what}; the screen then: {}", shown.display());
            }
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Processor time used since it started, clock ticks (1/100 s).
    fn ticks(&self) -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.process.id())).expect("it runs");
        let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
        fields[11].parse::<u64>().expect("utime") + fields[12].parse::<u64>().expect("stime")
    }

    /// Waits until it does nothing for `time`, and tells what the screen shows then.
    pub fn rest(&mut self, time: Duration) -> Picture {
        self.wait("rest", |editor| {
            let before = editor.ticks();
            std::thread::sleep(time);
            // A reply of the server or a timer of the driver may cost a tick.
            (editor.ticks() <= before + 2 && !editor.is_runnable()).then_some(())
        });
        self.screen.picture()
    }

    /// Whether one of its threads waits for a processor: on a busy machine, work that costs no time yet.
    fn is_runnable(&self) -> bool {
        let tasks = std::fs::read_dir(format!("/proc/{}/task", self.process.id())).expect("it runs");
        tasks.flatten().any(|task| {
            // A thread may end meanwhile.
            let stat = std::fs::read_to_string(task.path().join("stat")).unwrap_or_default();
            stat.rsplit(')').next().is_some_and(|rest| rest.trim_start().starts_with('R'))
        })
    }

    /// Waits until at least `pixels` of the viewport differ from `before`; then what it shows at rest.
    pub fn changed(&mut self, what: &str, before: &Picture, pixels: usize) -> Picture {
        self.wait(what, |editor| {
            let now = editor.screen.picture();
            (now.difference(before, VIEWPORT).len() >= pixels).then_some(())
        });
        self.rest(Duration::from_millis(500))
    }

    /// Selects all faces, as often as it takes until the picture shows it.
    pub fn select_all(&mut self, before: &Picture, pixels: usize) -> Picture {
        let mut pressed = None::<Instant>;
        self.wait("all faces selected", |editor| {
            if pressed.is_none_or(|at| at.elapsed() > AGAIN) {
                editor.key_with(CONTROL, A);
                pressed = Some(Instant::now());
            }
            (editor.screen.picture().difference(before, VIEWPORT).len() >= pixels).then_some(())
        });
        self.rest(Duration::from_millis(500))
    }

    pub fn key_with(&mut self, modifier: u8, key: u8) {
        self.screen.input(Input::KeyDown, modifier);
        self.screen.key(key);
        self.screen.input(Input::KeyUp, modifier);
    }

    /// As `kill -9` does.
    pub fn kill(&mut self) {
        self.process.kill().expect("it runs");
        self.process.wait().expect("it ends");
    }

    pub fn end(&mut self) -> ExitStatus {
        self.key_with(CONTROL, Q);
        let started = Instant::now();
        while started.elapsed() < PATIENCE {
            if let Some(status) = self.process.try_wait().expect("its state can be asked") {
                return status;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        panic!("Ctrl+Q does not end it");
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        // It has ended already unless the test failed.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A pixel in the middle of a run of changed ones, so that no edge is near.
fn inside(changed: &[(u16, u16)]) -> (u16, u16) {
    let all: std::collections::BTreeSet<_> = changed.iter().copied().collect();
    let reach = 6;
    let found = changed.iter().find(|(x, y)| {
        (x - reach..=x + reach).all(|x| all.contains(&(x, *y)))
            && (y - reach..=y + reach).all(|y| all.contains(&(*x, y)))
    });
    *found.expect("the model covers more than lines")
}

#[test]
fn the_model_is_drawn_selected_and_left_alone() {
    let settings = tempfile::tempdir().expect("a temporary folder");
    let mut editor = Editor::start(settings.path());
    let shown = editor.first_picture();
    let area = usize::from(VIEWPORT.2 - VIEWPORT.0) * usize::from(VIEWPORT.3 - VIEWPORT.1);

    // Hiding all faces leaves the background: where the picture changes the model was drawn.
    let marked = editor.select_all(&shown, area / 40);
    editor.screen.key(H);
    let empty = editor.changed("all faces hidden", &marked, area / 40);
    let model = shown.difference(&empty, VIEWPORT);
    assert!(model.len() > area / 20, "the model covers {} of {area} pixels", model.len());
    editor.screen.key(ESCAPE);
    editor.key_with(SHIFT, H);
    let again = editor.changed("all faces shown", &empty, area / 40);
    let left = again.difference(&shown, VIEWPORT).len();
    assert!(left < area / 1000, "{left} pixels are not as they were");

    // Hovering lights a face up a little; the click marks it for good.
    let place = inside(&model);
    editor.screen.move_to(place);
    let hovered = editor.rest(Duration::from_secs(1));
    editor.screen.input(Input::ButtonDown, 1);
    editor.screen.input(Input::ButtonUp, 1);
    let selected = editor.changed("a face selected", &hovered, 50);
    editor.screen.key(ESCAPE);
    editor.changed("nothing selected", &selected, 50);

    // At rest nothing runs.
    editor.rest(Duration::from_secs(3));
    assert!(editor.end().success());
}
