//! Meshes of all shared faces: none is left out, none is folded, areas fit.

use hairline::kernel::query::face_area;
use hairline::kernel::tessellate::{FaceMesh, TessellationOptions, tessellate};

use crate::truth;

#[test]
fn scratch() {
    let folder = truth::models().unwrap();
    let only = std::env::var("ONLY").unwrap_or_default();
    let rel: f64 = std::env::var("REL").map_or(1e-3, |s| s.parse().unwrap());
    for name in truth::names(&folder) {
        if !name.contains(&only) {
            continue;
        }
        let model = truth::model(&folder, &name);
        let mut bounds = hairline::kernel::view::Bounds::EMPTY;
        let faces: Vec<_> = model.faces.iter().map(|f| f.record().unwrap().derive().unwrap()).collect();
        for f in &faces {
            bounds = bounds.union(hairline::kernel::query::face_bounds(f));
        }
        let mut o = TessellationOptions::new(rel * bounds.diagonal());
        o.conservative = std::env::var("APPROX").is_err();
        let start = std::time::Instant::now();
        let mut n = 0;
        let mut over = 0;
        let mut fails = vec![];
        let mut off = vec![];
        let mut cross = 0;
        let mut worst = 0.0f64;
        let mut slow = (0.0, 0);
        for (k, f) in faces.iter().enumerate() {
            let t = std::time::Instant::now();
            if std::env::var("EACH").is_ok() {
                println!("face {}", model.faces[k].id);
            }
            match tessellate(f, &o) {
                Ok(m) => {
                    n += m.triangles.len();
                    over += m.quality.over_tolerance;
                    cross += m.quality.crossings;
                    worst = worst.max(m.quality.error);
                    let _: &FaceMesh = &m;
                    let e = t.elapsed().as_secs_f64();
                    if e > slow.0 {
                        slow = (e, model.faces[k].id);
                    }
                    let a = face_area(f).value;
                    let r = (m.area() - a).abs() / a;
                    if r > 0.02 {
                        off.push((model.faces[k].id, r));
                    }
                }
                Err(e) => fails.push((model.faces[k].id, e.to_string())),
            }
        }
        off.sort_by(|a, b| b.1.total_cmp(&a.1));
        println!(
            "{name}: {} faces, {n} triangles, {:.3} s, over {over}, cross {cross}, err/tol {:.2}, slow {slow:?} fails {:?} off {} {:?}",
            faces.len(),
            start.elapsed().as_secs_f64(),
            worst / o.tolerance,
            fails.iter().take(3).collect::<Vec<_>>(),
            off.len(),
            off.iter().take(4).collect::<Vec<_>>()
        );
    }
}
