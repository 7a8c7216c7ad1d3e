//! The eye of the viewport: orbit, pan, zoom, standard views, fitting, flights.
//!
//! Wiring: `Input` turns mouse and wheel into motions; `Tools` serves commands and [`CameraRequest`]s by
//! starting a flight; `Present` advances the flight and hands the result to Bevy's own camera, so that Bevy
//! content drawn later agrees with ours. [`motion`] has the mathematics, free of Bevy.

mod bevy_camera;
pub mod clip;
pub mod flight;
pub mod motion;
mod navigate;
mod request;

use bevy::prelude::*;

pub use bevy_camera::ViewportCamera;
pub(super) use navigate::Drag;
pub use request::CameraRequest;

use super::EditorSystems;
use crate::kernel::view::{Bounds, Camera as ViewPoint, Projection, StandardView};
use flight::Flight;

/// The camera of the viewport.
#[derive(Resource, Debug, Clone, PartialEq)]
pub struct ViewCamera {
    /// Where we are now.
    pub now: ViewPoint,
    /// The flight under way.
    pub flight: Option<Flight>,
}

impl Default for ViewCamera {
    fn default() -> Self {
        let (direction, up) = StandardView::Iso.directions();
        let projection = Projection::Perspective { fov_y: motion::FIELD_OF_VIEW };
        let bounds = Bounds { min: glam::DVec3::splat(-50.0), max: glam::DVec3::splat(50.0) };
        Self { now: ViewPoint::fit(&bounds, direction, up, projection, 1.5), flight: None }
    }
}

impl ViewCamera {
    /// Where the camera will be when the flight under way has ended.
    pub fn destination(&self) -> ViewPoint {
        self.flight.as_ref().map_or(self.now, |f| f.to)
    }
}

/// Adds the camera.
pub struct CameraPlugin;

impl Plugin for CameraPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ViewCamera>()
            .init_resource::<navigate::Drag>()
            .add_message::<CameraRequest>()
            .add_message::<bevy::window::WindowEvent>()
            .add_systems(Startup, bevy_camera::spawn)
            .add_systems(Update, (navigate::drag, navigate::wheel).chain().in_set(super::NavigationInput))
            .add_systems(Last, bevy_camera::clear)
            .add_systems(Update, request::command_requests.in_set(EditorSystems::Tools))
            .add_systems(
                Update,
                (request::serve, request::fly, bevy_camera::follow).chain().in_set(EditorSystems::Present),
            );
    }
}
