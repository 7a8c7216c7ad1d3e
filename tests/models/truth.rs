//! Reads the ground truth of the shared models: faces as OpenCASCADE or openNURBS has them, and
//! classified points.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use flate2::read::GzDecoder;
use glam::{DVec2, DVec3};
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use hairline::scene::records::{FaceRecord, LoopRecord, LoopRole};
use serde::Deserialize;

/// The folder of shared real models, where there is one.
pub fn models() -> Option<PathBuf> {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("shared/models"))
        .find(|folder| folder.is_dir())
}

#[derive(Deserialize)]
pub struct Model {
    pub faces: Vec<Face>,
}

#[derive(Deserialize)]
pub struct Face {
    pub id: usize,
    #[serde(default)]
    pub nurbform: u32,
    /// Trimmed area, model units squared; openNURBS gives none.
    pub area: Option<f64>,
    /// xmin ymin zmin xmax ymax zmax.
    #[serde(default)]
    pub bbox: Vec<f64>,
    surf: Option<Surface>,
    loops: Vec<Loop>,
}

#[derive(Deserialize)]
struct Surface {
    du: usize,
    dv: usize,
    ku: Vec<f64>,
    kv: Vec<f64>,
    cp: Vec<f64>,
}

#[derive(Deserialize)]
struct Loop {
    outer: bool,
    curves: Vec<Curve>,
}

#[derive(Deserialize)]
struct Curve {
    d: usize,
    k: Vec<f64>,
    cp: Vec<f64>,
}

/// One classified point.
pub struct Point {
    pub face: usize,
    pub uv: DVec2,
    pub inside: bool,
}

impl Face {
    /// The face as a record; what is wrong with it otherwise.
    pub fn record(&self) -> Result<FaceRecord, String> {
        let surf = self.surf.as_ref().ok_or("no surface")?;
        let knots =
            |degree, knots: &[f64]| KnotVector::new(degree, knots.to_vec()).map_err(|e| e.to_string());
        let points = surf.cp.chunks(4).map(|c| DVec3::new(c[0], c[1], c[2])).collect();
        let weights = surf.cp.chunks(4).map(|c| c[3]).collect();
        let surface =
            NurbsSurface::new(knots(surf.du, &surf.ku)?, knots(surf.dv, &surf.kv)?, points, weights)
                .map_err(|e| e.to_string())?;
        let curve = |c: &Curve| {
            let points = c.cp.chunks(3).map(|p| DVec2::new(p[0], p[1])).collect();
            let weights = c.cp.chunks(3).map(|p| p[2]).collect();
            NurbsCurve2::new(knots(c.d, &c.k)?, points, weights).map_err(|e| e.to_string())
        };
        let record = |l: &Loop| -> Result<LoopRecord, String> {
            let role = if l.outer { LoopRole::Outer } else { LoopRole::Inner };
            Ok(LoopRecord::new(role, l.curves.iter().map(curve).collect::<Result<_, _>>()?))
        };
        Ok(FaceRecord::new(surface, self.loops.iter().map(record).collect::<Result<_, _>>()?))
    }
}

fn unpacked(path: &Path) -> String {
    let file = File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut text = String::new();
    GzDecoder::new(BufReader::new(file))
        .read_to_string(&mut text)
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    text
}

/// Names of all models with truth, in order.
pub fn names(models: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(models.join("truth")).expect("the folder truth");
    let name = |e: std::io::Result<std::fs::DirEntry>| {
        e.expect("entry").file_name().to_string_lossy().strip_suffix(".json.gz").map(str::to_owned)
    };
    let mut names: Vec<String> = entries.filter_map(name).collect();
    names.sort();
    names
}

/// The faces of a model.
pub fn model(models: &Path, name: &str) -> Model {
    let path = models.join(format!("truth/{name}.json.gz"));
    serde_json::from_str(&unpacked(&path)).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The classified points of a model.
pub fn points(models: &Path, name: &str) -> Vec<Point> {
    let text = unpacked(&models.join(format!("truth/{name}.points.tsv.gz")));
    text.lines()
        .skip(1)
        .map(|line| {
            let mut fields = line.split('\t');
            let mut next = || fields.next().expect("four fields");
            let face = next().parse().expect("a face");
            let mut number = || next().parse().expect("a number");
            let uv = DVec2::new(number(), number());
            Point { face, uv, inside: next() == "1" }
        })
        .collect()
}
