//! Short messages in the lower corner of the viewport. Errors stay until they are closed.

use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::window::RequestRedraw;
use bevy_egui::egui::{self, Align2, Context, Frame, Margin, Rect, RichText, Sense, Stroke, vec2};

use super::icon::{self, Icon};
use super::report::mark;
use crate::editor::redraw::Waker;
use crate::editor::theme::Palette;
use crate::exchange::report::{ImportReport, Severity};

/// How long notes and warnings stay.
const STAY: Duration = Duration::from_secs(6);
/// Most notices shown at once.
const MOST: usize = 4;

/// One message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    /// How bad it is.
    pub severity: Severity,
    /// What happened, and where.
    pub text: String,
    until: Option<Instant>,
}

/// Messages shown now, oldest first.
#[derive(Resource, Debug, Default)]
pub struct Notices {
    list: Vec<Notice>,
    fresh: bool,
}

impl Notices {
    /// Messages shown now.
    pub fn list(&self) -> &[Notice] {
        &self.list
    }

    /// Says something that is good to know.
    pub fn info(&mut self, text: String) {
        self.push(Severity::Note, text);
    }

    /// Says what went wrong.
    pub fn error(&mut self, text: String) {
        self.push(Severity::Error, text);
    }

    /// Says how an import went, if not everything was well.
    pub fn imported(&mut self, name: &str, report: &ImportReport) {
        let number = |severity| report.remarks.iter().filter(|r| r.severity == severity).count();
        let (errors, warnings) = (number(Severity::Error), number(Severity::Warning));
        let many = |n: usize, what: &str| super::format::plural(n, what);
        if errors > 0 {
            let text =
                format!("{name}: {} skipped. The import report (R) lists them.", many(errors, "entity"));
            self.push(Severity::Warning, text.replace("entitys", "entities"));
        } else if warnings > 0 {
            let text = format!("{name}: {}. The import report (R) lists them.", many(warnings, "warning"));
            self.push(Severity::Note, text);
        }
    }

    fn push(&mut self, severity: Severity, text: String) {
        let until = (severity != Severity::Error).then(|| Instant::now() + STAY);
        self.list.retain(|n| n.text != text);
        self.list.push(Notice { severity, text, until });
        let excess = self.list.len().saturating_sub(MOST);
        self.list.drain(..excess);
        self.fresh = true;
    }
}

/// Drops what has been shown long enough; a timer wakes the window for it.
pub(super) fn expire(
    mut notices: ResMut<Notices>,
    waker: Res<Waker>,
    mut redraw: MessageWriter<RequestRedraw>,
) {
    if notices.list.is_empty() {
        return;
    }
    let now = Instant::now();
    if notices.list.iter().any(|n| n.until.is_some_and(|t| t <= now)) {
        notices.list.retain(|n| n.until.is_none_or(|t| t > now));
        redraw.write(RequestRedraw);
    }
    if std::mem::take(&mut notices.fresh) {
        redraw.write(RequestRedraw);
    }
    if let Some(next) = notices.list.iter().filter_map(|n| n.until).min() {
        waker.wake_after(next.saturating_duration_since(now) + Duration::from_millis(5));
    }
}

/// Shows the messages.
pub(super) fn show(ctx: &Context, viewport: Rect, palette: &Palette, notices: &mut Notices) {
    let mut closed = None;
    let mut bottom = viewport.max.y - 14.0;
    for (index, notice) in notices.list.iter().enumerate().rev() {
        let (icon, color) = mark(notice.severity, palette);
        let frame = Frame::new()
            .fill(palette.raised)
            .stroke(Stroke::new(1.0, color.gamma_multiply(0.6)))
            .corner_radius(6)
            .inner_margin(Margin::symmetric(10, 7));
        let area = egui::Area::new(egui::Id::new(("notice", &notice.text)))
            .order(egui::Order::Foreground)
            .pivot(Align2::LEFT_BOTTOM)
            .fixed_pos(egui::pos2(viewport.min.x + 14.0, bottom));
        let response = area.show(ctx, |ui| {
            frame.show(ui, |ui| {
                ui.horizontal(|ui| {
                    let (rect, _) = ui.allocate_exact_size(vec2(18.0, 18.0), Sense::hover());
                    icon::paint(ui.painter(), rect, icon, color);
                    let width = (viewport.width() - 130.0).clamp(120.0, 520.0);
                    ui.scope(|ui| {
                        ui.set_max_width(width);
                        ui.add(egui::Label::new(RichText::new(&notice.text).color(palette.text)).wrap());
                    });
                    let (rect, response) = ui.allocate_exact_size(vec2(18.0, 18.0), Sense::click());
                    icon::paint(ui.painter(), rect, Icon::Cross, palette.weak);
                    if response.clicked() {
                        closed = Some(index);
                    }
                });
            });
        });
        bottom = response.response.rect.min.y - 8.0;
    }
    if let Some(index) = closed {
        notices.list.remove(index);
    }
}
