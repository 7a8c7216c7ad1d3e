//! Binary STL: triangles without names, colours or shared vertices, in single precision.

use std::io;

use glam::DVec3;
use stl_io::{Normal, Triangle, Vertex};

use super::Group;

/// Bytes that the format leaves to the writer.
const TITLE: usize = 80;

/// The file's bytes.
///
/// # Errors
/// More than the format can hold.
pub fn stl(groups: &[Group], name: &str) -> io::Result<Vec<u8>> {
    let mut triangles: Vec<Triangle> = Vec::new();
    for group in groups {
        triangles.extend(group.single_triangles(DVec3::ZERO).map(|corners| {
            let p = corners.map(|v| group.mesh.positions[v as usize]);
            let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
            let single = |v: DVec3| (v.as_vec3() + 0.0).to_array();
            Triangle { normal: Normal::new(single(normal)), vertices: p.map(|p| Vertex::new(single(p))) }
        }));
    }
    if u32::try_from(triangles.len()).is_err() {
        return Err(io::Error::other("an STL file holds 4,294,967,295 triangles at most"));
    }
    let mut bytes = Vec::with_capacity(TITLE + 4 + 50 * triangles.len());
    stl_io::write_stl(&mut bytes, triangles.iter())?;
    // Not `solid`, which readers take for the text format.
    let title = format!("hairline {name}");
    bytes.iter_mut().take(TITLE).zip(title.bytes().chain(std::iter::repeat(b' '))).for_each(|(b, t)| *b = t);
    Ok(bytes)
}
