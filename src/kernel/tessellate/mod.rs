//! Triangles within an error for trimmed faces; those that the bounds do not prove are counted.
//!
//! Trim curves are lifted to model space ([`lift`], [`outline`]) and divided into chords ([`chords`]) independently of the
//! surface, which gets a lattice of vertices by its curvature and is divided until it is as close to its triangles as asked
//! ([`refine`], [`flatness`]); both meet in a
//! constrained Delaunay triangulation in parameters ([`triangulate`]); folds are turned and superfluous vertices taken out
//! again. Where that takes fewer triangles vertices lie off the surface, within the tolerance (`balance`). Unlike in the paper no vertex is ever put on a chord
//! where the surface's cells cross it, so that two faces that share chords share all their vertices there.
//! [`untrimmed()`] gives the surface alone, by the paper's kd-tree.
//!
//! Source (P2): A. Balazs, M. Guthe, R. Klein, "Efficient trimmed NURBS tessellation", 2004.
//!
//! Invariants: the same input gives the same mesh bit for bit; vertices of the boundary are where they were asked to be;
//! triangles are counter-clockwise against `du x dv`.

mod balance;
mod bends;
pub mod bilinear;
pub mod chords;
mod closing;
pub mod coherence;
mod creases;
mod decimate;
mod finish;
pub mod flatness;
mod interior;
mod judgement;
pub mod kd_tree;
pub mod lift;
pub mod line_error;
pub mod mesh;
mod nets;
pub mod options;
pub mod outline;
pub mod patience;
pub mod places;
pub mod placing;
pub mod plane;
pub mod refine;
mod seed;
pub mod simplify;
pub mod single;
pub mod tessellator;
pub mod triangulate;
mod untangle;
pub mod untrimmed;

pub use chords::{ChordLimits, EdgeSample};
pub use coherence::CoherentPoints;
pub use mesh::{FaceMesh, Quality};
pub use options::{CurveDivision, CurveError, SurfaceDivision, TessellateError, TessellationOptions};
pub use outline::{Ground, Outline, Run};
pub use single::{tessellate, tessellate_with};
pub use tessellator::{Boundary, LongChord, Tessellator};
pub use untrimmed::{UntrimmedMesh, untrimmed, untrimmed_over};
