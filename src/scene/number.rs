//! Numbers as users count: scripts and files number faces, loops, curves and points from 1, memory from 0.
//!
//! [`one`] and [`many`] are for `#[serde(with = ...)]` on positions.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serializer};

/// A position in memory from the number a user counts it by.
fn position<E: Error>(number: u64) -> Result<usize, E> {
    match number.checked_sub(1) {
        Some(position) => usize::try_from(position).map_err(E::custom),
        None => Err(E::custom("numbers count from 1")),
    }
}

/// One position.
pub mod one {
    use super::*;

    /// Writes the number of the position.
    ///
    /// # Errors
    /// The serializer's.
    pub fn serialize<S: Serializer>(at: &usize, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u64(*at as u64 + 1)
    }

    /// Reads a number.
    ///
    /// # Errors
    /// The number is 0.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
        position(u64::deserialize(deserializer)?)
    }
}

/// Several positions.
pub mod many {
    use super::*;

    /// Writes their numbers.
    ///
    /// # Errors
    /// The serializer's.
    pub fn serialize<S: Serializer>(all: &[usize], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(all.iter().map(|at| *at as u64 + 1))
    }

    /// Reads numbers.
    ///
    /// # Errors
    /// One of them is 0.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<usize>, D::Error> {
        Vec::<u64>::deserialize(deserializer)?.into_iter().map(position).collect()
    }
}
