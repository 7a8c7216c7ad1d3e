//! The parity grid against brute force, bit for bit, at every resolution; both against the f64 oracle.

use std::f64::consts::TAU;

use glam::{DVec2, Vec2};
use hairline::commands::bench::shapes::{Loops, Random, Shape, circle};
use hairline::kernel::bezier::BezierCurve2;
use hairline::kernel::trim::grid::GridOptions;
use hairline::kernel::trim::grid::layout::CELL_REFINED;
use hairline::kernel::trim::pack::PackedSegments;
use hairline::kernel::trim::{
    BruteForce, Counters, FillRule, ParityGrid, PieceList, SegmentSet, SlabGrid, TrimStructure, oracle,
};
use proptest::prelude::*;

struct Trimmed {
    pieces: PieceList,
    set: SegmentSet,
    packed: PackedSegments,
}

impl Trimmed {
    fn new(loops: &Loops) -> Self {
        let pieces = PieceList::from_loops(loops, 1e-9);
        let set = SegmentSet::new(&pieces);
        let packed = PackedSegments::new(&pieces, &set).expect("small");
        Self { pieces, set, packed }
    }

    /// Points where mistakes would hide: vertices and their float neighbours, points near curves, on
    /// cell borders, on the border of the square, and random ones.
    fn points(&self, count: usize, seed: u64) -> Vec<Vec2> {
        let mut random = Random(seed);
        let mut points = Vec::new();
        let nudge = |x: f32, by: i32| {
            if by == 0 {
                x
            } else if by > 0 {
                x.next_up()
            } else {
                x.next_down()
            }
        };
        while points.len() < count {
            let kind = random.bits() % 5;
            let p = random.point().as_vec2();
            let segment = &self.set.segments[(random.bits() % self.set.segments.len() as u64) as usize];
            let by = |r: &mut Random| (r.bits() % 3) as i32 - 1;
            points.push(match kind {
                0 => {
                    let (x, y) = if random.bits() & 1 == 0 { (0, 1) } else { (2, 3) };
                    let (u, v) = (segment.ends[x], segment.ends[y]);
                    Vec2::new(nudge(u, by(&mut random)), nudge(v, by(&mut random)))
                }
                1 => Vec2::new(p.x, nudge(segment.ends[1], by(&mut random))),
                2 => {
                    let piece = &self.pieces.pieces()[segment.piece as usize];
                    let q = oracle::point(&self.pieces, piece, random.unit());
                    let reach = 10f64.powf(-2.0 - 6.0 * random.unit());
                    (q + (random.point() - 0.5) * reach).as_vec2()
                }
                3 => {
                    let n = 1.0 + (random.bits() % 40) as f32;
                    Vec2::new(
                        nudge((p.x * n).round() / n, by(&mut random)),
                        nudge((p.y * n).round() / n, by(&mut random)),
                    )
                }
                _ => p,
            });
        }
        points
    }

    /// Every grid must answer like brute force, under both rules.
    fn check(&self, count: usize, seed: u64) {
        let points = self.points(count, seed);
        for rule in [FillRule::EvenOdd, FillRule::NonZero] {
            let brute = BruteForce::new(self.packed.clone(), rule);
            let truth: Vec<bool> = points.iter().map(|p| brute.classify(*p)).collect();
            for (per_segment, crowded, levels) in [
                (None, 8, 4),
                (None, 2, 4),
                (Some(0.01), 3, 4),
                (Some(1.0), 1, 2),
                (Some(7.3), 1, 3),
                (Some(60.0), 8, 1),
            ] {
                let options = GridOptions { cells_per_segment: per_segment, crowded, levels, rule };
                let grid = ParityGrid::new(&self.set, &self.packed, &options);
                let (slabs, lazy) = (SlabGrid::over(grid.clone()), SlabGrid::over(grid.clone()));
                slabs.complete();
                for (p, inside) in points.iter().zip(&truth) {
                    assert_eq!(grid.classify(*p), *inside, "{p:?} with {options:?}");
                    assert_eq!(slabs.classify(*p), *inside, "slabs: {p:?} with {options:?}");
                    assert_eq!(lazy.classify(*p), *inside, "lazy slabs: {p:?} with {options:?}");
                }
            }
        }
    }

    /// Answers of the grid and the oracle agree on points that are not on a curve.
    fn check_against_oracle(&self, count: usize, tolerance: f64) {
        let grid = ParityGrid::new(&self.set, &self.packed, &GridOptions::default());
        let mut checked = 0;
        for p in self.points(count, 7) {
            let q = p.as_dvec2();
            let inner = q.min_element() > 0.0 && q.max_element() < 1.0;
            if inner && !oracle::is_on(&self.pieces, q, tolerance) {
                let truth = oracle::inside(&self.pieces, q, FillRule::EvenOdd);
                assert_eq!(grid.classify(p), truth, "{p:?}");
                checked += 1;
            }
        }
        assert!(checked > count / 3, "only {checked} of {count} points were checked");
    }
}

fn polygon(points: &[(f64, f64)]) -> Vec<BezierCurve2> {
    let at = |i: usize| DVec2::from(points[i % points.len()]);
    (0..points.len()).map(|i| BezierCurve2::polynomial(vec![at(i), at(i + 1)])).collect()
}

fn square() -> Vec<BezierCurve2> {
    polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
}

/// A smooth closed loop of few curves of high degree.
fn high_degree(degree: usize, rational: bool, seed: u64) -> Vec<BezierCurve2> {
    let mut random = Random(seed);
    let curves = 4;
    let corners: Vec<DVec2> =
        (0..curves).map(|i| 0.5 + DVec2::from_angle(TAU * f64::from(i) / f64::from(curves)) * 0.3).collect();
    (0..curves as usize)
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % curves as usize]);
            let points = (0..=degree).map(|k| {
                let wobble = if k == 0 || k == degree { DVec2::ZERO } else { (random.point() - 0.5) * 0.3 };
                a.lerp(b, k as f64 / degree as f64) + wobble
            });
            let points = points.collect();
            let weights = (0..=degree)
                .map(|_| if rational { (2.0 * random.unit() - 1.0).exp() } else { 1.0 })
                .collect();
            BezierCurve2 { points, weights }
        })
        .collect()
}

fn zoo() -> Vec<(&'static str, Loops)> {
    let c = DVec2::splat(0.5);
    vec![
        ("square", vec![square()]),
        ("holes", Shape::Holes.loops(60)),
        ("rational holes", Shape::RationalHoles.loops(60)),
        ("blob", Shape::Blob.loops(200)),
        ("hair", Shape::Hair.loops(400)),
        ("nested", (0..8).map(|k| circle(c, 0.5 - 0.05 * f64::from(k), f64::from(k), k & 1 == 0)).collect()),
        ("touching square", vec![square(), circle(c, 0.5, 0.0, true)]),
        (
            "tangent",
            vec![circle(DVec2::new(0.3, 0.5), 0.2, 0.0, true), circle(DVec2::new(0.7, 0.5), 0.2, 0.0, false)],
        ),
        ("doubled", vec![circle(c, 0.4, 0.3, false), circle(c, 0.4, 0.3, false), square()]),
        (
            "doubled edge",
            vec![
                polygon(&[(0.1, 0.1), (0.5, 0.1), (0.5, 0.9), (0.1, 0.9)]),
                polygon(&[(0.5, 0.1), (0.9, 0.1), (0.9, 0.9), (0.5, 0.9)]),
            ],
        ),
        ("bow tie", vec![polygon(&[(0.1, 0.1), (0.9, 0.9), (0.9, 0.1), (0.1, 0.9)])]),
        (
            "spike",
            vec![polygon(&[
                (0.0, 0.0),
                (1.0, 0.0),
                (1.0, 0.5),
                (0.3, 0.5),
                (1.0, 0.5),
                (1.0, 1.0),
                (0.0, 1.0),
            ])],
        ),
        (
            "comb",
            vec![polygon(&[
                (0.0, 0.0),
                (1.0, 0.0),
                (1.0, 1.0),
                (0.8, 1.0),
                (0.8, 0.2),
                (0.6, 0.2),
                (0.6, 1.0),
                (0.4, 1.0),
                (0.4, 0.3),
                (0.2, 0.3),
                (0.2, 1.0),
                (0.0, 1.0),
            ])],
        ),
        (
            "stairs",
            vec![polygon(&[
                (0.0, 0.0),
                (1.0, 0.0),
                (1.0, 0.2),
                (0.7, 0.2),
                (0.7, 0.2),
                (0.7, 0.5),
                (0.5, 0.5),
                (0.4, 0.5),
                (0.1, 0.5),
            ])],
        ),
        (
            "sliver",
            vec![
                polygon(&[(0.0, 0.5), (1.0, 0.500_000_1), (1.0, 0.500_000_2), (0.3, 0.500_000_1)]),
                square(),
            ],
        ),
        ("tiny", vec![circle(c, 3e-7, 0.1, true), circle(c, 1e-4, 0.2, false), square()]),
        ("degree 13", vec![high_degree(13, false, 1), square()]),
        ("degree 13 rational", vec![high_degree(13, true, 2), square()]),
        ("degree 22", vec![high_degree(22, false, 3)]),
        ("degree 22 rational", vec![high_degree(22, true, 4)]),
        ("quartic", vec![high_degree(4, false, 5), high_degree(2, false, 6), high_degree(3, true, 8)]),
    ]
}

#[test]
fn the_grid_equals_brute_force_bit_for_bit_on_the_zoo() {
    let mut refined = 0;
    for (name, loops) in zoo() {
        println!("{name}");
        let trimmed = Trimmed::new(&loops);
        trimmed.check(3000, 1);
        let options = GridOptions { cells_per_segment: Some(0.01), crowded: 3, ..GridOptions::default() };
        let grid = ParityGrid::new(&trimmed.set, &trimmed.packed, &options);
        refined += grid.cells.iter().filter(|c| *c & CELL_REFINED != 0).count();
    }
    assert!(refined > 20, "only {refined} cells of the zoo are refined");
}

/// Slabs decide nearly all points, and many points near their borders are as the grid has them.
#[test]
fn slabs_leave_few_points_to_the_grid() {
    let shapes =
        [(Shape::Holes, 0.07), (Shape::RationalHoles, 0.07), (Shape::Blob, 0.07), (Shape::Hair, 0.2)];
    for (shape, most) in shapes {
        let trimmed = Trimmed::new(&shape.loops(400));
        let slabs = SlabGrid::new(&trimmed.set, &trimmed.packed, &GridOptions::default());
        slabs.complete();
        let brute = BruteForce::new(trimmed.packed.clone(), FillRule::EvenOdd);
        let (mut counters, count) = (Counters::default(), 20_000);
        let mut random = Random(11);
        for _ in 0..count {
            let p = random.point().as_vec2();
            assert_eq!(slabs.classify_counted(p, &mut counters), brute.classify(p), "{} {p:?}", shape.name());
        }
        let tested = counters.tests as f64 / f64::from(count);
        println!("{}: {tested}", shape.name());
        assert!(tested < most, "{}: {tested} tests for each point", shape.name());
    }
}

#[test]
fn the_grid_agrees_with_the_oracle_away_from_the_curves() {
    for (name, loops) in zoo() {
        println!("{name}");
        Trimmed::new(&loops).check_against_oracle(3000, 2.5e-7);
    }
}

/// A closed loop through random vertices, some of them equal, aligned or on the border.
fn random_loop() -> impl Strategy<Value = Vec<BezierCurve2>> {
    let coordinate = prop_oneof![
        3 => (0u32..=8).prop_map(|k| f64::from(k) / 8.0),
        2 => 0.0f64..1.0,
        1 => (0u32..4).prop_map(|k| 0.5 + f64::from(k) * 3e-8),
    ];
    let point = (coordinate.clone(), coordinate).prop_map(|(x, y)| DVec2::new(x, y));
    let vertex = (point.clone(), prop::collection::vec((point, -2.0f64..2.0), 0..4), any::<bool>());
    prop::collection::vec(vertex, 2..12).prop_map(|vertices| {
        let count = vertices.len();
        (0..count)
            .map(|i| {
                let (start, inner, rational) = &vertices[i];
                let mut points = vec![*start];
                points.extend(inner.iter().map(|(p, _)| *p));
                points.push(vertices[(i + 1) % count].0);
                let mut weights = vec![1.0; points.len()];
                if *rational {
                    for (w, (_, log)) in weights[1..].iter_mut().zip(inner) {
                        *w = log.exp();
                    }
                }
                BezierCurve2 { points, weights }
            })
            .collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]
    #[test]
    fn the_grid_equals_brute_force_on_random_loops(
        loops in prop::collection::vec(random_loop(), 1..4), seed in any::<u64>()
    ) {
        let trimmed = Trimmed::new(&loops);
        prop_assume!(!trimmed.set.segments.is_empty());
        trimmed.check(300, seed);
    }
}
