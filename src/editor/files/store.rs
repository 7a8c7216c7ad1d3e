//! Keeping settings and recent files between runs, as JSON in the user's configuration folder.
//!
//! Nothing depends on it: an unreadable file means defaults, an unwritable folder means nothing is kept.

use std::io::Write;
use std::path::{Path, PathBuf};

use bevy::prelude::*;

use crate::editor::settings::Settings;

/// Number of recent files kept.
const RECENT: usize = 10;

/// Where settings are kept; `None` keeps nothing (tests).
#[derive(Resource, Debug, Clone, Default)]
pub struct SettingsStore {
    /// The file.
    pub path: Option<PathBuf>,
}

impl SettingsStore {
    /// The file in the user's configuration folder.
    pub fn of_user() -> Self {
        let path =
            directories::ProjectDirs::from("", "", "hairline").map(|d| d.config_dir().join("settings.json"));
        Self { path }
    }
}

/// Puts `path` first among the recent files.
pub fn remember(settings: &mut Settings, path: &Path) {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    settings.recent.retain(|p| *p != path);
    settings.recent.insert(0, path);
    settings.recent.truncate(RECENT);
}

/// Reads the settings at start.
pub(super) fn read(store: Res<SettingsStore>, mut settings: ResMut<Settings>) {
    let read = store.path.as_ref().and_then(|path| std::fs::read(path).ok());
    if let Some(kept) = read.and_then(|bytes| serde_json::from_slice(&bytes).ok()) {
        *settings = kept;
    }
}

/// Writes the settings after they changed: whole file or nothing.
pub(super) fn write_changed(
    store: Res<SettingsStore>,
    settings: Res<Settings>,
    mut kept: Local<Option<Settings>>,
) {
    if !settings.is_changed() {
        return;
    }
    let before = kept.replace(settings.clone());
    let Some(path) = store.path.as_ref().filter(|_| before.is_some_and(|b| b != *settings)) else { return };
    if let Err(error) = write(path, &settings) {
        warn!("settings not kept in {}: {error}", path.display());
    }
}

fn write(path: &Path, settings: &Settings) -> std::io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder)?;
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    file.write_all(&serde_json::to_vec_pretty(settings)?)?;
    file.persist(path).map_err(|e| e.error)?;
    Ok(())
}
