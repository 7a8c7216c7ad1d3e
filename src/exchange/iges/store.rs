//! The entities of a file: finds parameter data on demand, and follows pointers without going in circles.
//!
//! Nothing is parsed until it is asked for, and nothing is kept: a file of 50,000 faces costs the
//! bytes of the file plus its directory. [`Store`] is shared; each face is read by its own [`Reader`].

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::directory::{self, Entry};
use super::error::{EntityError, ReadError};
use super::global::Global;
use super::parameter::{Args, Field, fields};
use super::physical::Physical;
use crate::exchange::report::{Remark, Severity};
use crate::scene::records::EdgeId;

/// Nested references followed for one face before giving up; far above any real face.
const BUDGET: usize = 200_000;
/// Deepest nesting of references followed.
const DEPTH: usize = 64;
/// Characters of parameter data accepted for one entity (1.6 million lines).
const MOST_TEXT: usize = 100_000_000;

/// A file cut into sections, with its directory.
#[derive(Debug)]
pub(crate) struct Store<'a> {
    file: Physical<'a>,
    /// Global section.
    pub global: Global,
    /// Directory, in file order.
    pub entries: Vec<Entry>,
    /// First parameter line of each entry by the back pointers of the lines; only for damaged files.
    by_back_pointer: OnceLock<BTreeMap<i64, usize>>,
    /// Curves of the edge lists (504) met so far: a list is read once, not once for each edge.
    edge_lists: Mutex<BTreeMap<usize, Arc<[i64]>>>,
    /// Number of the first edge of each edge list, and of all edges together.
    edge_numbers: OnceLock<(BTreeMap<usize, u32>, u32)>,
}

impl<'a> Store<'a> {
    /// Splits `bytes` and reads the global section and the directory.
    ///
    /// # Errors
    /// See [`ReadError`].
    pub(crate) fn open(bytes: &'a [u8]) -> Result<Self, ReadError> {
        let file = Physical::split(bytes)?;
        let global = Global::read(&file);
        let entries = directory::read(&file);
        Ok(Self {
            file,
            global,
            entries,
            by_back_pointer: OnceLock::new(),
            edge_lists: Mutex::default(),
            edge_numbers: OnceLock::new(),
        })
    }

    /// Whether the terminate section was there, and the number of lines.
    pub(crate) fn ending(&self) -> (bool, usize) {
        (self.file.terminated, self.file.line_count)
    }

    /// Whether the directory ends in half an entry.
    pub(crate) fn half_entry(&self) -> Option<usize> {
        (self.file.directory.len() % 2 == 1).then(|| self.file.directory.last().map_or(0, |l| l.number))
    }

    /// Directory-entry number of the entry at `index`.
    pub(crate) fn number(index: usize) -> u64 {
        2 * index as u64 + 1
    }

    /// Position of the entry that a pointer means.
    pub(crate) fn index(&self, pointer: i64, what: &'static str) -> Result<usize, EntityError> {
        let index = usize::try_from(pointer).ok().filter(|p| p % 2 == 1).map(|p| (p - 1) / 2);
        index.filter(|i| *i < self.entries.len()).ok_or(EntityError::Pointer { what, target: pointer as f64 })
    }

    /// The parameters of the entry at `index`: where the directory says, or else where the back
    /// pointers of the parameter lines say (some writers get one of the two wrong).
    pub(crate) fn args(&self, index: usize) -> Result<Args, EntityError> {
        let entry = &self.entries[index];
        let number = Self::number(index) as i64;
        let fits =
            |list: &[Field]| matches!(list.first(), Some(Field::Number(k)) if *k == f64::from(entry.kind));
        let lines = &self.file.parameters;
        let claimed = usize::try_from(entry.parameter_start - 1).ok().filter(|s| *s < lines.len());
        let mut found = None;
        if let Some(start) = claimed {
            let list = self.list(start, entry);
            if fits(&list) && !self.belongs_elsewhere(start, number) {
                return Ok(Args::new(list));
            }
            found = Some((start, list));
        }
        if let Some(start) = self.by_back_pointer().get(&number).copied().filter(|s| Some(*s) != claimed) {
            let list = self.list(start, entry);
            if fits(&list) {
                return Ok(Args::new(list));
            }
        }
        let reason = match found {
            Some((_, list)) if fits(&list) => return Ok(Args::new(list)),
            Some((start, list)) => format!(
                "parameter data at line {} begin with {} instead of {}",
                lines[start].number,
                list.first().unwrap_or(&Field::Blank),
                entry.kind
            ),
            None => format!("no parameter line {} for this entry", entry.parameter_start),
        };
        Err(EntityError::Data { reason })
    }

    /// Whether the line's back pointer names another entry of the file, whose own pointer agrees.
    fn belongs_elsewhere(&self, line: usize, number: i64) -> bool {
        let Some(back) = self.back_pointer(line).filter(|b| *b != number) else { return false };
        self.index(back, "back pointer").is_ok_and(|i| self.entries[i].parameter_start - 1 == line as i64)
    }

    /// The fields of the list that starts at parameter line `start`.
    fn list(&self, start: usize, entry: &Entry) -> Vec<Field> {
        let lines = &self.file.parameters;
        let count = usize::try_from(entry.parameter_count).unwrap_or(0).max(1);
        let claimed_end = start.saturating_add(count);
        let own = self.back_pointer(start);
        let mut text = Vec::new();
        let mut position = start;
        // The record delimiter ends the list; the line count of the directory is a hint.
        while position < lines.len() && text.len() < MOST_TEXT {
            if position >= claimed_end && (own.is_none() || self.back_pointer(position) != own) {
                break;
            }
            let part = self.file.text(lines[position], 64);
            text.extend_from_slice(part);
            text.resize(text.len() + 64 - part.len(), b' ');
            position += 1;
            if position >= claimed_end && part.trim_ascii_end().ends_with(&[self.global.delimiters.record]) {
                break;
            }
        }
        fields(&text, self.global.delimiters).0
    }

    /// The curves of the edge list at `index`, read by `read` the first time.
    pub(crate) fn edge_list(
        &self,
        index: usize,
        read: impl FnOnce() -> Result<Vec<i64>, EntityError>,
    ) -> Result<Arc<[i64]>, EntityError> {
        let mut lists = self.edge_lists.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(list) = lists.get(&index) {
            return Ok(list.clone());
        }
        let list: Arc<[i64]> = read()?.into();
        lists.insert(index, list.clone());
        Ok(list)
    }

    /// Numbers for all edges of the file, list by list.
    fn edge_numbers(&self) -> &(BTreeMap<usize, u32>, u32) {
        self.edge_numbers.get_or_init(|| {
            let mut firsts = BTreeMap::new();
            let mut next = 0_u32;
            for (index, _) in self.entries.iter().enumerate().filter(|(_, e)| e.kind == 504) {
                let count = self.args(index).and_then(|mut a| a.count("number of edges", 5)).unwrap_or(0);
                firsts.insert(index, next);
                next = next.saturating_add(u32::try_from(count).unwrap_or(u32::MAX));
            }
            (firsts, next)
        })
    }

    /// The directory entry that a parameter line says it belongs to (columns 66 to 72).
    fn back_pointer(&self, line: usize) -> Option<i64> {
        let text = self.file.text(self.file.parameters[line], 72);
        std::str::from_utf8(text.get(64..)?.trim_ascii()).ok()?.parse().ok()
    }

    fn by_back_pointer(&self) -> &BTreeMap<i64, usize> {
        self.by_back_pointer.get_or_init(|| {
            let mut first = BTreeMap::new();
            for line in 0..self.file.parameters.len() {
                if let Some(back) = self.back_pointer(line) {
                    first.entry(back).or_insert(line);
                }
            }
            first
        })
    }
}

/// Follows the references of one face (or one group) and collects remarks.
#[derive(Debug)]
pub(crate) struct Reader<'s, 'a> {
    /// The file.
    pub store: &'s Store<'a>,
    stack: Vec<usize>,
    budget: usize,
    /// Which instance of its face is read: each has edges of its own.
    pub instance: u32,
    /// Remarks made so far.
    pub remarks: Vec<Remark>,
}

/// An entity opened for reading.
#[derive(Debug)]
pub(crate) struct Opened<'s> {
    /// Position in the directory.
    pub index: usize,
    /// Directory entry.
    pub entry: &'s Entry,
    /// Parameters.
    pub args: Args,
}

impl<'s, 'a> Reader<'s, 'a> {
    /// A reader with nothing open.
    pub(crate) fn new(store: &'s Store<'a>) -> Self {
        Self { store, stack: Vec::new(), budget: BUDGET, instance: 0, remarks: Vec::new() }
    }

    /// Forgets how much was followed so far, before another independent entity.
    pub(crate) fn refresh(&mut self) {
        self.budget = BUDGET;
    }

    /// Millimetres in one unit of the file.
    pub(crate) fn millimetres(&self) -> f64 {
        self.store.global.unit.millimetres
    }

    /// Opens the entity that `pointer` means and calls `read` with it; while that runs, the entity
    /// cannot be opened again. An error inside is marked with `what` and the entity's number.
    pub(crate) fn open<T>(
        &mut self,
        pointer: i64,
        what: &'static str,
        read: impl FnOnce(&mut Self, Opened<'s>) -> Result<T, EntityError>,
    ) -> Result<T, EntityError> {
        let store = self.store;
        let index = store.index(pointer, what)?;
        let target = Store::number(index);
        if self.stack.contains(&index) {
            return Err(EntityError::Cycle { target });
        }
        if self.budget == 0 || self.stack.len() >= DEPTH {
            return Err(EntityError::Budget);
        }
        self.budget -= 1;
        self.stack.push(index);
        let result = store
            .args(index)
            .and_then(|args| read(self, Opened { index, entry: &store.entries[index], args }))
            .map_err(|e| e.in_part(what, target));
        self.stack.pop();
        result
    }

    /// Edge number `place` (from 1) of the edge list that `list` means, as an edge of the model. `None`
    /// beyond what numbers can hold.
    pub(crate) fn edge(&self, list: i64, place: i64) -> Option<EdgeId> {
        let (firsts, total) = self.store.edge_numbers();
        let first = firsts.get(&self.store.index(list, "edge list").ok()?)?;
        let within = u32::try_from(place).ok()?.checked_sub(1)?;
        total.checked_mul(self.instance)?.checked_add(*first)?.checked_add(within).map(EdgeId)
    }

    /// Type of the entity that `pointer` means.
    pub(crate) fn kind(&self, pointer: i64, what: &'static str) -> Result<u32, EntityError> {
        Ok(self.store.entries[self.store.index(pointer, what)?].kind)
    }

    /// Adds a remark on the entry at `index`.
    pub(crate) fn remark(&mut self, index: usize, severity: Severity, message: String) {
        let entry = &self.store.entries[index];
        self.remarks.push(Remark {
            severity,
            entity: entry.kind.to_string(),
            id: Store::number(index),
            line: entry.line,
            message,
        });
    }
}
