//! Writing [`ModelRecord`]s as IGES 5.3 in fixed ASCII form.
//!
//! Each face becomes a trimmed surface (144) with its boundaries (142) in the surface's parameters and in
//! space, an untrimmed one a plain surface (128). Every number of surfaces and pcurves is written so that
//! it reads back bit for bit (in millimetres; other units are a division away). Names, colours, levels
//! and parts travel as 406, 314, the level field and 402. Faces that IGES has no single entity for
//! (islands in holes) come apart, which the remarks say. The result depends on the model and the options
//! alone: no time, no order of threads.
//!
//! Source: "Initial Graphics Exchange Specification IGES 5.3", US PRO 1996.

mod appearance;
mod deck;
mod face;
mod global;
mod group;
mod list;
mod number;
mod regions;
mod seam;
mod spline;

use rayon::prelude::*;

use super::unit::Unit;
use crate::exchange::report::Severity;
use crate::scene::records::ModelRecord;
use appearance::Palette;
use deck::{Batch, Deck};

/// Faces whose entities are in memory at the same time.
const CHUNK: usize = 512;

/// What a file shall say besides the model.
#[derive(Debug, Clone, PartialEq)]
pub struct WriteOptions {
    /// Unit of length in the file.
    pub unit: Unit,
    /// Whether boundaries also get curves in space, which many systems ask for.
    pub space_curves: bool,
    /// Name of the file, for its global section.
    pub file_name: String,
    /// Author, for its global section.
    pub author: String,
    /// Date and time as `YYYYMMDD.HHNNSS`.
    pub date: String,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            unit: Unit::MILLIMETRE,
            space_curves: true,
            file_name: String::new(),
            author: String::new(),
            date: "19700101.000000".into(),
        }
    }
}

/// Something that the file could not hold as it was.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportRemark {
    /// How bad it is.
    pub severity: Severity,
    /// Number of the face, from 1.
    pub face: usize,
    /// What happened.
    pub message: String,
}

/// Why no file was made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// A file without entities is none.
    #[error("the model has no faces")]
    Empty,
    /// Sequence numbers have seven digits.
    #[error("the model is too large for IGES, which holds at most {most} lines to a section")]
    TooLarge {
        /// Most lines of a section.
        most: usize,
    },
}

/// The bytes of the file, and what it could not hold.
///
/// # Errors
/// See [`WriteError`].
pub fn write(
    model: &ModelRecord,
    options: &WriteOptions,
) -> Result<(Vec<u8>, Vec<ExportRemark>), WriteError> {
    let global = global::global(model, options)?;
    let mut deck = Deck::default();
    let mut remarks = Vec::new();
    let palette = Palette::write(&mut deck, model)?;
    let mut entries = Vec::with_capacity(model.faces.len());
    for (k, chunk) in model.faces.chunks(CHUNK).enumerate() {
        let made: Vec<face::FaceBatch> = chunk
            .par_iter()
            .enumerate()
            .map(|(i, f)| face::face(k * CHUNK + i + 1, f, &palette, f.part.is_some(), options))
            .collect();
        let mut batches: Vec<Batch> = Vec::with_capacity(made.len());
        let mut links = Vec::with_capacity(made.len());
        for (face, made) in chunk.iter().zip(made) {
            batches.push(made.batch);
            links.push((made.faces, face.part));
            remarks.extend(made.remarks);
        }
        let firsts = deck.append(&batches)?;
        for ((faces, part), first) in links.into_iter().zip(firsts) {
            entries.extend(faces.into_iter().map(|link| (link.number(first), part)));
        }
    }
    group::groups(&mut deck, &model.parts, &entries)?;
    Ok((deck.finish(&global::start(), &global), remarks))
}
