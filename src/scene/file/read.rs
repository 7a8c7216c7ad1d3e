//! From the bytes of a file to its scene.

use std::io::Read;
use std::ops::Range;

use rayon::prelude::*;
use ruzstd::decoding::StreamingDecoder;
use serde::de::DeserializeOwned;

use super::spans::{self, Broken, Member, Outline};
use super::{FORMAT, ZSTANDARD, migration};
use crate::scene::document::SceneRecord;
use crate::scene::records::{FaceRecord, ModelRecord};

/// Text of a scene at most, bytes: a few bytes can be made to unpack to any number of them.
const MOST_UNPACKED: u64 = 8 << 30;

/// Why bytes are no scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReadError {
    /// The file is something else.
    #[error("it is not a Hairline scene: {reason}")]
    NotAScene {
        /// What is missing.
        reason: String,
    },
    /// A later version of the program wrote it.
    #[error(
        "it was written by a newer version of Hairline ({program}) in format {version}; this version reads formats up to {FORMAT}"
    )]
    Newer {
        /// Format.
        version: u64,
        /// Version of the program that wrote it.
        program: String,
    },
    /// The packed data are incomplete or wrong.
    #[error("the packed data are damaged: {reason}")]
    Packed {
        /// What the decoder said.
        reason: String,
    },
    /// The text is damaged.
    #[error("line {line}, column {column}{}: {reason}", if .path.is_empty() { String::new() } else { format!(" (in {})", .path) })]
    Damaged {
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// Which part of the scene, elements counted from 1.
        path: String,
        /// What is wrong there.
        reason: String,
    },
}

pub(super) fn from_bytes(bytes: &[u8]) -> Result<SceneRecord, ReadError> {
    let unpacked;
    let bytes = if bytes.starts_with(&ZSTANDARD) {
        unpacked = unpack(bytes)?;
        &unpacked
    } else {
        bytes
    };
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let valid = std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
        damaged(valid, valid.len(), "these bytes are not UTF-8 text".into())
    })?;
    from_text(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// Unpacks all frames.
fn unpack(mut bytes: &[u8]) -> Result<Vec<u8>, ReadError> {
    let mut out = Vec::new();
    while !bytes.is_empty() {
        let fail = |reason: String| ReadError::Packed { reason };
        let mut decoder = StreamingDecoder::new(&mut bytes).map_err(|e| fail(e.to_string()))?;
        let room = MOST_UNPACKED.saturating_sub(out.len() as u64);
        decoder.by_ref().take(room + 1).read_to_end(&mut out).map_err(|e| fail(e.to_string()))?;
        if out.len() as u64 > MOST_UNPACKED {
            return Err(fail(format!("more than {} GiB when unpacked", MOST_UNPACKED >> 30)));
        }
        let (told, found) = {
            let frame = &decoder.decoder;
            (frame.get_checksum_from_data(), frame.get_calculated_checksum())
        };
        if told.is_some() && told != found {
            return Err(fail("the checksum does not fit".into()));
        }
    }
    Ok(out)
}

/// The scene of a text in this or an older format.
pub(super) fn from_text(text: &str) -> Result<SceneRecord, ReadError> {
    // The first line tells what it is, also of a file cut short; other layouts are read as a whole.
    let mut first = head(text);
    if !first.iter().any(|m| m.key == "version") {
        first = spans::members(text, 0..text.len()).unwrap_or(first);
    }
    let of = |key: &str| first.iter().find(|m| m.key == key).map(|m| &text[m.value.clone()]);
    if of("hairline") != Some("\"scene\"") {
        return Err(ReadError::NotAScene { reason: "it does not begin with {\"hairline\":\"scene\"".into() });
    }
    let Some(version) = of("version").and_then(|v| v.parse::<u64>().ok()) else {
        return Err(ReadError::NotAScene { reason: "it does not tell its version".into() });
    };
    if version > FORMAT {
        let program = of("program").unwrap_or("unknown").trim_matches('"').to_owned();
        return Err(ReadError::Newer { version, program });
    }
    if version < FORMAT {
        let migrated = migration::migrated(text, version);
        return from_text(&migrated.map_err(|e| of_serde(text, &(0..text.len()), &e))?);
    }
    scene(text, spans::outline(text).map_err(|broken| of_broken(text, broken))?)
}

/// What can be told of the beginning of a broken text.
fn head(text: &str) -> Vec<Member<'_>> {
    let end = text.find('\n').unwrap_or(text.len());
    let line = text[..end].trim_end().trim_end_matches(',');
    let Some(comma) = line.rfind(',') else { return Vec::new() };
    [line, &line[..comma]]
        .iter()
        .find_map(|line| {
            let closed = format!("{line}}}");
            let members = spans::members(&closed, 0..closed.len()).ok()?;
            // The spans are the same in the text itself.
            Some(
                members
                    .into_iter()
                    .map(|m| {
                        let start = m.key.as_ptr() as usize - closed.as_ptr() as usize;
                        Member { key: &text[start..start + m.key.len()], value: m.value }
                    })
                    .collect(),
            )
        })
        .unwrap_or_default()
}

fn scene(text: &str, outline: Outline) -> Result<SceneRecord, ReadError> {
    let Outline { members, models } = outline;
    let mut scene = SceneRecord::default();
    let mut seen: Vec<&str> = Vec::new();
    for Member { key, value } in members {
        once(text, &mut seen, key, &value)?;
        match key {
            "hairline" | "version" | "program" => {}
            "camera" => scene.camera = parse(text, &value)?,
            "views" => scene.views = parse(text, &value)?,
            "display" => scene.display = parse(text, &value)?,
            "hidden" => scene.hidden = parse(text, &value)?,
            // Read below.
            "models" => {}
            _ => return Err(unknown(text, key, &value)),
        }
    }
    scene.models =
        models.into_iter().map(|(members, faces)| model(text, members, &faces)).collect::<Result<_, _>>()?;
    Ok(scene)
}

fn model(text: &str, members: Vec<Member>, faces: &[Range<usize>]) -> Result<ModelRecord, ReadError> {
    let mut model = ModelRecord::default();
    let mut seen: Vec<&str> = Vec::new();
    for Member { key, value } in members {
        once(text, &mut seen, key, &value)?;
        match key {
            "name" => model.name = parse(text, &value)?,
            "unit" => model.unit = parse(text, &value)?,
            "parts" => model.parts = parse(text, &value)?,
            "faces" => {
                let read: Result<Vec<FaceRecord>, _> =
                    faces.par_iter().with_min_len(32).map(|f| parse(text, f)).collect();
                model.faces = read?;
            }
            _ => return Err(unknown(text, key, &value)),
        }
    }
    Ok(model)
}

fn parse<T: DeserializeOwned>(text: &str, range: &Range<usize>) -> Result<T, ReadError> {
    serde_json::from_str(&text[range.clone()]).map_err(|e| of_serde(text, range, &e))
}

/// Refuses a key that was there before.
fn once<'t>(
    text: &'t str,
    seen: &mut Vec<&'t str>,
    key: &'t str,
    value: &Range<usize>,
) -> Result<(), ReadError> {
    if seen.contains(&key) {
        return Err(damaged(text, value.start, format!("`{key}` is there twice")));
    }
    seen.push(key);
    Ok(())
}

fn unknown(text: &str, key: &str, value: &Range<usize>) -> ReadError {
    damaged(text, value.start, format!("unknown field `{key}`"))
}

fn of_broken(text: &str, broken: Broken) -> ReadError {
    damaged(text, broken.at, format!("expected {}", broken.expected))
}

/// serde's error in the part of `text` at `range`.
fn of_serde(text: &str, range: &Range<usize>, error: &serde_json::Error) -> ReadError {
    let part = &text[range.clone()];
    let at = range.start + spans::offset(part, error.line(), error.column());
    let message = error.to_string();
    // Its own line and column are of the part; ours are of the file.
    let reason = message.split(" at line ").next().unwrap_or(&message).to_owned();
    damaged(text, at, reason)
}

fn damaged(text: &str, at: usize, reason: String) -> ReadError {
    let (line, column) = spans::line_and_column(text, at);
    ReadError::Damaged { line, column, path: spans::path_at(text, at), reason }
}
