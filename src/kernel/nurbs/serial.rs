//! Curves and surfaces as serde data: degrees, knots, points, and weights unless all of them are 1.
//!
//! Reading goes through the constructors, so that whatever was read is valid. Numbers are kept bit for bit by
//! any format that does so itself.

use glam::DVec3;
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{KnotVector, NurbsCurve, NurbsError, NurbsSurface};
use crate::kernel::vector::Vector;

fn all_one(weights: &&[f64]) -> bool {
    weights.iter().all(|w| *w == 1.0)
}

#[derive(Serialize)]
struct KnotsOut<'a> {
    degree: usize,
    knots: &'a [f64],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct KnotsIn {
    degree: usize,
    knots: Vec<f64>,
}

impl Serialize for KnotVector {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        KnotsOut { degree: self.degree(), knots: self.as_slice() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for KnotVector {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let KnotsIn { degree, knots } = KnotsIn::deserialize(deserializer)?;
        Self::new(degree, knots).map_err(D::Error::custom)
    }
}

#[derive(Serialize)]
struct CurveOut<'a, V> {
    degree: usize,
    knots: &'a [f64],
    points: &'a [V],
    #[serde(skip_serializing_if = "all_one")]
    weights: &'a [f64],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, bound = "V: DeserializeOwned")]
struct CurveIn<V> {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<V>,
    #[serde(default)]
    weights: Option<Vec<f64>>,
}

impl<V: Vector + Serialize> Serialize for NurbsCurve<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (degree, knots) = (self.degree(), self.knots().as_slice());
        CurveOut { degree, knots, points: self.points(), weights: self.weights() }.serialize(serializer)
    }
}

impl<'de, V: Vector + DeserializeOwned> Deserialize<'de> for NurbsCurve<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let CurveIn { degree, knots, points, weights } = CurveIn::<V>::deserialize(deserializer)?;
        let weights = weights.unwrap_or_else(|| vec![1.0; points.len()]);
        let knots = KnotVector::new(degree, knots)
            .map_err(|source| D::Error::custom(NurbsError::Knots { direction: "t", source }))?;
        Self::new(knots, points, weights).map_err(D::Error::custom)
    }
}

#[derive(Serialize)]
struct SurfaceOut<'a> {
    degrees: (usize, usize),
    knots_u: &'a [f64],
    knots_v: &'a [f64],
    points: &'a [DVec3],
    #[serde(skip_serializing_if = "all_one")]
    weights: &'a [f64],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceIn {
    degrees: (usize, usize),
    knots_u: Vec<f64>,
    knots_v: Vec<f64>,
    points: Vec<DVec3>,
    #[serde(default)]
    weights: Option<Vec<f64>>,
}

impl Serialize for NurbsSurface {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (knots_u, knots_v) = (self.knots_u().as_slice(), self.knots_v().as_slice());
        let (degrees, points, weights) = (self.degrees(), self.points(), self.weights());
        SurfaceOut { degrees, knots_u, knots_v, points, weights }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for NurbsSurface {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let SurfaceIn { degrees, knots_u, knots_v, points, weights } = SurfaceIn::deserialize(deserializer)?;
        let weights = weights.unwrap_or_else(|| vec![1.0; points.len()]);
        let knots = |direction, degree, knots| {
            KnotVector::new(degree, knots)
                .map_err(|source| D::Error::custom(NurbsError::Knots { direction, source }))
        };
        let (knots_u, knots_v) = (knots("u", degrees.0, knots_u)?, knots("v", degrees.1, knots_v)?);
        Self::new(knots_u, knots_v, points, weights).map_err(D::Error::custom)
    }
}
