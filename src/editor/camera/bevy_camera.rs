//! Bevy's cameras: one for the viewport, one for the panels above it.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraOutputMode, Viewport as CameraViewport};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy_egui::{EguiGlobalSettings, PrimaryEguiContext};

use super::ViewCamera;
use super::clip::ClipView;
use crate::editor::derive::SceneBounds;
use crate::editor::theme::Palette;
use crate::editor::viewport::Viewport;
use crate::kernel::view::Projection as ViewProjection;

/// Marks the camera of the viewport.
#[derive(Component, Debug, Default, Clone, Copy)]
pub struct ViewportCamera;

/// Spawns both cameras. They share one texture: the panels are drawn over the picture of the viewport, and only
/// the result goes to the window, once. On a software driver every pass over the window counts.
pub(super) fn spawn(mut commands: Commands, settings: Option<ResMut<EguiGlobalSettings>>) {
    let Some(mut settings) = settings else { return };
    settings.auto_create_primary_context = false;
    commands.spawn((
        ViewportCamera,
        Camera3d::default(),
        Camera {
            clear_color: ClearColorConfig::Custom(Color::BLACK),
            output_mode: CameraOutputMode::Skip,
            ..default()
        },
        Msaa::Off,
        Tonemapping::None,
        DebandDither::Disabled,
    ));
    commands.spawn((
        PrimaryEguiContext,
        Camera2d,
        Msaa::Off,
        Tonemapping::None,
        DebandDither::Disabled,
        // Nothing but the panels.
        RenderLayers::none(),
        Camera {
            order: 1,
            output_mode: CameraOutputMode::Write {
                blend_state: Some(BlendState::REPLACE),
                clear_color: ClearColorConfig::None,
            },
            clear_color: ClearColorConfig::None,
            ..default()
        },
    ));
}

/// Clears the window to the colour of the panels, so that none has to be filled: a third of what they cost on a
/// software driver.
pub(super) fn clear(palette: Option<Res<Palette>>, mut cameras: Query<&mut Camera, With<ViewportCamera>>) {
    if let Some(palette) = palette.filter(|p| p.is_changed()) {
        let [r, g, b, _] = palette.panel.to_array();
        for mut camera in &mut cameras {
            camera.clear_color = ClearColorConfig::Custom(Color::srgb_u8(r, g, b));
        }
    }
}

/// Makes Bevy's camera show the same picture as ours.
pub(super) fn follow(
    camera: Res<ViewCamera>,
    viewport: Res<Viewport>,
    bounds: Res<SceneBounds>,
    mut cameras: Query<(&mut Camera, &mut Transform, &mut Projection), With<ViewportCamera>>,
) {
    if !camera.is_changed() && !viewport.is_changed() && !bounds.is_changed() {
        return;
    }
    for (mut bevy_camera, mut transform, mut projection) in &mut cameras {
        let (physical_position, physical_size) = viewport.physical();
        let wanted = CameraViewport { physical_position, physical_size, ..default() };
        let same = bevy_camera.viewport.as_ref().is_some_and(|v| {
            v.physical_position == wanted.physical_position && v.physical_size == wanted.physical_size
        });
        if !same && viewport.size.min_element() > 1.0 {
            bevy_camera.viewport = Some(wanted);
        }
        let (right, up, back) = camera.now.axes();
        transform.translation = camera.now.eye.as_vec3();
        transform.rotation = Quat::from_mat3(&Mat3::from_cols(right.as_vec3(), up.as_vec3(), back.as_vec3()));
        let clip = ClipView::of(&camera.now, viewport.aspect(), &bounds.all);
        *projection = match camera.now.projection {
            ViewProjection::Perspective { fov_y } => Projection::Perspective(PerspectiveProjection {
                fov: fov_y as f32,
                aspect_ratio: viewport.aspect() as f32,
                near: clip.near as f32,
                ..default()
            }),
            ViewProjection::Orthographic { height } => Projection::Orthographic(OrthographicProjection {
                near: clip.near as f32,
                far: clip.far as f32,
                scaling_mode: bevy::camera::ScalingMode::FixedVertical { viewport_height: height as f32 },
                ..OrthographicProjection::default_3d()
            }),
        };
    }
}
