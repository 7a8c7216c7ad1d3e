//! The inside of the face, row of pixels by row of pixels, by the even-odd rule.
//!
//! For every row the crossings of its middle line with the trimming chains are sorted; what lies between the
//! first and the second, the third and the fourth, ... is inside. Neighbouring rows with the same
//! spans are joined, so that a rectangle is one quad.

use bevy_egui::egui::{Color32, Mesh, pos2};
use glam::DVec2;

use super::view::UvView;

/// Spans closer than this in neighbouring rows are the same, logical pixels.
const SAME_PX: f32 = 0.02;

/// A run of rows with one span.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bar {
    left: f32,
    right: f32,
    first: usize,
}

/// Quads that cover the inside of `chains` on the canvas; `row_px` is the height of a row, logical pixels.
pub fn inside(chains: &[Vec<DVec2>], view: &UvView, row_px: f64, color: Color32) -> Mesh {
    let rows = (view.size_px.y / row_px).ceil().clamp(0.0, 16_384.0) as usize;
    let crossings = cross(chains, view, row_px, rows);
    let mut mesh = Mesh::default();
    let top = |row: usize| (view.min_px.y + row as f64 * row_px) as f32;
    let mut emit = |bar: Bar, end: usize| {
        let first = mesh.vertices.len() as u32;
        for (x, y) in [(bar.left, bar.first), (bar.right, bar.first), (bar.right, end), (bar.left, end)] {
            mesh.colored_vertex(pos2(x, top(y)), color);
        }
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first, first + 2, first + 3);
    };
    let mut open: Vec<Bar> = Vec::new();
    for (row, line) in crossings.iter().enumerate() {
        let spans: Vec<(f32, f32)> =
            line.chunks_exact(2).map(|s| (s[0], s[1])).filter(|s| s.1 > s.0).collect();
        let same = spans.len() == open.len()
            && spans
                .iter()
                .zip(&open)
                .all(|(s, b)| (s.0 - b.left).abs() < SAME_PX && (s.1 - b.right).abs() < SAME_PX);
        if !same {
            open.drain(..).for_each(|bar| emit(bar, row));
            open = spans.iter().map(|s| Bar { left: s.0, right: s.1, first: row }).collect();
        }
    }
    open.drain(..).for_each(|bar| emit(bar, rows));
    mesh
}

/// Sorted abscissae, cut to the canvas, at which each row's middle line crosses the chains.
fn cross(chains: &[Vec<DVec2>], view: &UvView, row_px: f64, rows: usize) -> Vec<Vec<f32>> {
    let mut crossings: Vec<Vec<f32>> = vec![Vec::new(); rows];
    let (left, right) = (view.min_px.x, view.min_px.x + view.size_px.x);
    for chain in chains {
        let Some(last) = chain.last() else { continue };
        let mut a = view.to_screen(*last);
        for point in chain {
            let b = view.to_screen(*point);
            let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
            let row = |y: f64| ((y - view.min_px.y) / row_px - 0.5).ceil().clamp(0.0, rows as f64) as usize;
            let slope = (high.x - low.x) / (high.y - low.y);
            for (k, line) in crossings.iter_mut().enumerate().take(row(high.y)).skip(row(low.y)) {
                let y = view.min_px.y + (k as f64 + 0.5) * row_px;
                line.push((low.x + (y - low.y) * slope).clamp(left, right) as f32);
            }
            a = b;
        }
    }
    crossings.iter_mut().for_each(|line| line.sort_by(f32::total_cmp));
    crossings
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> UvView {
        UvView {
            centre: DVec2::splat(0.5),
            scale: DVec2::splat(100.0),
            size_px: DVec2::new(200.0, 120.0),
            ..UvView::default()
        }
    }

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        vec![DVec2::splat(low), DVec2::new(high, low), DVec2::splat(high), DVec2::new(low, high)]
    }

    fn area(mesh: &Mesh) -> f32 {
        let p = |i: u32| mesh.vertices[i as usize].pos;
        let triangle = |t: &[u32]| {
            let (a, b) = (p(t[1]) - p(t[0]), p(t[2]) - p(t[0]));
            0.5 * (a.x * b.y - a.y * b.x).abs()
        };
        mesh.indices.chunks_exact(3).map(triangle).sum()
    }

    #[test]
    fn a_square_is_one_quad_and_a_hole_is_left_out() {
        let one = inside(&[square(0.0, 1.0)], &view(), 1.0, Color32::WHITE);
        assert_eq!(one.vertices.len(), 4);
        assert!((area(&one) - 1e4).abs() < 1.0, "{}", area(&one));
        let holed = inside(&[square(0.0, 1.0), square(0.2, 0.6)], &view(), 1.0, Color32::WHITE);
        assert!((area(&holed) - 0.84e4).abs() < 1.0, "{}", area(&holed));
    }

    #[test]
    fn what_leaves_the_canvas_is_cut_off() {
        let all = inside(&[square(-5.0, 5.0)], &view(), 1.0, Color32::WHITE);
        assert!((area(&all) - 200.0 * 120.0).abs() < 1.0, "{}", area(&all));
        assert!(inside(&[square(4.0, 5.0)], &view(), 1.0, Color32::WHITE).vertices.is_empty());
        assert!(inside(&[], &view(), 1.0, Color32::WHITE).vertices.is_empty());
    }
}
