//! All systems on one thread.
//!
//! The editor has hundreds of small systems and few that take time; those use the task pools themselves. Bevy's parallel
//! executor hands each of them to a pool and waits: thousands of context switches per frame, which on a machine of
//! few cores compete with drawing. Heavy work belongs into tasks, not into systems that happen to run beside others.

use bevy::ecs::schedule::{Schedules, SingleThreadedExecutor};
use bevy::prelude::*;
use bevy::render::RenderApp;

/// Gives every schedule there is the executor of one thread; to be added last.
pub struct OneThreadPlugin;

impl Plugin for OneThreadPlugin {
    fn build(&self, _: &mut App) {}

    fn cleanup(&self, app: &mut App) {
        run_on_one_thread(app.world_mut());
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            run_on_one_thread(render.world_mut());
        }
    }
}

fn run_on_one_thread(world: &mut World) {
    for (_, schedule) in world.resource_mut::<Schedules>().iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
}
