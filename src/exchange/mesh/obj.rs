//! Wavefront OBJ: a group for each face, common vertices, normals and texture coordinates (native parameters), colours
//! as materials in a file of their own.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::{Group, welded};

/// The file's bytes; `library` is the name of the material file.
pub fn obj(groups: &[Group], library: Option<&str>) -> Vec<u8> {
    let mut text = String::from("# hairline\n");
    if let Some(library) = library {
        let _ = writeln!(text, "mtllib {library}");
    }
    let (points, names) = welded(groups);
    for p in &points {
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    let used = names_of_colours(groups);
    let mut first = 1;
    for (group, names) in groups.iter().zip(&names) {
        let _ = writeln!(text, "g {}", word(group.name));
        let _ = writeln!(text, "usemtl {}", used[&group.colour.map(f32::to_bits)]);
        for uv in &group.mesh.uvs {
            let _ = writeln!(text, "vt {} {}", uv.x, uv.y);
        }
        for n in group.normals() {
            let _ = writeln!(text, "vn {} {} {}", n.x as f32, n.y as f32, n.z as f32);
        }
        for triangle in group.triangles() {
            let _ = write!(text, "f");
            for v in triangle {
                let own = first + v;
                let _ = write!(text, " {}/{own}/{own}", names[v as usize] + 1);
            }
            text.push('\n');
        }
        first += group.mesh.positions.len() as u32;
    }
    text.into_bytes()
}

/// The material file.
pub fn materials(groups: &[Group]) -> Vec<u8> {
    let mut text = String::from("# hairline\n");
    for (colour, name) in names_of_colours(groups) {
        let [r, g, b] = colour.map(f32::from_bits);
        let _ = writeln!(text, "newmtl {name}\nKd {r} {g} {b}\nKa 0 0 0\nKs 0.1 0.1 0.1\nNs 20\nillum 2\n");
    }
    text.into_bytes()
}

fn names_of_colours(groups: &[Group]) -> BTreeMap<[u32; 3], String> {
    let mut names = BTreeMap::new();
    for group in groups {
        let number = names.len() + 1;
        names.entry(group.colour.map(f32::to_bits)).or_insert_with(|| format!("colour_{number}"));
    }
    names
}

/// A name without blanks.
fn word(name: &str) -> String {
    name.split_whitespace().collect::<Vec<_>>().join("_")
}
