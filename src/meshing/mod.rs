//! Meshes of whole models: faces that share edges share their vertices, so that bodies come out watertight.
//!
//! [`seams`] finds which stretches of which outlines run along each other and divides each once; [`model_mesh`] meshes the
//! faces in parallel within those chords; [`measure()`] says how far the result really is from the exact faces,
//! [`deviations`] how far each triangle is; [`edges`] lists the edges.
//!
//! Unlike `inspect`, which measures the gaps between the trim curves of the records, this works on outlines after
//! repair (closed by lines, cut at seams), because these are what meshes are bounded by.

pub mod deviation;
pub mod edges;
pub mod measure;
pub mod model_mesh;
pub mod orient;
mod pairing;
pub mod seams;
mod starts;
mod stretches;

pub use deviation::{deviations, face_deviations};
pub use edges::{MeshEdge, mesh_edges};
pub use measure::{Distance, measure, measure_each, measure_face};
pub use model_mesh::{ModelMesh, Work, finest, mesh_faces, remesh_faces};
pub use orient::orientations;
