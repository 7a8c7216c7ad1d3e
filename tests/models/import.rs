//! IGES files against what OpenCASCADE makes of them.

use std::path::{Path, PathBuf};

/// The folder of shared real models, where there is one.
fn models() -> Option<PathBuf> {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("shared/models"))
        .find(|folder| folder.is_dir())
}

#[test]
fn the_part_has_all_its_faces_and_curves() {
    let Some(models) = models() else {
        println!("not run: no shared/models here");
        return;
    };
    let (model, report) = hairline::exchange::iges::read(&models.join("files/gpucast_part.igs")).unwrap();
    assert_eq!(model.faces.len(), 134);
    assert_eq!(report.entities["142"], 134);
    assert!(report.remarks.is_empty(), "{:?}", report.remarks);
    let curves: usize = model.faces.iter().flat_map(|f| &f.loops).map(|l| l.curves.len()).sum();
    assert_eq!(curves, 600);
}
