//! Binary PLY: common vertices, and for each triangle its colour and the number of its face (from 1).

use super::{Group, bytes, welded};

/// The file's bytes.
pub fn ply(groups: &[Group]) -> Vec<u8> {
    let (points, names) = welded(groups);
    let count: usize = groups.iter().map(|g| g.mesh.triangles.len()).sum();
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\ncomment hairline\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nelement face {count}\n\
         property list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
         property int group\nend_header\n",
        points.len()
    )
    .into_bytes();
    for p in &points {
        p.to_array().iter().for_each(|x| file.extend(x.to_le_bytes()));
    }
    for (number, (group, names)) in groups.iter().zip(&names).enumerate() {
        let colour = bytes(group.colour);
        for triangle in group.triangles() {
            file.push(3);
            triangle.iter().for_each(|v| file.extend((names[*v as usize] as i32).to_le_bytes()));
            file.extend(colour);
            file.extend((number as i32 + 1).to_le_bytes());
        }
    }
    file
}
