//! `hairline classify`: a filter from lines `face u v` to lines `in`, `out`, `on`.
//!
//! Streams: memory does not grow with the input, and answers are flushed whenever the input runs
//! dry, so that another program can hold a conversation with it.

use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};

use super::arguments::ClassifyArguments;
use super::failure::{Failure, plain};
use super::progress::Progress;
use super::source;
use crate::kernel::face::Side;
use crate::kernel::query::Locator;

/// Answers standard input on standard output.
///
/// # Errors
/// The model cannot be read, a line is bad, or standard output cannot be written.
pub fn run(arguments: &ClassifyArguments) -> Result<(), Failure> {
    let progress = Progress::start(format!("reading {}", arguments.file.display()));
    let opened = source::open(&arguments.file, &|part| progress.set(part))?;
    drop(progress);
    let records = &opened.model.faces;
    // Faces are made ready when first asked for: a few questions to a large model cost little.
    let mut ready: Vec<Option<Locator>> = records.iter().map(|_| None).collect();
    answer(io::stdin().lock(), io::stdout().lock(), records.len(), |face, u, v| {
        if ready[face].is_none() {
            let derived = records[face].derive().map_err(|e| format!("face {}: {e}", face + 1))?;
            ready[face] = Some(Locator::new(derived));
        }
        Ok(ready[face].as_ref().map_or(Side::Out, |locator| locator.classify_native(u, v)))
    })
}

/// Reads `face u v` lines from `input` and writes `classify(face - 1, u, v)` for each to `output`.
///
/// # Errors
/// [`Failure::Line`] for a line that is not three numbers or names no face of `1..=faces`, and when
/// `classify` fails.
pub fn answer(
    input: impl Read,
    output: impl Write,
    faces: usize,
    mut classify: impl FnMut(usize, f64, f64) -> Result<Side, String>,
) -> Result<(), Failure> {
    let mut input = BufReader::with_capacity(1 << 16, input);
    let mut output = BufWriter::with_capacity(1 << 16, output);
    let mut line = Vec::new();
    for number in 1.. {
        if !input.buffer().contains(&b'\n') {
            output.flush().map_err(|e| Failure::stdout(&e))?;
        }
        line.clear();
        // A line longer than any sensible one is refused instead of filling the memory.
        let length = input
            .by_ref()
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut line)
            .map_err(|e| Failure::Line { line: number, reason: plain(&e) })?;
        if length == 0 {
            break;
        }
        let side = parse(&line, faces)
            .and_then(|query| query.map(|(face, u, v)| classify(face, u, v)).transpose())
            .map_err(|reason| {
                // Answers given so far must reach the reader before the complaint.
                let _ = output.flush();
                Failure::Line { line: number, reason }
            })?;
        if let Some(side) = side {
            output.write_all(word(side)).map_err(|e| Failure::stdout(&e))?;
        }
    }
    output.flush().map_err(|e| Failure::stdout(&e))
}

fn word(side: Side) -> &'static [u8] {
    match side {
        Side::In => b"in\n",
        Side::Out => b"out\n",
        Side::On => b"on\n",
    }
}

const LONGEST_LINE: u64 = 4096;

/// The position of the face (from 0) and the parameters of a line; `None` for blanks and comments.
fn parse(line: &[u8], faces: usize) -> Result<Option<(usize, f64, f64)>, String> {
    if line.len() as u64 == LONGEST_LINE {
        return Err(format!("the line is longer than {LONGEST_LINE} bytes"));
    }
    let text = std::str::from_utf8(line).map_err(|_| "the line is not text".to_string())?.trim();
    if text.is_empty() || text.starts_with('#') {
        return Ok(None);
    }
    let mut words = text.split([' ', '\t', ',', ';']).filter(|w| !w.is_empty());
    let (Some(face), Some(u), Some(v), None) = (words.next(), words.next(), words.next(), words.next())
    else {
        return Err(format!("expected `face u v`, found `{}`", shortened(text)));
    };
    let face = match face.parse::<usize>() {
        Ok(face) if (1..=faces).contains(&face) => face - 1,
        _ if faces == 0 => return Err("the model has no faces".into()),
        _ => return Err(format!("there is no face `{}`; faces are numbered 1 to {faces}", shortened(face))),
    };
    let coordinate = |name, word: &str| match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("{name} is not a finite number: `{}`", shortened(word))),
    };
    Ok(Some((face, coordinate("u", u)?, coordinate("v", v)?)))
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers(text: &str) -> (String, Result<(), Failure>) {
        let mut output = Vec::new();
        let result = answer(text.as_bytes(), &mut output, 2, |face, u, v| {
            Ok(match face {
                0 if u < v => Side::In,
                0 => Side::Out,
                _ => Side::On,
            })
        });
        (String::from_utf8(output).expect("text"), result)
    }

    #[test]
    fn answers_in_order_with_blanks_comments_and_a_missing_last_newline() {
        let (text, result) = answers("1 0 1\n\n# a remark\n1\t1, 0\r\n  2 1e3 -.5");
        assert_eq!(text, "in\nout\non\n");
        result.expect("all lines are good");
    }

    #[test]
    fn the_first_bad_line_is_named_after_the_answers_before_it() {
        for (bad, hint) in [
            ("1 2", "expected `face u v`"),
            ("1 2 3 4", "expected `face u v`"),
            ("0 1 1", "numbered 1 to 2"),
            ("3 1 1", "numbered 1 to 2"),
            ("1.5 1 1", "numbered 1 to 2"),
            ("1 nan 1", "u is not a finite"),
            ("1 1 inf", "v is not a finite"),
            ("1 1 1e999", "v is not a finite"),
        ] {
            let (text, result) = answers(&format!("1 0 1\n\n{bad}\n1 0 1\n"));
            let message = result.expect_err(bad).to_string();
            assert_eq!(text, "in\n", "{bad}");
            assert!(message.contains("line 3") && message.contains(hint), "{message}");
        }
    }

    #[test]
    fn endless_and_binary_lines_are_refused() {
        let (_, result) = answers(&"1".repeat(1 << 20));
        assert!(result.expect_err("too long").to_string().contains("longer than"));
        let mut output = Vec::new();
        let result = answer(&b"\xff\xfe\n"[..], &mut output, 2, |_, _, _| Ok(Side::In));
        assert!(result.expect_err("binary").to_string().contains("not text"));
    }
}
