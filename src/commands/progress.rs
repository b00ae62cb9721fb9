//! A spinner for whatever takes over a second.

use std::time::{Duration, Instant};

use idim::runtime::identify::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget};

/// Shows the present step on standard error, but not before a second has passed.
#[derive(Debug)]
pub struct Spinner {
    bar: ProgressBar,
    start: Instant,
    quiet: bool,
}

impl Spinner {
    /// A spinner; silent if `quiet` or if standard error is no terminal.
    pub fn new(quiet: bool) -> Spinner {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        Spinner {
            bar,
            start: Instant::now(),
            quiet,
        }
    }

    /// A step begins.
    pub fn say(&self, what: &str) {
        self.bar.set_message(what.to_owned());
        let late = self.start.elapsed() > Duration::from_secs(1);
        if late && !self.quiet && self.bar.is_hidden() {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.bar.enable_steady_tick(Duration::from_millis(120));
        }
    }

    /// All is done.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Spinner {
    fn step(&self, what: &str) {
        self.say(what);
    }
}
