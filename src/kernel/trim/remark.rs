//! What was repaired or left out while loops became closed chains.

/// One remark on the loops of a face. Loops and curves are counted from 0 in the order of the record.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub enum TrimRemark {
    /// A gap before `curve` was closed with a straight line.
    Gap {
        /// Loop.
        loop_index: usize,
        /// Curve that starts behind the gap (0: the gap is between the last and the first).
        curve: usize,
        /// Length of the gap in native parameters.
        uv: f64,
        /// The same as a fraction of the domain's size.
        relative: f64,
    },
    /// A loop has no extent and was left out.
    EmptyLoop {
        /// Loop.
        loop_index: usize,
    },
    /// A curve runs against its neighbours and was turned round.
    Reversed {
        /// Loop.
        loop_index: usize,
        /// Curve.
        curve: usize,
    },
    /// Loops reach beyond the surface; what is outside was cut off.
    BeyondSurface {
        /// Largest distance beyond, as a fraction of the domain's size.
        relative: f64,
    },
    /// A loop goes once round a closed surface and was closed along the border of its domain.
    OpenByPeriod {
        /// Loop.
        loop_index: usize,
    },
    /// No loop bounds the face from outside: the border of the surface does.
    NoOuterLoop,
}

impl std::fmt::Display for TrimRemark {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Gap { loop_index, curve, uv, relative } => write!(
                f,
                "loop {}: gap of {uv:.3e} in uv ({relative:.1e} of the face) before curve {} closed with a line",
                loop_index + 1,
                curve + 1
            ),
            Self::EmptyLoop { loop_index } => {
                write!(f, "loop {} has no extent and is left out", loop_index + 1)
            }
            Self::Reversed { loop_index, curve } => {
                write!(f, "loop {}: curve {} runs backwards and was turned", loop_index + 1, curve + 1)
            }
            Self::BeyondSurface { relative } => {
                write!(f, "loops reach {relative:.1e} of the face beyond the surface; cut off there")
            }
            Self::OpenByPeriod { loop_index } => {
                write!(f, "loop {} goes round the closed surface; closed along the border", loop_index + 1)
            }
            Self::NoOuterLoop => write!(f, "no outer loop; the border of the surface is used"),
        }
    }
}
