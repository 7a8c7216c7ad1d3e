//! Files come back bit for bit, damaged ones are told, and saving is whole or not at all.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::kernel::nurbs::{KnotVector, NurbsCurve2, NurbsSurface};
use crate::kernel::view::{Camera, Projection};
use crate::scene::edit::FaceId;
use crate::scene::records::{FaceRecord, LoopRecord, LoopRole, ModelRecord, PartRecord, SourceRecord};
use crate::scene::settings::{DisplayRecord, ViewRecord};

/// Any finite number, extremes, zeros of both signs and subnormals among them.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>().prop_filter("finite", |x| x.is_finite()),
        prop::sample::select(vec![
            -0.0,
            0.0,
            5e-324,
            -5e-324,
            2.2e-308,
            f64::MAX,
            f64::MIN,
            0.1,
            1.0 / 3.0,
            1e22
        ]),
    ]
}

fn camera(n: &[f64]) -> Camera {
    let v = |k: usize| DVec3::new(n[k], n[k + 1], n[k + 2]);
    Camera { eye: v(0), target: v(1), up: v(2), projection: Projection::Orthographic { height: n[3] } }
}

fn scene_of(n: &[f64], text: &str, colour: [f32; 3]) -> SceneRecord {
    let weights = n[..4].iter().map(|x| x.abs().max(5e-324)).collect::<Vec<_>>();
    let knots = KnotVector::bezier(1, -0.0, 5e-324).expect("not empty");
    let points = (0..4).map(|k| DVec3::new(n[k], n[k + 1], n[k + 2])).collect();
    let surface = NurbsSurface::new(knots.clone(), knots.clone(), points, weights.clone()).expect("valid");
    let points = vec![DVec2::new(n[0], n[1]), DVec2::new(n[2], n[3])];
    let curve = NurbsCurve2::new(knots, points, weights[..2].to_vec()).expect("valid");
    let face = FaceRecord {
        name: Some(text.into()),
        source: Some(SourceRecord { entity: text.into(), id: u64::MAX }),
        colour: Some(colour),
        layer: Some(-3),
        part: Some(0),
        surface,
        loops: vec![LoopRecord::new(LoopRole::Inner, vec![curve.clone(), curve.reversed()])],
        reversed: true,
    };
    let plain = FaceRecord {
        name: None,
        source: None,
        colour: None,
        layer: None,
        part: None,
        loops: vec![],
        reversed: false,
        ..face.clone()
    };
    let parts = vec![PartRecord { name: text.into(), parent: None }];
    let model = ModelRecord { name: text.into(), parts, faces: vec![face, plain], ..ModelRecord::default() };
    SceneRecord {
        models: vec![model, ModelRecord::default()],
        hidden: vec![FaceId { model: 0, face: 1 }, FaceId { model: 1, face: 0 }],
        camera: Some(camera(n)),
        views: vec![ViewRecord { name: text.into(), camera: camera(&n[1..]) }],
        display: DisplayRecord { mode: Some(text.into()), edges: Some(true), grid: None, gaps: None },
    }
}

/// All bits of all numbers, by way of Rust's debug text, which tells zeros and every digit.
fn bits(scene: &SceneRecord) -> String {
    format!("{scene:?}")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_number_and_text_comes_back(n in prop::collection::vec(number(), 8), text in prop::collection::vec(any::<char>(), 0..12), c in prop::array::uniform3(0.0f32..1.0)) {
        let scene = scene_of(&n, &text.into_iter().collect::<String>(), c);
        for packing in [Packing::Plain, Packing::Packed] {
            let bytes = to_bytes(&scene, packing).expect("finite");
            prop_assert!(is_scene(&bytes));
            let back = from_bytes(&bytes).expect("as written");
            prop_assert_eq!(&back, &scene);
            prop_assert_eq!(bits(&back), bits(&scene));
            prop_assert_eq!(to_bytes(&back, packing).expect("finite"), bytes);
        }
    }
}

fn demo() -> SceneRecord {
    let mut scene = SceneRecord::of_model(crate::scene::demo::model());
    scene.models[0].faces.truncate(6);
    scene
}

#[test]
fn cut_and_changed_files_are_told_and_never_panic() {
    let mut scene = scene_of(&[0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5], "name \"x\"", [0.5; 3]);
    scene.models[0].faces.truncate(1);
    let plain = to_bytes(&scene, Packing::Plain).expect("finite");
    for end in 0..plain.len() - 2 {
        let error = from_bytes(&plain[..end]).expect_err("cut").to_string();
        assert!(error.starts_with("line ") || error.starts_with("it is not"), "{end}: {error}");
    }
    for at in 0..plain.len() {
        for byte in [b'x', b'"', b'}', b'[', 0xff] {
            let mut bytes = plain.clone();
            bytes[at] = byte;
            let _ = from_bytes(&bytes);
        }
    }
    let packed = to_bytes(&scene, Packing::Packed).expect("finite");
    for end in 0..packed.len() {
        assert!(from_bytes(&packed[..end]).is_err(), "{end}");
    }
    for at in 0..packed.len() {
        let mut bytes = packed.clone();
        bytes[at] ^= 0x10;
        if let Ok(read) = from_bytes(&bytes) {
            assert_eq!(read, scene, "a changed byte at {at} went unnoticed");
        }
    }
}

#[test]
fn errors_name_the_place() {
    let text = String::from_utf8(to_bytes(&demo(), Packing::Plain).expect("finite")).expect("text");
    let read = |text: &str| from_bytes(text.as_bytes()).expect_err("damaged").to_string();
    let bad = text.replacen("\"degrees\":[", "\"degree\":[", 1);
    assert!(read(&bad).contains("(in models[1].faces[1].surface"), "{}", read(&bad));
    assert!(read(&bad).contains("unknown field `degree`"), "{}", read(&bad));
    let bad = text.replacen("\"points\":[[", "\"points\":[[true,", 1);
    assert!(
        read(&bad).contains("(in models[1].faces[1].surface.points[1][1]): invalid type: boolean"),
        "{}",
        read(&bad)
    );
    let newer = text.replacen("\"version\":1", "\"version\":9", 1).replacen("\"camera\"", "\"lens\"", 1);
    assert!(
        read(&newer).contains("newer version of Hairline") && read(&newer).contains("format 9"),
        "{}",
        read(&newer)
    );
    assert!(read("S      1\n").contains("not a Hairline scene"));
    assert!(read("{\"a\":1}").contains("not a Hairline scene"));
    let extra = text.replacen("\"views\"", "\"veiws\"", 1);
    assert!(read(&extra).contains("unknown field `veiws`"), "{}", read(&extra));
}

#[test]
fn numbers_that_are_not_finite_are_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.hairline");
    let mut scene = demo();
    save(&path, &scene, &SaveOptions::default()).expect("saved");
    let before = fs::read(&path).expect("readable");
    scene.models[0].faces[2].colour = Some([f32::NAN; 3]);
    let error = save(&path, &scene, &SaveOptions::default()).expect_err("NaN").to_string();
    assert!(error.contains("colour of face 3 of model 1"), "{error}");
    assert_eq!(fs::read(&path).expect("readable"), before);
}

#[test]
fn another_programs_save_is_noticed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.hairline");
    let mut scene = demo();
    let first = save(&path, &scene, &SaveOptions::default()).expect("saved");
    let loaded = load(&path).expect("loaded");
    assert_eq!((loaded.scene, &loaded.fingerprint), (scene.clone(), &first));
    let options = SaveOptions { expected: Some(first), packing: Packing::Plain };
    scene.models[0].name = "here".into();
    let second = save(&path, &scene, &options).expect("nobody else wrote");
    scene.models[0].name = "elsewhere".into();
    save(&path, &scene, &SaveOptions::default()).expect("another window");
    let theirs = fs::read(&path).expect("readable");
    scene.models[0].name = "here again".into();
    let options = SaveOptions { expected: Some(second.clone()), ..options };
    assert!(matches!(save(&path, &scene, &options), Err(SaveError::ChangedOnDisk)));
    assert_eq!(fs::read(&path).expect("readable"), theirs, "their version stays");
    assert_eq!(fs::read_dir(folder.path()).expect("listable").count(), 1, "nothing is left behind");
    fs::remove_file(&path).expect("removed");
    save(&path, &scene, &options).expect("a file that is gone is brought back");
}

#[test]
fn leftovers_of_killed_processes_are_removed_and_others_are_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.hairline");
    let dead = folder.path().join(".a.hairline.hairline-4194999-xyz.part");
    let alive = folder.path().join(".a.hairline.hairline-1-xyz.part");
    let other = folder.path().join(".b.hairline.hairline-4194999-xyz.part");
    for file in [&dead, &alive, &other] {
        fs::write(file, b"x").expect("written");
    }
    save(&path, &demo(), &SaveOptions::default()).expect("saved");
    assert_eq!([dead.exists(), alive.exists(), other.exists()], [!cfg!(target_os = "linux"), true, true]);
}

#[test]
fn copies_of_crashed_runs_are_listed_and_those_of_running_ones_are_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let recovery = recovery::RecoveryFolder::at(folder.path().join("recovery"));
    assert!(recovery.recoverable().is_empty());
    let of = Path::new("/tmp/part.hairline");
    let file = recovery.keep(Some(of), 0, &demo()).expect("kept");
    assert!(recovery.recoverable().is_empty(), "this process is alive");
    let note = file.with_extension("json");
    let crashed =
        fs::read_to_string(&note).expect("readable").replace(&std::process::id().to_string(), "4194999");
    fs::write(&note, crashed).expect("written");
    let found = recovery.recoverable();
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].note.name.as_str(), found[0].note.path.as_deref()), ("part.hairline", Some(of)));
    assert_eq!(load(&found[0].file).expect("a scene").scene, demo());
    recovery.forget(Some(of), 0).expect("removed");
    assert!(recovery.recoverable().is_empty() && !file.exists());
}

#[test]
fn the_first_draft_format_is_read() {
    let text = r#"{"hairline": "scene", "version": 0, "model": {"name": "old", "faces": [
        {"color": [1.0, 0.5, 0.25], "surface": {"degrees": [1, 1], "knots_u": [0, 0, 1, 1], "knots_v": [0, 0, 1, 1],
         "points": [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]}}]}}"#;
    let scene = from_bytes(text.as_bytes()).expect("format 0");
    assert_eq!(scene.models[0].name, "old");
    assert_eq!(scene.models[0].faces[0].colour, Some([1.0, 0.5, 0.25]));
}
