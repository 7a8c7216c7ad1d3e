//! Colours for gaps: a logarithmic ramp from one nanometre to one millimetre, and colours for edges without a gap.

use crate::inspect::{Edge, EdgeKind};

/// Exponents of ten (of millimetres) between which the ramp runs: 1 nm to 1 mm.
pub const DECADES: std::ops::RangeInclusive<i32> = -6..=0;

/// Stops of the ramp, sRGB; evenly spaced in the logarithm. From calm to alarming, and legible on grey.
const STOPS: [[u8; 3]; 7] = [
    [58, 110, 190],
    [44, 160, 190],
    [60, 180, 120],
    [150, 200, 70],
    [240, 205, 60],
    [244, 140, 50],
    [226, 50, 50],
];
/// Edges of one face only.
pub const NAKED: [u8; 3] = [224, 70, 200];
/// Edges of three faces or more.
pub const NON_MANIFOLD: [u8; 3] = [150, 96, 230];
/// Edges within rounding.
pub const CLOSED: [u8; 3] = [110, 122, 140];

/// The colour of a gap of `mm` millimetres, sRGB.
pub fn colour(mm: f64) -> [u8; 3] {
    if !(mm > 0.0) {
        return CLOSED;
    }
    let (first, last) = (f64::from(*DECADES.start()), f64::from(*DECADES.end()));
    let exponent = mm.log10();
    if exponent < first {
        return CLOSED;
    }
    let at = ((exponent - first) / (last - first)).clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let (k, t) = ((at as usize).min(STOPS.len() - 2), at.fract());
    let t = if at >= (STOPS.len() - 1) as f64 { 1.0 } else { t };
    std::array::from_fn(|c| {
        (f64::from(STOPS[k][c]) * (1.0 - t) + f64::from(STOPS[k + 1][c]) * t).round() as u8
    })
}

/// The colour of an edge by its kind and gap, of which one is `unit` millimetres.
pub fn of_edge(edge: &Edge, unit: f64) -> [u8; 3] {
    match edge.kind {
        EdgeKind::Naked => NAKED,
        EdgeKind::NonManifold => NON_MANIFOLD,
        EdgeKind::Degenerate => CLOSED,
        EdgeKind::Shared | EdgeKind::Seam => edge.gap.map_or(CLOSED, |g| colour(unit * g.maximum)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_meets_its_stops_and_never_leaves_them() {
        assert_eq!(colour(0.0), CLOSED);
        assert_eq!(colour(f64::NAN), CLOSED);
        assert_eq!(colour(1e-9), CLOSED, "below a nanometre");
        assert_eq!(colour(1.01e-6)[2], 190);
        assert_eq!(colour(1.0), STOPS[6]);
        assert_eq!(colour(1e9), STOPS[6]);
        assert_eq!(colour(1e-3), STOPS[3]);
    }
}
