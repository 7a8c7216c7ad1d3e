//! Binary PLY: common vertices, and for each triangle its colour and the number of its face (from 1).

use std::io;

use glam::DVec3;
use ply_rs_bw::ply::{
    Addable, ElementDef, Encoding, Ply, PropertyAccess, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;

use super::{Group, bytes, welded};

/// The file's bytes.
///
/// # Errors
/// More than the format can hold.
pub fn ply(groups: &[Group]) -> io::Result<Vec<u8>> {
    let (points, names) = welded(groups);
    if i32::try_from(points.len()).is_err() {
        return Err(io::Error::other("a PLY file holds 2,147,483,647 vertices at most"));
    }
    let faces = groups.iter().zip(&names).enumerate().flat_map(|(number, (group, names))| {
        let colour = bytes(group.colour);
        group.triangles().map(move |corners| Row::Face {
            corners: corners.map(|v| names[v as usize] as i32),
            colour,
            group: number as i32 + 1,
        })
    });
    let mut file = Ply::<Row>::new();
    file.header.encoding = Encoding::BinaryLittleEndian;
    file.header.comments.push("hairline".into());
    let scalar = |name: &str, kind| PropertyDef::new(name.into(), PropertyType::Scalar(kind));
    let mut vertex = ElementDef::new("vertex".into());
    ["x", "y", "z"].iter().for_each(|name| vertex.properties.add(scalar(name, ScalarType::Double)));
    let mut face = ElementDef::new("face".into());
    let corners = PropertyType::List(ScalarType::UChar, ScalarType::Int);
    face.properties.add(PropertyDef::new("vertex_indices".into(), corners));
    ["red", "green", "blue"].iter().for_each(|name| face.properties.add(scalar(name, ScalarType::UChar)));
    face.properties.add(scalar("group", ScalarType::Int));
    file.header.elements.add(vertex);
    file.header.elements.add(face);
    file.payload.insert("face".into(), faces.collect());
    file.payload.insert("vertex".into(), points.into_iter().map(Row::Vertex).collect());
    let mut bytes = Vec::new();
    Writer::new().write_ply(&mut bytes, &mut file)?;
    Ok(bytes)
}

/// One entry of the file.
enum Row {
    Vertex(DVec3),
    Face { corners: [i32; 3], colour: [u8; 3], group: i32 },
}

impl PropertyAccess for Row {
    fn new() -> Self {
        Self::Vertex(DVec3::ZERO)
    }

    fn get_double(&self, property: &str) -> Option<f64> {
        match (self, property) {
            (Self::Vertex(p), "x") => Some(p.x),
            (Self::Vertex(p), "y") => Some(p.y),
            (Self::Vertex(p), "z") => Some(p.z),
            _ => None,
        }
    }

    fn get_list_int(&self, property: &str) -> Option<&[i32]> {
        match self {
            Self::Face { corners, .. } if property == "vertex_indices" => Some(corners),
            _ => None,
        }
    }

    fn get_uchar(&self, property: &str) -> Option<u8> {
        let Self::Face { colour: [red, green, blue], .. } = self else { return None };
        match property {
            "red" => Some(*red),
            "green" => Some(*green),
            "blue" => Some(*blue),
            _ => None,
        }
    }

    fn get_int(&self, property: &str) -> Option<i32> {
        match self {
            Self::Face { group, .. } if property == "group" => Some(*group),
            _ => None,
        }
    }
}
