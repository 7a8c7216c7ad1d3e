//! The deck of cards: directory and parameter sections as entities are added, numbered as they come.
//!
//! Entities are made in batches (a face with all that belongs to it) that point to each other by
//! position; numbers are given, and lines laid out, when a batch joins the deck. That is done for many
//! batches at once.

use rayon::prelude::*;

use super::WriteError;
use super::list::{Field, Link, lines};

/// Sequence numbers have seven digits.
const MOST_LINES: usize = 9_999_999;

/// How an entity stands to others and what it is for (IGES 5.3, 2.2.4.4.9).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    /// Stands by itself.
    Independent,
    /// Exists as a part of another one only.
    Part,
    /// As [`Self::Part`], in the parameters of a surface.
    ParameterPart,
    /// A member of a group.
    Member,
    /// A colour or a property.
    Definition,
}

impl Status {
    fn digits(self) -> &'static str {
        match self {
            Self::Independent => "00000000",
            Self::Part => "00010000",
            Self::ParameterPart => "00010500",
            Self::Member => "00020000",
            Self::Definition => "00010200",
        }
    }
}

/// The colour field of a directory entry.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Colour {
    /// None given.
    #[default]
    None,
    /// One of the standard's own.
    Standard(u8),
    /// A colour entity (314).
    Defined(Link),
}

/// One entity.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entity {
    pub kind: i64,
    pub form: i64,
    pub status: Status,
    pub level: i64,
    pub colour: Colour,
    /// Up to eight characters of plain ASCII.
    pub label: String,
    /// Parameters after the entity type.
    pub fields: Vec<Field>,
}

impl Entity {
    /// An entity without colour, level and label.
    pub(crate) fn new(kind: i64, status: Status, fields: Vec<Field>) -> Self {
        Self { kind, form: 0, status, level: 0, colour: Colour::None, label: String::new(), fields }
    }
}

/// Entities made together.
#[derive(Debug, Default)]
pub(crate) struct Batch {
    entities: Vec<Entity>,
}

impl Batch {
    /// Adds an entity.
    pub(crate) fn push(&mut self, entity: Entity) -> Link {
        self.entities.push(entity);
        Link::Local(self.entities.len() - 1)
    }
}

/// Both sections so far.
#[derive(Debug, Default)]
pub(crate) struct Deck {
    directory: Vec<u8>,
    parameters: Vec<u8>,
    entities: usize,
    parameter_lines: usize,
}

impl Deck {
    /// Number that the next entity will have.
    pub(crate) fn next(&self) -> u64 {
        2 * self.entities as u64 + 1
    }

    /// Adds batches in order. Returns for each the number of its first entity.
    ///
    /// # Errors
    /// [`WriteError::TooLarge`].
    pub(crate) fn append(&mut self, batches: &[Batch]) -> Result<Vec<u64>, WriteError> {
        let mut first = self.next();
        let mut firsts = Vec::with_capacity(batches.len());
        for batch in batches {
            firsts.push(first);
            first += 2 * batch.entities.len() as u64;
        }
        let laid: Vec<Vec<Vec<u8>>> = batches
            .par_iter()
            .zip(&firsts)
            .map(|(batch, first)| batch.entities.iter().map(|e| parameter_lines(e, *first)).collect())
            .collect();
        for ((batch, first), data) in batches.iter().zip(&firsts).zip(&laid) {
            for (entity, data) in batch.entities.iter().zip(data) {
                self.add(entity, *first, data);
            }
        }
        if 2 * self.entities > MOST_LINES || self.parameter_lines > MOST_LINES {
            return Err(WriteError::TooLarge { most: MOST_LINES });
        }
        Ok(firsts)
    }

    fn add(&mut self, entity: &Entity, first: u64, data: &[u8]) {
        let number = self.next();
        let start = self.parameter_lines + 1;
        for line in data.chunks(64) {
            self.parameter_lines += 1;
            self.parameters.extend_from_slice(line);
            self.parameters.extend_from_slice(format!(" {number:7}P{:7}\n", self.parameter_lines).as_bytes());
        }
        let (kind, form, level) = (entity.kind, entity.form, entity.level);
        let (status, label) = (entity.status.digits(), &entity.label);
        let colour = match entity.colour {
            Colour::None => 0,
            Colour::Standard(number) => i64::from(number),
            Colour::Defined(link) => -(link.number(first) as i64),
        };
        let count = self.parameter_lines + 1 - start;
        let zero = 0;
        let entry = format!(
            "{kind:8}{start:8}{zero:8}{zero:8}{level:8}{zero:8}{zero:8}{zero:8}{status}D{number:7}\n\
             {kind:8}{zero:8}{colour:8}{count:8}{form:8}{:16}{label:>8}{zero:8}D{:7}\n",
            "",
            number + 1
        );
        self.directory.extend_from_slice(entry.as_bytes());
        self.entities += 1;
    }

    /// The whole file: `start` and `global` are laid out in 72 columns.
    pub(crate) fn finish(self, start: &[u8], global: &[u8]) -> Vec<u8> {
        let mut file = Vec::with_capacity(self.directory.len() + self.parameters.len() + 81 * 16);
        let mut counts = [0, 0];
        for (k, (section, letter)) in [(start, 'S'), (global, 'G')].into_iter().enumerate() {
            for line in section.chunks(72) {
                counts[k] += 1;
                file.extend_from_slice(line);
                file.extend_from_slice(format!("{letter}{:7}\n", counts[k]).as_bytes());
            }
        }
        file.extend_from_slice(&self.directory);
        file.extend_from_slice(&self.parameters);
        let [s, g] = counts;
        let end =
            format!("S{s:7}G{g:7}D{:7}P{:7}{:40}T{:7}\n", 2 * self.entities, self.parameter_lines, "", 1);
        file.extend_from_slice(end.as_bytes());
        file
    }
}

/// Parameter data of one entity in lines of 64 columns.
fn parameter_lines(entity: &Entity, first: u64) -> Vec<u8> {
    let mut all = Vec::with_capacity(entity.fields.len() + 1);
    all.push(Field::Integer(entity.kind));
    all.extend_from_slice(&entity.fields);
    lines(&all, 64, first)
}
