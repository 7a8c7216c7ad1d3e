//! Icons drawn with lines, so that they are sharp at every scale and follow the theme.

use bevy_egui::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, vec2};

/// The icons, each drawn in a square.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::editor) enum Icon {
    Open,
    Fit,
    FitSelection,
    Cube,
    Faces,
    Uv,
    Heat,
    Untrimmed,
    Edges,
    Grid,
    Sun,
    Moon,
    Perspective,
    Parallel,
    Eye,
    EyeOff,
    Left,
    Right,
    Down,
    Search,
    Cross,
    Note,
    Warning,
    Error,
    Tree,
    Properties,
    Report,
    Question,
    Arrow,
    Rectangle,
    Circle,
    Polyline,
    Freehand,
    Knot,
    Split,
    Magnet,
    Intervals,
    Cells,
    DockBelow,
    DockBeside,
    Curves,
    Net,
    UvEditor,
    Triangles,
    Wipe,
}

/// Draws `icon` in the middle of `rect`, 16 points wide.
pub(in crate::editor) fn paint(painter: &Painter, rect: Rect, icon: Icon, color: Color32) {
    let side = 16.0;
    let origin = rect.center() - vec2(side, side) / 2.0;
    let at = |x: f32, y: f32| origin + vec2(x, y);
    let stroke = Stroke::new(1.3, color);
    let line = |points: &[(f32, f32)]| {
        let points: Vec<Pos2> = points.iter().map(|(x, y)| at(*x, *y)).collect();
        painter.add(Shape::line(points, stroke));
    };
    let closed = |points: &[(f32, f32)]| {
        let points: Vec<Pos2> = points.iter().map(|(x, y)| at(*x, *y)).collect();
        painter.add(Shape::closed_line(points, stroke));
    };
    let fill = |points: &[(f32, f32)], color: Color32| {
        let points: Vec<Pos2> = points.iter().map(|(x, y)| at(*x, *y)).collect();
        painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
    };
    let circle = |x: f32, y: f32, r: f32| {
        painter.circle_stroke(at(x, y), r, stroke);
    };
    let dim = |f: f32| color.gamma_multiply(f);
    const TOP: [(f32, f32); 4] = [(8.0, 1.5), (14.0, 4.8), (8.0, 8.0), (2.0, 4.8)];
    const LEFT: [(f32, f32); 4] = [(2.0, 4.8), (8.0, 8.0), (8.0, 14.8), (2.0, 11.4)];
    const RIGHT: [(f32, f32); 4] = [(14.0, 4.8), (14.0, 11.4), (8.0, 14.8), (8.0, 8.0)];
    match icon {
        Icon::Open => line(&[
            (1.5, 13.0),
            (1.5, 3.0),
            (6.0, 3.0),
            (7.5, 5.0),
            (13.0, 5.0),
            (13.0, 7.0),
            (4.5, 7.0),
            (1.5, 13.0),
            (12.0, 13.0),
            (15.0, 7.0),
            (13.0, 7.0),
        ]),
        Icon::Fit => {
            line(&[(1.5, 5.0), (1.5, 1.5), (5.0, 1.5)]);
            line(&[(11.0, 1.5), (14.5, 1.5), (14.5, 5.0)]);
            line(&[(14.5, 11.0), (14.5, 14.5), (11.0, 14.5)]);
            line(&[(5.0, 14.5), (1.5, 14.5), (1.5, 11.0)]);
        }
        Icon::FitSelection => {
            paint(painter, rect, Icon::Fit, color);
            fill(&[(5.0, 5.0), (11.0, 5.0), (11.0, 11.0), (5.0, 11.0)], color);
        }
        Icon::Cube => {
            fill(&TOP, dim(0.35));
            fill(&LEFT, dim(0.75));
            fill(&RIGHT, color);
        }
        Icon::Faces => {
            fill(&TOP, Color32::from_rgb(120, 184, 122));
            fill(&LEFT, Color32::from_rgb(224, 138, 90));
            fill(&RIGHT, Color32::from_rgb(104, 150, 214));
        }
        Icon::Uv => {
            fill(&[(2.0, 2.0), (8.0, 2.0), (8.0, 8.0), (2.0, 8.0)], Color32::from_rgb(70, 160, 90));
            fill(&[(8.0, 2.0), (14.0, 2.0), (14.0, 8.0), (8.0, 8.0)], Color32::from_rgb(226, 196, 80));
            fill(&[(2.0, 8.0), (8.0, 8.0), (8.0, 14.0), (2.0, 14.0)], Color32::from_rgb(54, 62, 70));
            fill(&[(8.0, 8.0), (14.0, 8.0), (14.0, 14.0), (8.0, 14.0)], Color32::from_rgb(206, 86, 74));
        }
        Icon::Heat => {
            for (i, c) in
                [(58, 92, 190), (72, 180, 170), (226, 200, 80), (222, 90, 60)].into_iter().enumerate()
            {
                let x = 1.5 + 3.4 * i as f32;
                let h = 4.0 + 3.0 * i as f32;
                let c = Color32::from_rgb(c.0, c.1, c.2);
                fill(&[(x, 14.5 - h), (x + 2.8, 14.5 - h), (x + 2.8, 14.5), (x, 14.5)], c);
            }
        }
        Icon::Untrimmed => {
            closed(&[(2.0, 2.0), (14.0, 2.0), (14.0, 14.0), (2.0, 14.0)]);
            painter.circle_filled(at(8.0, 8.0), 3.4, dim(0.45));
            circle(8.0, 8.0, 3.4);
        }
        Icon::Triangles => {
            closed(&[(1.5, 13.5), (5.5, 2.5), (14.5, 6.0), (11.0, 14.0)]);
            line(&[(1.5, 13.5), (8.0, 8.5), (5.5, 2.5)]);
            line(&[(14.5, 6.0), (8.0, 8.5), (11.0, 14.0)]);
        }
        Icon::Wipe => {
            circle(8.0, 8.0, 5.5);
            fill(&[(8.0, 3.0), (12.3, 5.5), (12.3, 10.5), (8.0, 13.0)], dim(0.5));
            line(&[(8.0, 0.5), (8.0, 15.5)]);
        }
        Icon::Edges => {
            closed(&TOP);
            line(&[(2.0, 4.8), (2.0, 11.4), (8.0, 14.8), (14.0, 11.4), (14.0, 4.8)]);
            line(&[(8.0, 8.0), (8.0, 14.8)]);
        }
        Icon::Grid => {
            for t in [2.0, 6.0, 10.0, 14.0] {
                line(&[(t, 2.0), (t, 14.0)]);
                line(&[(2.0, t), (14.0, t)]);
            }
        }
        Icon::Sun => {
            circle(8.0, 8.0, 3.0);
            for k in 0..8 {
                let a = k as f32 * std::f32::consts::FRAC_PI_4;
                let (s, c) = a.sin_cos();
                line(&[(8.0 + 5.0 * c, 8.0 + 5.0 * s), (8.0 + 7.0 * c, 8.0 + 7.0 * s)]);
            }
        }
        Icon::Moon => {
            let arc = |cx: f32, r: f32, from: f32, to: f32| -> Vec<(f32, f32)> {
                (0..=16)
                    .map(|k| from + (to - from) * k as f32 / 16.0)
                    .map(|a| (cx + r * a.cos(), 8.0 + r * a.sin()))
                    .collect()
            };
            let mut points = arc(7.5, 6.0, -1.0, -5.3);
            points.extend(arc(10.6, 4.9, 1.55, 4.72).into_iter().skip(1));
            closed(&points);
        }
        Icon::Perspective => {
            closed(&[(2.0, 2.0), (14.0, 2.0), (10.8, 13.5), (5.2, 13.5)]);
            line(&[(3.6, 7.6), (12.4, 7.6)]);
        }
        Icon::Parallel => {
            closed(&[(3.0, 2.0), (13.0, 2.0), (13.0, 13.5), (3.0, 13.5)]);
            line(&[(3.0, 7.6), (13.0, 7.6)]);
        }
        Icon::Eye | Icon::EyeOff => {
            let lid = |sign: f32| -> Vec<(f32, f32)> {
                (0..=10)
                    .map(|k| k as f32 / 10.0)
                    .map(|t| (1.5 + 13.0 * t, 8.0 + sign * 4.4 * (std::f32::consts::PI * t).sin()))
                    .collect()
            };
            line(&lid(1.0));
            line(&lid(-1.0));
            if icon == Icon::Eye {
                painter.circle_filled(at(8.0, 8.0), 2.2, color);
            } else {
                line(&[(3.0, 14.0), (13.0, 2.0)]);
            }
        }
        Icon::Left => line(&[(10.0, 4.5), (6.2, 8.0), (10.0, 11.5)]),
        Icon::Right => line(&[(6.0, 4.5), (9.8, 8.0), (6.0, 11.5)]),
        Icon::Down => line(&[(4.5, 6.0), (8.0, 9.8), (11.5, 6.0)]),
        Icon::Search => {
            circle(7.0, 7.0, 4.2);
            line(&[(10.2, 10.2), (14.0, 14.0)]);
        }
        Icon::Cross => {
            line(&[(4.0, 4.0), (12.0, 12.0)]);
            line(&[(12.0, 4.0), (4.0, 12.0)]);
        }
        Icon::Note => {
            circle(8.0, 8.0, 6.0);
            line(&[(8.0, 7.2), (8.0, 11.4)]);
            painter.circle_filled(at(8.0, 4.9), 0.9, color);
        }
        Icon::Warning => {
            closed(&[(8.0, 2.0), (14.5, 13.5), (1.5, 13.5)]);
            line(&[(8.0, 6.2), (8.0, 10.0)]);
            painter.circle_filled(at(8.0, 11.8), 0.8, color);
        }
        Icon::Error => {
            circle(8.0, 8.0, 6.0);
            line(&[(5.7, 5.7), (10.3, 10.3)]);
            line(&[(10.3, 5.7), (5.7, 10.3)]);
        }
        Icon::Tree => {
            line(&[(2.0, 3.0), (8.0, 3.0)]);
            line(&[(4.0, 3.0), (4.0, 13.0), (8.0, 13.0)]);
            line(&[(4.0, 8.0), (8.0, 8.0)]);
            line(&[(9.5, 8.0), (14.0, 8.0)]);
            line(&[(9.5, 13.0), (14.0, 13.0)]);
        }
        Icon::Properties => {
            for y in [3.5, 8.0, 12.5] {
                line(&[(2.0, y), (5.5, y)]);
                line(&[(7.5, y), (14.0, y)]);
            }
        }
        Icon::Report => {
            closed(&[(3.0, 1.5), (13.0, 1.5), (13.0, 14.5), (3.0, 14.5)]);
            for y in [5.0, 8.0, 11.0] {
                line(&[(5.5, y), (10.5, y)]);
            }
        }
        Icon::Question => {
            circle(8.0, 8.0, 6.3);
            line(&[(6.0, 6.4), (6.5, 5.0), (8.0, 4.4), (9.5, 5.0), (9.9, 6.3), (8.0, 8.0), (8.0, 9.4)]);
            painter.circle_filled(at(8.0, 11.5), 0.9, color);
        }
        Icon::Arrow => closed(&[
            (4.0, 1.5),
            (4.0, 13.0),
            (7.0, 10.2),
            (9.0, 14.6),
            (11.0, 13.7),
            (9.0, 9.4),
            (13.0, 9.2),
        ]),
        Icon::Rectangle => {
            closed(&[(2.5, 4.0), (13.5, 4.0), (13.5, 12.0), (2.5, 12.0)]);
            fill(&[(1.0, 2.5), (4.0, 2.5), (4.0, 5.5), (1.0, 5.5)], color);
            fill(&[(12.0, 10.5), (15.0, 10.5), (15.0, 13.5), (12.0, 13.5)], color);
        }
        Icon::Circle => {
            circle(8.0, 8.0, 6.0);
            painter.circle_filled(at(8.0, 8.0), 1.5, color);
        }
        Icon::Polyline => {
            line(&[(2.0, 12.5), (5.5, 4.0), (10.0, 10.0), (14.0, 3.0)]);
            for (x, y) in [(2.0, 12.5), (5.5, 4.0), (10.0, 10.0), (14.0, 3.0)] {
                painter.circle_filled(at(x, y), 1.7, color);
            }
        }
        Icon::Freehand => {
            let wave = |k: i32| {
                (1.5 + 0.65 * k as f32, 8.0 - 4.5 * (0.42 * k as f32).sin() * (0.3 + 0.035 * k as f32))
            };
            line(&(0..=20).map(wave).collect::<Vec<_>>());
        }
        Icon::Knot => {
            line(&[(1.5, 12.0), (4.5, 7.0), (8.0, 5.2), (11.5, 7.0), (14.5, 12.0)]);
            line(&[(8.0, 1.5), (8.0, 9.0)]);
            painter.circle_filled(at(8.0, 5.2), 2.0, color);
        }
        Icon::Split => {
            line(&[(1.5, 12.0), (3.8, 8.0), (6.4, 6.0)]);
            line(&[(9.6, 6.0), (12.2, 8.0), (14.5, 12.0)]);
            line(&[(10.2, 2.0), (5.8, 10.0)]);
        }
        Icon::Magnet => {
            let arc = |r: f32| -> Vec<(f32, f32)> {
                (0..=12)
                    .map(|k| std::f32::consts::PI * k as f32 / 12.0)
                    .map(|a| (8.0 - r * a.cos(), 8.0 + r * a.sin()))
                    .collect()
            };
            let mut outline = vec![(2.0, 2.0)];
            outline.extend(arc(6.0));
            outline.extend([(14.0, 2.0), (10.5, 2.0)]);
            outline.extend(arc(2.5).into_iter().rev());
            outline.push((5.5, 2.0));
            closed(&outline);
            line(&[(2.0, 5.0), (5.5, 5.0)]);
            line(&[(10.5, 5.0), (14.0, 5.0)]);
        }
        Icon::Intervals => {
            closed(&[(2.0, 2.0), (14.0, 2.0), (14.0, 14.0), (2.0, 14.0)]);
            line(&[(2.0, 6.0), (14.0, 6.0)]);
            line(&[(2.0, 10.0), (14.0, 10.0)]);
            line(&[(6.0, 2.0), (6.0, 6.0)]);
            line(&[(10.0, 6.0), (10.0, 10.0)]);
            line(&[(5.0, 10.0), (5.0, 14.0)]);
        }
        Icon::Cells => {
            closed(&[(2.0, 2.0), (14.0, 2.0), (14.0, 14.0), (2.0, 14.0)]);
            line(&[(8.0, 2.0), (8.0, 14.0)]);
            line(&[(2.0, 8.0), (14.0, 8.0)]);
            fill(&[(8.0, 8.0), (14.0, 8.0), (14.0, 14.0), (8.0, 14.0)], dim(0.6));
        }
        Icon::DockBelow => {
            closed(&[(2.0, 2.5), (14.0, 2.5), (14.0, 13.5), (2.0, 13.5)]);
            fill(&[(2.0, 8.5), (14.0, 8.5), (14.0, 13.5), (2.0, 13.5)], dim(0.6));
        }
        Icon::DockBeside => {
            closed(&[(2.0, 2.5), (14.0, 2.5), (14.0, 13.5), (2.0, 13.5)]);
            fill(&[(8.5, 2.5), (14.0, 2.5), (14.0, 13.5), (8.5, 13.5)], dim(0.6));
        }
        Icon::UvEditor => {
            closed(&[(2.0, 2.5), (14.0, 2.5), (14.0, 13.5), (2.0, 13.5)]);
            circle(9.2, 8.0, 3.0);
            painter.circle_filled(at(6.2, 8.0), 1.7, color);
        }
        Icon::Curves => {
            let arch = |k: i32| {
                let t = k as f32 / 12.0;
                (2.0 + 12.0 * t, 12.5 - 9.0 * 4.0 * t * (1.0 - t) * 0.9)
            };
            line(&(0..=12).map(arch).collect::<Vec<_>>());
            for (x, y) in [(2.0, 12.5), (8.0, 4.4), (14.0, 12.5)] {
                fill(
                    &[(x - 1.8, y - 1.8), (x + 1.8, y - 1.8), (x + 1.8, y + 1.8), (x - 1.8, y + 1.8)],
                    color,
                );
            }
        }
        Icon::Net => {
            for (a, b) in [((2.0, 5.0), (14.0, 3.0)), ((2.0, 9.5), (14.0, 7.5)), ((2.0, 14.0), (14.0, 12.0))]
            {
                line(&[a, b]);
            }
            for x in [2.0, 8.0, 14.0] {
                let lift = (x - 2.0) / 6.0;
                line(&[(x, 5.0 - lift), (x, 14.0 - lift)]);
            }
            painter.circle_filled(at(8.0, 8.5), 2.2, color);
        }
    }
}
