//! `hairline tessellate`: a model as triangles within an error, into a mesh file.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use serde::Serialize;

use super::arguments::TessellateArguments;
use super::failure::Failure;
use super::progress::Progress;
use super::{output, source};
use crate::exchange::mesh::{self, Group, PLAIN};
use crate::inspect::Length;
use crate::kernel::face::Face;
use crate::kernel::tessellate::{FaceMesh, TessellateError, TessellationOptions};
use crate::kernel::view::Bounds;
use crate::meshing::{Distance, ModelMesh, Work, finest, measure_each, mesh_edges, mesh_faces, orientations};
use crate::scene::records::{FaceRecord, ModelRecord};

/// A format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Glb,
    Stl,
    Obj,
    Ply,
}

/// What is told about a mesh. Lengths in units of the model, times in seconds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Statistics {
    /// Unit of the model.
    pub unit: String,
    /// The tolerance that was kept to.
    pub tolerance: f64,
    /// Whether the tolerance is guaranteed by bounds.
    pub conservative: bool,
    /// Faces with a mesh.
    pub faces: usize,
    /// Faces without, by number, with the reason.
    pub left_out: Vec<(usize, String)>,
    /// Triangles.
    pub triangles: usize,
    /// Edges of triangles, shared ones once.
    pub edges: usize,
    /// Edges with a triangle on one side only.
    pub open_edges: usize,
    /// Distance between mesh and exact faces, measured at samples.
    pub measured: Distance,
    /// Triangles that could not be proved to keep the tolerance.
    pub over_tolerance: usize,
    /// Faces with such triangles, or measured beyond the tolerance.
    pub unproved: Vec<Unproved>,
    /// Largest distance by which vertices were moved to close gaps between faces.
    pub gap: f64,
    /// Seconds to prepare faces.
    pub prepare_s: f64,
    /// Seconds to tessellate.
    pub tessellate_s: f64,
}

/// A face whose error is not known to be within the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Unproved {
    /// Number of the face.
    pub face: usize,
    /// Triangles without a proof.
    pub triangles: usize,
    /// Largest distance between the face and its mesh that was found at samples.
    pub measured: f64,
    /// Largest distance by which vertices of the face were moved to close gaps.
    pub gap: f64,
}

/// Faces without a proof that are listed; JSON has all.
const LISTED: usize = 20;
/// Samples along an edge when the error is measured, and of one face at most.
const DENSITY: usize = 3;
const SAMPLES: usize = 20_000;
/// Gaps of more than this part of the tolerance are told as the reason for errors beyond it.
const GAPPING: f64 = 0.5;
/// Rounding of more than this part of the tolerance is told.
const ROUNDING: f64 = 0.05;
/// Smaller tolerances than this part of the model's size drown in rounding.
const FINEST: f64 = 1e-9;

/// Tessellates `arguments.file` into `arguments.output`.
///
/// # Errors
/// The input cannot be read, the output not written, the tolerance is no use for the model, or there are more
/// triangles than allowed.
pub fn run(arguments: &TessellateArguments) -> Result<(), Failure> {
    let format = format_of(&arguments.output)?;
    output::check_writable(&arguments.output)?;
    let progress = Progress::start(format!("reading {}", arguments.file.display()));
    let opened = source::open(&arguments.file, &|part| progress.set(part))?;
    drop(progress);
    if let Some(line) = source::remarks_line(&arguments.file, &opened.report) {
        eprintln!("hairline: note: {line}");
    }
    let model = opened.model;
    let start = Instant::now();
    let derived = model.derive_all();
    let faces: Vec<Option<&Face>> = derived.iter().map(|f| f.as_ref().ok()).collect();
    let prepare_s = start.elapsed().as_secs_f64();
    let mut options = options(arguments, &model, &faces)?;
    let mut start = Instant::now();
    let mut meshed = tessellate(&faces, &options);
    if let Err(TessellateError::TooManyTriangles { limit }) = meshed
        && limit < TessellationOptions::TRIANGLE_LIMIT
        && go_on(limit)?
    {
        options.triangle_limit = TessellationOptions::TRIANGLE_LIMIT;
        start = Instant::now();
        meshed = tessellate(&faces, &options);
    }
    let meshed = meshed.map_err(|error| refusal(&error, arguments))?;
    let tessellate_s = start.elapsed().as_secs_f64();
    let mut statistics = statistics(&model, &faces, &meshed, &options);
    for (face, error) in derived.iter().enumerate() {
        if let (Err(error), Some(entry)) = (error, statistics.left_out.iter_mut().find(|l| l.0 == face + 1)) {
            entry.1 = error.to_string();
        }
    }
    (statistics.prepare_s, statistics.tessellate_s) = (prepare_s, tessellate_s);
    for (face, reason) in &statistics.left_out {
        eprintln!("hairline: note: {}: face {face} is left out: {reason}", arguments.file.display());
    }
    write(&model, &meshed, format, options.tolerance, &arguments.output)?;
    tell(&statistics, arguments.json).map_err(|e| Failure::stdout(&e))
}

fn tessellate(faces: &[Option<&Face>], options: &TessellationOptions) -> Result<ModelMesh, TessellateError> {
    let progress = Progress::start("tessellating");
    let work = Work { progress: &|part| progress.set(part), cancelled: &|| false };
    mesh_faces(faces, options, &work)
}

/// Asks whether to make more triangles than `limit`; no where nobody can answer.
fn go_on(limit: usize) -> Result<bool, Failure> {
    if !(io::stdin().is_terminal() && io::stderr().is_terminal()) {
        return Ok(false);
    }
    eprint!("hairline: this needs more than {limit} triangles. Go on? [y/N] ");
    let mut answer = String::new();
    let read = io::stdin().read_line(&mut answer);
    read.map_err(|e| Failure::Work { reason: format!("the question was not answered: {e}") })?;
    Ok(matches!(answer.trim().to_lowercase().as_str(), "y" | "yes"))
}

fn format_of(path: &Path) -> Result<Format, Failure> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    match ending.as_str() {
        "glb" => Ok(Format::Glb),
        "stl" => Ok(Format::Stl),
        "obj" => Ok(Format::Obj),
        "ply" => Ok(Format::Ply),
        _ => Err(Failure::Usage {
            reason: format!("{}: the name must end in .glb, .stl, .obj or .ply", path.display()),
        }),
    }
}

/// The options in units of the model, with a tolerance that makes sense for it.
fn options(
    arguments: &TessellateArguments,
    model: &ModelRecord,
    faces: &[Option<&Face>],
) -> Result<TessellationOptions, Failure> {
    let unit = model.unit.millimetres;
    let bounds = faces.iter().flatten().fold(Bounds::EMPTY, |b, f| b.union(f.bounds));
    let size = if bounds.is_empty() { 0.0 } else { bounds.diagonal() };
    let mut tolerance = arguments.error.mm / unit;
    if size > 0.0 && tolerance < FINEST * size {
        return Err(Failure::Usage {
            reason: format!(
                "--error {} is below what numbers can tell apart on a model of {}; use {} or more",
                given(arguments.error),
                given(Length { mm: size * unit }),
                given(Length { mm: FINEST * size * unit })
            ),
        });
    }
    let least = finest(&bounds);
    if tolerance < least {
        return Err(Failure::Usage {
            reason: format!(
                "--error {} is below what numbers can tell apart as far from the origin as this model lies; use {} or more",
                given(arguments.error),
                Length { mm: least * unit }
            ),
        });
    }
    let largest = 0.1 * size;
    if size > 0.0 && tolerance > largest {
        eprintln!(
            "hairline: note: --error {} is large for a model of {}; {} is used",
            arguments.error,
            given(Length { mm: size * unit }),
            given(Length { mm: largest * unit })
        );
        tolerance = largest;
    }
    Ok(TessellationOptions {
        conservative: !arguments.approximate,
        balanced: !arguments.on_surface,
        max_angle: arguments.angle.map(|a| a.0),
        max_edge: arguments.max_edge.map(|l| l.mm / unit),
        triangle_limit: if arguments.yes { TessellationOptions::TRIANGLE_LIMIT } else { arguments.limit },
        ..TessellationOptions::new(tolerance)
    })
}

/// A length that was asked for, also where it is smaller than lengths are told.
fn given(length: Length) -> String {
    /// Smaller ones are shown as nothing.
    const SHOWN: f64 = 1e-11;
    if length.mm < SHOWN { format!("{:e} mm", length.mm) } else { length.to_string() }
}

fn refusal(error: &TessellateError, arguments: &TessellateArguments) -> Failure {
    match error {
        TessellateError::TooManyTriangles { limit } => Failure::Work {
            reason: format!(
                "this needs more than {limit} triangles; choose a larger --error than {}, or allow more with --limit N or --yes",
                arguments.error
            ),
        },
        other => Failure::Work { reason: other.to_string() },
    }
}

/// Figures of a mesh, its error measured.
pub fn statistics(
    model: &ModelRecord,
    faces: &[Option<&Face>],
    mesh: &ModelMesh,
    options: &TessellationOptions,
) -> Statistics {
    let meshes = || mesh.faces.iter().flatten();
    let all_edges = mesh_edges(mesh);
    let left_out = mesh.faces.iter().enumerate();
    let each = measure_each(faces, mesh, DENSITY, SAMPLES);
    let doubt = |(k, m): (usize, &FaceMesh)| {
        let (triangles, measured) = (m.quality.over_tolerance, each[k].map_or(0.0, |d| d.largest()));
        (options.conservative && (triangles > 0 || measured > options.tolerance)).then_some(Unproved {
            face: k + 1,
            triangles,
            measured,
            gap: m.quality.gap,
        })
    };
    let meshed = mesh.faces.iter().enumerate().filter_map(|(k, m)| Some((k, m.as_ref().ok()?)));
    Statistics {
        unit: model.unit.name.clone(),
        tolerance: options.tolerance,
        conservative: options.conservative,
        faces: meshes().count(),
        left_out: left_out.filter_map(|(k, m)| Some((k + 1, m.as_ref().err()?.to_string()))).collect(),
        triangles: mesh.triangle_count(),
        edges: all_edges.len(),
        open_edges: all_edges.iter().filter(|e| e.is_open()).count(),
        measured: each.iter().flatten().fold(Distance::default(), |all, d| all.join(*d)),
        unproved: meshed.filter_map(doubt).collect(),
        over_tolerance: meshes().map(|m| m.quality.over_tolerance).sum(),
        gap: meshes().map(|m| m.quality.gap).fold(0.0, f64::max),
        prepare_s: 0.0,
        tessellate_s: 0.0,
    }
}

fn write(
    model: &ModelRecord,
    meshed: &ModelMesh,
    format: Format,
    tolerance: f64,
    path: &Path,
) -> Result<(), Failure> {
    let names: Vec<String> = model
        .faces
        .iter()
        .enumerate()
        .map(|(k, f)| f.name.clone().unwrap_or_else(|| format!("face {}", k + 1)))
        .collect();
    let part = |face: &FaceRecord| face.part.and_then(|p| model.parts.get(p)).map_or("", |p| p.name.as_str());
    let senses: Vec<bool> = model.faces.iter().map(|f| f.reversed).collect();
    let groups: Vec<Group> = model
        .faces
        .iter()
        .zip(&meshed.faces)
        .zip(names.iter().zip(orientations(meshed, &senses)))
        .filter_map(|((face, mesh), (name, reversed))| {
            let mesh = mesh.as_ref().ok().filter(|m| !m.triangles.is_empty())?;
            let colour = face.colour.unwrap_or(PLAIN);
            Some(Group { name, part: part(face), colour, mesh, reversed })
        })
        .collect();
    let lost = match format {
        Format::Stl => mesh::single_loss(&groups, DVec3::ZERO),
        Format::Glb => mesh::single_loss(&groups, mesh::glb_origin(&groups)),
        // These hold double precision.
        Format::Obj | Format::Ply => 0.0,
    };
    if lost > ROUNDING * tolerance {
        eprintln!(
            "hairline: note: {}: the format holds single precision, which moves vertices of this model by up to {}, {:.0} % of \
             the tolerance; .obj and .ply keep them{}",
            path.display(),
            Length { mm: lost * model.unit.millimetres },
            100.0 * lost / tolerance,
            if format == Format::Stl { ", .glb counts from the model's middle" } else { "" }
        );
    }
    let too_much = |e: io::Error| Failure::Work { reason: format!("{}: {e}", path.display()) };
    let bytes = match format {
        Format::Glb => mesh::glb(&groups, &model.name, 1e-3 * model.unit.millimetres).map_err(too_much)?,
        Format::Stl => mesh::stl(&groups, &model.name).map_err(too_much)?,
        Format::Ply => mesh::ply(&groups).map_err(too_much)?,
        Format::Obj => {
            let library = path.with_extension("mtl");
            output::write_whole(&library, &mesh::materials(&groups))?;
            mesh::obj(&groups, library.file_name().map(|n| n.to_string_lossy()).as_deref())
        }
    };
    output::write_whole(path, &bytes)
}

fn tell(statistics: &Statistics, as_json: bool) -> io::Result<()> {
    let mut out = io::stdout().lock();
    if as_json {
        serde_json::to_writer_pretty(&mut out, statistics)?;
        return writeln!(out);
    }
    let s = statistics;
    let unit = &s.unit;
    writeln!(out, "faces       {} meshed, {} left out", s.faces, s.left_out.len())?;
    writeln!(out, "triangles   {} ({} edges, {} of them open)", s.triangles, s.edges, s.open_edges)?;
    let kind = match (s.conservative, s.unproved.is_empty()) {
        (true, true) => "guaranteed",
        (true, false) => "guaranteed but for the faces below",
        (false, _) => "estimated",
    };
    writeln!(out, "tolerance   {:.6} {unit}, {kind}", s.tolerance)?;
    let m = &s.measured;
    writeln!(
        out,
        "true error  {:.6} {unit} mesh to surface, {:.6} {unit} surface to mesh ({} samples)",
        m.mesh_to_surface, m.surface_to_mesh, m.samples
    )?;
    for doubt in s.unproved.iter().take(LISTED) {
        let why = match (doubt.triangles, doubt.gap > GAPPING * s.tolerance) {
            (0, true) => {
                format!("its edges lie {:.6} {unit} off its neighbours' in the file", 2.0 * doubt.gap)
            }
            (0, false) => "beyond the tolerance".into(),
            (1, _) => "1 triangle not proved to keep the tolerance".into(),
            (many, _) => format!("{many} triangles not proved to keep the tolerance"),
        };
        writeln!(out, "            face {}: {:.6} {unit} measured, {why}", doubt.face, doubt.measured)?;
    }
    if s.unproved.len() > LISTED {
        writeln!(out, "            and {} more faces (--json lists all)", s.unproved.len() - LISTED)?;
    }
    writeln!(out, "gaps        vertices moved by {:.3e} {unit} at most", s.gap)?;
    writeln!(out, "time        {:.3} s preparing faces, {:.3} s tessellating", s.prepare_s, s.tessellate_s)
}
