//! Names (property 406, form 15), colours (314, or the standard's numbers) and levels.

use std::collections::BTreeMap;

use super::super::appearance::{STANDARD, linear};
use super::deck::{Batch, Colour, Deck, Entity, Status};
use super::face::Remarks;
use super::list::{Field, Link};
use super::{WriteError, number};
use crate::exchange::report::Severity;
use crate::scene::records::{FaceRecord, ModelRecord};

/// Levels have a field of eight columns.
const MOST_LEVEL: i32 = 99_999_999;

/// The colours of a model, each written once. Keys are the bits of linear RGB.
pub(crate) struct Palette {
    colours: BTreeMap<[u32; 3], Colour>,
}

impl Palette {
    /// Writes all colours of `model`, in the order of their first use.
    ///
    /// # Errors
    /// [`WriteError::TooLarge`].
    pub(crate) fn write(deck: &mut Deck, model: &ModelRecord) -> Result<Self, WriteError> {
        let mut colours = BTreeMap::new();
        let mut batch = Batch::default();
        for colour in model.faces.iter().filter_map(|f| f.colour) {
            colours.entry(colour.map(f32::to_bits)).or_insert_with(|| define(&mut batch, colour));
        }
        let first = deck.append(&[batch])?[0];
        for colour in colours.values_mut() {
            if let Colour::Defined(link) = colour {
                *link = Link::Entry(link.number(first));
            }
        }
        Ok(Self { colours })
    }
}

/// The standard's number of a colour, or a colour entity.
fn define(batch: &mut Batch, colour: [f32; 3]) -> Colour {
    let percent = colour.map(|c| {
        let exact = 100.0 * nonlinear(f64::from(c).clamp(0.0, 1.0));
        number::shortest(exact, |p| linear((p / 100.0).clamp(0.0, 1.0)) as f32 == c)
    });
    match STANDARD.iter().position(|s| *s == percent) {
        Some(index) => Colour::Standard(index as u8 + 1),
        None => {
            let fields = percent.map(Field::Real).to_vec();
            Colour::Defined(batch.push(Entity::new(314, Status::Definition, fields)))
        }
    }
}

/// The inverse of [`linear`].
fn nonlinear(c: f64) -> f64 {
    if c <= 0.04045 / 12.92 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Colour, level and name that entities of one face share.
pub(crate) struct Look<'a> {
    colour: Colour,
    level: i64,
    name: Option<(&'a str, Option<Link>)>,
}

/// How `face` looks; its name becomes a property in `batch`.
pub(crate) fn look<'a>(
    batch: &mut Batch,
    face: &'a FaceRecord,
    palette: &Palette,
    remarks: &mut Remarks,
) -> Look<'a> {
    let colour = face.colour.and_then(|c| palette.colours.get(&c.map(f32::to_bits)).copied());
    let level = match face.layer {
        Some(level @ 1..=MOST_LEVEL) => i64::from(level),
        Some(level) => {
            remarks.add(Severity::Warning, format!("level {level} is not a level of IGES and is left out"));
            0
        }
        None => 0,
    };
    let name = face.name.as_deref().map(|name| (name, property(batch, name)));
    Look { colour: colour.unwrap_or_default(), level, name }
}

impl Look<'_> {
    /// Gives it to an entity, whose own parameters must be complete.
    pub(crate) fn dress(&self, entity: &mut Entity) {
        entity.colour = self.colour;
        entity.level = self.level;
        if let Some((name, property)) = self.name {
            label(entity, name, property);
        }
    }
}

/// Adds a name property; none for an empty name.
pub(crate) fn property(batch: &mut Batch, name: &str) -> Option<Link> {
    let fields = vec![Field::Integer(1), Field::Text(name.trim().to_owned())];
    let entity = Entity { form: 15, ..Entity::new(406, Status::Definition, fields) };
    (!name.trim().is_empty()).then(|| batch.push(entity))
}

/// Gives an entity a name: the whole of it by its `property`, what fits as its label.
pub(crate) fn label(entity: &mut Entity, name: &str, property: Option<Link>) {
    let Some(property) = property else { return };
    // No associations, one property.
    entity.fields.extend([Field::Integer(0), Field::Integer(1), Field::Pointer(property)]);
    entity.label = name.chars().filter(char::is_ascii_graphic).take(8).collect();
}
