//! Faces that lie in a plane: there triangles have no error, whatever the parameters do.

use glam::{DVec2, DVec3};

use super::outline::Ground;

/// A plane with an orthonormal frame; `x cross y` is the normal on the side of `du x dv`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// A point of it.
    pub origin: DVec3,
    /// First axis.
    pub x: DVec3,
    /// Second axis.
    pub y: DVec3,
}

impl Plane {
    /// The plane that all control points of the patches lie within `tolerance` of, if there is one.
    pub fn of(ground: &Ground, tolerance: f64) -> Option<Self> {
        let points = || ground.patches().iter().flat_map(|p| &p.points);
        let origin = *points().next()?;
        let far = |from: DVec3| {
            points().map(move |p| *p - from).max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        };
        let x = far(origin)?.try_normalize()?;
        let aside = |p: &DVec3| (*p - origin) - x * (*p - origin).dot(x);
        let y = points().map(aside).max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
        let y = y.try_normalize()?;
        let normal = x.cross(y);
        if points().any(|p| !((*p - origin).dot(normal).abs() <= tolerance)) {
            return None;
        }
        // Which side the surface faces: by the sum of its patches' normals.
        let side: f64 = ground
            .patches()
            .iter()
            .map(|p| {
                let at = p.tangents(0.5, 0.5);
                at.du.cross(at.dv).dot(normal)
            })
            .sum();
        Some(if side < 0.0 { Self { origin, x, y: -y } } else { Self { origin, x, y } })
    }

    /// Coordinates of the foot of `p`.
    pub fn coordinates(&self, p: DVec3) -> DVec2 {
        let d = p - self.origin;
        DVec2::new(d.dot(self.x), d.dot(self.y))
    }

    /// The normal.
    pub fn normal(&self) -> DVec3 {
        self.x.cross(self.y)
    }
}
