//! Where the shared real models are.

use std::path::{Path, PathBuf};

/// The folder of shared real models, where there is one; says so when there is none.
pub fn models() -> Option<PathBuf> {
    let found = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("shared/models"))
        .find(|folder| folder.is_dir());
    if found.is_none() {
        println!("not run: no shared/models in any parent folder");
    }
    found
}
