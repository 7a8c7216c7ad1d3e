//! The visibility buffer drawn on the CPU: tiles in parallel, every cell of a tile in turn.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::bins::{PixelRect, cover};
use super::cast::{Fragment, cast, piece_of, view_axes};
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
    let pieces: Vec<(u32, Piece, PixelRect)> = cells
        .par_iter()
        .filter_map(|index| {
            let cell = &scene.cells.data()[*index as usize];
            let piece = piece_of(view, cell);
            let shift: Vec3 = piece.shift;
            cover(view, &axes, cell, shift).map(|rect| (*index, piece, rect))
        })
        .collect();
    let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
    let mut bins: Vec<Vec<u32>> = vec![Vec::new(); (columns * rows) as usize];
    for (k, (_, _, rect)) in pieces.iter().enumerate() {
        for row in rect.min[1] / TILE..rect.max[1].div_ceil(TILE).min(rows) {
            for column in rect.min[0] / TILE..rect.max[0].div_ceil(TILE).min(columns) {
                bins[(row * columns + column) as usize].push(k as u32);
            }
        }
    }
    // Nearest first, so that most of what is hidden is found hidden without casting.
    let tiles: Vec<Vec<Fragment>> = bins
        .into_par_iter()
        .enumerate()
        .map(|(tile, mut list)| {
            list.sort_by(|a, b| {
                let z = |k: u32| pieces[k as usize].1.m00.z;
                z(*a).total_cmp(&z(*b)).then(a.cmp(b))
            });
            let origin = [tile as u32 % columns * TILE, tile as u32 / columns * TILE];
            draw_tile(scene, view, &pieces, &list, origin)
        })
        .collect();
    let mut fragments = vec![Fragment::NONE; (width * height) as usize];
    for (tile, drawn) in tiles.iter().enumerate() {
        let origin = [tile as u32 % columns * TILE, tile as u32 / columns * TILE];
        for y in 0..TILE.min(height - origin[1]) {
            let count = TILE.min(width - origin[0]) as usize;
            let to = ((origin[1] + y) * width + origin[0]) as usize;
            let from = (y * TILE) as usize;
            fragments[to..to + count].copy_from_slice(&drawn[from..from + count]);
        }
    }
    VisibilityBuffer { width, height, fragments }
}

fn draw_tile(
    scene: &PackedScene,
    view: &View,
    pieces: &[(u32, Piece, PixelRect)],
    list: &[u32],
    origin: [u32; 2],
) -> Vec<Fragment> {
    let mut tile = vec![Fragment::NONE; (TILE * TILE) as usize];
    for k in list {
        let (index, piece, rect) = &pieces[*k as usize];
        let cell = &scene.cells.data()[*index as usize];
        let nearest = piece.m00.z - 2.0 * piece.size;
        let w = view.depth[2] + view.depth[3] * nearest;
        let best = if view.depth[3] == 0.0 || nearest > 0.0 {
            (view.depth[0] + view.depth[1] * nearest) / w
        } else {
            f32::INFINITY
        };
        for y in rect.min[1].max(origin[1])..rect.max[1].min(origin[1] + TILE) {
            for x in rect.min[0].max(origin[0])..rect.max[0].min(origin[0] + TILE) {
                let here = &mut tile[((y - origin[1]) * TILE + x - origin[0]) as usize];
                if here.depth >= best {
                    continue;
                }
                let pixel = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) + Vec2::from(view.jitter);
                let fragment = cast(scene, view, cell, piece, pixel);
                if fragment.words[0] != 0 && fragment.depth > here.depth {
                    *here = fragment;
                }
            }
        }
    }
    tile
}
