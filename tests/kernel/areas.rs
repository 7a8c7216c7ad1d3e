//! Areas of trimmed faces against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};
use hairline::commands::bench::shapes::Shape;
use hairline::kernel::bezier::{BezierCurve2, BezierPatch};
use hairline::kernel::face::UvRect;
use hairline::kernel::nurbs::{KnotVector, NurbsSurface};
use hairline::kernel::query::{Area, Boundary, Sheet, trimmed_area};
use hairline::kernel::trim::PieceList;

use crate::zoo::{arc, revolution, sphere, torus};

/// The rectangle from `min` to `max` as a plane in space, tilted: its area is `slant` times that in uv.
fn plane(min: DVec2, max: DVec2) -> (NurbsSurface, f64) {
    let (a, b) = (DVec3::new(1.0, 0.5, 0.2), DVec3::new(-0.3, 2.0, 1.0));
    let knots = |low, high| KnotVector::bezier(1, low, high).expect("not empty");
    let corners = [min, DVec2::new(min.x, max.y), DVec2::new(max.x, min.y), max];
    let points = corners.iter().map(|c| a * c.x + b * c.y).collect();
    let surface = NurbsSurface::new(knots(min.x, max.x), knots(min.y, max.y), points, vec![1.0; 4]);
    (surface.expect("plane"), a.cross(b).length())
}

fn measure(surface: &NurbsSurface, loops: &[Vec<BezierCurve2>]) -> Area {
    let mut pieces = PieceList::default();
    for curves in loops {
        curves.iter().for_each(|c| pieces.push(&c.points, &c.weights, None));
        pieces.close_chain();
    }
    let unit = UvRect { min: DVec2::ZERO, max: DVec2::ONE };
    let patches: Vec<BezierPatch> = surface.to_bezier();
    trimmed_area(&Sheet::new(&patches), &Boundary::new(&pieces, &unit))
}

fn circle(centre: DVec2, radius: f64) -> Vec<BezierCurve2> {
    arc(centre, radius, 4).to_bezier().into_iter().map(|(piece, _)| piece).collect()
}

fn polygon(points: &[DVec2]) -> Vec<BezierCurve2> {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| BezierCurve2::polynomial(vec![*a, *b])).collect()
}

fn rectangle(min: DVec2, max: DVec2) -> Vec<BezierCurve2> {
    polygon(&[min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)])
}

fn assert_area(found: Area, expected: f64) {
    let off = (found.value - expected).abs() / expected;
    assert!(off < 1e-9, "{found:?}, expected {expected}: off by {off:e}");
    assert!((found.value - expected).abs() <= found.error + 1e-11 * expected, "{found:?} {expected}");
}

#[test]
fn a_plate_with_holes_and_an_island() {
    let (surface, slant) = plane(DVec2::new(-4.0, -3.0), DVec2::new(5.0, 6.0));
    let loops = [
        rectangle(DVec2::new(-3.0, -2.0), DVec2::new(3.0, 2.0)),
        circle(DVec2::new(1.0, 0.3), 1.5),
        circle(DVec2::new(1.2, 0.4), 0.5),
        circle(DVec2::new(-2.0, -1.0), 0.75),
    ];
    assert_area(measure(&surface, &loops), slant * (24.0 - PI * (2.25 - 0.25 + 0.5625)));
}

#[test]
fn orientation_and_order_of_loops_do_not_matter() {
    let (surface, slant) = plane(DVec2::splat(-2.0), DVec2::splat(2.0));
    let hole: Vec<BezierCurve2> = circle(DVec2::ZERO, 0.5).iter().rev().map(|c| c.reversed()).collect();
    let outer = circle(DVec2::ZERO, 1.0);
    assert_area(measure(&surface, &[hole.clone(), outer.clone()]), slant * 0.75 * PI);
    let hole = circle(DVec2::ZERO, 0.5);
    assert_area(measure(&surface, &[outer, hole]), slant * 0.75 * PI);
}

#[test]
fn whole_surfaces_of_revolution() {
    assert_area(measure(&sphere(), &[]), 4.0 * PI);
    assert_area(measure(&torus(2.0, 0.7), &[]), 4.0 * PI * PI * 2.0 * 0.7);
}

#[test]
fn an_octant_of_the_sphere_and_a_zone() {
    // u from 0 to 1 is a quarter turn, v from 1 to 2 the northern half.
    let octant = rectangle(DVec2::new(0.0, 1.0), DVec2::new(1.0, 2.0));
    assert_area(measure(&sphere(), &[octant]), FRAC_PI_2);
    // Between the equator and the height of v = 1.5, z = sqrt(1/2): area is proportional to height.
    let zone = rectangle(DVec2::new(0.0, 1.0), DVec2::new(4.0, 1.5));
    assert_area(measure(&sphere(), &[zone]), 2.0 * PI * 0.5f64.sqrt());
}

#[test]
fn a_triangle_on_a_cone_through_its_tip() {
    let profile = hairline::kernel::nurbs::NurbsCurve2::line(DVec2::ZERO, DVec2::new(1.0, 2.0));
    // Half the cone, as a rectangle in uv from the tip.
    let half = rectangle(DVec2::ZERO, DVec2::new(2.0, 1.0));
    assert_area(measure(&revolution(&profile), &[half]), 0.5 * PI * 5f64.sqrt());
}

#[test]
fn empty_loops_have_no_area() {
    let (surface, _) = plane(DVec2::ZERO, DVec2::ONE);
    let line = polygon(&[DVec2::splat(0.2), DVec2::splat(0.8)]);
    assert!(measure(&surface, &[line]).value.abs() < 1e-15);
    let beside = circle(DVec2::new(5.0, 0.5), 0.3);
    assert_eq!(measure(&surface, &[beside]).value, 0.0);
}

#[test]
fn a_plate_with_a_thousand_holes_in_strips() {
    let (surface, slant) = plane(DVec2::ZERO, DVec2::splat(34.0));
    let mut loops = vec![rectangle(DVec2::splat(0.5), DVec2::splat(33.5))];
    // Rows shifted against each other, so that holes have many heights.
    for k in 0..1024u32 {
        let (i, j) = (f64::from(k / 32), f64::from(k % 32));
        loops.push(circle(DVec2::new(1.0 + i, 1.0 + j + 0.013 * i), 0.3));
    }
    assert_area(measure(&surface, &loops), slant * (33.0 * 33.0 - 1024.0 * 0.09 * PI));
    // A comb: one loop that leaves and enters every strip.
    let mut comb = vec![DVec2::new(1.0, 1.0)];
    for k in 0..200 {
        let v = 1.0 + 0.15 * f64::from(k);
        comb.extend([DVec2::new(33.0, v + 0.01), DVec2::new(33.0, v + 0.06), DVec2::new(1.0, v + 0.1)]);
    }
    comb.push(DVec2::new(0.7, 1.0 + 0.15 * 200.0));
    let next = comb.iter().cycle().skip(1);
    let doubled: f64 = comb.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
    assert_area(measure(&surface, &[polygon(&comb)]), slant * 0.5 * doubled.abs());
}

#[test]
fn a_boundary_too_tangled_for_panels_is_sampled() {
    let loops = Shape::Hair.loops(10_000);
    // Green's theorem, exact for cubics with three nodes.
    let off = (3.0f64 / 20.0).sqrt();
    let around = loops[0].iter().map(|curve| {
        let term = |t: f64, w: f64| {
            let jet = curve.jet(t);
            w * jet.point.x * jet.d1.y
        };
        term(0.5 - off, 5.0 / 18.0) + term(0.5, 8.0 / 18.0) + term(0.5 + off, 5.0 / 18.0)
    });
    let expected = around.sum::<f64>().abs();
    let (surface, slant) = plane(DVec2::ZERO, DVec2::ONE);
    let pieces = PieceList::from_loops(&loops, 1e-9);
    let unit = UvRect { min: DVec2::ZERO, max: DVec2::ONE };
    let found = trimmed_area(&Sheet::new(&surface.to_bezier()), &Boundary::new(&pieces, &unit));
    let miss = (found.value / slant - expected).abs() / expected;
    assert!(miss < 1e-3 && found.error < 0.02 * found.value, "{found:?}, {expected} times {slant}");
    assert!(found.error > 1e-8 * found.value, "measured in panels: {found:?}");
}

#[test]
fn a_folded_surface_ends_with_an_honest_error() {
    // Flat and folded: the area element has creases along curves inside the patch.
    let mut patch = crate::zoo::Seed(21).patch((4, 4), false);
    patch.points.iter_mut().for_each(|p| p.z = 0.0);
    let patches = [patch.clone()];
    let found = trimmed_area(&Sheet::new(&patches), &Boundary::default());
    let n = 1500;
    let middle = |k: usize| (k as f64 + 0.5) / f64::from(n as u32);
    let sum: f64 = (0..n * n)
        .map(|k| {
            let at = patch.tangents(middle(k / n), middle(k % n));
            at.du.cross(at.dv).length()
        })
        .sum();
    let sum = sum / (n * n) as f64;
    assert!((found.value - sum).abs() < 1e-4 * sum + found.error, "{found:?} {sum}");
    assert!(found.error < 1e-2 * sum, "{found:?}");
}
