//! `hairline check` as its users meet it, and what it finds in real models.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use hairline::exchange::iges;
use hairline::inspect::{EdgeKind, Inspection, Statistics};
use serde_json::Value;

use crate::json_schema::misfits;
use crate::truth;

fn check(arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_hairline")).arg("check").args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let stderr = text(output.stderr);
    assert!(!stderr.to_lowercase().contains("panic"), "{stderr}");
    (output.status.code().expect("no signal"), text(output.stdout), stderr)
}

/// A file of our own: plane squares, naked all round.
fn own(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/models/data").join(name);
    path.to_str().unwrap().to_owned()
}

/// All field names of a value, with their paths; array items count once.
fn fields(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| {
            let path = format!("{path}.{key}");
            fields(value, &path, found);
            found.insert(path);
        }),
        Value::Array(items) => items.iter().for_each(|item| fields(item, path, found)),
        _ => {}
    }
}

/// Holds `report`, which has the fields `found`, against the schema.
fn fits_the_schema(report: &Value, found: &BTreeSet<String>) {
    let schema: Value = serde_json::from_str(include_str!("../../docs/check.schema.json")).unwrap();
    assert_eq!(misfits(report, &schema, &schema), Vec::<String>::new());
    // Every field that is written is in the schema, and what is not allowed does not fit.
    let text = schema.to_string();
    for name in found.iter().filter_map(|path| path.rsplit('.').next()) {
        assert!(text.contains(&format!("\"{name}\":")), "{name} is not in the schema");
    }
    let broken = |change: &dyn Fn(&mut Value)| {
        let mut report = report.clone();
        change(&mut report);
        misfits(&report, &schema, &schema)
    };
    assert!(!broken(&|r| r["version"] = 2.into()).is_empty());
    assert!(!broken(&|r| r["gaps"]["maximum_mm"] = "much".into()).is_empty());
    assert!(!broken(&|r| r["findings"][0]["gap"]["between"] = Value::Array(vec![])).is_empty());
    assert!(!broken(&|r| r["findings"][0]["sides"][0]["face"] = 0.into()).is_empty());
    let (_, out, _) = check(&["no/such/file.igs", &own("bounded_143_hole.igs")]);
    for line in out.lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        assert_eq!(misfits(&line, &schema, &schema), Vec::<String>::new());
    }
}

#[test]
fn every_field_is_in_the_description_and_has_its_type() {
    let (code, out, _) = check(&["demo", "--json", "-", "--tolerance", "1nm"]);
    assert!(code <= 1, "{code}");
    let report: Value = serde_json::from_str(&out).unwrap();
    let mut found = BTreeSet::new();
    fields(&report, "", &mut found);
    let described = include_str!("../../docs/check-schema.md");
    for path in &found {
        let name = path.rsplit('.').next().unwrap();
        assert!(
            described.contains(&format!("`{name}`")) || path.starts_with(".findings.sides.source"),
            "{path} is not described"
        );
    }
    assert_eq!(report["format"], "hairline-check");
    assert_eq!(report["version"], 1);
    assert_eq!(report["passes"], code == 0);
    let gaps = &report["gaps"];
    let bins = gaps["histogram"].as_array().unwrap();
    let sum: u64 = bins.iter().map(|b| b["count"].as_u64().unwrap()).sum();
    assert_eq!(sum, gaps["count"].as_u64().unwrap());
    assert!(bins.windows(2).all(|w| w[0]["to_mm"] == w[1]["from_mm"]));
    let exceeding = report["findings"].as_array().unwrap().iter().filter(|f| f["exceeds"] == true).count();
    assert_eq!(exceeding as u64, gaps["above_tolerance"].as_u64().unwrap());
    for finding in report["findings"].as_array().unwrap() {
        assert_eq!(finding["gap"].is_null(), finding["sides"].as_array().unwrap().len() == 1);
    }
    fits_the_schema(&report, &found);
}

#[test]
fn exit_codes_and_lines() {
    let files = ["bounded_143_hole.igs", "bounded_143_senses.igs"].map(own);
    let [a, b] = [files[0].as_str(), files[1].as_str()];
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.igs");
    let missing = missing.to_str().unwrap();
    let (code, out, _) = check(&[a, b]);
    let lines: Vec<Value> = out.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert_eq!(lines.len(), 2, "{out}");
    assert_eq!((lines[0]["file"].as_str(), lines[1]["file"].as_str()), (Some(a), Some(b)));
    assert!(code <= 1);
    // A file that cannot be read does not stop the others.
    let (code, out, err) = check(&[missing, a]);
    assert_eq!((code, out.lines().count()), (2, 2));
    assert!(err.contains("missing.igs") && out.contains("no such file"), "{err} {out}");
    let empty = folder.path().join("empty.igs");
    fs::write(&empty, "").unwrap();
    assert_eq!(check(&[empty.to_str().unwrap()]).0, 2);
    for bad in ["0", "-1um", "ten", "nan"] {
        assert_eq!(check(&[a, &format!("--tolerance={bad}")]).0, 2, "{bad}");
    }
    assert_eq!(check(&[]).0, 2);
    assert_eq!(check(&[a, "--html", "no/such/folder/a.html"]).0, 2);
    // Squares with nothing beside them: only --naked minds.
    let (code, out, _) = check(&[a, "--naked"]);
    assert_eq!(code, 1, "{out}");
    assert!(out.contains("naked"), "{out}");
}

#[test]
fn the_page_holds_everything_it_shows() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("gaps.html");
    let pictures = folder.path().join("pictures");
    let argument = format!("--pictures={}", pictures.display());
    check(&["demo", "--html", page.to_str().unwrap(), &argument]);
    let text = fs::read_to_string(&page).unwrap();
    assert!(text.starts_with("<!doctype html>") && text.trim_end().ends_with("</html>"));
    for outside in ["src=\"http", "href=", "url(", "@import"] {
        assert!(!text.contains(outside), "{outside}");
    }
    let shown = text.matches("data:image/png;base64,").count();
    let written = fs::read_dir(&pictures).unwrap().count();
    assert_eq!(shown, written);
    for tag in ["section", "figure", "table", "svg", "div", "tr", "main"] {
        assert_eq!(
            text.matches(&format!("<{tag}")).count(),
            text.matches(&format!("</{tag}>")).count(),
            "{tag}"
        );
    }
}

/// (file, shared, naked): figures that shall not change unnoticed.
const FIGURES: [(&str, usize, usize); 1] = [("gpucast_part.igs", 300, 46)];

#[test]
fn figures_of_real_models_are_stable() {
    let Some(folder) = truth::models() else {
        println!("not run: no shared/models here");
        return;
    };
    let mut names: Vec<String> = fs::read_dir(folder.join("files"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .filter(|n| n.ends_with(".igs") || n.ends_with(".iges"))
        .collect();
    names.sort();
    assert!(names.len() >= 13);
    for name in names {
        let (model, _) = iges::read(&folder.join("files").join(&name)).unwrap();
        let inspection = Inspection::in_unit(&model.faces, model.unit.millimetres);
        let statistics = Statistics::of(&inspection);
        let curves: f64 = inspection.edges().flat_map(|e| &e.1.uses).map(|u| u.length).sum();
        assert!(curves.is_finite() && curves > 0.0, "{name}");
        for (_, edge) in inspection.edges() {
            assert_eq!(
                edge.gap.is_some(),
                edge.uses.len() > 1 && edge.kind != EdgeKind::Degenerate,
                "{name}"
            );
        }
        if let Some((_, shared, naked)) = FIGURES.iter().find(|f| f.0 == name) {
            assert_eq!((statistics.shared.count, statistics.naked.count), (*shared, *naked), "{name}");
        }
    }
}
