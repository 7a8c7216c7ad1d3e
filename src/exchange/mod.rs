//! Files from and to other systems, always through [`crate::scene::records`].

pub mod boundary;
pub mod iges;
pub mod mesh;
pub mod report;
