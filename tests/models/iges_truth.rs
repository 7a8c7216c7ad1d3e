//! The shared real models and what OpenCASCADE says of them (format: `README.md` beside the models).

use std::io::Read;
use std::path::Path;

use flate2::read::GzDecoder;
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use hairline::scene::records::FaceRecord;
use serde_json::Value;

pub use crate::folder::models;

/// One face of the truth.
#[derive(Debug)]
pub struct TruthFace {
    pub area: f64,
    /// `[umin, umax, vmin, vmax]`.
    pub uv_box: [f64; 4],
    pub surface: NurbsSurface,
    /// Random points: u, v, inside.
    pub points: Vec<(f64, f64, bool)>,
}

fn unpack(path: &Path) -> String {
    let file = std::fs::File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut text = String::new();
    GzDecoder::new(file).read_to_string(&mut text).unwrap();
    text
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// The truth of the model file `name`.
pub fn read(models: &Path, name: &str) -> Vec<TruthFace> {
    let json: Value = serde_json::from_str(&unpack(&models.join(format!("truth/{name}.json.gz")))).unwrap();
    let mut faces: Vec<TruthFace> = json["faces"].as_array().unwrap().iter().map(face).collect();
    for line in unpack(&models.join(format!("truth/{name}.points.tsv.gz"))).lines().skip(1) {
        let fields: Vec<&str> = line.split('\t').collect();
        let face: usize = fields[0].parse().unwrap();
        faces[face - 1].points.push((
            fields[1].parse().unwrap(),
            fields[2].parse().unwrap(),
            fields[3] == "1",
        ));
    }
    faces
}

fn face(value: &Value) -> TruthFace {
    let s = &value["surf"];
    let knots = |degree: &str, knots: &str| {
        KnotVector::new(s[degree].as_u64().unwrap() as usize, numbers(&s[knots])).unwrap()
    };
    let cp = numbers(&s["cp"]);
    let points = cp.chunks(4).map(|c| glam::DVec3::new(c[0], c[1], c[2])).collect();
    let weights = cp.chunks(4).map(|c| c[3]).collect();
    TruthFace {
        area: value["area"].as_f64().unwrap(),
        uv_box: numbers(&value["uvbox"]).try_into().unwrap(),
        surface: NurbsSurface::new(knots("du", "ku"), knots("dv", "kv"), points, weights).unwrap(),
        points: Vec::new(),
    }
}

/// A face's loops as polygons, fine enough to judge points that keep a distance from them.
pub fn polygons(face: &FaceRecord) -> Vec<Vec<(f64, f64)>> {
    face.loops.iter().map(|l| l.curves.iter().flat_map(flatten).collect()).collect()
}

fn flatten(curve: &NurbsCurve2) -> Vec<(f64, f64)> {
    let breaks = curve.knots().breaks();
    let parts = if curve.degree() == 1 { 1 } else { (1024 / breaks.len()).max(16) };
    let mut result = Vec::new();
    for span in breaks.windows(2) {
        for k in 0..parts {
            let p = curve.point(span[0] + (span[1] - span[0]) * k as f64 / parts as f64);
            result.push((p.x, p.y));
        }
    }
    let p = curve.point(curve.domain().1);
    result.push((p.x, p.y));
    result
}

/// Crossings of the line `v` with closed polygons, sorted by u.
pub fn crossings(polygons: &[Vec<(f64, f64)>], v: f64) -> Vec<f64> {
    let mut result = Vec::new();
    for polygon in polygons {
        for k in 0..polygon.len() {
            let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            if (a.1 <= v) != (b.1 <= v) {
                result.push(a.0 + (v - a.1) / (b.1 - a.1) * (b.0 - a.0));
            }
        }
    }
    result.sort_by(f64::total_cmp);
    result
}
