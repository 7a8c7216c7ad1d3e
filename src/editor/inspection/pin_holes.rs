//! The pin holes of the picture at rest.

use bevy::prelude::*;

use crate::inspect::{HoleClass, PinHole};
use crate::kernel::view::Camera as ViewPoint;

/// Pin holes that were proved in the last picture at rest.
#[derive(Resource, Debug, Clone, Default)]
pub struct PinHoles {
    /// By rows of the picture.
    pub holes: Vec<PinHole>,
    /// Size of the picture, pixels.
    pub size: UVec2,
    /// The view it was of; marks of another are not shown.
    pub camera: Option<ViewPoint>,
}

impl PinHoles {
    /// The holes, if they are of this view.
    pub fn of(&self, camera: &ViewPoint) -> Option<&[PinHole]> {
        (self.camera.as_ref() == Some(camera)).then_some(self.holes.as_slice())
    }

    /// How many are of a class.
    pub fn count(&self, class: HoleClass) -> usize {
        self.holes.iter().filter(|h| h.class == class).count()
    }
}
