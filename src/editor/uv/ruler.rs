//! Steps of the grid and of the rulers: 1, 2 or 5 times a power of ten, as far apart as is good to read.

use glam::DVec2;

use super::view::UvView;

/// Labels are at least this far apart, logical pixels.
const LABELS_PX: DVec2 = DVec2::new(72.0, 44.0);

/// Distances of lines along u and v, native parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// Lines with a number.
    pub major: DVec2,
    /// Lines between them.
    pub minor: DVec2,
}

impl Steps {
    /// The steps for a view.
    pub fn of(view: &UvView) -> Self {
        let (u, v) = (nice(LABELS_PX.x / view.scale.x), nice(LABELS_PX.y / view.scale.y));
        Self { major: DVec2::new(u.0, v.0), minor: DVec2::new(u.0 / u.1, v.0 / v.1) }
    }

    /// The multiples of `step` from `low` to `high`; none when there are absurdly many.
    pub fn multiples(step: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
        let (first, last) = ((low / step).ceil(), (high / step).floor());
        let count = if last - first < 4_000.0 { (last - first + 1.0).max(0.0) as usize } else { 0 };
        (0..count).map(move |k| (first + k as f64) * step)
    }

    /// How many decimals tell two lines apart.
    pub fn decimals(step: f64) -> usize {
        (-step.log10().floor()).clamp(0.0, 15.0) as usize
    }
}

/// The smallest of 1, 2, 5 times a power of ten not below `least`, and into how many it is divided.
fn nice(least: f64) -> (f64, f64) {
    let power = 10f64.powf(least.log10().floor());
    let step = [(1.0, 5.0), (2.0, 4.0), (5.0, 5.0), (10.0, 5.0)];
    step.into_iter()
        .map(|(m, parts)| (m * power, parts))
        .find(|s| s.0 >= least * (1.0 - 1e-9))
        .unwrap_or((power, 5.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_labels_have_room() {
        for exponent in -8..8 {
            for factor in [1.0, 1.7, 3.3, 7.9] {
                let scale = DVec2::splat(factor * 10f64.powi(exponent));
                let view = UvView { scale, ..UvView::default() };
                let steps = Steps::of(&view);
                assert!((steps.major * scale).cmpge(LABELS_PX * 0.999).all(), "{steps:?}");
                assert!((steps.major * scale).cmple(LABELS_PX * 2.6).all(), "{steps:?}");
                let mantissa = steps.major.x / 10f64.powf(steps.major.x.log10().floor() + 1e-12);
                assert!([1.0, 2.0, 5.0, 10.0].iter().any(|m| (mantissa - m).abs() < 1e-6), "{mantissa}");
            }
        }
    }

    #[test]
    fn multiples_cover_an_interval() {
        let all: Vec<f64> = Steps::multiples(0.5, -0.6, 1.1).collect();
        assert_eq!(all, [-0.5, 0.0, 0.5, 1.0]);
        assert_eq!(Steps::multiples(1e-9, 0.0, 1.0).count(), 0);
        assert_eq!((Steps::decimals(0.05), Steps::decimals(1.0), Steps::decimals(20.0)), (2, 0, 0));
    }
}
