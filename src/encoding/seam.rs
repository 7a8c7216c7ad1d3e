//! Triangles that close the gaps between pieces of one face with triangles of different sizes.
//!
//! Along the line at which a piece was cut in two, either side has vertices of its own, all of them on the surface. The strip
//! between the two lines of chords is as thin as the levels allow; filled with triangles of the same vertices it has no hole
//! that a pixel could fall through, as sides of triangles are shared bit for bit.

/// A vertex: its place along the line, and its number.
pub type OnLine = (f64, u32);

/// Fills the strips between the chains of both sides, each in order along the line. Chains of a side that follow each other
/// without a gap count as one; where a side has none nothing is filled.
pub fn close(sides: [&[&[OnLine]]; 2], triangles: &mut Vec<u32>) {
    let [left, right] = sides.map(runs);
    for a in &left {
        for b in &right {
            if let (Some(a), Some(b)) = (shared(a, b), shared(b, a)) {
                fill(a, b, triangles);
            }
        }
    }
}

fn runs(chains: &[&[OnLine]]) -> Vec<Vec<OnLine>> {
    let mut runs: Vec<Vec<OnLine>> = Vec::new();
    for chain in chains.iter().filter(|chain| !chain.is_empty()) {
        match runs.last_mut() {
            Some(run) if run.last().is_some_and(|end| end.0 == chain[0].0) => run.extend_from_slice(chain),
            _ => runs.push(chain.to_vec()),
        }
    }
    runs
}

/// The part of `run` that lies along `other`, and no less.
fn shared<'a>(run: &'a [OnLine], other: &[OnLine]) -> Option<&'a [OnLine]> {
    let (first, last) = (other.first()?.0, other.last()?.0);
    let from = run.partition_point(|v| v.0 <= first).saturating_sub(1);
    let to = (run.partition_point(|v| v.0 < last) + 1).min(run.len());
    (from + 1 < to && run[from].0 < last && run[to - 1].0 > first).then(|| &run[from..to])
}

fn fill(a: &[OnLine], b: &[OnLine], triangles: &mut Vec<u32>) {
    let (mut i, mut j) = (0, 0);
    while i + 1 < a.len() || j + 1 < b.len() {
        let along_a = j + 1 == b.len() || i + 1 < a.len() && a[i + 1].0 <= b[j + 1].0;
        let next = if along_a { a[i + 1].1 } else { b[j + 1].1 };
        triangles.extend([a[i].1, b[j].1, next]);
        if along_a {
            i += 1;
        } else {
            j += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    fn chain(places: &[f64], first: u32) -> Vec<OnLine> {
        places.iter().zip(first..).map(|(t, k)| (*t, k)).collect()
    }

    #[test]
    fn every_side_of_both_lines_is_closed() {
        let a = [chain(&[0.0, 0.1, 0.5], 0), chain(&[0.5, 0.75, 1.0], 10)];
        let b = [chain(&[0.0, 0.25, 0.3, 0.5, 0.8, 1.0], 20)];
        let mut triangles = Vec::new();
        close([&[&a[0], &a[1]], &[&b[0]]], &mut triangles);
        let mut sides: HashMap<[u32; 2], usize> = HashMap::new();
        for t in triangles.chunks_exact(3) {
            for k in 0..3 {
                let (p, q) = (t[k], t[(k + 1) % 3]);
                *sides.entry([p.min(q), p.max(q)]).or_default() += 1;
            }
        }
        // Sides of the strip once, those inside twice.
        for line in a.iter().chain(&b) {
            assert!(line.windows(2).all(|w| sides[&[w[0].1, w[1].1]] == 1));
        }
        let open = sides.values().filter(|n| **n == 1).count();
        // The two ends, and the joint of two chains.
        assert_eq!(open, 4 + 5 + 2 + 1);
        assert!(sides.values().all(|n| *n <= 2));
    }

    #[test]
    fn only_what_both_sides_have_is_filled() {
        let a = [chain(&[0.0, 0.2], 0), chain(&[0.6, 0.7, 0.8], 10)];
        let b = [chain(&[0.0, 1.0], 20)];
        let mut triangles = Vec::new();
        close([&[&a[0], &a[1]], &[&b[0]]], &mut triangles);
        assert_eq!(triangles.len(), 3 * (2 + 3));
        triangles.clear();
        close([&[&a[0]], &[&chain(&[0.2, 0.4], 30)]], &mut triangles);
        close([&[&a[0]], &[]], &mut triangles);
        assert!(triangles.is_empty());
    }
}
