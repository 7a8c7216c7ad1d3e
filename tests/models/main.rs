//! Real CAD files against independent ground truth.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on shall fail")]

mod areas;
mod check;
mod cli;
mod convert;
mod edit_script;
mod export;
mod fixtures;
mod folder;
mod iges_truth;
mod import;
mod json_schema;
mod mend;
mod mutations;
mod pin_holes;
mod points;
mod saving;
mod tessellate_command;
mod tessellation;
mod truth;
