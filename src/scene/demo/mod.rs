//! The built-in demo scene, made by code alone: a puzzle ball of nested shells on a plate with a
//! sunflower of holes.
//!
//! It shows what the program is for: exact trims on high-degree and rational surfaces, holes in
//! holes, seams and poles. Lengths are millimetres; z is up. Everything is deterministic.

mod assembly;
mod outline;
mod plate;
mod puzzle_ball;
mod sail;
mod shape;

pub use plate::holes;

use super::records::ModelRecord;

/// The demo scene.
pub fn model() -> ModelRecord {
    let mut assembly = assembly::Assembly::new("Demo scene");
    plate::add(&mut assembly);
    puzzle_ball::add(&mut assembly);
    sail::add(&mut assembly);
    assembly.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_loop_is_closed_and_every_face_has_a_name_a_part_and_a_colour() {
        let model = model();
        assert!(!model.faces.is_empty());
        for face in &model.faces {
            assert!(face.name.is_some() && face.colour.is_some());
            assert!(face.part.is_some_and(|p| p < model.parts.len()));
            for trim in &face.loops {
                for (i, curve) in trim.curves.iter().enumerate() {
                    let next = &trim.curves[(i + 1) % trim.curves.len()];
                    assert_eq!(curve.points().last(), next.points().first(), "{:?}", face.name);
                }
            }
        }
    }
}
