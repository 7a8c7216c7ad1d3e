//! The visibility buffer drawn on the CPU: tiles in parallel, every cell of a tile in turn.

use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::bins::{PixelRect, cover};
use super::cast::{CastCounts, Fragment, box_of, cast, piece_of, view_axes, view_ray};
use super::ray::{ViewBox, box_span, depth_from};
use super::solve::Piece;
use crate::encoding::PackedScene;
use crate::encoding::view::View;

/// Edge of a tile in pixels.
const TILE: u32 = 32;

/// What every pixel shows, rows from the top.
#[derive(Debug, Clone)]
pub struct VisibilityBuffer {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Pixels.
    pub fragments: Vec<Fragment>,
    /// What casting took.
    pub counts: CastCounts,
}

impl VisibilityBuffer {
    /// The pixel at column `x` of row `y`, both clamped to the picture.
    pub fn at(&self, x: i32, y: i32) -> Fragment {
        let x = x.clamp(0, self.width as i32 - 1) as usize;
        let y = y.clamp(0, self.height as i32 - 1) as usize;
        self.fragments[y * self.width as usize + x]
    }
}

/// Draws `scene` as `view` sees it.
pub fn draw(scene: &PackedScene, view: &View) -> VisibilityBuffer {
    draw_cells(scene, view, scene.visible_cells().collect())
}

/// Draws some of the cells, by position in the cell array.
pub fn draw_cells(scene: &PackedScene, view: &View, cells: Vec<u32>) -> VisibilityBuffer {
    let (width, height) = (view.size[0] as u32, view.size[1] as u32);
    let axes = view_axes(view);
    let pieces: Vec<Visible> = cells
        .par_iter()
        .filter_map(|index| {
            let cell = &scene.cells.data()[*index as usize];
            let piece = piece_of(view, cell);
            let shift: Vec3 = piece.shift;
            let bound = box_of(view, cell, shift);
            cover(view, &axes, cell, shift).map(|rect| Visible { index: *index, piece, rect, bound })
        })
        .collect();
    let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
    let mut bins: Vec<Vec<u32>> = vec![Vec::new(); (columns * rows) as usize];
    for (k, Visible { rect, .. }) in pieces.iter().enumerate() {
        for row in rect.min[1] / TILE..rect.max[1].div_ceil(TILE).min(rows) {
            for column in rect.min[0] / TILE..rect.max[0].div_ceil(TILE).min(columns) {
                bins[(row * columns + column) as usize].push(k as u32);
            }
        }
    }
    // Nearest first, so that most of what is hidden is found hidden without casting.
    let tiles: Vec<(Vec<Fragment>, CastCounts)> = bins
        .into_par_iter()
        .enumerate()
        .map(|(tile, mut list)| {
            list.sort_by(|a, b| {
                let z = |k: u32| pieces[k as usize].nearest();
                z(*a).total_cmp(&z(*b)).then(a.cmp(b))
            });
            let origin = [tile as u32 % columns * TILE, tile as u32 / columns * TILE];
            draw_tile(scene, view, &pieces, &list, origin)
        })
        .collect();
    let mut fragments = vec![Fragment::NONE; (width * height) as usize];
    for (tile, (drawn, _)) in tiles.iter().enumerate() {
        let origin = [tile as u32 % columns * TILE, tile as u32 / columns * TILE];
        for y in 0..TILE.min(height - origin[1]) {
            let count = TILE.min(width - origin[0]) as usize;
            let to = ((origin[1] + y) * width + origin[0]) as usize;
            let from = (y * TILE) as usize;
            fragments[to..to + count].copy_from_slice(&drawn[from..from + count]);
        }
    }
    let counts = tiles.iter().fold(CastCounts::default(), |sum, (_, counts)| sum + *counts);
    VisibilityBuffer { width, height, fragments, counts }
}

/// A cell in sight.
struct Visible {
    /// Position in the cell array.
    index: u32,
    piece: Piece,
    rect: PixelRect,
    bound: ViewBox,
}

impl Visible {
    /// Depth of the nearest corner of its box.
    fn nearest(&self) -> f32 {
        let b = &self.bound;
        let reach = |axis: Vec4| axis.z.abs() * axis.w;
        b.centre.z - reach(b.x) - reach(b.y) - reach(b.z)
    }
}

fn draw_tile(
    scene: &PackedScene,
    view: &View,
    pieces: &[Visible],
    list: &[u32],
    origin: [u32; 2],
) -> (Vec<Fragment>, CastCounts) {
    let mut tile = vec![Fragment::NONE; (TILE * TILE) as usize];
    let mut counts = CastCounts::default();
    let planes = Vec4::from(view.depth);
    for k in list {
        let Visible { index, piece, rect, bound } = &pieces[*k as usize];
        let cell = &scene.cells.data()[*index as usize];
        for y in rect.min[1].max(origin[1])..rect.max[1].min(origin[1] + TILE) {
            for x in rect.min[0].max(origin[0])..rect.max[0].min(origin[0] + TILE) {
                let pixel = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) + Vec2::from(view.jitter);
                let ray = view_ray(view, pixel);
                let span = box_span(ray, bound);
                if span.x > span.y {
                    continue;
                }
                counts.entered += 1;
                let here = &mut tile[((y - origin[1]) * TILE + x - origin[0]) as usize];
                if here.depth > depth_from(planes, span.x) {
                    counts.hidden += 1;
                    continue;
                }
                let fragment = cast(scene, view, cell, piece, ray, &mut counts);
                if fragment.words[0] != 0 && fragment.depth > here.depth {
                    *here = fragment;
                }
            }
        }
    }
    (tile, counts)
}
