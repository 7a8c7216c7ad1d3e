//! Copious data (106) used as a curve: the polyline through its points (forms 1 to 3, 11 to 13, 20 to 40, 63).

use glam::DVec3;

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::nurbs::{KnotVector, NurbsCurve3};

/// Appends one curve of degree 1 with a knot at each point. Repeated points are left out.
pub(crate) fn read(args: &mut Args, scale: f64, pieces: &mut Vec<NurbsCurve3>) -> Result<(), EntityError> {
    let flag = args.integer_or("interpretation flag", 0)?;
    let width = match flag {
        1 => 2,
        2 => 3,
        3 => 6,
        _ => {
            let value = flag as f64;
            return Err(EntityError::Range {
                index: 1,
                what: "interpretation flag",
                value,
                expected: "1, 2 or 3",
            });
        }
    };
    let count = args.count("number of points", width)?;
    let z = if flag == 1 { args.real("z")? } else { 0.0 };
    let mut points: Vec<DVec3> = Vec::with_capacity(count);
    for _ in 0..count {
        let (x, y) = (args.real("x")?, args.real("y")?);
        let z = if flag == 1 { z } else { args.real("z")? };
        if flag == 3 {
            args.skip(3);
        }
        let point = DVec3::new(x, y, z) * scale;
        if points.last() != Some(&point) {
            points.push(point);
        }
    }
    if points.len() < 2 {
        return Err(EntityError::Degenerate("fewer than two different points".into()));
    }
    let last = points.len() - 1;
    let knots = std::iter::once(0).chain(0..=last).chain(std::iter::once(last)).map(|k| k as f64).collect();
    let knots = KnotVector::new(1, knots).map_err(EntityError::knots("t"))?;
    let weights = vec![1.0; points.len()];
    pieces.push(NurbsCurve3::new(knots, points, weights)?);
    Ok(())
}
