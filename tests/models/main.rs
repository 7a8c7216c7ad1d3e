//! Real CAD files against independent ground truth.

mod cli;
mod import;
mod points;
mod truth;
