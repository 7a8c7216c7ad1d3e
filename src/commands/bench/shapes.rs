//! Trim shapes of any size for benchmarks and property tests, in the unit square.
//!
//! `holes`: a perforated plate, round holes side by side, each turned by its own angle. `blob`: one loop
//! of big lobes with small waves, its curves crowded into a narrow ring. `hair`: one loop whose waves are
//! deep and dense. Deterministic: same name and size, same curves.

use std::f64::consts::TAU;

use glam::DVec2;

use crate::kernel::bezier::BezierCurve2;

/// Closed loops of Bezier curves.
pub type Loops = Vec<Vec<BezierCurve2>>;

/// A family of shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Round holes of four cubics.
    Holes,
    /// Round holes of four rational quadratics: exact circles.
    RationalHoles,
    /// One wavy loop, waves shallow.
    Blob,
    /// One wavy loop, waves deep.
    Hair,
}

impl Shape {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holes => "holes",
            Self::RationalHoles => "rational",
            Self::Blob => "blob",
            Self::Hair => "hair",
        }
    }

    /// About `curves` curves of this shape.
    pub fn loops(self, curves: usize) -> Loops {
        match self {
            Self::Holes => holes(curves, false),
            Self::RationalHoles => holes(curves, true),
            Self::Blob => vec![wave(curves, 0.03)],
            Self::Hair => vec![wave(curves, 0.1 * curves as f64 / 10.0)],
        }
    }
}

/// A deterministic source of evenly distributed numbers (splitmix64).
#[derive(Debug, Clone)]
pub struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// The next number in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A point of the unit square.
    pub fn point(&mut self) -> DVec2 {
        DVec2::new(self.unit(), self.unit())
    }
}

/// A circle of four curves, turned by `angle`; cubics or exact rational quadratics.
pub fn circle(centre: DVec2, radius: f64, angle: f64, rational: bool) -> Vec<BezierCurve2> {
    let vertex: Vec<DVec2> =
        (0..4).map(|i| centre + DVec2::from_angle(angle + TAU * f64::from(i) / 4.0) * radius).collect();
    (0..4)
        .map(|i| {
            let (a, b) = (vertex[i], vertex[(i + 1) % 4]);
            let (ta, tb) = ((a - centre).perp(), (b - centre).perp());
            if rational {
                let weights = vec![1.0, std::f64::consts::FRAC_1_SQRT_2, 1.0];
                BezierCurve2 { points: vec![a, a + ta, b], weights }
            } else {
                const K: f64 = 0.552_284_749_830_793_6;
                BezierCurve2::polynomial(vec![a, a + ta * K, b - tb * K, b])
            }
        })
        .collect()
}

fn holes(curves: usize, rational: bool) -> Loops {
    let count = curves.div_ceil(4);
    let side = (count as f64).sqrt().ceil() as usize;
    let mut random = Random(count as u64);
    (0..count)
        .map(|k| {
            let cell = 1.0 / side as f64;
            let centre = DVec2::new((k % side) as f64 + 0.5, (k / side) as f64 + 0.5) * cell;
            circle(centre, cell * (0.25 + 0.15 * random.unit()), TAU * random.unit(), rational)
        })
        .collect()
}

/// A loop of `curves` cubics (Hermite pieces) around the centre with `curves / 10` waves; `depth` is the
/// amplitude of the waves for 10 curves and falls with their number.
fn wave(curves: usize, depth: f64) -> Vec<BezierCurve2> {
    let count = curves.max(6);
    let waves = (count as f64 / 10.0).max(2.0).round();
    let amplitude = (depth / waves).min(0.1);
    let radius = |a: f64| 0.3 + 0.06 * (3.0 * a).sin() + amplitude * (waves * a).sin();
    let slope = |a: f64| 0.18 * (3.0 * a).cos() + amplitude * waves * (waves * a).cos();
    let vertex: Vec<(DVec2, DVec2)> = (0..count)
        .map(|i| {
            let a = TAU * i as f64 / count as f64;
            let e = DVec2::from_angle(a);
            (DVec2::splat(0.5) + e * radius(a), e * slope(a) + e.perp() * radius(a))
        })
        .collect();
    let third = TAU / count as f64 / 3.0;
    (0..count)
        .map(|i| {
            let ((a, ta), (b, tb)) = (vertex[i], vertex[(i + 1) % count]);
            BezierCurve2::polynomial(vec![a, a + ta * third, b - tb * third, b])
        })
        .collect()
}
