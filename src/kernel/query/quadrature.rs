//! Gauss-Legendre rules on `[0, 1]`.

use std::sync::OnceLock;

/// Numbers of nodes that [`rule`] offers.
pub const ORDERS: [usize; 4] = [2, 4, 8, 16];

/// The `(node, weight)` pairs of the rule with `ORDERS[index]` nodes on `[0, 1]`, exact for polynomials of
/// degree `2 * ORDERS[index] - 1`.
pub fn rule(index: usize) -> &'static [(f64, f64)] {
    static RULES: OnceLock<[Vec<(f64, f64)>; 4]> = OnceLock::new();
    &RULES.get_or_init(|| ORDERS.map(gauss_legendre))[index]
}

/// Nodes by Newton's method on the Legendre polynomial, from Tricomi's asymptotic start.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = (std::f64::consts::PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for j in 2..=n {
                let next = ((2 * j - 1) as f64 * x * value - (j - 1) as f64 * before) / j as f64;
                (before, value) = (value, next);
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree() {
        for (index, n) in ORDERS.into_iter().enumerate() {
            for degree in 0..2 * n {
                let sum: f64 = rule(index).iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
                assert!((sum - 1.0 / (degree + 1) as f64).abs() < 1e-14, "{n} nodes, degree {degree}: {sum}");
            }
        }
    }
}
