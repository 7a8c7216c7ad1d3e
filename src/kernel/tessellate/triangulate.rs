//! Constrained Delaunay triangulation of a face's loops, with the part inside known by flooding.
//!
//! The triangulation is `spade`'s, whose predicates are exact. Loops go in as constraints; where two chords cross a vertex
//! is put at the crossing, so that loops are free of intersections (P2, section 5.1). What is inside is decided once per
//! connected region by even-odd over all chords, as the rest of the program does; points inserted later inherit it.
//! Holes need no bridges: they are constraints like any others.

use glam::DVec2;
use spade::handles::{FixedDirectedEdgeHandle, FixedFaceHandle, FixedVertexHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, PositionInTriangulation, Triangulation};

/// A vertex of the triangulation: its place and its number among the caller's vertices.
#[derive(Debug, Clone, Copy)]
pub struct Site {
    place: Point2<f64>,
    /// Number of the vertex; [`Site::CROSSING`] for one made where chords cross, until it is given one.
    pub number: u32,
}

impl Site {
    /// Marks vertices at crossings.
    pub const CROSSING: u32 = u32::MAX;
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.place
    }
}

/// Whether a triangle belongs to the face.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Side {
    #[default]
    Unknown,
    Inside,
    Outside,
}

type Delaunay = ConstrainedDelaunayTriangulation<Site, (), (), Side>;

/// A triangulated region.
pub struct Region {
    delaunay: Delaunay,
}

/// A chord by its two vertices, numbers of the caller.
pub type Chord = [u32; 2];

/// Loops that could not be laid without crossing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Crossings {
    /// Pairs of chords that cross each other.
    pub pairs: Vec<(Chord, Chord)>,
    /// Places of the vertices made there.
    pub places: Vec<DVec2>,
    /// Whether a chord passes through a vertex.
    pub through: bool,
}

fn point(p: DVec2) -> Point2<f64> {
    // Numbers too small for exact predicates, which the triangulation refuses, are nothing.
    let clean = |x: f64| if x.abs() < 10.0 * spade::MIN_ALLOWED_VALUE { 0.0 } else { x };
    Point2::new(clean(p.x), clean(p.y))
}

fn place(p: Point2<f64>) -> DVec2 {
    DVec2::new(p.x, p.y)
}

impl Region {
    /// Triangulates closed `loops` of vertex numbers over `places`. Vertices in the same place become one: the first.
    /// Crossing vertices get numbers from `places.len()` on.
    pub fn new(places: &[DVec2], loops: &[Vec<u32>]) -> (Self, Crossings) {
        let count: usize = loops.iter().map(Vec::len).sum();
        let mut delaunay = Delaunay::with_capacity(count, 3 * count, 2 * count);
        let mut handles = vec![None; places.len()];
        let mut hint = None;
        // The caller's number of each vertex.
        let mut firsts: Vec<u32> = Vec::with_capacity(count);
        for number in loops.iter().flatten() {
            let site = Site { place: point(places[*number as usize]), number: *number };
            let handle = match hint {
                Some(hint) => delaunay.insert_with_hint(site, hint).ok(),
                None => delaunay.insert(site).ok(),
            };
            if let Some(handle) = handle {
                // Where a vertex lies already it stays, with its number.
                match firsts.get(handle.index()) {
                    Some(first) => delaunay.vertex_data_mut(handle).number = *first,
                    None => firsts.push(*number),
                }
            }
            handles[*number as usize] = handle;
            hint = handle.or(hint);
        }
        let mut crossings = Crossings::default();
        // By undirected edges, whose handles stay while no vertex is added.
        let mut odd = vec![false; delaunay.num_undirected_edges()];
        for ring in loops {
            for (k, from) in ring.iter().enumerate() {
                let to = ring[(k + 1) % ring.len()];
                let (Some(a), Some(b)) = (handles[*from as usize], handles[to as usize]) else { continue };
                if a == b {
                    continue;
                }
                let laid = delaunay.try_add_constraint(a, b);
                crossings.through |= laid.len() > 1;
                for edge in &laid {
                    if let Some(odd) = odd.get_mut(edge.as_undirected().index()) {
                        *odd = !*odd;
                    }
                }
                if !laid.is_empty() {
                    continue;
                }
                for edge in delaunay.get_conflicting_edges_between_vertices(a, b) {
                    let ends = [edge.from().data().number, edge.to().data().number];
                    crossings.pairs.push(([*from, to], ends));
                }
                delaunay.add_constraint_and_split(a, b, |p| Site { place: p, number: Site::CROSSING });
            }
        }
        let made: Vec<FixedVertexHandle> =
            delaunay.vertices().filter(|v| v.data().number == Site::CROSSING).map(|v| v.fix()).collect();
        for (number, handle) in (places.len() as u32..).zip(made) {
            crossings.places.push(place(delaunay.vertex(handle).position()));
            delaunay.vertex_data_mut(handle).number = number;
        }
        let mut region = Self { delaunay };
        // A crossing on a vertex makes no new place, but its chords were laid in other ways than counted.
        if crossings.pairs.is_empty() {
            region.spread(&odd);
        } else {
            region.flood(places, loops);
        }
        (region, crossings)
    }

    /// Marks every triangle as inside or outside, from the outside inwards: the side changes at chords laid an odd number
    /// of times. No numbers are compared, so triangles of no width are right as well.
    fn spread(&mut self, odd: &[bool]) {
        let mut open: Vec<(FixedFaceHandle<InnerTag>, bool)> = Vec::with_capacity(self.len() + 1);
        let changes = |edge: FixedDirectedEdgeHandle| odd.get(edge.as_undirected().index()) == Some(&true);
        for edge in self.delaunay.convex_hull() {
            let inner = [edge.face(), edge.rev().face()].into_iter().filter_map(|f| f.as_inner());
            open.extend(inner.map(|f| (f.fix(), changes(edge.fix()))));
        }
        while let Some((face, inside)) = open.pop() {
            if *self.delaunay.face(face).data() != Side::Unknown {
                continue;
            }
            *self.delaunay.face_data_mut(face) = if inside { Side::Inside } else { Side::Outside };
            for edge in self.delaunay.face(face).adjacent_edges() {
                let next = edge.rev().face().as_inner().map(|f| f.fix());
                open.extend(next.map(|f| (f, inside != changes(edge.fix()))));
            }
        }
    }

    /// Marks every triangle as inside or outside, each connected region by even-odd at one place.
    fn flood(&mut self, places: &[DVec2], loops: &[Vec<u32>]) {
        let faces: Vec<FixedFaceHandle<InnerTag>> = self.delaunay.fixed_inner_faces().collect();
        for start in faces {
            if *self.delaunay.face(start).data() != Side::Unknown {
                continue;
            }
            let mut region = vec![start];
            let (mut widest, mut middle) = (-1.0, DVec2::ZERO);
            *self.delaunay.face_data_mut(start) = Side::Outside;
            let mut k = 0;
            while k < region.len() {
                let face = self.delaunay.face(region[k]);
                let [a, b, c] = face.positions().map(place);
                // The roundest, largest triangle has the safest middle.
                let size = (b - a).perp_dot(c - a).abs()
                    / (a.distance(b) + b.distance(c) + c.distance(a)).max(f64::MIN_POSITIVE);
                if size > widest {
                    (widest, middle) = (size, (a + b + c) / 3.0);
                }
                let next: Vec<_> = face
                    .adjacent_edges()
                    .into_iter()
                    .filter(|e| !e.is_constraint_edge())
                    .filter_map(|e| e.rev().face().as_inner())
                    .filter(|f| *f.data() == Side::Unknown)
                    .map(|f| f.fix())
                    .collect();
                for face in next {
                    *self.delaunay.face_data_mut(face) = Side::Outside;
                    region.push(face);
                }
                k += 1;
            }
            if crosses_odd(places, loops, middle) {
                region.iter().for_each(|f| *self.delaunay.face_data_mut(*f) = Side::Inside);
            }
        }
    }

    /// Triangles inside, by vertex numbers, counter-clockwise.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let inside = self.delaunay.inner_faces().filter(|f| *f.data() == Side::Inside);
        inside.map(|f| f.vertices().map(|v| v.data().number))
    }

    /// Handles and numbers of the triangles inside.
    pub fn corners(&self) -> impl Iterator<Item = [FixedVertexHandle; 3]> {
        let inside = self.delaunay.inner_faces().filter(|f| *f.data() == Side::Inside);
        inside.map(|f| f.vertices().map(|v| v.fix()))
    }

    /// The caller's number of a vertex.
    pub fn number(&self, vertex: FixedVertexHandle) -> u32 {
        self.delaunay.vertex(vertex).data().number
    }

    /// Whether the triangle still stands, inside; then for each edge (from corner k to the next) whether it bounds the
    /// face.
    pub fn standing(&self, [a, b, c]: [FixedVertexHandle; 3]) -> Option<[bool; 3]> {
        let edge = self.delaunay.get_edge_from_neighbors(a, b)?;
        let face = edge.face().as_inner()?;
        let whole = edge.next().to().fix() == c && *face.data() == Side::Inside;
        whole.then(|| [edge, edge.next(), edge.prev()].map(|e| e.is_constraint_edge()))
    }

    /// The triangle of the face that has a place inside it, looked for from `hint`.
    pub fn around(&self, at: DVec2, hint: FixedVertexHandle) -> Option<[FixedVertexHandle; 3]> {
        match self.delaunay.locate_with_hint(point(at), hint) {
            PositionInTriangulation::OnFace(face) => {
                let face = self.delaunay.face(face);
                (*face.data() == Side::Inside).then(|| face.vertices().map(|v| v.fix()))
            }
            _ => None,
        }
    }

    /// Puts a vertex inside the face, near `hint`. Gives the triangles around it; `None` where it would lie on a vertex,
    /// on a chord or outside.
    pub fn insert(
        &mut self,
        at: DVec2,
        number: u32,
        hint: FixedVertexHandle,
    ) -> Option<Vec<[FixedVertexHandle; 3]>> {
        let site = Site { place: point(at), number };
        let found = self.delaunay.locate_with_hint(site.place, hint);
        let free = match found {
            PositionInTriangulation::OnFace(face) => {
                *self.delaunay.face(face).data() == Side::Inside && self.is_clear(face, at)
            }
            PositionInTriangulation::OnEdge(edge) => {
                let edge = self.delaunay.directed_edge(edge);
                let inside = edge.face().as_inner().is_some_and(|f| *f.data() == Side::Inside);
                let clear = |f: Option<FixedFaceHandle<InnerTag>>| f.is_none_or(|f| self.is_clear(f, at));
                inside
                    && !edge.is_constraint_edge()
                    && clear(edge.face().as_inner().map(|f| f.fix()))
                    && clear(edge.rev().face().as_inner().map(|f| f.fix()))
            }
            _ => false,
        };
        if !free {
            return None;
        }
        // It is looked for again: from where it was found.
        let near = match found {
            PositionInTriangulation::OnFace(face) => self.delaunay.face(face).vertices()[0].fix(),
            PositionInTriangulation::OnEdge(edge) => self.delaunay.directed_edge(edge).from().fix(),
            _ => hint,
        };
        let vertex = self.delaunay.insert_with_hint(site, near).ok()?;
        let around: Vec<FixedFaceHandle<InnerTag>> = self
            .delaunay
            .vertex(vertex)
            .out_edges()
            .filter_map(|e| e.face().as_inner())
            .map(|f| f.fix())
            .collect();
        for face in &around {
            *self.delaunay.face_data_mut(*face) = Side::Inside;
        }
        Some(around.into_iter().map(|f| self.delaunay.face(f).vertices().map(|v| v.fix())).collect())
    }

    /// The triangles inside that have a vertex as a corner.
    pub fn star(&self, vertex: FixedVertexHandle) -> impl Iterator<Item = [FixedVertexHandle; 3]> {
        let faces = self.delaunay.vertex(vertex).out_edges().filter_map(|e| e.face().as_inner());
        faces.filter(|f| *f.data() == Side::Inside).map(|f| f.vertices().map(|v| v.fix()))
    }

    /// Whether a place is not so near to a chord of the triangle that the triangle between them would be a sliver.
    fn is_clear(&self, face: FixedFaceHandle<InnerTag>, at: DVec2) -> bool {
        const NEAREST: f64 = 0.01;
        let edges = self.delaunay.face(face).adjacent_edges();
        edges.into_iter().filter(|e| e.is_constraint_edge()).all(|e| {
            let [a, b] = e.positions().map(place);
            (b - a).perp_dot(at - a) > NEAREST * a.distance_squared(b)
        })
    }

    /// Number of triangles, outside ones included.
    pub fn len(&self) -> usize {
        self.delaunay.num_inner_faces()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Even-odd over the chords.
fn crosses_odd(places: &[DVec2], loops: &[Vec<u32>], p: DVec2) -> bool {
    let mut odd = false;
    for ring in loops {
        for (k, from) in ring.iter().enumerate() {
            let (a, b) = (places[*from as usize], places[ring[(k + 1) % ring.len()] as usize]);
            if (a.y <= p.y) != (b.y <= p.y) {
                let x = a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y));
                odd ^= x > p.x;
            }
        }
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(region: &Region, places: &[DVec2]) -> f64 {
        let at = |i: u32| places[i as usize];
        region.triangles().map(|[a, b, c]| 0.5 * (at(b) - at(a)).perp_dot(at(c) - at(a))).sum()
    }

    fn ring(points: &[(f64, f64)], places: &mut Vec<DVec2>) -> Vec<u32> {
        let first = places.len() as u32;
        places.extend(points.iter().map(|p| DVec2::new(p.0, p.1)));
        (first..places.len() as u32).collect()
    }

    #[test]
    fn holes_and_islands_alternate() {
        let mut places = Vec::new();
        let square = |r: f64| [(-r, -r), (r, -r), (r, r), (-r, r)];
        let loops = [
            ring(&square(3.0), &mut places),
            ring(&square(2.0), &mut places),
            ring(&square(1.0), &mut places),
        ];
        let (region, crossings) = Region::new(&places, &loops);
        assert_eq!(crossings, Crossings::default());
        assert!((area(&region, &places) - (36.0 - 16.0 + 4.0)).abs() < 1e-12);
        // Triangles = vertices - 2 + 2 * holes.
        assert_eq!(region.triangles().count(), (8 - 2 + 2) + 2);
    }

    #[test]
    fn crossing_and_touching_loops_are_taken_by_even_odd() {
        let mut places = Vec::new();
        let bow = ring(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)], &mut places);
        let (region, crossings) = Region::new(&places, &[bow]);
        assert_eq!((crossings.pairs.len(), crossings.places.len()), (1, 1));
        assert!(crossings.places[0].distance(DVec2::ONE) < 1e-15);
        places.extend(&crossings.places);
        assert!((area(&region, &places) - 2.0).abs() < 1e-12);
        // Two squares that share a corner, and a third along a side of the first.
        let mut places = Vec::new();
        let loops = [
            ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], &mut places),
            ring(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)], &mut places),
            ring(&[(0.25, 0.0), (0.75, 0.0), (0.75, -1.0), (0.25, -1.0)], &mut places),
        ];
        let (region, _) = Region::new(&places, &loops);
        assert!((area(&region, &places) - 2.5).abs() < 1e-12);
    }

    #[test]
    fn a_hole_that_touches_the_sides_leaves_the_corners() {
        for off in [0.0, 1e-16, -1e-16, 1e-9, -1e-9] {
            let mut places = Vec::new();
            let square = ring(&[(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (1.0, 9.0)], &mut places);
            let circle = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / 48.0;
                (5.0 + (4.0 + off) * angle.cos(), 5.0 + (4.0 + off) * angle.sin())
            };
            let hole = ring(&(0..48).map(circle).collect::<Vec<_>>(), &mut places);
            let (region, crossings) = Region::new(&places, &[square, hole]);
            places.extend(&crossings.places);
            let expected = 64.0 - 0.5 * 48.0 * 16.0 * (std::f64::consts::TAU / 48.0).sin();
            assert!((area(&region, &places) - expected).abs() < 1e-6, "{off:e}: {}", area(&region, &places));
        }
    }

    #[test]
    fn vertices_go_in_only_inside() {
        let mut places = Vec::new();
        let loops = [ring(&[(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)], &mut places)];
        let (mut region, _) = Region::new(&places, &loops);
        let hint = region.corners().next().expect("a triangle")[0];
        assert!(region.insert(DVec2::new(2.0, 2.0), 3, hint).is_none(), "on a chord");
        assert!(region.insert(DVec2::new(3.0, 3.0), 3, hint).is_none(), "outside");
        assert!(region.insert(DVec2::ZERO, 3, hint).is_none(), "on a vertex");
        assert_eq!(region.insert(DVec2::ONE, 3, hint).map(|t| t.len()), Some(3));
    }
}
