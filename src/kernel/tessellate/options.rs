//! What a tessellation is asked for, and why it can fail.

/// How a trim curve is divided into chords.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum CurveDivision {
    /// As many chords as the curvature asks for, at even shares of it along the whole curve.
    #[default]
    Even,
    /// Halving at the middle of the parameter interval (P2, section 5).
    Midpoint,
    /// Division at the parameter of the control point farthest from the chord (P2, section 5).
    ControlPoint,
}

/// How far a chord is from its curve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum CurveError {
    /// P2's bound by distances to the chord, with the factor corrected for polynomials and made valid for
    /// rational curves.
    #[default]
    Line,
    /// Distances to points at even shares of the chord (Kahlesz et al. 2002), P2's `eps_point`.
    Point,
}

/// How the parameter rectangle is divided.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum SurfaceDivision {
    /// At the control point of largest deviation, across one direction (P2, section 5).
    #[default]
    KdTree,
    /// Into four equal quarters.
    QuadTree,
}

/// Choices for tessellating a face. Lengths in model units.
#[derive(Debug, Clone, PartialEq)]
pub struct TessellationOptions {
    /// Largest distance between mesh and face, both ways.
    pub tolerance: f64,
    /// Whether the tolerance is guaranteed by bounds (P2's conservative error) or estimated at points of the
    /// surface (its approximate error), which takes fewer triangles.
    pub conservative: bool,
    /// Largest angle between the normals within a triangle and between chords of a boundary, radians.
    pub max_angle: Option<f64>,
    /// Longest edge of a triangle.
    pub max_edge: Option<f64>,
    /// Share of the tolerance that trim curves are approximated with where P2's simplification is to use the rest.
    pub gamma: f64,
    /// Whether whole loops of a single face are simplified. Edges shared with other faces never are.
    pub simplify: bool,
    /// Whether vertices may lie off the surface, within the tolerance, where that takes fewer triangles.
    pub balanced: bool,
    /// How trim curves are divided.
    pub curve_division: CurveDivision,
    /// How chords are judged.
    pub curve_error: CurveError,
    /// How the surface is divided.
    pub surface_division: SurfaceDivision,
    /// More triangles than this are an error.
    pub triangle_limit: usize,
}

impl TessellationOptions {
    /// Share of the tolerance for trim curves (P2, section 5.1).
    pub const GAMMA: f64 = 0.75;
    /// Triangles of one face at most.
    pub const TRIANGLE_LIMIT: usize = 20_000_000;

    /// The usual choices for `tolerance` (model units), guaranteed.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            conservative: true,
            max_angle: None,
            max_edge: None,
            gamma: Self::GAMMA,
            simplify: false,
            balanced: true,
            curve_division: CurveDivision::Even,
            curve_error: CurveError::Line,
            surface_division: SurfaceDivision::KdTree,
            triangle_limit: Self::TRIANGLE_LIMIT,
        }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// One that is not finite, not positive or out of range, by name.
    pub fn check(&self) -> Result<(), TessellateError> {
        let positive = |name, value: f64| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(TessellateError::BadOption { name, value })
            }
        };
        positive("tolerance", self.tolerance)?;
        positive("angle", self.max_angle.unwrap_or(1.0))?;
        positive("longest edge", self.max_edge.unwrap_or(1.0))?;
        positive("share gamma", self.gamma)?;
        if self.gamma > 1.0 {
            return Err(TessellateError::BadOption { name: "share gamma", value: self.gamma });
        }
        Ok(())
    }
}

/// Why a face has no mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TessellateError {
    /// An option is not a usable number.
    #[error("the {name} must be a finite number above zero, not {value}")]
    BadOption {
        /// Which.
        name: &'static str,
        /// What it was.
        value: f64,
    },
    /// No part of the surface lies inside the trim loops.
    #[error("nothing of the surface lies inside the trim loops")]
    Empty,
    /// All of its edges meet within the tolerance, or all of it lies inside an even number of loops.
    #[error("nothing is left of it: it is narrower than the tolerance or its loops cancel out")]
    Narrow,
    /// Numbers as far from the origin as the model is are farther apart than the tolerance.
    #[error(
        "{tolerance:e} is below what numbers can tell apart as far from the origin as this model lies; use {finest:e} or more"
    )]
    TooFine {
        /// The tolerance asked for, model units.
        tolerance: f64,
        /// The least that makes sense, model units.
        finest: f64,
    },
    /// Points of the surface or of its boundary are not finite.
    #[error("the surface has points that are not finite numbers, near u {u}, v {v}")]
    NotFinite {
        /// Where.
        u: f64,
        /// Where.
        v: f64,
    },
    /// The loops cross each other so often that they cannot be laid.
    #[error("the trim loops cross each other too often to be triangulated")]
    Tangled,
    /// More triangles than allowed.
    #[error("the mesh needs more than {limit} triangles")]
    TooManyTriangles {
        /// The limit.
        limit: usize,
    },
    /// The work was called off.
    #[error("cancelled")]
    Cancelled,
}
