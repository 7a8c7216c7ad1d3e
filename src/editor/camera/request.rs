//! Views asked for by commands, the view cube and opened files, served by short flights.

use bevy::prelude::*;
use bevy::window::RequestRedraw;
use glam::DVec3;

use super::flight::Flight;
use super::{ViewCamera, motion};
use crate::editor::derive::SceneBounds;
use crate::editor::object::{DerivedFace, Shown};
use crate::editor::selection::Selection;
use crate::editor::settings::Settings;
use crate::editor::tools::{Action, CommandRequest};
use crate::editor::viewport::Viewport;
use crate::kernel::view::{Bounds, Camera as ViewPoint, Projection, StandardView};

/// Asks for another view.
#[derive(Message, Debug, Clone, Copy, PartialEq)]
pub enum CameraRequest {
    /// Everything shown, from the same side.
    Fit,
    /// These bounds, from the same side.
    FitBounds(Bounds),
    /// Everything, isometric, at once: another model was opened.
    FitNew,
    /// From another side, showing everything.
    Standard(StandardView),
    /// Turn about the target.
    Look {
        /// Direction of sight.
        direction: DVec3,
        /// Up on the screen.
        up: DVec3,
    },
    /// This view, at once.
    Go(ViewPoint),
    /// Straight to a place.
    Approach {
        /// The point to look at, in the middle of the screen.
        point: DVec3,
        /// Direction of sight.
        direction: DVec3,
        /// Up on the screen.
        up: DVec3,
        /// Height of what is seen in the plane through the point, model units.
        size: f64,
    },
    /// Perspective to parallel and back.
    ToggleProjection,
}

/// View commands of the table.
pub(super) fn command_requests(
    mut commands: MessageReader<CommandRequest>,
    selection: Res<Selection>,
    faces: Query<&DerivedFace>,
    mut requests: MessageWriter<CameraRequest>,
) {
    for CommandRequest(action) in commands.read() {
        requests.write(match action {
            Action::Fit => CameraRequest::Fit,
            Action::FitSelection => {
                let bounds =
                    faces.iter_many(selection.faces()).fold(Bounds::EMPTY, |b, f| b.union(f.0.best_bounds()));
                CameraRequest::FitBounds(bounds)
            }
            Action::View(view) => CameraRequest::Standard(*view),
            Action::ToggleProjection => CameraRequest::ToggleProjection,
            _ => continue,
        });
    }
}

/// Starts the flight for each request; requests build on the end of the flight under way.
pub(super) fn serve(
    mut requests: MessageReader<CameraRequest>,
    mut camera: ResMut<ViewCamera>,
    mut settings: ResMut<Settings>,
    bounds: Res<SceneBounds>,
    viewport: Res<Viewport>,
    faces: Query<(&DerivedFace, &Shown)>,
) {
    for request in requests.read() {
        let all = || -> Vec<Bounds> {
            let shown: Vec<Bounds> =
                faces.iter().filter(|(_, s)| s.0).map(|(d, _)| d.0.best_bounds()).collect();
            if shown.is_empty() { vec![bounds.to_fit()] } else { shown }
        };
        let from = camera.destination();
        let (_, up, back) = from.axes();
        let aspect = viewport.aspect();
        let fit = |boxes: &[Bounds], direction, up| {
            motion::fit_boxes(boxes, direction, up, from.projection, aspect).unwrap_or(from)
        };
        let to = match request {
            CameraRequest::Fit => fit(&all(), -back, up),
            CameraRequest::FitBounds(bounds) if bounds.is_empty() => continue,
            CameraRequest::FitBounds(bounds) => fit(&[*bounds], -back, up),
            CameraRequest::FitNew => {
                let (direction, up) = StandardView::Iso.directions();
                let projection = match settings.perspective {
                    true => Projection::Perspective { fov_y: motion::FIELD_OF_VIEW },
                    false => Projection::Orthographic { height: 1.0 },
                };
                let now = motion::fit_boxes(&all(), direction, up, projection, aspect).unwrap_or(from);
                *camera = ViewCamera { now, flight: None };
                continue;
            }
            CameraRequest::Standard(view) => {
                let (direction, up) = view.directions();
                fit(&all(), direction, up)
            }
            CameraRequest::Approach { point, direction, up, size } => {
                motion::approach(&from, *point, *direction, *up, *size)
            }
            CameraRequest::Look { direction, up } => motion::look_along(&from, *direction, *up),
            CameraRequest::Go(view) => {
                settings.perspective = matches!(view.projection, Projection::Perspective { .. });
                *camera = ViewCamera { now: *view, flight: None };
                continue;
            }
            CameraRequest::ToggleProjection => {
                let toggled = motion::toggle_projection(&from, 0.5 * bounds.scale());
                settings.perspective = matches!(toggled.projection, Projection::Perspective { .. });
                *camera = ViewCamera { now: toggled, flight: None };
                continue;
            }
        };
        camera.flight = Some(Flight::new(camera.now, to));
    }
}

/// Advances the flight and asks for the next frame until it is over.
pub(super) fn fly(
    mut camera: ResMut<ViewCamera>,
    time: Res<Time<Real>>,
    mut redraw: MessageWriter<RequestRedraw>,
) {
    let Some(mut flight) = camera.flight.clone() else { return };
    // The frame that starts a flight may come after a long idle time: a short first step,
    // so that a flight is seen even where frames are slow.
    let step = if flight.elapsed.is_zero() {
        time.delta().min(super::flight::FLIGHT_TIME / 8)
    } else {
        time.delta()
    };
    flight.elapsed += step.min(super::flight::FLIGHT_TIME / 3);
    camera.now = flight.camera();
    camera.flight = (!flight.is_over()).then_some(flight);
    redraw.write(RequestRedraw);
}
