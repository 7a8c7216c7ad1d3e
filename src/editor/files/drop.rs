//! Files dropped onto the window.

use bevy::prelude::*;
use bevy::window::FileDragAndDrop;

use super::{OpenFiles, Source};

/// All files dropped in one frame are opened together; with Shift they are added.
pub(super) fn open_dropped(
    mut drops: MessageReader<FileDragAndDrop>,
    held: Res<ButtonInput<KeyCode>>,
    mut requests: MessageWriter<OpenFiles>,
) {
    let sources: Vec<Source> = drops
        .read()
        .filter_map(|drop| match drop {
            FileDragAndDrop::DroppedFile { path_buf, .. } => Some(Source::File(path_buf.clone())),
            _ => None,
        })
        .collect();
    if !sources.is_empty() {
        let replace = !held.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
        requests.write(OpenFiles { sources, replace });
    }
}
