//! The thread that makes a tessellation: meshes, hands the result over to be shown, then measures it.
//!
//! It has threads of its own, one fewer than there are processors, so that neither the window nor work of the window
//! that waits for the common threads stands still. A run after an edit takes over the meshes and measurements of faces
//! that came out the same.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::{Duration, Instant};

use glam::DVec3;
use rayon::prelude::*;

use super::made::{Faces, Figures, Largest, Made, Measured, Task};
use crate::editor::redraw::Waker;
use crate::encoding::PackedMesh;
use crate::kernel::face::Face;
use crate::kernel::tessellate::{FaceMesh, TessellateError};
use crate::meshing::{ModelMesh, Work, face_deviations, measure_face, mesh_edges, mesh_faces, remesh_faces};

/// Samples along an edge and of one face at most when a face as a whole is measured; its triangles are sampled besides.
const DENSITY: usize = 2;
const SAMPLES: usize = 3000;
/// The window hears of progress this often.
const REPORT: Duration = Duration::from_millis(400);

/// What the thread says.
pub(super) enum Said {
    /// A tessellation to show; what follows is the same with more figures.
    Made(Arc<Made>),
    /// There will be none.
    Failed(TessellateError),
    /// A defect of ours.
    Broken,
    /// Nothing more to come.
    Done,
}

/// What both sides see.
pub(super) struct Shared {
    pub cancel: AtomicBool,
    /// Thousandths done of the stage under way.
    pub progress: AtomicU32,
    pub measuring: AtomicBool,
    reported: Mutex<Instant>,
}

/// What is to be made.
pub(super) struct Order {
    pub task: Task,
    pub faces: Faces,
    pub unit_mm: f64,
    /// Of the same options and faces.
    pub previous: Option<Arc<Made>>,
}

/// A thread at work.
pub(super) struct Worker {
    pub task: Task,
    pub shared: Arc<Shared>,
    pub said: Mutex<mpsc::Receiver<Said>>,
}

impl Shared {
    fn report(&self, part: f64, waker: &Waker) {
        self.progress.store((1000.0 * part.clamp(0.0, 1.0)) as u32, Ordering::Relaxed);
        if let Ok(mut reported) = self.reported.try_lock()
            && reported.elapsed() > REPORT
        {
            *reported = Instant::now();
            waker.wake();
        }
    }

    fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.shared.cancel.store(true, Ordering::Relaxed);
    }
}

impl Worker {
    /// Starts it.
    ///
    /// # Errors
    /// The system gives no thread.
    pub fn start(order: Order, waker: Waker) -> std::io::Result<Self> {
        let shared = Arc::new(Shared {
            cancel: AtomicBool::new(false),
            progress: AtomicU32::new(0),
            measuring: AtomicBool::new(false),
            reported: Mutex::new(Instant::now()),
        });
        let (sender, said) = mpsc::channel();
        let (task, own) = (order.task.clone(), Arc::clone(&shared));
        std::thread::Builder::new().name("hairline-mesh".into()).spawn(move || {
            let say = |what| {
                // Fails only when nobody waits any more.
                let _ = sender.send(what);
                waker.wake();
            };
            // A defect in meshing costs the triangles, not the window and the unsaved work in it.
            let work = std::panic::AssertUnwindSafe(|| run(order, &own, &waker, &say));
            say(match std::panic::catch_unwind(work) {
                Ok(Ok(())) => Said::Done,
                Ok(Err(error)) => Said::Failed(error),
                Err(_) => Said::Broken,
            });
        })?;
        Ok(Self { task, shared, said: Mutex::new(said) })
    }
}

fn run(
    order: Order,
    shared: &Shared,
    waker: &Waker,
    say: &(dyn Fn(Said) + Sync),
) -> Result<(), TessellateError> {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get().saturating_sub(1).max(1));
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(|| make(order, shared, waker, say)),
        // Slower for the window, but it works.
        Err(_) => make(order, shared, waker, say),
    }
}

fn make(
    order: Order,
    shared: &Shared,
    waker: &Waker,
    say: &(dyn Fn(Said) + Sync),
) -> Result<(), TessellateError> {
    let Order { task, faces, unit_mm, previous } = order;
    let kernel: Vec<Option<&Face>> =
        faces.derived.iter().map(|d| d.as_ref().and_then(|d| d.face.as_deref())).collect();
    let work = Work { progress: &|part| shared.report(part, waker), cancelled: &|| shared.is_cancelled() };
    let changed = |k: usize| match (previous.as_ref().and_then(|p| p.faces.derived.get(k)), &faces.derived[k])
    {
        (Some(Some(before)), Some(now)) => !Arc::ptr_eq(before, now),
        _ => true,
    };
    let started = Instant::now();
    let mesh = match &previous {
        Some(previous) => remesh_faces(&kernel, &task.options, &previous.mesh, &changed, &work)?,
        None => mesh_faces(&kernel, &task.options, &work)?,
    };
    let mesh_time = started.elapsed();
    let kept: Vec<bool> = (0..kernel.len())
        .into_par_iter()
        .map(|k| !changed(k) && previous.as_ref().is_some_and(|p| p.mesh.faces.get(k) == mesh.faces.get(k)))
        .collect();
    let of_previous = |k: usize| previous.as_ref().filter(|_| kept[k]);
    let packed: Vec<Option<Arc<PackedMesh>>> = (0..kernel.len())
        .into_par_iter()
        .map(|k| {
            let (face, mesh) = (kernel[k]?, mesh.faces[k].as_ref().ok()?);
            let before = of_previous(k).and_then(|p| p.packed[k].clone());
            before.or_else(|| Some(Arc::new(PackedMesh::new(face, mesh))))
        })
        .collect();
    let edges = mesh_edges(&mesh);
    let mut figures = figures(&mesh, &task, unit_mm);
    figures.edges = edges.len();
    figures.open_edges = edges.iter().filter(|e| e.is_open()).count();
    figures.remade = kept.iter().filter(|kept| !**kept).count();
    figures.mesh_time = mesh_time;
    let measured: Vec<_> = (0..kernel.len()).map(|k| of_previous(k)?.measured[k].clone()).collect();
    let made = Made {
        task,
        faces: Arc::new(Faces { entities: faces.entities.clone(), derived: faces.derived.clone() }),
        unit_mm,
        mesh: Arc::new(mesh),
        packed,
        edges: Arc::new(edges),
        measured,
        figures,
    };
    let shown = Arc::new(made.clone());
    drop(previous);
    // In this order: whoever sees that it measures has the triangles.
    say(Said::Made(shown));
    shared.progress.store(0, Ordering::Relaxed);
    shared.measuring.store(true, Ordering::Release);
    let made = measure(made, &kernel, &work)?;
    say(Said::Made(Arc::new(made)));
    Ok(())
}

/// Measures what was not measured before, and says where it is worst.
fn measure(mut made: Made, kernel: &[Option<&Face>], work: &Work) -> Result<Made, TessellateError> {
    let started = Instant::now();
    let tolerance = made.task.options.tolerance;
    let all = made.figures.triangles.max(1) as f64;
    let done = AtomicUsize::new(0);
    let found: Result<Vec<Option<Arc<Measured>>>, TessellateError> = kernel
        .par_iter()
        .enumerate()
        .map(|(k, face)| {
            let (Some(face), Ok(mesh)) = (face, &made.mesh.faces[k]) else { return Ok(None) };
            let result = match &made.measured[k] {
                Some(known) => {
                    done.fetch_add(mesh.triangles.len(), Ordering::Relaxed);
                    Arc::clone(known)
                }
                None if (work.cancelled)() => return Err(TessellateError::Cancelled),
                None => {
                    // Asked for each triangle: so it also says how far it is, even within a large face.
                    let asked = || {
                        let before = done.fetch_add(1, Ordering::Relaxed);
                        if before.is_multiple_of(64) {
                            (work.progress)(before as f64 / all);
                        }
                        (work.cancelled)()
                    };
                    let deviations = face_deviations(face, mesh, tolerance, &asked)?;
                    let distance = measure_face(face, mesh, DENSITY, SAMPLES);
                    Arc::new(Measured { deviations, distance })
                }
            };
            Ok(Some(result))
        })
        .collect();
    made.measured = found?;
    made.packed = made
        .packed
        .into_par_iter()
        .zip(&made.measured)
        .map(|(packed, measured)| match (packed, measured) {
            (Some(packed), Some(measured)) => {
                Some(Arc::new(Arc::unwrap_or_clone(packed).measured(&measured.deviations, tolerance)))
            }
            (packed, _) => packed,
        })
        .collect();
    made.figures.largest = largest(&made);
    made.figures.measure_time = Some(started.elapsed());
    Ok(made)
}

fn figures(mesh: &ModelMesh, task: &Task, unit_mm: f64) -> Figures {
    let meshes = || mesh.faces.iter().flatten();
    let left_out = mesh.faces.iter().enumerate();
    Figures {
        tolerance_mm: task.options.tolerance * unit_mm,
        conservative: task.options.conservative,
        triangles: mesh.triangle_count(),
        over_tolerance: meshes().map(|m| m.quality.over_tolerance).sum(),
        faces: meshes().count(),
        left_out: left_out.filter_map(|(k, m)| Some((k, m.as_ref().err()?.to_string()))).collect(),
        ..Figures::default()
    }
}

/// The largest distance over all faces, by triangles and by faces as a whole.
fn largest(made: &Made) -> Option<Largest> {
    let mut best: Option<(usize, f64, DVec3)> = None;
    for (face, measured) in made.measured.iter().enumerate() {
        let (Some(measured), Ok(mesh)) = (measured, &made.mesh.faces[face]) else { continue };
        let worst = measured.deviations.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let (mut value, mut place) = (measured.distance.largest(), measured.distance.place);
        if let Some((triangle, deviation)) = worst
            && *deviation > value
        {
            value = *deviation;
            place = centre(mesh, triangle);
        }
        if best.is_none_or(|(_, most, _)| value > most) {
            best = Some((face, value, place));
        }
    }
    let (face, value, place) = best?;
    let mesh = made.mesh.faces[face].as_ref().ok()?;
    let off = |p: &DVec3| p.distance_squared(place);
    let near = (0..mesh.positions.len())
        .min_by(|a, b| off(&mesh.positions[*a]).total_cmp(&off(&mesh.positions[*b])));
    let normal = near.and_then(|k| mesh.normals.get(k)).copied().unwrap_or(DVec3::Z);
    Some(Largest { mm: value * made.unit_mm, place, normal, face })
}

fn centre(mesh: &FaceMesh, triangle: usize) -> DVec3 {
    let [a, b, c] = mesh.triangles[triangle].map(|v| mesh.positions[v as usize]);
    (a + b + c) / 3.0
}
