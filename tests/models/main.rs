//! Real CAD files against independent ground truth.

mod areas;
mod cli;
mod iges_truth;
mod import;
mod points;
mod truth;
