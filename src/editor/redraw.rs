//! Frames only when there is something new to show.
//!
//! The window runs in reactive mode with an endless wait: events of the window, [`Waker::wake`] from other
//! threads and `RequestRedraw` messages are the only things that cause a frame. bevy_egui 0.42 reports the
//! modifier keys anew every frame and egui repaints on every event, so unchanged reports are dropped:
//! without that an idle window draws for ever.

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::window::{RequestRedraw, WindowResized, WindowScaleFactorChanged};
use bevy::winit::{EventLoopProxyWrapper, UpdateMode, WinitSettings, WinitUserEvent};
use bevy_egui::{EguiInput, EguiPreUpdateSet, egui};

use super::tools::CommandRequest;
use super::viewport::Pointer;

/// Wakes the window from any thread.
#[derive(Resource, Clone, Default)]
pub struct Waker {
    proxy: Option<bevy::winit::EventLoopProxy<WinitUserEvent>>,
    /// When the earliest timer ends: later ones are not started, who is woken too early asks again.
    timer: Arc<Mutex<Option<Instant>>>,
}

impl Waker {
    /// Causes a frame soon. Does nothing without a window.
    pub fn wake(&self) {
        if let Some(proxy) = &self.proxy {
            // Fails only when the event loop has ended: nothing left to wake.
            let _ = proxy.send_event(WinitUserEvent::WakeUp);
        }
    }

    /// Causes a frame when `time` has passed, or earlier.
    pub fn wake_after(&self, time: Duration) {
        let end = Instant::now() + time;
        let set = |waker: &Self, value| *waker.timer.lock().unwrap_or_else(|e| e.into_inner()) = value;
        let running = *self.timer.lock().unwrap_or_else(|e| e.into_inner());
        if self.proxy.is_none() || running.is_some_and(|running| running <= end) {
            return;
        }
        set(self, Some(end));
        let waker = self.clone();
        let timer = std::thread::Builder::new().name("hairline-timer".into()).spawn(move || {
            std::thread::sleep(time);
            let mut timer = waker.timer.lock().unwrap_or_else(|e| e.into_inner());
            *timer = timer.filter(|running| *running != end);
            drop(timer);
            waker.wake();
        });
        if timer.is_err() {
            set(self, None);
            self.wake();
        }
    }
}

/// Adds reactive redrawing.
pub struct RedrawPlugin;

impl Plugin for RedrawPlugin {
    fn build(&self, app: &mut App) {
        let wait = UpdateMode::reactive_low_power(Duration::MAX);
        app.init_resource::<Waker>()
            .insert_resource(WinitSettings { focused_mode: wait, unfocused_mode: wait })
            .add_systems(PreStartup, connect)
            .add_systems(
                PreUpdate,
                drop_noise.after(EguiPreUpdateSet::ProcessInput).before(EguiPreUpdateSet::BeginPass),
            )
            .add_message::<WindowResized>()
            .add_message::<WindowScaleFactorChanged>()
            .add_systems(Last, (redraw_after_commands, redraw_after_resize));
    }
}

fn connect(proxy: Option<Res<EventLoopProxyWrapper>>, mut waker: ResMut<Waker>) {
    waker.proxy = proxy.map(|p| (**p).clone());
}

/// Drops reports of modifier keys that repeat the last one, and Tab, which is a key of ours: it would move egui's
/// focus to a button.
fn drop_noise(mut inputs: Query<&mut EguiInput>, mut last: Local<egui::Modifiers>, pointer: Res<Pointer>) {
    let typing = pointer.keyboard_taken;
    for mut input in &mut inputs {
        input.events.retain(|event| match event {
            egui::Event::ModifiersChanged(modifiers) => {
                std::mem::replace(&mut *last, *modifiers) != *modifiers
            }
            egui::Event::Key { key: egui::Key::Tab, .. } => typing,
            _ => true,
        });
    }
}

/// Frames that a new size of the window takes to reach the panels, by way of the camera, and the viewport, by way of
/// the panels.
const RESIZE_FRAMES: u32 = 3;

fn redraw_after_resize(
    mut sizes: MessageReader<WindowResized>,
    mut scales: MessageReader<WindowScaleFactorChanged>,
    mut left: Local<u32>,
    mut redraw: MessageWriter<RequestRedraw>,
) {
    if sizes.read().count() + scales.read().count() > 0 {
        *left = RESIZE_FRAMES;
    }
    if *left > 0 {
        *left -= 1;
        redraw.write(RequestRedraw);
    }
}

/// Commands sent by panels are served in the next frame: make sure there is one.
fn redraw_after_commands(
    mut requests: MessageReader<CommandRequest>,
    mut redraw: MessageWriter<RequestRedraw>,
) {
    if requests.read().count() > 0 {
        redraw.write(RequestRedraw);
    }
}
