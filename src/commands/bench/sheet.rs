//! A small printer of right-aligned tables, and the clock they are filled with.

use std::fmt::{self, Display};
use std::time::Instant;

/// A table: a title, columns, rows of text.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sheet {
    /// Stands above the table.
    pub title: String,
    /// Heads of the columns.
    pub columns: Vec<&'static str>,
    /// One cell for each column.
    pub rows: Vec<Vec<String>>,
}

impl Sheet {
    /// An empty table.
    pub fn new(title: impl Into<String>, columns: &[&'static str]) -> Self {
        Self { title: title.into(), columns: columns.to_vec(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }
}

impl Display for Sheet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        let width = |i: usize| {
            let cells = self.rows.iter().filter_map(|r| r.get(i)).map(|c| c.chars().count());
            cells.chain([self.columns[i].chars().count()]).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let heads: Vec<String> = self.columns.iter().map(|c| (*c).to_owned()).collect();
        for row in std::iter::once(&heads).chain(&self.rows) {
            for (cell, width) in row.iter().zip(&widths) {
                write!(f, "  {cell:>width$}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// A number with about three significant digits; a dash for one that is missing.
pub fn number(x: Option<f64>) -> String {
    match x {
        None => "-".into(),
        Some(x) if x >= 99.5 => format!("{x:.0}"),
        Some(x) if x >= 9.95 => format!("{x:.1}"),
        Some(x) if x >= 0.995 => format!("{x:.2}"),
        Some(x) if x >= 0.0995 || x <= 0.0 => format!("{x:.3}"),
        Some(x) => format!("{x:.4}"),
    }
}

/// Seconds of the fastest of several runs of `work`: other load only ever makes a run slower.
pub fn fastest<R>(runs: usize, mut work: impl FnMut() -> R) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..runs.max(1) {
        let start = Instant::now();
        std::hint::black_box(work());
        best = best.min(start.elapsed().as_secs_f64());
    }
    best
}

/// Nanoseconds per item of `work` over `items`, in chunks so short that most runs of each are undisturbed:
/// the sum over the chunks of the fastest of `runs` runs.
pub fn per_item<T>(items: &[T], runs: usize, work: impl Fn(&T) -> bool) -> f64 {
    const CHUNK: usize = 2048;
    let mut best = vec![f64::INFINITY; items.len().div_ceil(CHUNK)];
    for _ in 0..runs.max(1) {
        for (chunk, best) in items.chunks(CHUNK).zip(&mut best) {
            let start = Instant::now();
            std::hint::black_box(chunk.iter().filter(|item| work(item)).count());
            *best = best.min(start.elapsed().as_secs_f64());
        }
    }
    best.iter().sum::<f64>() * 1e9 / items.len().max(1) as f64
}

/// CPU seconds of this process per run of `work`, wall seconds where the system does not tell.
pub fn cpu_per_run(runs: u32, mut work: impl FnMut()) -> f64 {
    let (wall, cpu) = (Instant::now(), process_seconds());
    (0..runs).for_each(|_| work());
    let spent = match (cpu, process_seconds()) {
        (Some(before), Some(after)) => after - before,
        _ => wall.elapsed().as_secs_f64(),
    };
    spent / f64::from(runs)
}

/// CPU seconds per run of each of `count` kinds of work: medians of `rounds` rounds, in each of which every kind in turn runs
/// `runs` times, so that what disturbs the machine for a while disturbs all kinds alike.
pub fn cpu_medians(count: usize, rounds: u32, runs: u32, mut work: impl FnMut(usize)) -> Vec<f64> {
    let mut seconds = vec![Vec::new(); count];
    for _ in 0..rounds.max(1) {
        for (kind, list) in seconds.iter_mut().enumerate() {
            list.push(cpu_per_run(runs, || work(kind)));
        }
    }
    let median = |mut list: Vec<f64>| {
        list.sort_by(f64::total_cmp);
        list[list.len() / 2]
    };
    seconds.into_iter().map(median).collect()
}

/// User and system time of all threads so far, ended ones included, to the nanosecond; `None` where the system does not tell.
pub fn process_seconds() -> Option<f64> {
    #[cfg(unix)]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
    }
    #[cfg(not(unix))]
    None
}
