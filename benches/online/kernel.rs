//! How often and how long the kernel took the processor away from this thread.

/// Counters of the calling thread, as far as the system says them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counters {
    /// Nanoseconds that it could have run and did not, because others ran.
    pub waited: u64,
    /// Times that it was put on a processor.
    pub slices: u64,
}

/// Reads them, again and again.
#[derive(Debug)]
pub struct Kernel(#[cfg(target_os = "linux")] Option<std::fs::File>);

#[cfg(target_os = "linux")]
impl Kernel {
    /// The counters of the thread that asks; it has to stay this one.
    pub fn of_this_thread() -> Kernel {
        Kernel(std::fs::File::open("/proc/thread-self/schedstat").ok())
    }

    /// The counters now; `None` where the kernel keeps none.
    pub fn counters(&self) -> Option<Counters> {
        use std::os::unix::fs::FileExt;
        let mut text = [0; 96];
        let len = self.0.as_ref()?.read_at(&mut text, 0).ok()?;
        let mut numbers = std::str::from_utf8(&text[..len]).ok()?.split_whitespace();
        let mut number = |place: usize| numbers.nth(place)?.parse().ok();
        Some(Counters {
            waited: number(1)?,
            slices: number(0)?,
        })
    }
}

#[cfg(not(target_os = "linux"))]
impl Kernel {
    /// Nothing.
    pub fn of_this_thread() -> Kernel {
        Kernel()
    }

    /// None.
    pub fn counters(&self) -> Option<Counters> {
        None
    }
}
