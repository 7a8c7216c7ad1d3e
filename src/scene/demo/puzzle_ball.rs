//! Hollow balls one inside the other, each an exact rational sphere; rosettes at the corners of an
//! icosahedron and round holes at the centres of its faces. Some trims cross the seam, where their
//! loops run past the knots; the walls of the outer shell are exact ruled surfaces of degree 12 x 1.

use glam::{DQuat, DVec2, DVec3};

use super::assembly::Assembly;
use super::outline::{rosette, smooth_at};
use super::ruled::wall;
use super::shape::{sphere, sphere_parameters};
use crate::kernel::nurbs::{NurbsCurve2, NurbsSurface};

/// Centre of all the shells.
const CENTRE: DVec3 = DVec3::new(0.0, 0.0, 64.0);
/// Thickness of the outer shell.
const THICKNESS: f64 = 3.2;

/// Adds the shells and the core.
pub fn add(assembly: &mut Assembly) {
    assembly.part("Puzzle ball", [0.83, 0.74, 0.58]);
    let turn = DQuat::from_rotation_y(0.35) * DQuat::from_rotation_z(0.5);
    let (outer, inner) = (shell(40.0, turn), shell(40.0 - THICKNESS, turn));
    let mut holes: Vec<Vec<NurbsCurve2>> = Vec::new();
    for (corner, neighbour) in corners() {
        holes.push(hole(corner, neighbour, 0.335, 5.0, 0.28, 20));
    }
    for centre in face_centres() {
        holes.push(hole(centre, DVec3::Z, 0.15, 1.0, 0.0, 8));
    }
    let loops = cut_at_seam(&holes);
    assembly.face("Outer shell, outside", outer.clone(), loops.clone());
    assembly.colour([0.55, 0.40, 0.24]);
    assembly.face("Outer shell, inside", inner.clone(), loops);
    assembly.reverse();
    assembly.colour([0.83, 0.66, 0.40]);
    for (i, trim) in holes.iter().enumerate() {
        assembly.face(format!("Wall of hole {}", i + 1), wall(&outer, &inner, trim), Vec::new());
    }

    assembly.part("Middle ball", [0.02, 0.30, 0.33]);
    let turn = DQuat::from_rotation_x(0.9) * DQuat::from_rotation_z(0.2);
    let mut holes: Vec<_> =
        corners().map(|(corner, neighbour)| hole(corner, neighbour, 0.37, 1.0, 0.0, 8)).collect();
    holes.extend(face_centres().map(|centre| hole(centre, DVec3::Z, 0.19, 1.0, 0.0, 8)));
    assembly.face("Lattice", shell(27.0, turn), cut_at_seam(&holes));

    assembly.part("Core", [0.95, 0.55, 0.12]);
    assembly.face("Core", shell(14.0, DQuat::IDENTITY), Vec::new());
}

fn shell(radius: f64, turn: DQuat) -> NurbsSurface {
    sphere(radius).map_points(|p| turn * p + CENTRE)
}

/// The corners of an icosahedron with the north pole in the middle of an edge, each with a neighbour.
fn corners() -> impl Iterator<Item = (DVec3, DVec3)> {
    let all = corner_list();
    (0..all.len()).map(move |i| {
        let nearest = |a: &&DVec3, b: &&DVec3| all[i].distance(**a).total_cmp(&all[i].distance(**b));
        let neighbour = all.iter().filter(|q| **q != all[i]).min_by(nearest).copied();
        (all[i], neighbour.unwrap_or(DVec3::Z))
    })
}

fn corner_list() -> Vec<DVec3> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.push(DVec3::new(0.0, a, b).normalize());
        corners.push(DVec3::new(a, b, 0.0).normalize());
        corners.push(DVec3::new(b, 0.0, a).normalize());
    }
    corners
}

fn face_centres() -> impl Iterator<Item = DVec3> {
    let all = corner_list();
    let edge = 1.1;
    let mut centres = Vec::new();
    for i in 0..all.len() {
        for j in i + 1..all.len() {
            for k in j + 1..all.len() {
                let longest =
                    all[i].distance(all[j]).max(all[j].distance(all[k])).max(all[k].distance(all[i]));
                if longest < edge {
                    centres.push((all[i] + all[j] + all[k]).normalize());
                }
            }
        }
    }
    centres.into_iter()
}

/// The hole of angular radius `opening * (1 + depth cos(petals * turn))` around `axis`, the first
/// petal towards `towards`: at least `pieces` cubics, broken where they cross a knot line.
fn hole(
    axis: DVec3,
    towards: DVec3,
    opening: f64,
    petals: f64,
    depth: f64,
    pieces: usize,
) -> Vec<NurbsCurve2> {
    let x =
        (towards - axis * towards.dot(axis)).try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
    let y = axis.cross(x);
    let shape = rosette(petals, depth, 0.0);
    let direction = |t: f64| {
        let p = shape(t);
        let angle = opening * p.length();
        let spin = p.normalize() * angle.sin();
        axis * angle.cos() + x * spin.x + y * spin.y
    };
    let middle = sphere_parameters(axis).x;
    // Continuous across the seam: the turn nearest to the middle of the hole.
    let path = |t: f64| {
        let mut uv = sphere_parameters(direction(t));
        uv.x -= 4.0 * ((uv.x - middle) / 4.0).round();
        uv
    };
    let mut curves = smooth_at(path, &breaks(&path, pieces));
    let farthest = curves.iter().map(|c| c.points()[0].x).fold(0.0, f64::max);
    // A hole across the seam lies around u = 0, with both its crossings exactly there.
    let turn = if farthest > 4.0 + ON_SEAM { 4.0 } else { 0.0 };
    for curve in &mut curves {
        *curve = curve.map_points(|p| {
            let u = p.x - turn;
            DVec2::new(if u.abs() < ON_SEAM { 0.0 } else { u }, p.y)
        });
    }
    curves
}

/// How near to the seam a point counts as on it.
const ON_SEAM: f64 = 1e-9;

/// The loops of a ball: its whole parameter rectangle, with notches where a hole lies across the
/// seam, and the other holes.
fn cut_at_seam(holes: &[Vec<NurbsCurve2>]) -> Vec<Vec<NurbsCurve2>> {
    let middle = |c: &NurbsCurve2| c.point(0.5).x;
    let (mut notched, mut loops): (Vec<_>, Vec<_>) =
        holes.iter().partition(|hole| hole.iter().any(|c| middle(c) < 0.0));
    // From the south pole upwards.
    notched.sort_by(|a, b| a[0].points()[0].y.total_cmp(&b[0].points()[0].y));
    let mut sides: [Vec<NurbsCurve2>; 2] = [Vec::new(), Vec::new()];
    for (side, u) in sides.iter_mut().zip([0.0, 4.0]) {
        let mut from = DVec2::new(u, 0.0);
        for hole in &notched {
            let inside = |c: &NurbsCurve2| (middle(c) >= 0.0) == (u == 0.0);
            let count = hole.len();
            // The half of the loop on this side of the seam, from its first curve on.
            let first = (0..count).find(|i| inside(&hole[*i]) && !inside(&hole[(i + count - 1) % count]));
            let first = first.unwrap_or(0);
            let mut half: Vec<NurbsCurve2> = (first..first + count)
                .map(|i| &hole[i % count])
                .take_while(|c| inside(c))
                .map(|c| c.map_points(|p| p + DVec2::new(u, 0.0)))
                .collect();
            if u > 0.0 {
                half = half.iter().rev().map(NurbsCurve2::reversed).collect();
            }
            side.push(NurbsCurve2::line(from, half[0].points()[0]));
            from = half[half.len() - 1].points()[3];
            side.extend(half);
        }
        side.push(NurbsCurve2::line(from, DVec2::new(u, 2.0)));
    }
    let [west, east] = sides;
    let (south, north) = ((DVec2::ZERO, DVec2::new(4.0, 0.0)), (DVec2::new(4.0, 2.0), DVec2::new(0.0, 2.0)));
    let mut outer = vec![NurbsCurve2::line(south.0, south.1)];
    outer.extend(east);
    outer.push(NurbsCurve2::line(north.0, north.1));
    outer.extend(west.iter().rev().map(NurbsCurve2::reversed));
    std::iter::once(outer).chain(loops.drain(..).cloned()).collect()
}

/// `pieces` even breaks in 0..1 and the crossings of the knot lines of a sphere.
fn breaks(path: &dyn Fn(f64) -> DVec2, pieces: usize) -> Vec<f64> {
    let even = (0..pieces).map(|i| i as f64 / pieces as f64);
    let mut crossings: Vec<f64> = Vec::new();
    let side = |uv: DVec2| (uv.x.floor(), uv.y >= 1.0);
    const STEPS: usize = 500;
    for i in 0..STEPS {
        let (mut a, mut b) = (i as f64 / STEPS as f64, (i + 1) as f64 / STEPS as f64);
        let start = side(path(a));
        if start != side(path(b)) {
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                if side(path(middle)) == start { a = middle } else { b = middle }
            }
            crossings.push(0.5 * (a + b));
        }
    }
    // An even break right beside a crossing, also across the start, would leave a sliver.
    let apart = |a: f64, b: f64| (a - b).abs().min(1.0 - (a - b).abs());
    let alone = |t: &f64| crossings.iter().all(|c| apart(*c, *t) >= 0.15 / pieces as f64);
    let mut breaks: Vec<f64> = even.filter(alone).collect();
    breaks.extend(&crossings);
    breaks.sort_by(f64::total_cmp);
    breaks
}
