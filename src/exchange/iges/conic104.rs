//! Conic arc (104): `A x^2 + B x y + C y^2 + D x + E y + F = 0` in a plane z = constant, from a start
//! point to an end point (counter-clockwise for ellipses).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::error::EntityError;
use super::parameter::Args;
use crate::kernel::nurbs::NurbsCurve3;
use crate::kernel::primitives::{arc, hyperbola, parabola};

/// Reads the coefficients and finds the arc; the form number is not needed (the discriminant tells).
pub(crate) fn read(args: &mut Args, _form: i32, scale: f64) -> Result<NurbsCurve3, EntityError> {
    let k = args.reals("coefficient", 6)?;
    let z = args.real("z")? * scale;
    let start = DVec2::new(args.real("start")?, args.real("start")?);
    let end = DVec2::new(args.real("end")?, args.real("end")?);
    let (a, b, c, d, e, f) = (k[0], k[1], k[2], k[3], k[4], k[5]);
    let size = a.abs().max(b.abs()).max(c.abs());
    if !(size > 0.0) {
        return Err(EntityError::Degenerate("the conic has no quadratic part".into()));
    }
    // Principal axes: B' = 0 after turning by the angle t with tan 2t = B / (A - C).
    let (sin, cos) = (0.5 * b.atan2(a - c)).sin_cos();
    let axis = DVec2::new(cos, sin);
    let across = axis.perp();
    let la = a * cos * cos + b * cos * sin + c * sin * sin;
    let lb = a * sin * sin - b * cos * sin + c * cos * cos;
    let (da, db) = (d * cos + e * sin, e * cos - d * sin);
    let place = |p: DVec2| (p * scale).extend(z);
    let vector = |p: DVec2| DVec3::new(p.x, p.y, 0.0) * scale;
    if la.abs() <= 1e-9 * size || lb.abs() <= 1e-9 * size {
        // One squared term only: a parabola, turned so that the squared coordinate is `across`.
        let (axis, across, lb, da, db) =
            if la.abs() > lb.abs() { (across, -axis, la, db, -da) } else { (axis, across, lb, da, db) };
        if da == 0.0 {
            return Err(EntityError::Degenerate("the conic is a pair of lines".into()));
        }
        let y0 = -db / (2.0 * lb);
        let x0 = (lb * y0 * y0 - f) / da;
        let vertex = axis * x0 + across * y0;
        let bend = -lb / da;
        // The parameter grows from start to end, as in OpenCASCADE.
        let (from, to) = (start.dot(across) - y0, end.dot(across) - y0);
        let (across, from, to) = if to < from { (-across, -from, -to) } else { (across, from, to) };
        return Ok(parabola(place(vertex), vector(axis) * bend, vector(across), from, to)?);
    }
    let (xa, xb) = (-da / (2.0 * la), -db / (2.0 * lb));
    let centre = axis * xa + across * xb;
    let rest = la * xa * xa + lb * xb * xb - f;
    let (ra, rb) = (rest / la, rest / lb);
    let local = |p: DVec2| DVec2::new((p - centre).dot(axis), (p - centre).dot(across));
    if ra > 0.0 && rb > 0.0 {
        // OpenCASCADE's ellipses start at the end of the long axis.
        let (long, short, r, s) = if ra >= rb {
            (axis, across, ra.sqrt(), rb.sqrt())
        } else {
            (across, -axis, rb.sqrt(), ra.sqrt())
        };
        // Of its two ends, at the one further along x (or y).
        let away = if long.x.abs() > 1e-9 { long.x < 0.0 } else { long.y < 0.0 };
        let (long, short) = if away { (-long, -short) } else { (long, short) };
        let angle =
            |p: DVec2| ((p - centre).dot(short) / s).atan2((p - centre).dot(long) / r).rem_euclid(TAU);
        let from = angle(start);
        let sweep = (angle(end) - from).rem_euclid(TAU);
        let closed = (end - start).length() <= 1e-9 * r || sweep == 0.0;
        let to = from + if closed { TAU } else { sweep };
        return Ok(arc(place(centre), vector(long) * r, vector(short) * s, from, to)?);
    }
    if ra * rb < 0.0 {
        let (main, side, r, s) = if ra > 0.0 {
            (axis, across, ra.sqrt(), (-rb).sqrt())
        } else {
            (across, -axis, rb.sqrt(), (-ra).sqrt())
        };
        let main = if (start - centre).dot(main) < 0.0 { -main } else { main };
        let t = |p: DVec2| ((p - centre).dot(side) / s).asinh();
        debug_assert!(local(start).is_finite());
        return ordered(t(start), t(end), |a, b| {
            hyperbola(place(centre), vector(main) * r, vector(side) * s, a, b)
        });
    }
    Err(EntityError::Degenerate("the conic has no real points".into()))
}

/// Makes the curve over the sorted parameters and turns it round where the end comes first.
fn ordered(
    start: f64,
    end: f64,
    make: impl Fn(f64, f64) -> Result<NurbsCurve3, crate::kernel::nurbs::NurbsError>,
) -> Result<NurbsCurve3, EntityError> {
    Ok(if end < start { make(end, start)?.reversed() } else { make(start, end)? })
}
