//! Edit scripts: lists of operations as JSON, for tests and batch work.
//!
//! A script is an array of steps; a step is an object with the field `op` and the fields of that
//! [`Operation`], positions counted from 1. Errors name the step and the field.

use serde_json::{Map, Value};

use super::Operation;
use crate::scene::file::spans;

/// Why a text is no script.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ScriptError {
    /// The text is no JSON array of objects.
    #[error("line {line}, column {column}: expected {expected}")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// What should stand there.
        expected: String,
    },
    /// A step is not an operation.
    #[error("step {step}{}, line {line}: {}{reason}", if .op.is_empty() { String::new() } else { format!(" ({op})") }, if .field.is_empty() { String::new() } else { format!("{field}: ") })]
    Step {
        /// Number of the step, from 1.
        step: usize,
        /// Line where it begins, from 1.
        line: usize,
        /// What it asks for.
        op: String,
        /// The field that is wrong, `points[1].curve` say.
        field: String,
        /// What is wrong.
        reason: String,
    },
}

/// Reads a script.
///
/// # Errors
/// See [`ScriptError`].
pub fn parse(text: &str) -> Result<Vec<Operation>, ScriptError> {
    let syntax = |broken: spans::Broken| {
        let (line, column) = spans::line_and_column(text, broken.at);
        ScriptError::Syntax { line, column, expected: broken.expected.into() }
    };
    let steps = spans::elements(text, 0..text.len()).map_err(syntax)?;
    let read = |(number, range): (usize, std::ops::Range<usize>)| {
        let start = range.start;
        let members = spans::members(text, range).map_err(syntax)?;
        // Lines are counted for errors only: counting them for each step would take the square of their number.
        let fail = |op: &str, field: &str, reason: String| ScriptError::Step {
            step: number + 1,
            line: spans::line_and_column(text, start).0,
            op: op.into(),
            field: field.into(),
            reason,
        };
        let named = members.iter().filter(|m| m.key == "op").map(|m| &text[m.value.clone()]);
        let op = match named.collect::<Vec<_>>()[..] {
            [op] => serde_json::from_str::<String>(op)
                .map_err(|_| fail("", "op", "must be the name of an operation, in quotes".into()))?,
            [] => return Err(fail("", "", "the field `op`, which names the operation, is missing".into())),
            _ => return Err(fail("", "op", "is there twice".into())),
        };
        // The form that serde derives: the name, then the fields.
        let fields = members.iter().filter(|m| m.key != "op");
        let fields: Vec<String> =
            fields.map(|m| format!("\"{}\":{}", m.key, &text[m.value.clone()])).collect();
        let name = Value::from(op.as_str());
        let step = format!("{{{name}:{{{}}}}}", fields.join(","));
        serde_json::from_str::<Operation>(&step).map_err(|error| {
            let at = spans::offset(&step, error.line(), error.column());
            let path = spans::path_at(&step, at);
            let field = path.strip_prefix(op.as_str()).unwrap_or_default().trim_start_matches('.');
            let message = error.to_string();
            let reason = message.split(" at line ").next().unwrap_or(&message);
            let reason = match reason.split_once("unknown variant ") {
                Some((_, rest)) if field.is_empty() => format!("there is no operation {rest}"),
                _ => reason.to_owned(),
            };
            fail(&op, field, reason)
        })
    };
    steps.into_iter().enumerate().map(read).collect()
}

/// The script of operations, a step to a line.
pub fn to_text(operations: &[Operation]) -> String {
    let steps: Vec<String> =
        operations.iter().map(|operation| Value::Object(step(operation)).to_string()).collect();
    format!("[\n{}\n]\n", steps.join(",\n"))
}

/// The name by which scripts call an operation.
pub fn name(operation: &Operation) -> String {
    match step(operation).get("op") {
        Some(Value::String(name)) => name.clone(),
        _ => String::new(),
    }
}

fn step(operation: &Operation) -> Map<String, Value> {
    let mut step = Map::new();
    if let Ok(Value::Object(tagged)) = serde_json::to_value(operation) {
        for (op, fields) in tagged {
            step.insert("op".into(), Value::from(op));
            if let Value::Object(fields) = fields {
                step.extend(fields);
            }
        }
    }
    step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_step_and_field() {
        let good = r#"{"op": "untrim", "face": 1}"#;
        let message = |step: &str| parse(&format!("[{good},\n {step}]")).expect_err("bad").to_string();
        for (step, expected) in [
            (r#"{"face": 1}"#, "step 2, line 2: the field `op`, which names the operation, is missing"),
            (r#"{"op": 3}"#, "step 2, line 2: op: must be the name of an operation"),
            (r#"{"op": "fly", "face": 1}"#, "step 2 (fly), line 2: there is no operation `fly`"),
            (r#"{"op": "untrim"}"#, "step 2 (untrim), line 2: missing field `face`"),
            (r#"{"op": "untrim", "face": 0}"#, "step 2 (untrim), line 2: face: faces count from 1"),
            (r#"{"op": "untrim", "face": 1, "x": 2}"#, "step 2 (untrim), line 2: unknown field `x`"),
            (
                r#"{"op": "set_weight", "face": 1, "points": [{"loop": 1, "curve": "a", "point": 1}], "weight": 1}"#,
                "step 2 (set_weight), line 2: points[1].curve: invalid type: string \"a\"",
            ),
            (
                r#"{"op": "set_weight", "face": 1, "points": [{"loop": 0, "curve": 1, "point": 1}], "weight": 1}"#,
                "step 2 (set_weight), line 2: points[1].loop: numbers count from 1",
            ),
            (r#"{"op": "untrim", "face": }"#, "line 2, column 27: expected a value"),
            ("3", "line 2, column 2: expected an object"),
        ] {
            assert!(message(step).starts_with(expected), "{}", message(step));
        }
        assert_eq!(parse("{}").expect_err("no list").to_string(), "line 1, column 1: expected an array");
        assert!(parse("[").is_err() && parse("").is_err() && parse("[] x").is_err());
        assert_eq!(parse(" [ ] ").expect("empty"), []);
    }

    #[test]
    fn scripts_come_back_from_their_text() {
        let text = r#"[{"op": "untrim", "face": [2, 3]}, {"op": "add_loop", "face": 4, "role": "inner",
            "shape": {"circle": {"centre": [0.1, -0.0], "radius": 1e-300}}}]"#;
        let operations = parse(text).expect("a script");
        assert_eq!(parse(&to_text(&operations)).expect("as written"), operations);
        assert_eq!(name(&operations[1]), "add_loop");
    }
}
