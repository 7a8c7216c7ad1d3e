//! Knot vectors. A [`KnotVector`] that exists is sorted, finite and has a non-empty domain.

/// Highest degree accepted; far above anything CAD systems write, low enough to bound memory.
pub const MAX_DEGREE: usize = 64;

/// Why numbers do not form a knot vector.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum KnotError {
    /// Degree 0 or beyond [`MAX_DEGREE`].
    #[error("degree {degree} is not between 1 and {MAX_DEGREE}")]
    Degree {
        /// The degree asked for.
        degree: usize,
    },
    /// Fewer knots than `2 * (degree + 1)`.
    #[error("{found} knots are too few for degree {degree}; at least {least} are needed")]
    TooFew {
        /// Degree.
        degree: usize,
        /// Knots given.
        found: usize,
        /// Knots needed.
        least: usize,
    },
    /// A knot is NaN or infinite.
    #[error("knot {index} is not finite")]
    NotFinite {
        /// Position.
        index: usize,
    },
    /// A knot is smaller than the one before.
    #[error("knot {index} ({value}) is smaller than the knot before it ({before})")]
    NotSorted {
        /// Position.
        index: usize,
        /// Knot.
        value: f64,
        /// Knot before.
        before: f64,
    },
    /// All knots of the domain coincide, or an inner knot repeats more than `degree + 1` times.
    #[error("the domain is empty: from {start} to {end}")]
    EmptyDomain {
        /// First parameter.
        start: f64,
        /// Last parameter.
        end: f64,
    },
    /// A parameter lies outside the domain.
    #[error("parameter {value} is outside the domain from {start} to {end}")]
    OutsideDomain {
        /// The parameter.
        value: f64,
        /// First parameter.
        start: f64,
        /// Last parameter.
        end: f64,
    },
    /// An inserted knot would repeat too often.
    #[error("knot {value} would repeat more than {most} times")]
    Multiplicity {
        /// The knot.
        value: f64,
        /// Most repeats allowed.
        most: usize,
    },
}

/// A sorted, finite, flat knot vector (multiplicities written out) with its degree. Need not be clamped.
#[derive(Debug, Clone, PartialEq)]
pub struct KnotVector {
    degree: usize,
    knots: Vec<f64>,
}

impl KnotVector {
    /// Takes `knots` (flat, sorted) for a spline of `degree`.
    ///
    /// # Errors
    /// See [`KnotError`].
    pub fn new(degree: usize, knots: Vec<f64>) -> Result<Self, KnotError> {
        if degree == 0 || degree > MAX_DEGREE {
            return Err(KnotError::Degree { degree });
        }
        let least = 2 * (degree + 1);
        if knots.len() < least {
            return Err(KnotError::TooFew { degree, found: knots.len(), least });
        }
        if let Some(index) = knots.iter().position(|k| !k.is_finite()) {
            return Err(KnotError::NotFinite { index });
        }
        if let Some(i) = knots.windows(2).position(|w| w[1] < w[0]) {
            return Err(KnotError::NotSorted { index: i + 1, value: knots[i + 1], before: knots[i] });
        }
        let vector = Self { degree, knots };
        let (start, end) = vector.domain();
        if !(end > start) || !(end - start).is_finite() {
            return Err(KnotError::EmptyDomain { start, end });
        }
        Ok(vector)
    }

    /// The clamped knot vector of one Bezier piece over `[start, end]`.
    ///
    /// # Errors
    /// When the degree is out of range or the interval is empty.
    pub fn bezier(degree: usize, start: f64, end: f64) -> Result<Self, KnotError> {
        let mut knots = vec![start; degree + 1];
        knots.resize(2 * (degree + 1), end);
        Self::new(degree, knots)
    }

    /// Whether the knots are those of one Bezier piece: a spline over them is its own decomposition.
    pub fn is_bezier(&self) -> bool {
        let (head, tail) = self.as_slice().split_at(self.degree + 1);
        let same = |knots: &[f64]| knots.iter().all(|k| *k == knots[0]);
        tail.len() == head.len() && same(head) && same(tail) && self.spans().next().is_some()
    }

    /// Polynomial degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All knots, repeated ones written out.
    pub fn as_slice(&self) -> &[f64] {
        &self.knots
    }

    /// Number of control points of a spline over these knots.
    pub fn control_count(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// First and last parameter at which a spline over these knots is defined.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.knots.len() - self.degree - 1])
    }

    /// Index `i` with `knots[i] <= t < knots[i + 1]`, `degree <= i < control_count`; clamped to the
    /// domain, and the last non-empty span at its end (Piegl & Tiller, algorithm A2.1).
    pub fn span(&self, t: f64) -> usize {
        let last = self.control_count() - 1;
        let inner = &self.knots[self.degree + 1..=last];
        let mut span = self.degree + inner.partition_point(|k| *k <= t);
        // At the end of an unclamped or multiple end knot: step back to a span that is not empty.
        while span > self.degree && self.knots[span] >= self.knots[span + 1] {
            span -= 1;
        }
        while span < last && self.knots[span] >= self.knots[span + 1] {
            span += 1;
        }
        span
    }

    /// The distinct knots inside the domain, both ends included.
    pub fn breaks(&self) -> Vec<f64> {
        let (start, end) = self.domain();
        let mut breaks: Vec<f64> = self.knots.iter().copied().filter(|k| *k >= start && *k <= end).collect();
        breaks.dedup();
        breaks
    }
}
