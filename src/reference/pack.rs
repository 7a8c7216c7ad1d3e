//! The last word of the visibility buffer. Twin of `shaders/lib/pack.wgsl`.

use glam::{Vec2, Vec3};

fn octahedral(n: Vec3) -> Vec2 {
    let flat = n.truncate() / (n.x.abs() + n.y.abs() + n.z.abs()).max(1e-30);
    if n.z >= 0.0 { flat } else { fold(flat) }
}

fn fold(e: Vec2) -> Vec2 {
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    Vec2::new((1.0 - e.y.abs()) * sign(e.x), (1.0 - e.x.abs()) * sign(e.y))
}

fn from_octahedral(e: Vec2) -> Vec3 {
    let z = 1.0 - e.x.abs() - e.y.abs();
    let flat = if z >= 0.0 { e } else { fold(e) };
    flat.extend(z).normalize()
}

/// Unit vector as two signed 16-bit numbers.
pub fn pack_normal(n: Vec3) -> u32 {
    let e = octahedral(n);
    let part = |x: f32| ((0.5 + 32767.0 * x.clamp(-1.0, 1.0)).floor() as i32 as u32) & 0xffff;
    part(e.x) | part(e.y) << 16
}

/// The vector back.
pub fn unpack_normal(word: u32) -> Vec3 {
    let part = |x: u32| (f32::from(x as u16 as i16) / 32767.0).max(-1.0);
    from_octahedral(Vec2::new(part(word), part(word >> 16)))
}

/// Curve evaluations (7 bits), kept (1 bit), surface evaluations (8 bits), normal (2 x 8 bits).
pub fn pack_heat(n: Vec3, curve_evaluations: u32, kept: bool, surface_evaluations: u32) -> u32 {
    let e = (octahedral(n) * 0.5 + 0.5) * 255.0 + 0.5;
    curve_evaluations.min(127)
        | u32::from(kept) << 7
        | surface_evaluations.min(255) << 8
        | (e.x as u32) << 16
        | (e.y as u32) << 24
}

/// The normal of a heat word.
pub fn unpack_heat_normal(word: u32) -> Vec3 {
    let part = |x: u32| (x & 255) as f32 / 255.0;
    from_octahedral(2.0 * Vec2::new(part(word >> 16), part(word >> 24)) - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_survive_packing() {
        for k in 0..2000 {
            let a = k as f32 * 2.399_963;
            let z = 1.0 - 2.0 * (k as f32 + 0.5) / 2000.0;
            let r = (1.0 - z * z).sqrt();
            let n = Vec3::new(r * a.cos(), r * a.sin(), z);
            assert!((unpack_normal(pack_normal(n)) - n).length() < 1e-4, "{n}");
            assert!((unpack_heat_normal(pack_heat(n, 3, true, 2)) - n).length() < 2e-2, "{n}");
        }
    }
}
