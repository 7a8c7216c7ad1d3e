//! Figures for the status bar: frame time, GPU time, samples, memory.
//!
//! Wiring: `First` and the render world's last set stamp the frame; `render` fills in the rest through
//! [`RenderFigures`], which both worlds share.

use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::render::{Render, RenderApp, RenderSystems};

/// What the renderer last measured.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Figures {
    /// Wall time of the last frame, milliseconds.
    pub frame_ms: f32,
    /// GPU time of the last frame's model passes, milliseconds; `None` where it cannot be measured.
    pub gpu_ms: Option<f32>,
    /// Samples per pixel in the picture.
    pub samples: u32,
    /// Samples per pixel wanted.
    pub samples_wanted: u32,
    /// Part of the full resolution (1 = all pixels).
    pub resolution: f32,
    /// Whether the picture is drawn from triangles.
    pub triangles: bool,
    /// Bytes of the model on the GPU.
    pub gpu_bytes: u64,
    /// Frames drawn since start.
    pub frames: u64,
    /// What the last edit cost.
    pub edit: EditCost,
    started: Option<Instant>,
    ended: Option<Instant>,
}

/// What an edit cost from the request to the upload, and what was uploaded.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EditCost {
    /// Time on the processor of the last edit that was uploaded: working it out, changing components, deriving,
    /// packing, uploading.
    pub time: Duration,
    /// Bytes uploaded for it.
    pub bytes: u64,
    /// Time so far of the one under way.
    spent: Duration,
    /// Edits so far.
    pub edits: u64,
    /// Whether something of it is still to be done.
    under_way: bool,
}

impl EditCost {
    /// Starts the account of an edit that took `time` so far. One whose results were never drawn goes on.
    pub fn begin(&mut self, time: Duration) {
        if !self.under_way {
            (self.under_way, self.spent) = (true, Duration::ZERO);
        }
        self.edits += 1;
        self.spent += time;
    }

    /// Adds work that was done for the edit, if there is one.
    pub fn add(&mut self, time: Duration) {
        if self.under_way {
            self.spent += time;
        }
    }

    /// Adds the upload, which is the end of it.
    pub fn finish(&mut self, time: Duration, bytes: u64) {
        if self.under_way {
            *self = Self { time: self.spent + time, bytes, under_way: false, ..*self };
        }
    }
}

/// Figures shared by the main and the render world.
#[derive(Resource, Clone, Default)]
pub struct RenderFigures {
    figures: Arc<Mutex<Figures>>,
    failure: Arc<Mutex<Option<String>>>,
}

impl RenderFigures {
    /// The figures, to read or write. Held for moments only.
    pub fn lock(&self) -> MutexGuard<'_, Figures> {
        self.figures.lock().unwrap_or_else(|e| e.into_inner())
    }

    /// Notes what keeps the model, or triangles of it, from being drawn.
    pub fn fail(&self, text: String) {
        *self.failure.lock().unwrap_or_else(|e| e.into_inner()) = Some(text);
    }

    /// The same, once.
    pub fn take_failure(&self) -> Option<String> {
        self.failure.lock().unwrap_or_else(|e| e.into_inner()).take()
    }
}

/// Memory of this process, bytes. Looked up at most once per second.
#[derive(Resource, Debug, Default)]
pub struct ProcessMemory {
    /// Resident bytes; `None` where it cannot be found out.
    pub resident: Option<u64>,
    looked_up: Option<Instant>,
}

/// Adds the figures.
pub struct DiagnosticsPlugin;

impl Plugin for DiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        let figures = app.world_mut().get_resource_or_init::<RenderFigures>().clone();
        app.init_resource::<ProcessMemory>().add_systems(First, (start_frame, look_up_memory));
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.insert_resource(figures).add_systems(Render, end_frame.in_set(RenderSystems::Cleanup));
        }
    }
}

fn start_frame(figures: Res<RenderFigures>) {
    figures.lock().started = Some(Instant::now());
}

/// Frames that follow each other closely are timed from end to end (the GPU may still be at work when the
/// CPU is through), single ones from their own start.
fn end_frame(figures: Res<RenderFigures>) {
    let mut figures = figures.lock();
    let now = Instant::now();
    let Some(started) = figures.started else { return };
    let from = figures.ended.filter(|e| started.duration_since(*e).as_millis() < 4).unwrap_or(started);
    figures.frame_ms = 1e3 * now.duration_since(from).as_secs_f32();
    figures.ended = Some(now);
    figures.frames += 1;
}

fn look_up_memory(mut memory: ResMut<ProcessMemory>) {
    if memory.looked_up.is_some_and(|t| t.elapsed().as_secs_f32() < 1.0) {
        return;
    }
    memory.looked_up = Some(Instant::now());
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmRSS:"));
    let kib = line.and_then(|l| l.split_whitespace().next()).and_then(|n| n.parse::<u64>().ok());
    memory.resident = kib.map(|kib| kib * 1024);
}
