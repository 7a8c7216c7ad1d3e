//! The picture at rest as the rays left it, read back from the GPU: what pin holes are found in and the magnifier shows.

use std::sync::Arc;

use bevy::prelude::*;

use crate::encoding::{FaceHeader, View};
use crate::kernel::view::Camera as ViewPoint;
use crate::reference::visibility::VisibilityBuffer;

/// A picture read back.
#[derive(Debug)]
pub struct Picture {
    /// What each pixel shows.
    pub buffer: VisibilityBuffer,
    /// What it was cast with.
    pub view: View,
    /// What it is a picture of.
    pub camera: ViewPoint,
    /// Faces by slot.
    pub faces: Vec<Option<Entity>>,
    /// Colours and flags by slot.
    pub headers: Vec<FaceHeader>,
}

/// The latest picture.
#[derive(Resource, Debug, Clone, Default)]
pub struct LatestPicture(pub Option<Arc<Picture>>);

impl LatestPicture {
    /// The picture, if it is of this view.
    pub fn of(&self, camera: &ViewPoint) -> Option<&Picture> {
        self.0.as_deref().filter(|picture| picture.camera == *camera)
    }
}
