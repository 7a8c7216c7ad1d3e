//! Progress on standard error, only when that is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar that runs from 0 to 1; silent when standard error is not a terminal.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    const STEPS: u64 = 1000;

    /// Starts a bar for `task`, a few words in the present participle ("reading part.igs").
    pub fn start(task: impl Into<String>) -> Self {
        let style = ProgressStyle::with_template("{msg:30!} [{bar:40}] {percent:>3} %  {elapsed}")
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> ");
        let bar = ProgressBar::with_draw_target(Some(Self::STEPS), ProgressDrawTarget::stderr_with_hz(15));
        bar.set_style(style);
        bar.set_message(task.into());
        Self { bar }
    }

    /// Moves the bar to `fraction` of the work, 0 to 1.
    pub fn set(&self, fraction: f64) {
        self.bar.set_position((fraction.clamp(0.0, 1.0) * Self::STEPS as f64) as u64);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
