//! Identities and properties of the geometry kernel.
