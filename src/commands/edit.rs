//! `hairline edit`: applies a script of operations to a scene, without a window.

use std::fs;
use std::io::{Read, Write};
use std::path::Path;

use serde_json::json;

use super::arguments::EditArguments;
use super::convert::{Format, format_of, iges, scene as save_scene};
use super::failure::{Failure, plain};
use super::output::check_writable;
use super::source;
use crate::exchange::iges::write::WriteOptions;
use crate::kernel::trim::validity::{LoopProblem, Severity};
use crate::scene::operation::{Operation, script};
use crate::scene::{Change, Document, Edit, FaceId, SceneRecord};

/// Reads the scene and the script, applies all steps, and writes the result whole or not at all.
///
/// # Errors
/// A file cannot be read, the script is none, a step is refused (with its number), or the result cannot
/// be written. Nothing is written then.
pub fn run(arguments: &EditArguments) -> Result<(), Failure> {
    let format = match &arguments.output {
        Some(output) => {
            let format = format_of(output)?;
            check_writable(output)?;
            Some((output, format))
        }
        None if arguments.dry_run => None,
        None => {
            let reason = "name the file to write with -o, or look at what would change with --dry-run".into();
            return Err(Failure::Usage { reason });
        }
    };
    let text = read_script(&arguments.script)?;
    let input = |reason: String| Failure::Input { path: arguments.script.clone(), reason };
    let operations = script::parse(&text).map_err(|e| input(e.to_string()))?;
    let opened = source::open_scene(&arguments.file, &|_| ())?;
    if let Some(line) = source::remarks_line(&arguments.file, &opened.report) {
        eprintln!("hairline: {line}");
    }
    let mut scene = opened.scene;
    let mut lines = Vec::new();
    let mut touched: Vec<FaceId> = Vec::new();
    for (number, operation) in operations.iter().enumerate() {
        let step = number + 1;
        let fail = |reason: String| input(format!("step {step} ({}): {reason}", script::name(operation)));
        let edit = operation.perform(&scene).map_err(|e| fail(e.to_string()))?;
        edit.apply(&mut scene).map_err(|e| fail(e.to_string()))?;
        lines.push(told(&scene, step, operation, &edit, arguments.json));
        touched.extend(edit.faces());
    }
    touched.sort_unstable();
    touched.dedup();
    lines.extend(problems(&scene, &touched, arguments.json));
    if let (Some((output, format)), false) = (format, arguments.dry_run) {
        match format {
            Format::Scene => save_scene(&scene, output)?,
            Format::Iges => {
                let file_name =
                    output.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
                iges(&scene.into_model(), output, &WriteOptions { file_name, ..WriteOptions::default() })?;
            }
        }
    }
    let mut out = std::io::stdout().lock();
    lines.iter().try_for_each(|line| writeln!(out, "{line}")).map_err(|e| Failure::stdout(&e))
}

fn read_script(path: &Path) -> Result<String, Failure> {
    let fail = |reason: String| Failure::Input { path: path.into(), reason };
    if path == Path::new("-") {
        let mut text = String::new();
        std::io::stdin().lock().read_to_string(&mut text).map_err(|e| fail(plain(&e)))?;
        return Ok(text);
    }
    let bytes = fs::read(path).map_err(|e| fail(plain(&e)))?;
    String::from_utf8(bytes)
        .map_err(|e| fail(format!("byte {} is not UTF-8 text", e.utf8_error().valid_up_to())))
}

/// Number of a face through all models, as `hairline info` counts.
fn number(scene: &SceneRecord, id: FaceId) -> usize {
    (0..id.model).map(|m| scene.face_count(m)).sum::<usize>() + id.face + 1
}

/// What one step did.
fn told(scene: &SceneRecord, step: usize, operation: &Operation, edit: &Edit, as_json: bool) -> String {
    let mut faces: Vec<usize> = edit.faces().into_iter().map(|id| number(scene, id)).collect();
    let (mut added, mut removed) = (0, 0);
    for change in &edit.changes {
        if let Change::Faces { model, at, before, after } = change {
            (added, removed) = (added + after.len(), removed + before.len());
            // Where they are now; those that went have no number.
            let first = number(scene, FaceId { model: *model, face: *at });
            faces.extend(first..first + after.len());
        }
    }
    if as_json {
        let changed = !edit.is_empty();
        return json!({
            "step": step, "op": script::name(operation), "label": edit.label, "changed": changed,
            "faces": faces, "faces_added": added, "faces_removed": removed,
        })
        .to_string();
    }
    let what = if edit.is_empty() { format!("{} (no change)", edit.label) } else { edit.label.clone() };
    let list = faces.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    match (faces.len(), removed) {
        (0, 0) => format!("step {step}: {what}"),
        (0, count) => format!("step {step}: {what}: {count} removed"),
        (1, _) => format!("step {step}: {what}: face {list}"),
        _ => format!("step {step}: {what}: faces {list}"),
    }
}

/// What is wrong with the loops of the faces that were touched.
fn problems(scene: &SceneRecord, touched: &[FaceId], as_json: bool) -> Vec<String> {
    let found = touched.iter().filter_map(|id| Some((*id, scene.face(*id)?.problems())));
    let each = found.flat_map(|(id, problems)| problems.into_iter().map(move |p| (id, p)));
    each.filter(|(_, p)| p.severity() > Severity::Note)
        .map(|(id, problem)| {
            let face = number(scene, id);
            let LoopProblem { at, uv, .. } = problem;
            let severity = match problem.severity() {
                Severity::Error => "error",
                _ => "warning",
            };
            if as_json {
                return json!({
                    "problem": problem.to_string(), "severity": severity, "face": face,
                    "loop": at.trim_loop + 1, "curve": at.curve + 1, "uv": [uv.x, uv.y],
                })
                .to_string();
            }
            format!("{severity}: face {face}, {problem}, at u {} v {}", uv.x, uv.y)
        })
        .collect()
}
