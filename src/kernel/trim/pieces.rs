//! Closed chains of bi-monotone rational Bezier pieces in f64: the exact trim loops of a face.
//!
//! Control data of all pieces lie in two flat arrays, because faces have hundreds of thousands of
//! them. Invariants: every chain is closed (a piece starts where the one before ends, bit for bit),
//! every piece is monotone in u and in v, weights are positive.

use glam::DVec2;

/// One bi-monotone rational Bezier curve of a [`PieceList`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Position of its first control point.
    pub first: u32,
    /// Polynomial degree; straight pieces always have 1.
    pub degree: u16,
    /// Whether the weights differ.
    pub rational: bool,
    /// Number of the curve in its loop record that it was cut from; `None` for a line that closes a gap.
    pub source: Option<u32>,
}

/// Closed chains of monotone pieces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PieceList {
    points: Vec<DVec2>,
    weights: Vec<f64>,
    pieces: Vec<Piece>,
    chain_ends: Vec<u32>,
}

impl PieceList {
    /// Adds a piece to the open chain.
    pub fn push(&mut self, points: &[DVec2], weights: &[f64], source: Option<u32>) {
        let first = self.points.len() as u32;
        let rational = weights.iter().any(|w| *w != weights[0]);
        self.points.extend_from_slice(points);
        self.weights.extend_from_slice(weights);
        self.pieces.push(Piece { first, degree: (points.len() - 1) as u16, rational, source });
    }

    /// Ends the open chain. Its last piece is bent to end exactly where its first one starts; a chain
    /// with fewer than two pieces, which bounds nothing, is taken away again.
    pub fn close_chain(&mut self) {
        let start = self.chain_ends.last().map_or(0, |e| *e as usize);
        if self.pieces.len() < start + 2 {
            if let Some(piece) = self.pieces.get(start) {
                self.points.truncate(piece.first as usize);
                self.weights.truncate(piece.first as usize);
                self.pieces.truncate(start);
            }
            return;
        }
        for i in start..self.pieces.len() {
            let next = if i + 1 == self.pieces.len() { start } else { i + 1 };
            let vertex = self.points[self.pieces[next].first as usize];
            let piece = self.pieces[i];
            self.points[piece.first as usize + piece.degree as usize] = vertex;
        }
        self.chain_ends.push(self.pieces.len() as u32);
    }

    /// Takes the last chain away and gives it as a list of its own.
    pub fn take_last_chain(&mut self) -> Self {
        let mut chain = Self::default();
        if let Some(last) = self.chain_count().checked_sub(1) {
            chain.append_chains(self, last..last + 1);
            let first = self.chain(last).start;
            let place = self.pieces[first].first as usize;
            self.chain_ends.truncate(last);
            self.pieces.truncate(first);
            self.points.truncate(place);
            self.weights.truncate(place);
        }
        chain
    }

    /// Adds whole chains of another list.
    pub fn append_chains(&mut self, other: &Self, chains: std::ops::Range<usize>) {
        if chains.is_empty() {
            return;
        }
        let (first, end) = (other.chain(chains.start).start, other.chain(chains.end - 1).end);
        let from = other.pieces[first].first as usize;
        let to = other.pieces.get(end).map_or(other.points.len(), |p| p.first as usize);
        let (place, number) = (self.points.len() as u32, self.pieces.len() as u32);
        self.points.extend_from_slice(&other.points[from..to]);
        self.weights.extend_from_slice(&other.weights[from..to]);
        let moved = |p: &Piece| Piece { first: p.first - from as u32 + place, ..*p };
        self.pieces.extend(other.pieces[first..end].iter().map(moved));
        self.chain_ends.extend(other.chain_ends[chains].iter().map(|e| e - first as u32 + number));
    }

    /// All pieces, chain after chain, in loop order.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Number of chains.
    pub fn chain_count(&self) -> usize {
        self.chain_ends.len()
    }

    /// Positions of the pieces of chain `index`.
    pub fn chain(&self, index: usize) -> std::ops::Range<usize> {
        let start = if index == 0 { 0 } else { self.chain_ends[index - 1] as usize };
        start..self.chain_ends[index] as usize
    }

    /// Control points of a piece, not premultiplied.
    pub fn points(&self, piece: &Piece) -> &[DVec2] {
        &self.points[piece.first as usize..=piece.first as usize + piece.degree as usize]
    }

    /// Weights of a piece.
    pub fn weights(&self, piece: &Piece) -> &[f64] {
        &self.weights[piece.first as usize..=piece.first as usize + piece.degree as usize]
    }

    /// First point of a piece.
    pub fn start(&self, piece: &Piece) -> DVec2 {
        self.points[piece.first as usize]
    }

    /// Last point of a piece.
    pub fn end(&self, piece: &Piece) -> DVec2 {
        self.points[piece.first as usize + piece.degree as usize]
    }
}

impl PieceList {
    /// Splits closed loops of Bezier curves into monotone pieces. Curves within `straight` of the segment
    /// between their ends become lines.
    pub fn from_loops(loops: &[Vec<crate::kernel::bezier::BezierCurve2>], straight: f64) -> Self {
        let mut list = Self::default();
        let mut splitter = crate::kernel::bezier::MonotoneSplitter::default();
        let given: usize = loops.iter().flatten().map(|c| c.points.len()).sum();
        list.points.reserve(2 * given);
        list.weights.reserve(2 * given);
        for curves in loops {
            for (number, curve) in curves.iter().enumerate() {
                let source = Some(number as u32);
                splitter.split(&curve.points, &curve.weights, straight, |p, w| list.push(p, w, source));
            }
            list.close_chain();
        }
        list
    }
}
