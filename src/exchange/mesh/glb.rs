//! glTF 2.0 binary: a node for each part with a node for each of its faces, positions, normals and parameters per
//! vertex, a material for each colour. Lengths become metres and z becomes y, as the format wants, by the root node's
//! matrix, so that positions stay those of the model.

use serde_json::{Value, json};

use super::Group;

const ARRAY: u32 = 34962;
const ELEMENTS: u32 = 34963;
const FLOAT: u32 = 5126;
const UINT: u32 = 5125;

/// The file's bytes; `metres` is one unit of the model.
pub fn glb(groups: &[Group], name: &str, metres: f64) -> Vec<u8> {
    let mut buffer: Vec<u8> = Vec::new();
    let (mut views, mut accessors, mut meshes) = (Vec::new(), Vec::new(), Vec::new());
    let mut colours: Vec<[f32; 3]> = Vec::new();
    let mut parts: Vec<(&str, Vec<usize>)> = Vec::new();
    let mut nodes: Vec<Value> = vec![Value::Null];
    let mut add = |bytes: Vec<u8>, target: u32, accessor: Value| -> usize {
        views.push(
            json!({ "buffer": 0, "byteOffset": buffer.len(), "byteLength": bytes.len(), "target": target }),
        );
        buffer.extend(bytes);
        let mut accessor = accessor;
        accessor["bufferView"] = json!(views.len() - 1);
        accessors.push(accessor);
        accessors.len() - 1
    };
    for group in groups {
        let mesh = group.mesh;
        let indices: Vec<u32> = group.single_triangles().flatten().collect();
        if indices.is_empty() {
            continue;
        }
        let count = mesh.positions.len();
        let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.as_vec3().to_array()).collect();
        let limit = |pick: fn(f32, f32) -> f32, start: f32| {
            [0, 1, 2].map(|k| positions.iter().map(|p| p[k]).fold(start, pick))
        };
        let floats =
            |rows: &mut dyn Iterator<Item = f32>| rows.flat_map(f32::to_le_bytes).collect::<Vec<u8>>();
        let position = add(
            floats(&mut positions.iter().flatten().copied()),
            ARRAY,
            json!({ "componentType": FLOAT, "count": count, "type": "VEC3",
                    "min": limit(f32::min, f32::INFINITY), "max": limit(f32::max, f32::NEG_INFINITY) }),
        );
        let normal = add(
            floats(&mut group.normals().flat_map(|n| n.as_vec3().normalize_or(glam::Vec3::Z).to_array())),
            ARRAY,
            json!({ "componentType": FLOAT, "count": count, "type": "VEC3" }),
        );
        let uv = add(
            floats(&mut mesh.uvs.iter().flat_map(|uv| uv.as_vec2().to_array())),
            ARRAY,
            json!({ "componentType": FLOAT, "count": count, "type": "VEC2" }),
        );
        let index = add(
            indices.iter().flat_map(|v| v.to_le_bytes()).collect(),
            ELEMENTS,
            json!({ "componentType": UINT, "count": indices.len(), "type": "SCALAR" }),
        );
        let material = colours.iter().position(|c| *c == group.colour).unwrap_or_else(|| {
            colours.push(group.colour);
            colours.len() - 1
        });
        meshes.push(json!({ "name": group.name, "primitives": [{
            "attributes": { "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv },
            "indices": index, "material": material }] }));
        nodes.push(json!({ "name": group.name, "mesh": meshes.len() - 1 }));
        let node = nodes.len() - 1;
        match parts.iter_mut().find(|p| p.0 == group.part) {
            Some(part) => part.1.push(node),
            None => parts.push((group.part, vec![node])),
        }
    }
    let mut children = Vec::new();
    for (part, faces) in parts {
        nodes.push(json!({ "name": part, "children": faces }));
        children.push(nodes.len() - 1);
    }
    let m = metres;
    let matrix = [m, 0.0, 0.0, 0.0, 0.0, 0.0, -m, 0.0, 0.0, m, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    nodes[0] = json!({ "name": name, "matrix": matrix });
    if !children.is_empty() {
        nodes[0]["children"] = json!(children);
    }
    let materials: Vec<Value> = colours
        .iter()
        .map(|[r, g, b]| {
            json!({ "doubleSided": true, "pbrMetallicRoughness": {
                "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6 } })
        })
        .collect();
    let mut document = json!({
        "asset": { "version": "2.0", "generator": "hairline" },
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": nodes });
    if !buffer.is_empty() {
        document["meshes"] = json!(meshes);
        document["materials"] = json!(materials);
        document["accessors"] = json!(accessors);
        document["bufferViews"] = json!(views);
        document["buffers"] = json!([{ "byteLength": buffer.len() }]);
    }
    assemble(document.to_string().into_bytes(), buffer)
}

/// The two chunks, each padded to four bytes.
fn assemble(mut json: Vec<u8>, mut buffer: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    buffer.resize(buffer.len().next_multiple_of(4), 0);
    let mut file = b"glTF".to_vec();
    let length = 12 + 8 + json.len() + 8 + buffer.len();
    file.extend(2u32.to_le_bytes());
    file.extend((length as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", buffer)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}
