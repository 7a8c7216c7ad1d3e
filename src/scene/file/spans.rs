//! Where things are in a JSON text, without reading them: members of objects, elements of arrays, and the
//! path and line of a place.
//!
//! Lets faces be read in parallel, and errors be told by path. It trusts brackets and quotes only; the
//! values are checked by whoever reads them.

use std::ops::Range;

/// A place where a text stops being JSON.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Broken {
    /// Byte offset.
    pub at: usize,
    /// What was expected there.
    pub expected: &'static str,
}

/// A member of an object: its key (as written, without quotes) and where its value is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member<'t> {
    /// Key.
    pub key: &'t str,
    /// Value.
    pub value: Range<usize>,
}

/// A scene's text in outline, found in one pass.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outline<'t> {
    /// Members of the scene, `models` among them.
    pub members: Vec<Member<'t>>,
    /// Members of each model, `faces` among them, and its faces.
    pub models: Vec<(Vec<Member<'t>>, Vec<Range<usize>>)>,
}

struct Scanner<'t> {
    text: &'t str,
    at: usize,
    end: usize,
}

/// The outline of a whole scene.
///
/// # Errors
/// It is no object, `models` or `faces` no array, or brackets do not match.
pub fn outline(text: &str) -> Result<Outline<'_>, Broken> {
    let mut scanner = Scanner { text, at: 0, end: text.len() };
    let mut outline = Outline::default();
    let models = &mut outline.models;
    let members = &mut outline.members;
    scanner.members(&mut |scanner, key| {
        let start = scanner.at;
        if key == "models" {
            scanner.elements(&mut |scanner| {
                let (mut members, mut faces) = (Vec::new(), Vec::new());
                scanner.members(&mut |scanner, key| {
                    let start = scanner.at;
                    if key == "faces" {
                        scanner.elements(&mut |scanner| {
                            faces.push(scanner.value()?);
                            Ok(())
                        })?;
                    } else {
                        scanner.value()?;
                    }
                    members.push(Member { key, value: start..scanner.at });
                    Ok(())
                })?;
                models.push((members, faces));
                Ok(())
            })?;
        } else {
            scanner.value()?;
        }
        members.push(Member { key, value: start..scanner.at });
        Ok(())
    })?;
    scanner.finish()?;
    Ok(outline)
}

/// The members of the object at `range` of `text`.
///
/// # Errors
/// It is no object, or its brackets do not match.
pub fn members<'t>(text: &'t str, range: Range<usize>) -> Result<Vec<Member<'t>>, Broken> {
    let mut scanner = Scanner { text, at: range.start, end: range.end };
    let mut members = Vec::new();
    scanner.members(&mut |scanner, key| {
        members.push(Member { key, value: scanner.value()? });
        Ok(())
    })?;
    scanner.finish()?;
    Ok(members)
}

/// The elements of the array at `range` of `text`.
///
/// # Errors
/// It is no array, or its brackets do not match.
pub fn elements(text: &str, range: Range<usize>) -> Result<Vec<Range<usize>>, Broken> {
    let mut scanner = Scanner { text, at: range.start, end: range.end };
    let mut elements = Vec::new();
    scanner.elements(&mut |scanner| {
        elements.push(scanner.value()?);
        Ok(())
    })?;
    scanner.finish()?;
    Ok(elements)
}

/// Line and column, both from 1, of a byte offset.
pub fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = &text.as_bytes()[..at.min(text.len())];
    let line = before.iter().filter(|b| **b == b'\n').count() + 1;
    let start = before.iter().rposition(|b| *b == b'\n').map_or(0, |p| p + 1);
    (line, before.len() - start + 1)
}

/// Byte offset of a line and column, both from 1.
pub fn offset(text: &str, line: usize, column: usize) -> usize {
    let start = match line {
        0 | 1 => 0,
        _ => text.match_indices('\n').nth(line - 2).map_or(text.len(), |(at, _)| at + 1),
    };
    (start + column.saturating_sub(1)).min(text.len())
}

/// The path of the innermost value at a byte offset, elements counted from 1: `models[1].faces[3].loops`.
pub fn path_at(text: &str, at: usize) -> String {
    let (mut path, mut range) = (String::new(), 0..text.len());
    let holds = |value: &Range<usize>| value.start <= at && at <= value.end;
    loop {
        if let Ok(members) = members(text, range.clone()) {
            let Some(inner) = members.into_iter().find(|m| holds(&m.value)) else { break };
            if !path.is_empty() {
                path.push('.');
            }
            path.push_str(inner.key);
            range = inner.value;
        } else if let Ok(elements) = elements(text, range.clone()) {
            let Some(number) = elements.iter().position(holds) else { break };
            path.push_str(&format!("[{}]", number + 1));
            range = elements[number].clone();
        } else {
            break;
        }
    }
    path
}

impl<'t> Scanner<'t> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied().filter(|_| self.at < self.end)
    }

    fn blank(&mut self) {
        while self.peek().is_some_and(|b| b.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    fn broken<T>(&self, expected: &'static str) -> Result<T, Broken> {
        Err(Broken { at: self.at, expected })
    }

    fn expect(&mut self, byte: u8, expected: &'static str) -> Result<(), Broken> {
        self.blank();
        if self.peek() != Some(byte) {
            return self.broken(expected);
        }
        self.at += 1;
        self.blank();
        Ok(())
    }

    /// Nothing but blanks may follow.
    fn finish(&mut self) -> Result<(), Broken> {
        self.blank();
        if self.at < self.end { self.broken("the end") } else { Ok(()) }
    }

    /// An object; `member` is called at the beginning of each value and reads it.
    fn members(
        &mut self,
        member: &mut dyn FnMut(&mut Self, &'t str) -> Result<(), Broken>,
    ) -> Result<(), Broken> {
        let text = self.text;
        self.list(b'{', b'}', ["an object", "`,` or `}`"], &mut |scanner| {
            let key = scanner.string()?;
            scanner.expect(b':', "`:`")?;
            member(scanner, &text[key.start + 1..key.end - 1])
        })
    }

    /// An array; `element` is called at the beginning of each element and reads it.
    fn elements(&mut self, element: &mut dyn FnMut(&mut Self) -> Result<(), Broken>) -> Result<(), Broken> {
        self.list(b'[', b']', ["an array", "`,` or `]`"], element)
    }

    fn list(
        &mut self,
        open: u8,
        close: u8,
        [what, separator]: [&'static str; 2],
        item: &mut dyn FnMut(&mut Self) -> Result<(), Broken>,
    ) -> Result<(), Broken> {
        self.expect(open, what)?;
        if self.peek() == Some(close) {
            self.at += 1;
            return Ok(());
        }
        loop {
            item(self)?;
            self.blank();
            match self.peek() {
                Some(b',') => self.at += 1,
                Some(b) if b == close => {
                    self.at += 1;
                    return Ok(());
                }
                _ => return self.broken(separator),
            }
            self.blank();
        }
    }

    fn string(&mut self) -> Result<Range<usize>, Broken> {
        let start = self.at;
        if self.peek() != Some(b'"') {
            return self.broken("a key in quotes");
        }
        self.at += 1;
        loop {
            match self.peek() {
                None => return self.broken("the end of a text in quotes"),
                Some(b'\\') => self.at += 2,
                Some(b'"') => break,
                Some(_) => self.at += 1,
            }
        }
        self.at += 1;
        Ok(start..self.at)
    }

    /// Passes over one value: a text, a number or a word up to the next mark, or brackets up to their match.
    fn value(&mut self) -> Result<Range<usize>, Broken> {
        let start = self.at;
        match self.peek() {
            Some(b'"') => return self.string(),
            Some(b'{' | b'[') => {}
            Some(b',' | b':' | b'}' | b']') | None => return self.broken("a value"),
            Some(_) => {
                while self.peek().is_some_and(|b| !b",:]}[{\" \n\r\t".contains(&b)) {
                    self.at += 1;
                }
                return Ok(start..self.at);
            }
        }
        let bytes = &self.text.as_bytes()[..self.end];
        let mut depth = 0usize;
        while let Some(byte) = bytes.get(self.at) {
            match byte {
                b'"' => {
                    self.string()?;
                    continue;
                }
                b'{' | b'[' => depth += 1,
                b'}' | b']' => depth -= 1,
                _ => {}
            }
            self.at += 1;
            if depth == 0 {
                return Ok(start..self.at);
            }
        }
        self.broken("more: the text ends in the middle")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_members_elements_and_paths() {
        let text = r#" {"a": [1, {"b\"}": "x,]"}, []], "c" : -1.5e3 , "d":{}}"#;
        let all = members(text, 0..text.len()).expect("an object");
        let seen: Vec<_> = all.iter().map(|m| (m.key, &text[m.value.clone()])).collect();
        assert_eq!(seen, [("a", r#"[1, {"b\"}": "x,]"}, []]"#), ("c", "-1.5e3"), ("d", "{}")]);
        let inner = elements(text, all[0].value.clone()).expect("an array");
        assert_eq!(
            inner.iter().map(|r| &text[r.clone()]).collect::<Vec<_>>(),
            ["1", r#"{"b\"}": "x,]"}"#, "[]"]
        );
        assert_eq!(path_at(text, text.find("x,]").expect("there")), r#"a[2].b\"}"#);
        assert_eq!(line_and_column("ab\ncd", 4), (2, 2));
        assert_eq!(offset("ab\ncd", 2, 2), 4);
    }

    #[test]
    fn broken_texts_are_told_and_never_panic() {
        let text = r#"{"a": [1, {"b": "x"}, []], "c": -1.5}"#;
        for end in 0..text.len() {
            assert!(members(&text[..end], 0..end).is_err(), "{end}");
        }
        for bad in ["{\"a\":1,}", "{\"a\" 1}", "{a:1}", "{} x", "[1]", "{\"a\":\"\\", "{\"a\":]}"] {
            assert!(members(bad, 0..bad.len()).is_err(), "{bad}");
        }
    }
}
