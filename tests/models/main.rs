//! Real CAD files against independent ground truth.

mod import;
