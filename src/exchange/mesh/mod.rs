//! Triangle meshes as files: glTF binary, STL, OBJ and PLY.
//!
//! The formats are those of `gltf`, `stl_io` and `ply-rs-bw`; OBJ is written here, as no crate that is looked after writes it
//! with groups, parameters and materials.
//! Positions go out in the order of faces, so that the same model gives the same bytes. Lengths are those of the model,
//! in glTF metres.

mod glb;
mod obj;
mod ply;
mod stl;

pub use glb::{glb, origin as glb_origin};
pub use obj::{materials, obj};
pub use ply::ply;
pub use stl::stl;

use glam::DVec3;

use crate::kernel::tessellate::FaceMesh;

/// Colour of faces that have none: a light grey, linear.
pub const PLAIN: [f32; 3] = [0.6, 0.6, 0.62];

/// One face to write.
#[derive(Debug, Clone, Copy)]
pub struct Group<'a> {
    /// Name: that of the face, or its number.
    pub name: &'a str,
    /// Name of the part it belongs to.
    pub part: &'a str,
    /// Linear RGB.
    pub colour: [f32; 3],
    /// Its triangles.
    pub mesh: &'a FaceMesh,
    /// Whether the face looks against `du x dv`.
    pub reversed: bool,
}

impl Group<'_> {
    /// Triangles in the face's own sense.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.mesh.triangles.iter().map(|[a, b, c]| if self.reversed { [*a, *c, *b] } else { [*a, *b, *c] })
    }

    /// Those of them that have three corners left in single precision, counted from `origin`. Where an edge is lost both triangles at it are, so that
    /// what was closed stays closed.
    pub fn single_triangles(&self, origin: DVec3) -> impl Iterator<Item = [u32; 3]> {
        let at = move |v: u32| (self.mesh.positions[v as usize] - origin).as_vec3() + 0.0;
        self.triangles().filter(move |[a, b, c]| {
            let (a, b, c) = (at(*a), at(*b), at(*c));
            a != b && b != c && c != a
        })
    }

    /// Normals in the face's own sense.
    pub fn normals(&self) -> impl Iterator<Item = DVec3> {
        let sign = if self.reversed { -1.0 } else { 1.0 };
        self.mesh.normals.iter().map(move |n| *n * sign)
    }
}

/// How far single precision moves a vertex at most, counted from `origin`; units of the model.
pub fn single_loss(groups: &[Group], origin: DVec3) -> f64 {
    let positions = groups.iter().flat_map(|g| &g.mesh.positions).map(|p| *p - origin);
    positions.map(|p| p.as_vec3().as_dvec3().distance(p)).fold(0.0, f64::max)
}

/// Colour as eight bits per channel, as screens show it.
fn bytes(colour: [f32; 3]) -> [u8; 3] {
    colour.map(|x| {
        let x = x.clamp(0.0, 1.0);
        let shown = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (255.0 * shown).round() as u8
    })
}

/// All vertices with the same position as one, in order of appearance: the number of each vertex of each group.
fn welded(groups: &[Group]) -> (Vec<DVec3>, Vec<Vec<u32>>) {
    let mut order: Vec<(usize, usize)> = groups
        .iter()
        .enumerate()
        .flat_map(|(g, group)| (0..group.mesh.positions.len()).map(move |k| (g, k)))
        .collect();
    let at = |(g, k): (usize, usize)| groups[g].mesh.positions[k];
    let key = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
    order.sort_by_key(|v| key(at(*v)));
    let mut first: Vec<Vec<(usize, usize)>> =
        groups.iter().map(|g| vec![(0, 0); g.mesh.positions.len()]).collect();
    for run in order.chunk_by(|a, b| key(at(*a)) == key(at(*b))) {
        let least = run.iter().copied().min().unwrap_or(run[0]);
        run.iter().for_each(|(g, k)| first[*g][*k] = least);
    }
    let mut points = Vec::new();
    let mut names: Vec<Vec<u32>> = groups.iter().map(|g| vec![0; g.mesh.positions.len()]).collect();
    for g in 0..groups.len() {
        for k in 0..names[g].len() {
            let (fg, fk) = first[g][k];
            names[g][k] = if (fg, fk) == (g, k) {
                points.push(at((g, k)));
                points.len() as u32 - 1
            } else {
                names[fg][fk]
            };
        }
    }
    (points, names)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, Vec3};

    /// Two triangles on either side of an edge.
    fn faces() -> [FaceMesh; 2] {
        let mesh = |p: [DVec3; 3]| FaceMesh {
            positions: p.to_vec(),
            normals: vec![DVec3::Z; 3],
            uvs: vec![DVec2::ZERO; 3],
            triangles: vec![[0, 1, 2]],
            ..FaceMesh::default()
        };
        [mesh([DVec3::ZERO, DVec3::X, DVec3::Y]), mesh([DVec3::X, DVec3::ONE, DVec3::Y])]
    }

    fn groups(faces: &[FaceMesh; 2]) -> [Group<'_>; 2] {
        let group = |mesh, name, reversed| Group { name, part: "part", colour: PLAIN, mesh, reversed };
        [group(&faces[0], "one", false), group(&faces[1], "two", true)]
    }

    #[test]
    fn common_vertices_are_welded_and_reversed_faces_turned() {
        let faces = faces();
        let groups = groups(&faces);
        let (points, names) = welded(&groups);
        assert_eq!(points.len(), 4);
        assert_eq!(names, [vec![0, 1, 2], vec![1, 3, 2]]);
        assert_eq!(groups[1].triangles().collect::<Vec<_>>(), [[0, 2, 1]]);
    }

    #[test]
    fn triangles_that_single_precision_flattens_are_left_out_there() {
        let mut faces = faces();
        // Next to nothing wide, and far from the origin.
        let far = DVec3::splat(1000.0);
        faces[0].positions = vec![far, far + DVec3::X * 1e-9, far + DVec3::Y];
        let groups = groups(&faces);
        assert_eq!(groups[0].triangles().count(), 1);
        assert_eq!(groups[0].single_triangles(DVec3::ZERO).count(), 0);
        let binary = stl(&groups, "t").unwrap();
        assert_eq!((binary.len(), binary[80]), (84 + 50, 1));
        let file = glb(&groups, "t", 1.0).unwrap();
        let length = u32::from_le_bytes([file[12], file[13], file[14], file[15]]) as usize;
        let json: serde_json::Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
        // A face without triangles is no mesh in a glTF file.
        assert_eq!(json["meshes"].as_array().map(Vec::len), Some(1));
        assert_eq!(json["accessors"][3]["count"], 3);
        let text = String::from_utf8(obj(&groups, None)).unwrap();
        assert_eq!(text.lines().filter(|l| l.starts_with("f ")).count(), 2);
    }

    #[test]
    fn what_single_precision_loses_is_known() {
        let mut faces = faces();
        assert_eq!(single_loss(&groups(&faces), DVec3::ZERO), 0.0);
        // Steps of a quarter of a millimetre out there.
        let far = DVec3::new(3e6, 0.0, 0.0);
        for p in faces.iter_mut().flat_map(|f| &mut f.positions) {
            *p = far + *p * 0.1;
        }
        let groups = groups(&faces);
        let lost = single_loss(&groups, DVec3::ZERO);
        assert!((lost - 0.1).abs() < 1e-9, "{lost}");
        assert!(single_loss(&groups, glb_origin(&groups)) < 1e-8);
    }

    #[test]
    fn every_format_holds_every_triangle() {
        let faces = faces();
        let groups = groups(&faces);
        let binary = stl(&groups, "t").unwrap();
        assert_eq!((binary.len(), binary[80]), (84 + 2 * 50, 2));
        let text = String::from_utf8(obj(&groups, Some("t.mtl"))).unwrap();
        assert_eq!(text.lines().filter(|l| l.starts_with("f ")).count(), 2);
        assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 4);
        assert!(text.contains("g one") && text.contains("mtllib t.mtl"));
        let bytes = ply(&groups).unwrap();
        assert!(bytes.starts_with(b"ply\nformat binary_little_endian 1.0\n"));
        let file = glb(&groups, "t", 1.0).unwrap();
        assert_eq!(&file[..4], b"glTF");
        assert_eq!(u32::from_le_bytes([file[8], file[9], file[10], file[11]]) as usize, file.len());
        let length = u32::from_le_bytes([file[12], file[13], file[14], file[15]]) as usize;
        let json: serde_json::Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
        assert_eq!(json["meshes"].as_array().map(Vec::len), Some(2));
        assert_eq!(json["accessors"][2]["count"], 3);
    }

    #[test]
    fn what_is_far_from_the_origin_keeps_its_shape_in_gltf() {
        let mut faces = faces();
        let far = DVec3::new(3e6, -2e6, 5e5);
        for p in faces.iter_mut().flat_map(|f| &mut f.positions) {
            *p = far + *p * 0.1;
        }
        let file = glb(&groups(&faces), "t", 1e-3).unwrap();
        // The crate checks what it reads against the format's rules.
        let read = gltf::Gltf::from_slice(&file).unwrap();
        let root = read.default_scene().unwrap().nodes().next().unwrap();
        let matrix = glam::DMat4::from_cols_array_2d(&root.transform().matrix().map(|c| c.map(f64::from)));
        let blob = read.blob.as_deref().unwrap();
        let mut lengths = Vec::new();
        for mesh in read.meshes() {
            let primitive = mesh.primitives().next().unwrap();
            let accessor = primitive.get(&gltf::Semantic::Positions).unwrap();
            let start = accessor.view().unwrap().offset();
            let floats: &[f32] = bytemuck::cast_slice(&blob[start..start + 12 * accessor.count()]);
            let place_of = |p: &[f32]| matrix.transform_point3(Vec3::from_slice(p).as_dvec3());
            let points: Vec<DVec3> = floats.chunks_exact(3).map(place_of).collect();
            assert_eq!((points.len(), primitive.indices().unwrap().count()), (3, 3));
            // Metres, with y up.
            let place = 1e-3 * DVec3::new(far.x, far.z, -far.y);
            assert!(points.iter().all(|p| p.distance(place) < 1e-3), "{points:?}");
            lengths.extend([points[0].distance(points[1]), points[1].distance(points[2])]);
        }
        // 0.25 mm are the smallest step of single precision out there.
        let diagonal = 2f64.sqrt() * 1e-4;
        let expected = [1e-4, diagonal, diagonal, diagonal];
        for (length, expected) in lengths.iter().zip(expected) {
            assert!((length / expected - 1.0).abs() < 1e-5, "{lengths:?}");
        }
    }
}
