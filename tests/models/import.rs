//! IGES files against what OpenCASCADE makes of them: faces, parameters, points inside and outside, areas.

use glam::DVec2;
use hairline::exchange::iges;
use hairline::scene::records::FaceRecord;

use crate::iges_truth::{self as truth, TruthFace};

/// File, faces.
const FILES: [(&str, usize); 14] = [
    ("gpucast_part.igs", 134),
    ("gpucast_teapot.igs", 32),
    ("occt_hammer.iges", 45),
    ("dealii_DTMB-5415_bulbous_bow.iges", 1),
    ("dealii_wing.iges", 4),
    ("dealii_wigley.iges", 1),
    ("tigl_D150_wing.igs", 8),
    ("pygem_test_pipe_hollow.iges", 6),
    ("igesio_single_rounded_cube.iges", 7),
    ("pyiges_144-000.igs", 1),
    ("pyiges_144-example-1.igs", 13),
    ("pyiges_128-005.igs", 1),
    ("elmer_cylinder_in_channel.iges", 10),
    ("freecad_SOT23.igs", 73),
];

/// Largest differences between a face and its truth.
#[derive(Debug, Default)]
struct Differences {
    /// Between the surfaces at the same parameters, relative to the face's size.
    surface: f64,
    /// Between the boxes of the loops, relative to the box.
    uv_box: f64,
    /// Of the areas, relative.
    area: f64,
    /// Points on the wrong side.
    wrong: usize,
    /// Points tried.
    points: usize,
}

fn compare(face: &FaceRecord, truth: &TruthFace) -> Differences {
    let mut d = Differences::default();
    let size = truth.surface.bounds().diagonal();
    let [u0, u1, v0, v1] = truth.uv_box;
    for i in 0..=12 {
        for j in 0..=12 {
            let (u, v) = (u0 + (u1 - u0) * f64::from(i) / 12.0, v0 + (v1 - v0) * f64::from(j) / 12.0);
            let gap = face.surface.point(u, v) - truth.surface.point(u, v);
            d.surface = d.surface.max(gap.length() / size);
        }
    }
    let polygons = if face.loops.is_empty() {
        let ((a, b), (c, e)) = (face.surface.knots_u().domain(), face.surface.knots_v().domain());
        vec![vec![(a, c), (b, c), (b, e), (a, e)]]
    } else {
        truth::polygons(face)
    };
    let all = || polygons.iter().flatten().map(|p| DVec2::new(p.0, p.1));
    let (min, max) = all().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
    d.uv_box = ((min.x - u0).abs().max((max.x - u1).abs()) / (u1 - u0))
        .max((min.y - v0).abs().max((max.y - v1).abs()) / (v1 - v0));
    for (u, v, inside) in &truth.points {
        let left = truth::crossings(&polygons, *v).iter().filter(|x| *x < u).count();
        d.wrong += usize::from((left % 2 == 1) != *inside);
        d.points += 1;
    }
    d.area = (area(face, &polygons, min, max) / truth.area - 1.0).abs();
    d
}

/// Three Gauss points on [-1, 1].
const NODES: [(f64, f64); 3] =
    [(0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0), (-0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Area row by row, in v between all places where the loops turn; good to about 1e-6.
fn area(face: &FaceRecord, polygons: &[Vec<(f64, f64)>], min: DVec2, max: DVec2) -> f64 {
    let mut breaks: Vec<f64> = face.surface.knots_v().breaks();
    breaks.extend(face.loops.iter().flat_map(|l| &l.curves).map(|c| c.point(c.domain().0).y));
    for polygon in polygons {
        let n = polygon.len();
        let turns = (0..n).filter(|k| {
            let (a, b, c) = (polygon[(k + n - 1) % n].1, polygon[*k].1, polygon[(k + 1) % n].1);
            (b - a) * (c - b) <= 0.0
        });
        breaks.extend(turns.map(|k| polygon[k].1));
    }
    breaks.retain(|v| *v > min.y && *v < max.y);
    breaks.extend([min.y, max.y]);
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|a, b| *a - *b < 1e-12 * (max.y - min.y));
    let parts = (240 / breaks.len()).max(6);
    let mut total = 0.0;
    for w in breaks.windows(2) {
        for part in 0..parts {
            for (x, weight) in NODES {
                // Rows crowd towards both ends, where round loops open like a square root.
                let s = std::f64::consts::PI * (part as f64 + 0.5 + 0.5 * x) / parts as f64;
                let v = w[0] + (w[1] - w[0]) * 0.5 * (1.0 - s.cos());
                let scale = (w[1] - w[0]) * 0.25 * std::f64::consts::PI * s.sin() / parts as f64;
                for pair in truth::crossings(polygons, v).chunks_exact(2) {
                    total += scale * weight * row(face, v, pair[0], pair[1]);
                }
            }
        }
    }
    total
}

fn row(face: &FaceRecord, v: f64, a: f64, b: f64) -> f64 {
    let mut breaks = face.surface.knots_u().breaks();
    breaks.retain(|u| *u > a && *u < b);
    breaks.extend([a, b]);
    breaks.sort_by(f64::total_cmp);
    let mut total = 0.0;
    for w in breaks.windows(2) {
        for part in 0..3 {
            let (c, d) = (
                w[0] + (w[1] - w[0]) * f64::from(part) / 3.0,
                w[0] + (w[1] - w[0]) * f64::from(part + 1) / 3.0,
            );
            for (x, weight) in NODES {
                let jet = face.surface.jet(0.5 * (c + d) + 0.5 * (d - c) * x, v);
                total += 0.5 * (d - c) * weight * jet.du.cross(jet.dv).length();
            }
        }
    }
    total
}

#[test]
fn faces_agree_with_opencascade() {
    let Some(models) = truth::models() else { return };
    let mut bad = Vec::new();
    println!(
        "{:36} {:>5} {:>7} {:>9} {:>9} {:>9} {:>6}/points",
        "file", "faces", "remarks", "surface", "uv box", "area", "wrong"
    );
    for (name, count) in FILES {
        let (model, report) = iges::read(&models.join("files").join(name)).unwrap();
        let mut worst = Differences::default();
        if name != "gpucast_teapot.igs" && model.faces.len() == count {
            let truth = truth::read(&models, name);
            assert_eq!(truth.len(), count, "{name}");
            for (k, (face, truth)) in model.faces.iter().zip(&truth).enumerate() {
                let d = compare(face, truth);
                // The truth's boxes hold the control points of its curves, ours the curves.
                if d.surface > 1e-6 || d.uv_box > 5e-3 || d.area > 1e-4 || d.wrong > 0 {
                    bad.push(format!("{name} face {}: {d:?}", k + 1));
                }
                worst.surface = worst.surface.max(d.surface);
                worst.uv_box = worst.uv_box.max(d.uv_box);
                worst.area = worst.area.max(d.area);
                worst.wrong += d.wrong;
                worst.points += d.points;
            }
        }
        let w = &worst;
        println!(
            "{name:36} {:5} {:7} {:9.1e} {:9.1e} {:9.1e} {:6}/{}",
            model.faces.len(),
            report.remarks.len(),
            w.surface,
            w.uv_box,
            w.area,
            w.wrong,
            w.points
        );
        for remark in &report.remarks {
            println!("    {remark:?}");
        }
        if model.faces.len() != count {
            bad.push(format!("{name}: {} faces instead of {count}", model.faces.len()));
        }
    }
    assert!(bad.is_empty(), "{}", bad.join("\n"));
}

#[test]
fn the_part_keeps_its_curves() {
    let Some(models) = truth::models() else { return };
    let (model, report) = iges::read(&models.join("files/gpucast_part.igs")).unwrap();
    assert_eq!(report.entities["142"], 134);
    assert!(report.remarks.is_empty(), "{:?}", report.remarks);
    let curves: usize = model.faces.iter().flat_map(|f| &f.loops).map(|l| l.curves.len()).sum();
    assert_eq!(curves, 600);
}

#[test]
fn edges_of_a_solid_bound_two_faces_each() {
    let Some(models) = truth::models() else { return };
    let (model, _) = iges::read(&models.join("files/elmer_cylinder_in_channel.iges")).unwrap();
    let mut uses = std::collections::BTreeMap::new();
    for (face, record) in model.faces.iter().enumerate() {
        for trim in &record.loops {
            for curve in 0..trim.curves.len() {
                let edge = trim.edge(curve).unwrap_or_else(|| panic!("no edge: face {}", face + 1));
                uses.entry(edge).or_insert_with(Vec::new).push((face, trim, curve));
            }
        }
    }
    for (edge, uses) in &uses {
        let [(a, first, i), (b, second, j)] = uses[..] else { panic!("{edge:?}: {}", uses.len()) };
        // The two sides meet in space, run through in opposite directions as seen from outside.
        let ends = |face: usize, curve: &hairline::kernel::nurbs::NurbsCurve2| {
            let (s, e) = curve.domain();
            [curve.point(s), curve.point(e)].map(|uv| model.faces[face].surface.point(uv.x, uv.y))
        };
        let (x, mut y) = (ends(a, &first.curves[i]), ends(b, &second.curves[j]));
        if model.faces[a].reversed != model.faces[b].reversed {
            y.reverse();
        }
        assert!(x[0].distance(y[1]) < 1e-6 && x[1].distance(y[0]) < 1e-6, "{edge:?}: {x:?} {y:?}");
    }
}
