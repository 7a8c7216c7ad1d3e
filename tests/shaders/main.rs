//! WGSL against the CPU twins and the f64 kernel.
