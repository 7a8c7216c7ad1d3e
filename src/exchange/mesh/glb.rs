//! glTF 2.0 binary: a node for each part with a node for each of its faces, positions, normals and parameters per
//! vertex, a material for each colour. Lengths become metres and z becomes y, as the format wants, by the root node's
//! matrix, so that positions stay those of the model; far from the origin, where single precision would lose them, the
//! matrix moves them there as well.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io;

use glam::DVec3;
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Target, View};
use gltf::json::material::{PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked::Valid;
use gltf::json::validation::USize64;
use gltf::json::{Accessor, Asset, Buffer, Index, Material, Mesh, Node, Root, Scene, Value};

use super::Group;
use crate::kernel::view::Bounds;

/// Models whose middle is farther off than this many times their size are moved to the origin.
const FAR: f64 = 8.0;

/// The file's bytes; `metres` is one unit of the model.
///
/// # Errors
/// More than the format can hold.
pub fn glb(groups: &[Group], name: &str, metres: f64) -> io::Result<Vec<u8>> {
    let mut file = File::default();
    let origin = origin(groups);
    let mut colours: Vec<[f32; 3]> = Vec::new();
    let mut parts: Vec<(&str, Vec<Index<Node>>)> = Vec::new();
    let root = file.json.push(node(name));
    for group in groups {
        let Some(mesh) = file.mesh(group, origin, &mut colours) else { continue };
        let face = file.json.push(Node { mesh: Some(mesh), ..node(group.name) });
        match parts.iter_mut().find(|p| p.0 == group.part) {
            Some(part) => part.1.push(face),
            None => parts.push((group.part, vec![face])),
        }
    }
    let children: Vec<Index<Node>> = parts
        .into_iter()
        .map(|(part, faces)| file.json.push(Node { children: Some(faces), ..node(part) }))
        .collect();
    let m = metres as f32;
    let at = (metres * origin).as_vec3();
    let turned = [m, 0.0, 0.0, 0.0, 0.0, 0.0, -m, 0.0, 0.0, m, 0.0, 0.0, at.x, at.z, -at.y, 1.0];
    let own = &mut file.json.nodes[root.value()];
    own.matrix = Some(turned);
    own.children = Some(children).filter(|c| !c.is_empty());
    let scene = Scene { extensions: None, extras: Default::default(), name: None, nodes: vec![root] };
    file.json.scene = Some(file.json.push(scene));
    file.json.materials = colours.into_iter().map(material).collect();
    file.finish()
}

/// Where positions are counted from, units of the model.
pub fn origin(groups: &[Group]) -> DVec3 {
    let all = Bounds::of(groups.iter().flat_map(|g| g.mesh.positions.iter().copied()));
    if !all.is_empty() && all.centre().length() > FAR * all.diagonal() { all.centre() } else { DVec3::ZERO }
}

fn node(name: &str) -> Node {
    Node { name: Some(name.to_owned()), ..Node::default() }
}

fn material([r, g, b]: [f32; 3]) -> Material {
    Material {
        double_sided: true,
        pbr_metallic_roughness: PbrMetallicRoughness {
            base_color_factor: PbrBaseColorFactor([r, g, b, 1.0]),
            metallic_factor: StrengthFactor(0.0),
            roughness_factor: StrengthFactor(0.6),
            ..Default::default()
        },
        ..Default::default()
    }
}

/// The description and the one buffer.
#[derive(Default)]
struct File {
    json: Root,
    buffer: Vec<u8>,
}

impl File {
    /// A face; `None` without triangles, which the format does not know.
    fn mesh(&mut self, group: &Group, origin: DVec3, colours: &mut Vec<[f32; 3]>) -> Option<Index<Mesh>> {
        let triangles: Vec<[u32; 3]> = group.single_triangles(origin).collect();
        if triangles.is_empty() {
            return None;
        }
        let mesh = group.mesh;
        let positions: Vec<[f32; 3]> =
            mesh.positions.iter().map(|p| (*p - origin).as_vec3().to_array()).collect();
        let normals: Vec<[f32; 3]> =
            group.normals().map(|n| n.as_vec3().normalize_or(glam::Vec3::Z).to_array()).collect();
        let uvs: Vec<[f32; 2]> = mesh.uvs.iter().map(|uv| uv.as_vec2().to_array()).collect();
        let limits = [f32::min, f32::max].map(|pick| {
            let all = positions.iter().copied().reduce(|a, b| [0, 1, 2].map(|k| pick(a[k], b[k])));
            all.map(|limit| Value::from(limit.to_vec()))
        });
        let position = self.values(bytemuck::cast_slice(&positions), Type::Vec3, positions.len());
        let [least, most] = limits;
        let accessor = &mut self.json.accessors[position.value()];
        (accessor.min, accessor.max) = (least, most);
        let normal = self.values(bytemuck::cast_slice(&normals), Type::Vec3, normals.len());
        let uv = self.values(bytemuck::cast_slice(&uvs), Type::Vec2, uvs.len());
        let indices: &[u32] = bytemuck::cast_slice(&triangles);
        let indices = self.add(
            bytemuck::cast_slice(indices),
            Target::ElementArrayBuffer,
            (ComponentType::U32, Type::Scalar, indices.len()),
        );
        let material = colours.iter().position(|c| *c == group.colour).unwrap_or_else(|| {
            colours.push(group.colour);
            colours.len() - 1
        });
        let attributes =
            [(Semantic::Positions, position), (Semantic::Normals, normal), (Semantic::TexCoords(0), uv)];
        let primitive = Primitive {
            attributes: BTreeMap::from(attributes.map(|(what, values)| (Valid(what), values))),
            extensions: None,
            extras: Default::default(),
            indices: Some(indices),
            material: Some(Index::new(material as u32)),
            mode: Valid(Mode::Triangles),
            targets: None,
        };
        Some(self.json.push(Mesh {
            extensions: None,
            extras: Default::default(),
            name: Some(group.name.to_owned()),
            primitives: vec![primitive],
            weights: None,
        }))
    }

    fn values(&mut self, bytes: &[u8], kind: Type, count: usize) -> Index<Accessor> {
        self.add(bytes, Target::ArrayBuffer, (ComponentType::F32, kind, count))
    }

    fn add(
        &mut self,
        bytes: &[u8],
        target: Target,
        (component, kind, count): (ComponentType, Type, usize),
    ) -> Index<Accessor> {
        let view = self.json.push(View {
            buffer: Index::new(0),
            byte_length: bytes.len().into(),
            byte_offset: Some(self.buffer.len().into()),
            byte_stride: None,
            name: None,
            target: Some(Valid(target)),
            extensions: None,
            extras: Default::default(),
        });
        self.buffer.extend(bytes);
        self.json.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: count.into(),
            component_type: Valid(GenericComponentType(component)),
            extensions: None,
            extras: Default::default(),
            type_: Valid(kind),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }

    fn finish(mut self) -> io::Result<Vec<u8>> {
        self.json.asset = Asset { generator: Some("hairline".into()), ..Asset::default() };
        if !self.buffer.is_empty() {
            self.json.buffers = vec![Buffer {
                byte_length: USize64::from(self.buffer.len()),
                name: None,
                uri: None,
                extensions: None,
                extras: Default::default(),
            }];
        }
        let json = self.json.to_vec().map_err(io::Error::other)?;
        if u32::try_from(json.len() + self.buffer.len() + 64).is_err() {
            return Err(io::Error::other("a glTF binary file holds 4 GiB at most; choose another format"));
        }
        let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
        let bin = (!self.buffer.is_empty()).then_some(Cow::Owned(self.buffer));
        gltf::Glb { header, json: Cow::Owned(json), bin }.to_vec().map_err(io::Error::other)
    }
}
