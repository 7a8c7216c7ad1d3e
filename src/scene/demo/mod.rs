//! The built-in demo scene, made by code alone: a puzzle ball of nested shells on a turned foot,
//! before a sail with the program's name cut out of it, on a plate with a sunflower of holes.
//!
//! It shows what the program is for: exact trims on high-degree and rational surfaces, holes in
//! holes, seams and poles. Lengths are millimetres; z is up. Everything is deterministic.

mod assembly;
mod coin;
mod panels;
mod pedestal;
mod plate;
mod puzzle_ball;
mod ring;
mod ruled;
mod sail;
mod shape;

pub use panels::panels;
pub use plate::holes;

use std::path::Path;

use super::records::ModelRecord;
use crate::kernel::primitives::{lettering, outline};

/// Panels at most in a scene asked for by name.
const MOST_PANELS: usize = 1_000_000;

/// The scene that is opened in place of a file: `demo`, or `demo:50000` for that many [`panels()`]. `None`
/// for every other name.
pub fn named(name: &Path) -> Option<ModelRecord> {
    let count = name.to_str()?.strip_prefix("demo")?;
    if count.is_empty() { Some(model()) } else { panel_count(count).map(panels) }
}

/// `:50000` as a number of panels.
fn panel_count(text: &str) -> Option<usize> {
    text.strip_prefix(':')?.parse().ok().filter(|n| (1..=MOST_PANELS).contains(n))
}

/// Whether [`named`] knows `name`; makes nothing.
pub fn is_named(name: &Path) -> bool {
    let count = name.to_str().and_then(|n| n.strip_prefix("demo"));
    count.is_some_and(|c| c.is_empty() || panel_count(c).is_some())
}

/// The demo scene.
pub fn model() -> ModelRecord {
    let mut assembly = assembly::Assembly::new("Demo scene");
    plate::add(&mut assembly);
    pedestal::add(&mut assembly);
    puzzle_ball::add(&mut assembly);
    sail::add(&mut assembly);
    coin::add(&mut assembly);
    ring::add(&mut assembly);
    assembly.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::trim::validity;

    #[test]
    fn scenes_have_names() {
        assert_eq!(named(Path::new("demo:9")).map(|m| m.faces.len()), Some(9));
        for (name, known) in
            [("demo", true), ("demo:1", true), ("demo:0", false), ("demo:x", false), ("./demo", false)]
        {
            assert_eq!(is_named(Path::new(name)), known, "{name}");
        }
        assert!(named(Path::new("demo:1000001")).is_none() && named(Path::new("a.igs")).is_none());
    }

    #[test]
    fn loops_are_closed_and_inside_and_faces_have_names_parts_and_colours() {
        let model = model();
        assert!(!model.faces.is_empty());
        for face in &model.faces {
            assert!(face.name.is_some() && face.colour.is_some());
            assert!(face.part.is_some_and(|p| p < model.parts.len()));
            for trim in &face.loops {
                for (i, curve) in trim.curves.iter().enumerate() {
                    let ((u0, u1), (v0, v1)) =
                        (face.surface.knots_u().domain(), face.surface.knots_v().domain());
                    let (a, b) = curve.domain();
                    for p in (0..=20).map(|k| curve.point(a + (b - a) * k as f64 / 20.0)) {
                        // The torus is periodic in both directions, so its loops may run past its knots.
                        let inside = p.x >= u0 && p.x <= u1 && p.y >= v0 && p.y <= v1;
                        assert!(inside || face.name.as_deref() == Some("Ring"), "{:?} at {p}", face.name);
                    }
                    let next = &trim.curves[(i + 1) % trim.curves.len()];
                    assert_eq!(curve.points().last(), next.points().first(), "{:?}", face.name);
                }
            }
        }
    }

    #[test]
    fn nothing_is_wrong_with_its_loops() {
        for face in &model().faces {
            let loops: Vec<_> = face.loops.iter().collect();
            let problems = validity::check(&face.surface, &loops);
            let texts: Vec<String> = problems.iter().map(ToString::to_string).collect();
            assert!(texts.is_empty(), "{:?}: {texts:?}", face.name);
        }
    }
}
