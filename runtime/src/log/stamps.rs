//! Time stamps that can be walked along more than once, wherever they are kept.

use super::error::Found;

/// First and last stamp (s), and how many there are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ends {
    pub first: f64,
    pub last: f64,
    pub len: usize,
}

/// Stamps in memory or on disk.
pub(super) trait Stamps: Sync {
    /// Shows all stamps, stretch by stretch, in their order.
    fn each(&self, see: &mut dyn FnMut(&[f64])) -> Found<()>;

    /// Where they begin and end; zeros if there are none.
    fn ends(&self) -> Ends;
}

impl Stamps for &[f64] {
    fn each(&self, see: &mut dyn FnMut(&[f64])) -> Found<()> {
        see(self);
        Ok(())
    }

    fn ends(&self) -> Ends {
        Ends {
            first: self.first().copied().unwrap_or(0.0),
            last: self.last().copied().unwrap_or(0.0),
            len: self.len(),
        }
    }
}

/// The stamps of the rows that are kept.
pub(super) struct Kept<'a> {
    stamps: &'a dyn Stamps,
    /// Places left out, ascending.
    dropped: &'a [usize],
    ends: Ends,
}

impl<'a> Kept<'a> {
    /// All stamps but those at the places `dropped`, which repeat the stamp before them.
    pub(super) fn new(stamps: &'a dyn Stamps, dropped: &'a [usize]) -> Kept<'a> {
        let ends = stamps.ends();
        Kept {
            stamps,
            dropped,
            ends: Ends {
                len: ends.len - dropped.len(),
                ..ends
            },
        }
    }
}

impl Stamps for Kept<'_> {
    fn each(&self, see: &mut dyn FnMut(&[f64])) -> Found<()> {
        let (mut k, mut dropped) = (0, self.dropped);
        self.stamps.each(&mut |stamps| {
            let (here, later) =
                dropped.split_at(dropped.partition_point(|d| *d < k + stamps.len()));
            let mut from = 0;
            for place in here {
                see(stamps.get(from..place - k).unwrap_or_default());
                from = place - k + 1;
            }
            see(stamps.get(from..).unwrap_or_default());
            dropped = later;
            k += stamps.len();
        })
    }

    fn ends(&self) -> Ends {
        self.ends
    }
}

/// Shows the place of the earlier stamp, that stamp and the step to the next one.
pub(super) fn each_step(stamps: &dyn Stamps, see: &mut dyn FnMut(usize, f64, f64)) -> Found<()> {
    let (mut k, mut before) = (0, f64::NAN);
    stamps.each(&mut |stamps| {
        for &stamp in stamps {
            if k > 0 {
                see(k - 1, before, stamp - before);
            }
            before = stamp;
            k += 1;
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_that_are_kept_are_all_but_the_dropped_ones() {
        let all: Vec<f64> = (0..10).map(f64::from).collect();
        let stamps = all.as_slice();
        let kept = Kept::new(&stamps, &[1, 2, 7]);
        let mut found = Vec::new();
        kept.each(&mut |stamps| found.extend_from_slice(stamps))
            .unwrap();
        assert_eq!(found, [0.0, 3.0, 4.0, 5.0, 6.0, 8.0, 9.0]);
        assert_eq!((kept.ends().len, kept.ends().last), (7, 9.0));
        let mut steps = Vec::new();
        each_step(&kept, &mut |k, t, step| steps.push((k, t, step))).unwrap();
        assert_eq!(steps[..2], [(0, 0.0, 3.0), (1, 3.0, 1.0)]);
    }
}
