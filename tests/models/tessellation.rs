//! Meshes of shared models: no face is left out, bodies are closed, areas fit, and the program writes them.

use std::path::Path;

use glam::DVec3;
use hairline::kernel::face::Face;
use hairline::kernel::query::{face_area, face_bounds};
use hairline::kernel::tessellate::{FaceMesh, TessellationOptions};
use hairline::kernel::view::Bounds;
use hairline::meshing::{ModelMesh, Work, measure_each, mesh_faces, remesh_faces};

use crate::truth;

/// The faces of a model and their meshes at a part of its size.
fn meshed(name: &str, part: f64) -> Option<(Vec<Face>, TessellationOptions, ModelMesh)> {
    let folder = truth::models().or_else(|| {
        println!("not run: no shared/models here");
        None
    })?;
    let faces: Vec<Face> =
        truth::model(&folder, name).faces.iter().map(|f| f.record().unwrap().derive().unwrap()).collect();
    let bounds = faces.iter().fold(Bounds::EMPTY, |b, f| b.union(face_bounds(f)));
    let options = TessellationOptions::new(part * bounds.diagonal());
    let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
    let mesh = mesh_faces(&all, &options, &Work::QUIET).unwrap();
    Some((faces, options, mesh))
}

/// Edges with a triangle on one side only, by exact positions.
fn open_edges(mesh: &ModelMesh) -> usize {
    let mut sides = std::collections::BTreeMap::<[[u64; 3]; 2], usize>::new();
    for m in mesh.faces.iter().flatten() {
        let key = |v: u32| (m.positions[v as usize] + 0.0).to_array().map(f64::to_bits);
        for [a, b, c] in &m.triangles {
            for (p, q) in [(a, b), (b, c), (c, a)] {
                let (p, q) = (key(*p), key(*q));
                *sides.entry([p.min(q), p.max(q)]).or_default() += 1;
            }
        }
    }
    sides.values().filter(|n| **n == 1).count()
}

/// Triangles that look away from the surface.
fn folded(mesh: &ModelMesh) -> usize {
    let away = |m: &FaceMesh, t: &[u32; 3]| {
        let p = t.map(|v| m.positions[v as usize]);
        let side: DVec3 = t.iter().map(|v| m.normals[*v as usize]).sum();
        (p[1] - p[0]).cross(p[2] - p[0]).dot(side) < 0.0
    };
    mesh.faces.iter().flatten().map(|m| m.triangles.iter().filter(|t| away(m, t)).count()).sum()
}

/// Bodies with topology, of which the mesh must be closed.
const CLOSED: [&str; 18] = [
    "M6-1x12-countersunk-screw.step",
    "axom_boxed_sphere.step",
    "occt_hammer.iges",
    "kicad_EA_DOGXL160-7.step",
    "on_v4_SolidHandle.3dm",
    "axom_sliced_cylinder.step",
    "axom_revolved_sphere.step",
    "igesio_single_rounded_cube.iges",
    "elmer_cylinder_in_channel.iges",
    "NIST_MBE_PMI_1.stp",
    "NIST_MBE_PMI_3.stp",
    "netgen_frame.step",
    "as1-oc-214.stp",
    "occt_screw.step",
    "profile4040.step",
    "on_v4_WishBone.3dm",
    "freecad_SOT23.igs",
    "tigl_D150_wing.igs",
];

#[test]
fn closed_bodies_come_out_closed_and_within_the_tolerance() {
    for name in CLOSED {
        let Some((faces, options, mesh)) = meshed(name, 1e-3) else { return };
        assert_eq!(open_edges(&mesh), 0, "{name}");
        assert_eq!(folded(&mesh), 0, "{name}");
        keeps_its_tolerance(name, &faces, &options, &mesh);
    }
}

#[test]
fn bodies_stay_closed_where_the_tolerance_is_finer_than_their_gaps() {
    for name in ["axom_boxed_sphere.step", "on_v4_WishBone.3dm", "on_v4_SolidHandle.3dm", "occt_hammer.iges"]
    {
        let Some((_, _, mesh)) = meshed(name, 1e-4) else { return };
        assert_eq!((open_edges(&mesh), folded(&mesh)), (0, 0), "{name}");
    }
}

#[test]
fn files_without_loops_and_with_tiny_closing_edges_come_out_whole() {
    let Some(folder) = truth::models() else {
        println!("not run: no shared/models here");
        return;
    };
    // Open edges as many as the borders of the model make.
    for (name, closed) in [
        ("pyiges_128-005.igs", true),
        ("pyiges_144-example-1.igs", false),
        ("pyiges_144-000.igs", false),
        ("gpucast_teapot.igs", false),
    ] {
        let (model, _) = hairline::exchange::iges::read(&folder.join("files").join(name)).unwrap();
        let faces: Vec<Face> = model.faces.iter().map(|f| f.derive().unwrap()).collect();
        let bounds = faces.iter().fold(Bounds::EMPTY, |b, f| b.union(face_bounds(f)));
        let options = TessellationOptions::new(1e-3 * bounds.diagonal());
        let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
        let mesh = mesh_faces(&all, &options, &Work::QUIET).unwrap();
        keeps_its_tolerance(name, &faces, &options, &mesh);
        assert_eq!(folded(&mesh), 0, "{name}");
        assert!(!closed || open_edges(&mesh) == 0, "{name}");
    }
}

/// A prism over a closed spline, whose parameters along it are shares from 0 to 1 in its file, as IGES says.
#[test]
fn extruded_splines_keep_their_sides() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/data/extruded_122_closed.igs");
    let (model, report) = hairline::exchange::iges::read(&path).unwrap();
    assert!(report.remarks.is_empty(), "{:?}", report.remarks);
    let faces: Vec<Face> = model.faces.iter().map(|f| f.derive().unwrap()).collect();
    let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
    let options = TessellationOptions::new(1e-3);
    let mesh = mesh_faces(&all, &options, &Work::QUIET).unwrap();
    assert_eq!((open_edges(&mesh), folded(&mesh)), (0, 0));
    let area: f64 = mesh.faces.iter().flatten().map(FaceMesh::area).sum();
    // Caps of 94.348466, sides as long as 200,000 chords of the spline, 2 high.
    assert!((area - 2.0 * (94.348_466 + 35.153_900)).abs() < 0.05, "{area}");
}

fn keeps_its_tolerance(name: &str, faces: &[Face], options: &TessellationOptions, mesh: &ModelMesh) {
    let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
    for (k, distance) in measure_each(&all, mesh, 2, 800).into_iter().enumerate() {
        let distance = distance.unwrap_or_else(|| panic!("{name}: face {} is left out", k + 1));
        let off = distance.largest() / options.tolerance;
        assert!(off <= 1.0 + 1e-9, "{name}: face {}: {off} of the tolerance", k + 1);
    }
}

#[test]
fn poles_seams_slivers_and_uneven_parameters_keep_the_tolerance() {
    for name in [
        "gpucast_part.igs",
        "brlcad_plate_mode_samples_rhino.stp",
        "brlcad_ayam_hyperbolid.3dm",
        "ap203_periodic_bspline_triangular_cap.stp",
        "ap214_wavy_periodic_band.stp",
        "dealii_wigley.iges",
        "pyiges_128-005.igs",
    ] {
        let Some((faces, options, mesh)) = meshed(name, 1e-3) else { return };
        keeps_its_tolerance(name, &faces, &options, &mesh);
        assert_eq!(folded(&mesh), 0, "{name}");
    }
}

#[test]
fn angle_and_edge_limits_are_kept() {
    let Some((faces, options, _)) = meshed("axom_sliced_cylinder.step", 1e-2) else { return };
    let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
    let (angle, edge) = (0.3, 40.0 * options.tolerance);
    let finer = TessellationOptions { max_angle: Some(angle), max_edge: Some(edge), ..options };
    let mesh = mesh_faces(&all, &finer, &Work::QUIET).unwrap();
    assert_eq!(open_edges(&mesh), 0);
    for m in mesh.faces.iter().flatten() {
        for t in &m.triangles {
            for k in 0..3 {
                let [a, b] = [t[k] as usize, t[(k + 1) % 3] as usize];
                assert!(m.positions[a].distance(m.positions[b]) <= edge * (1.0 + 1e-9));
                assert!(m.normals[a].angle_between(m.normals[b]) <= angle * (1.0 + 1e-6));
            }
        }
    }
}

#[test]
fn meshes_have_the_area_of_their_faces() {
    for name in ["axom_sliced_cylinder.step", "igesio_single_rounded_cube.iges", "NIST_MBE_PMI_3.stp"] {
        let Some((faces, _, mesh)) = meshed(name, 1e-4) else { return };
        for (face, m) in faces.iter().zip(&mesh.faces) {
            let (found, exact) = (m.as_ref().unwrap().area(), face_area(face).value);
            assert!((found - exact).abs() < 0.03 * exact, "{name}: {found} for {exact}");
        }
    }
}

#[test]
fn the_same_model_gives_the_same_mesh_and_unchanged_faces_are_taken_over() {
    let Some((faces, options, mesh)) = meshed("axom_sliced_cylinder.step", 1e-3) else { return };
    let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
    assert_eq!(mesh_faces(&all, &options, &Work::QUIET).unwrap(), mesh);
    assert_eq!(remesh_faces(&all, &options, &mesh, &|face| face == 0, &Work::QUIET).unwrap(), mesh);
    let called_off = Work { progress: &|_| (), cancelled: &|| true };
    assert!(mesh_faces(&all, &options, &called_off).is_err());
}
