//! `hairline tessellate` as its users meet it: figures, limits, bad input.

use std::path::PathBuf;

use crate::cli::{BAD_INPUT, DONE, NOT_WRITTEN, fails, run};
use crate::truth;

fn cube() -> Option<String> {
    let folder = truth::models().or_else(|| {
        println!("not run: no shared/models here");
        None
    })?;
    Some(folder.join("files/igesio_single_rounded_cube.iges").display().to_string())
}

fn place(name: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}

/// Runs with `--json` and gives the figures and what was said aside.
fn figures(file: &str, more: &[&str]) -> (serde_json::Value, String, u64) {
    let (_folder, path) = place("out.stl");
    let out = path.display().to_string();
    let arguments = [&["tessellate", file, "-o", &out, "--json"], more].concat();
    let (code, stdout, stderr) = run(&arguments, "");
    assert_eq!(code, DONE, "{stderr}");
    (serde_json::from_str(&stdout).unwrap(), stderr, path.metadata().unwrap().len())
}

#[test]
fn a_body_comes_out_closed_and_within_its_tolerance() {
    let Some(cube) = cube() else { return };
    let (found, _, bytes) = figures(&cube, &["--error", "10um"]);
    assert_eq!(found["open_edges"], 0);
    assert_eq!(found["unproved"].as_array().map(Vec::len), Some(0));
    assert_eq!(bytes, 84 + 50 * found["triangles"].as_u64().unwrap());
    let tolerance = found["tolerance"].as_f64().unwrap();
    for side in ["mesh_to_surface", "surface_to_mesh"] {
        let error = found["measured"][side].as_f64().unwrap();
        assert!(error > 0.0 && error <= tolerance, "{side} {error}");
    }
    let finer = figures(&cube, &["--error", "10um", "--angle", "1deg"]).0["triangles"].as_u64();
    let shorter = figures(&cube, &["--error", "10um", "--max-edge", "1mm"]).0["triangles"].as_u64();
    assert!(finer > found["triangles"].as_u64() && shorter > found["triangles"].as_u64());
}

#[test]
fn useless_tolerances_and_limits_are_refused_or_noted() {
    let Some(cube) = cube() else { return };
    let (_folder, path) = place("out.obj");
    let out = path.display().to_string();
    fails(
        &["tessellate", &cube, "--error", "1e-13mm", "-o", &out],
        BAD_INPUT,
        "below what numbers can tell apart",
    );
    fails(
        &["tessellate", &cube, "--error", "1um", "--limit", "50", "-o", &out],
        NOT_WRITTEN,
        "more than 50 triangles",
    );
    // Told before the work, not after: this would be billions.
    fails(
        &["tessellate", &cube, "--error", "1um", "--max-edge", "1um", "-o", &out],
        NOT_WRITTEN,
        "allow more with --limit N or --yes",
    );
    fails(&["tessellate", &cube, "--error", "1e-20mm", "-o", &out], BAD_INPUT, "--error 1e-20 mm is below");
    fails(&["tessellate", &cube, "--error", "-1mm", "-o", &out], BAD_INPUT, "`-1mm` is not positive");
    assert!(!path.exists());
    let (found, _, _) = figures(&cube, &["--error", "1um", "--limit", "50", "--yes"]);
    assert!(found["triangles"].as_u64() > Some(50));
    let (found, stderr, _) = figures(&cube, &["--error", "100m"]);
    assert!(stderr.contains("is large for a model"), "{stderr}");
    assert!(found["triangles"].as_u64() > Some(0));
}
