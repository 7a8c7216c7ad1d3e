//! Finding commands by a few letters of their name.
//!
//! All letters must come in order. Letters that begin a word, and letters that follow each other, count most, so that
//! `ik` finds "Insert knot" before anything else with an i and a k.

use super::command::{COMMANDS, Command};

/// Commands that match `text`, best first; all of them in menu order for an empty text.
pub fn find(text: &str) -> Vec<&'static Command> {
    let wanted: Vec<char> =
        text.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect();
    let name = |c: &Command| format!("{} {}", c.label, c.menu.label());
    let mut found: Vec<(i32, &Command)> =
        COMMANDS.iter().filter_map(|c| Some((score(&wanted, &name(c))?, c))).collect();
    found.sort_by_key(|(score, _)| -score);
    found.into_iter().map(|(_, command)| command).collect()
}

/// How well `wanted` fits `name`: the best over all places of the first letter; `None` if it does not.
fn score(wanted: &[char], name: &str) -> Option<i32> {
    let letters: Vec<char> = name.chars().flat_map(char::to_lowercase).collect();
    let Some(first) = wanted.first() else { return Some(0) };
    let starts = letters.iter().enumerate().filter(|(_, c)| *c == first).map(|(k, _)| k);
    starts.filter_map(|start| score_from(wanted, &letters, start)).max()
}

fn score_from(wanted: &[char], letters: &[char], start: usize) -> Option<i32> {
    let begins = |k: usize| k == 0 || !letters[k - 1].is_alphanumeric();
    let (mut at, mut sum) = (start, 0);
    for (k, letter) in wanted.iter().enumerate() {
        let mut rest = (at..letters.len()).filter(|i| letters[*i] == *letter);
        let next = rest.next()?;
        // The next letter, or the next beginning of a word with it.
        let place = if next == at {
            next
        } else {
            [next].into_iter().chain(rest).find(|i| begins(*i)).unwrap_or(next)
        };
        sum += match (k > 0 && place == at, begins(place)) {
            (_, true) => 8,
            (true, false) => 5,
            (false, false) => 0,
        };
        at = place + 1;
    }
    Some(sum - (letters.len() as i32) / 8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_letters_find_the_command() {
        for (text, id) in [
            ("ik", "curve.insert_knot"),
            ("insert kn", "curve.insert_knot"),
            ("save", "file.save"),
            ("saveas", "file.save_as"),
            ("untrim f", "loop.untrim"),
            ("undo", "edit.undo"),
            ("circ", "loop.circle"),
        ] {
            assert_eq!(find(text).first().map(|c| c.id), Some(id), "{text}");
        }
        assert_eq!(find("").len(), COMMANDS.len());
        assert!(find("qqqq").is_empty());
    }
}
