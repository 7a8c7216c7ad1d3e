//! Binary STL: triangles without names, colours or shared vertices.

use super::Group;

/// The file's bytes.
pub fn stl(groups: &[Group], name: &str) -> Vec<u8> {
    let count: usize = groups.iter().map(|g| g.single_triangles().count()).sum();
    let mut bytes = vec![b' '; 80];
    // Not `solid`, which readers take for the text format.
    let title = format!("hairline {name}");
    title.bytes().take(80).enumerate().for_each(|(k, b)| bytes[k] = b);
    bytes.reserve(4 + 50 * count);
    bytes.extend((count as u32).to_le_bytes());
    for group in groups {
        for triangle in group.single_triangles() {
            let p = triangle.map(|v| group.mesh.positions[v as usize]);
            let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
            for vector in [normal, p[0], p[1], p[2]] {
                vector.as_vec3().to_array().iter().for_each(|x| bytes.extend((x + 0.0).to_le_bytes()));
            }
            bytes.extend([0, 0]);
        }
    }
    bytes
}
