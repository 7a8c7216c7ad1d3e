//! Files from and to other systems, always through [`crate::scene::records`].

pub mod iges;
pub mod report;
