//! Meshes of shared models: no face is left out, bodies are closed, areas fit, and the program writes them.

use hairline::kernel::face::Face;
use hairline::kernel::query::{face_area, face_bounds};
use hairline::kernel::tessellate::TessellationOptions;
use hairline::kernel::view::Bounds;
use hairline::meshing::{ModelMesh, Work, measure, mesh_faces, remesh_faces};

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

#[test]
fn closed_bodies_come_out_closed_and_within_the_tolerance() {
    for name in
        ["axom_sliced_cylinder.step", "igesio_single_rounded_cube.iges", "elmer_cylinder_in_channel.iges"]
    {
        let Some((faces, options, mesh)) = meshed(name, 1e-3) else { return };
        assert_eq!(open_edges(&mesh), 0, "{name}");
        let all: Vec<Option<&Face>> = faces.iter().map(Some).collect();
        let distance = measure(&all, &mesh, 4, 20_000);
        assert!(distance.samples > 500, "{name}: {distance:?}");
        assert!(distance.largest() <= options.tolerance * (1.0 + 1e-9), "{name}: {distance:?}");
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
