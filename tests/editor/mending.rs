//! Closing gaps in the editor: one step, its figure live, taken back by undo; what cannot be closed is said.

use bevy::prelude::*;
use glam::{DVec2, DVec3};
use hairline::editor::editing::{EditRequest, Editing};
use hairline::editor::files::{OpenFiles, Source};
use hairline::editor::inspection::{
    Chosen, Findings, InspectRequest, MendChoices, MendOutcome, Progress, Rows,
};
use hairline::editor::panels::Notices;
use hairline::editor::settings::Settings;
use hairline::editor::tools::Action;
use hairline::inspect::{EdgeKey, EdgeKind};
use hairline::kernel::nurbs::{KnotVector, NurbsCurve2};
use hairline::kernel::primitives::{arc, extrusion, outline};
use hairline::scene::records::{FaceRecord, LengthUnit, LoopRecord, LoopRole, ModelRecord};
use hairline::scene::{Change, Edit};

use crate::editing::{records, send};
use crate::world::{app, command, finish_loading};

/// A quarter of a cylinder cut across: the lower face ends in a line, the upper one in a wave that leaves `gap` open.
fn cut_cylinder(gap: f64, unit: LengthUnit) -> ModelRecord {
    let circle = arc(DVec3::ZERO, DVec3::X * 20.0, DVec3::Y * 20.0, 0.0, 1.5).expect("valid test data");
    let surface = extrusion(&circle, DVec3::Z * 10.0).expect("valid test data");
    let ((u0, u1), (v0, v1)) = (surface.knots_u().domain(), surface.knots_v().domain());
    let middle = 0.5 * (v0 + v1);
    let side = |low: f64, high: f64| outline::rectangle(DVec2::new(u0, low), DVec2::new(u1, high));
    let mut upper = side(middle, v1);
    // The middle of a cubic is three quarters of its inner points.
    let off = gap / 0.75 * (v1 - v0) / 10.0;
    let points = [(0.0, 0.0), (0.3, off), (0.7, off), (1.0, 0.0)]
        .map(|(t, up)| DVec2::new(u0 + t * (u1 - u0), middle + up));
    let knots = KnotVector::bezier(3, 0.0, 1.0).expect("valid test data");
    upper[0] = NurbsCurve2::new(knots, points.to_vec(), vec![1.0; 4]).expect("valid test data");
    let face = |curves| FaceRecord::new(surface.clone(), vec![LoopRecord::new(LoopRole::Outer, curves)]);
    let faces = vec![face(side(v0, middle)), face(upper)];
    ModelRecord { name: "cut".into(), unit, faces, ..ModelRecord::default() }
}

fn open(app: &mut App, model: ModelRecord) {
    let change = Change::Models { at: 0, before: Vec::new(), after: vec![model] };
    send(app, [EditRequest::Apply(Edit::new("Open", vec![change]))]);
    inspect(app);
}

fn inspect(app: &mut App) {
    command(app, Action::ToggleInspection);
    let until = std::time::Instant::now() + std::time::Duration::from_secs(60);
    while app.world().resource::<Findings>().progress() != Progress::Ready {
        assert!(std::time::Instant::now() < until, "the inspection never came to an end");
        std::thread::sleep(std::time::Duration::from_millis(5));
        app.update();
    }
    app.update();
}

fn choose(app: &mut App, edge: EdgeKey) {
    app.world_mut().write_message(InspectRequest::Choose { edge, fly: false });
    app.update();
}

/// The gap of an edge in the table, millimetres.
fn in_table(app: &App, edge: EdgeKey) -> f64 {
    let rows = app.world().resource::<Rows>();
    rows.rows.iter().find(|r| r.key == edge).and_then(|r| r.gap).expect("a gap")
}

fn last_words(app: &App) -> String {
    app.world().resource::<Notices>().list().last().map(|n| n.text.clone()).unwrap_or_default()
}

fn steps(app: &App) -> usize {
    app.world().resource::<Editing>().history().undo_count()
}

fn first(app: &App, kind: EdgeKind) -> EdgeKey {
    let findings = app.world().resource::<Findings>();
    let mut edges = findings.inspection().expect("ready").edges();
    *edges.find(|(_, e)| e.kind == kind).expect("an edge of that kind").0
}

fn shared(app: &App) -> EdgeKey {
    first(app, EdgeKind::Shared)
}

#[test]
fn closing_is_one_step_whose_figure_is_live() {
    for side in [None, Some(0), Some(1)] {
        let mut app = app();
        open(&mut app, cut_cylinder(0.02, LengthUnit::default()));
        let edge = shared(&app);
        assert!((in_table(&app, edge) - 0.02).abs() < 1e-3, "{}", in_table(&app, edge));
        app.world_mut().resource_mut::<MendChoices>().side = side;
        choose(&mut app, edge);
        let (before, count) = (records(&mut app), steps(&app));
        let statistics = app.world().resource::<Findings>().statistics().clone();
        command(&mut app, Action::CloseGap);
        assert_eq!(steps(&app), count + 1);
        assert!(in_table(&app, edge) <= 1e-4, "in the table: {}", in_table(&app, edge));
        assert!(app.world().resource::<Findings>().statistics().quantile(1.0) <= 1e-4, "in the histogram");
        assert_eq!(app.world().resource::<Chosen>().edge, Some(edge), "it stays chosen");
        let moved: Vec<usize> =
            (0..2).filter(|k| records(&mut app)[0].faces[*k] != before[0].faces[*k]).collect();
        assert_eq!(moved, [side.unwrap_or(0)], "one side moves");
        let words = last_words(&app);
        assert!(
            words.contains("from 20.0 um to") && words.contains(&format!("face {}", moved[0] + 1)),
            "{words}"
        );
        let outcome = app.world().resource::<MendOutcome>().last.clone();
        assert_eq!(outcome, Some((edge, words)));
        command(&mut app, Action::Undo);
        assert_eq!(records(&mut app), before);
        assert_eq!(app.world().resource::<Findings>().statistics(), &statistics);
        assert_eq!(
            app.world().resource::<MendOutcome>().last,
            None,
            "nothing is told of what was taken back"
        );
    }
}

#[test]
fn figures_are_in_millimetres_whatever_the_unit() {
    let mut app = app();
    let inch = LengthUnit { name: "IN".into(), millimetres: 25.4 };
    open(&mut app, cut_cylinder(0.02, inch));
    let edge = shared(&app);
    assert!((in_table(&app, edge) - 0.508).abs() < 0.02);
    choose(&mut app, edge);
    command(&mut app, Action::CloseGap);
    assert!(in_table(&app, edge) <= 1e-4 && last_words(&app).contains("508 um"), "{}", last_words(&app));
}

#[test]
fn what_cannot_be_closed_is_said_and_changes_nothing() {
    let mut app = app();
    open(&mut app, cut_cylinder(0.02, LengthUnit::default()));
    let (before, count) = (records(&mut app), steps(&app));
    command(&mut app, Action::CloseGap);
    assert!(last_words(&app).contains("Choose an edge"));
    let naked = first(&app, EdgeKind::Naked);
    choose(&mut app, naked);
    command(&mut app, Action::CloseGap);
    assert!(last_words(&app).contains("naked"), "{}", last_words(&app));
    let edge = shared(&app);
    choose(&mut app, edge);
    app.world_mut().resource_mut::<MendChoices>().tolerance = 1.0;
    command(&mut app, Action::CloseGap);
    assert!(last_words(&app).contains("already"), "{}", last_words(&app));
    assert_eq!((records(&mut app), steps(&app)), (before, count));
}

#[test]
fn gaps_of_a_real_part_are_closed_and_opened_again_by_undo() {
    let models = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("shared/models"))
        .find(|folder| folder.is_dir());
    let Some(models) = models else {
        eprintln!("no folder of shared models");
        return;
    };
    let mut app = app();
    app.insert_resource(Settings { recent: Vec::new(), ..Settings::default() });
    let sources = vec![Source::File(models.join("files/gpucast_part.igs"))];
    app.world_mut().write_message(OpenFiles { sources, replace: true });
    finish_loading(&mut app);
    inspect(&mut app);
    let before = records(&mut app);
    let rows = app.world().resource::<Rows>().rows.clone();
    let wide: Vec<(EdgeKey, f64)> = rows
        .iter()
        .filter(|r| r.kind == EdgeKind::Shared)
        .filter_map(|r| Some((r.key, r.gap?)))
        .filter(|(_, gap)| *gap > 1e-3)
        .take(12)
        .collect();
    assert!(wide.len() >= 8, "gaps above 1 um: {}", wide.len());
    let mut closed = 0;
    for (edge, gap) in wide {
        choose(&mut app, edge);
        let count = steps(&app);
        command(&mut app, Action::CloseGap);
        let now = app.world().resource::<Findings>().edge(&edge).and_then(|e| e.gap).expect("a gap").maximum;
        if steps(&app) > count {
            closed += 1;
            assert!(now < 0.95 * gap, "{now} of {gap}: {}", last_words(&app));
            assert!(last_words(&app).starts_with("Gap closed from"), "{}", last_words(&app));
        } else {
            assert!(!last_words(&app).is_empty());
        }
    }
    assert!(closed >= 4, "{closed} closed");
    while steps(&app) > 0 {
        command(&mut app, Action::Undo);
    }
    assert_eq!(records(&mut app), before);
}
