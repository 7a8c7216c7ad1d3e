//! A free-form sheet of degree 15 x 9 behind the ball, with the program's name cut out of it, dots
//! that fade like a halftone, and an upper edge that is one curve of degree 13.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::assembly::Assembly;
use super::lettering::{HEIGHT, place, text};
use super::outline::{bezier, circle};
use super::shape::sheet;
use crate::kernel::nurbs::NurbsCurve2;

/// Rows and columns of dots.
const DOTS: (usize, usize) = (9, 46);

/// Adds the sail.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Sail", [0.60, 0.07, 0.045]);
    let surface = sheet(15, 9, |s, t| {
        let angle = PI * (1.28 - 1.06 * s);
        let radius = 92.0 - 20.0 * (PI * t).sin() * (0.6 + 0.4 * (TAU * s).cos()) + 16.0 * t * t;
        DVec3::new(radius * angle.cos(), radius * angle.sin(), 3.0 + 118.0 * t)
    });
    let (letters, width) = text("HAIRLINE").expect("capitals have glyphs");
    // The sheet is about 2.3 times as long as it is high.
    let scale = DVec2::new(0.56 / width, 2.1 * 0.56 / width);
    let origin = DVec2::new(0.5 - 0.5 * width * scale.x, 0.78 - 0.5 * HEIGHT * scale.y);
    let mut loops = vec![outline()];
    loops.extend(letters.iter().map(|curves| place(curves, |p| origin + p * scale)));
    loops.extend(dots());
    assembly.face("Sail", surface, loops);
}

/// Straight sides and foot; the head is a single curve of degree 13.
fn outline() -> Vec<NurbsCurve2> {
    let (low, high) = (0.01, 0.99);
    let line = |a: (f64, f64), b: (f64, f64)| NurbsCurve2::line(a.into(), b.into());
    let mut head: Vec<DVec2> = (0..=13)
        .map(|i| {
            let s = i as f64 / 13.0;
            let rise = 0.20 * (PI * s).sin().powf(0.3) + 0.08 * (PI * s).sin();
            DVec2::new(high + (low - high) * s, 0.70 + rise)
        })
        .collect();
    // Rounding must not part the head from the sides.
    (head[0], head[13]) = (DVec2::new(high, 0.70), DVec2::new(low, 0.70));
    vec![
        line((low, low), (high, low)),
        line((high, low), (high, 0.70)),
        bezier(head),
        line((low, 0.70), (low, low)),
    ]
}

/// Dots in rows, largest at the foot.
fn dots() -> impl Iterator<Item = Vec<NurbsCurve2>> {
    let (rows, columns) = DOTS;
    (0..rows * columns).map(move |k| {
        let (row, column) = (k / columns, k % columns);
        let shift = 0.5 * (row % 2) as f64;
        let s = 0.04 + 0.92 * (column as f64 + 0.25 + shift) / columns as f64;
        let t = 0.06 + 0.056 * row as f64;
        let fade = 1.0 - row as f64 / rows as f64;
        let wave = 0.75 + 0.25 * (3.0 * TAU * s).cos();
        let radius = 0.0088 * (0.25 + 0.75 * fade * wave);
        place(&circle(DVec2::ZERO, radius), |p| DVec2::new(s, t) + p * DVec2::new(1.0, 2.3))
    })
}
