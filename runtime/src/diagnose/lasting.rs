//! Errors of the model that last longer than the noise, and what they do to error bars.

use std::ops::Range;

use super::joined::Joined;
use super::state::State;
use super::track::Track;

/// Length of the blocks whose errors are independent of each other, s; and the fewest of them.
const BLOCK_S: f64 = 2.0;
const BLOCKS: usize = 12;

/// Error bars that hold beside an error of the model that lasts: it is independent only from block to
/// block.
pub(super) fn widen(state: &mut State, joined: &Joined) {
    let step = joined.tracks.first().map_or(1.0, Track::step);
    let rows = joined.rows();
    let len = ((BLOCK_S / step) as usize).min(rows / BLOCKS).max(1);
    let inside = |segment: &Range<usize>| {
        let end = segment.end;
        let starts = segment.clone().step_by(len);
        starts
            .map(move |start| start..(start + len).min(end))
            .collect::<Vec<_>>()
    };
    let blocks: Vec<Range<usize>> = joined.segments.iter().flat_map(inside).collect();
    let count = state.effects.iter().map(|effect| effect.values.len()).sum();
    let mut wide = state.system.block_sigmas(count, &blocks).into_iter();
    for sigma in state
        .effects
        .iter_mut()
        .flat_map(|effect| &mut effect.sigmas)
    {
        let wide = wide.next().flatten();
        *sigma = sigma.map(|own| own.max(wide.unwrap_or(0.0)));
    }
}
