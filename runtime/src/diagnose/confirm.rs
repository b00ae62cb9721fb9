//! Whether an effect keeps on another motion what it promises from the training log.

use super::catalogue::EntryKind;
use super::joined::Joined;
use super::lasting;
use super::screen::Contender;
use super::state::State;
use super::stepwise::{Named, Stepwise};

/// Share of the gain that the columns promise on another motion which must be there.
const CONFIRMED: f64 = 1.0 / 3.0;

/// Times the root of the promise by which a gain may be short: two and a half standard deviations of
/// its own noise, which is twice that root. What a promise is too small to decide, the training log
/// decides.
const DOUBT: f64 = 5.0;

/// Standard deviations by which a column that the noise of its motion swamps must still go along with
/// what is left on another motion.
const GOES_ALONG: f64 = 2.5;

/// By how much an effect may raise the plain torque error on another motion, as a factor: what
/// only noise decides.
const WORSE: f64 = 1.005;

/// The same of an effect that parameters can hide: it moves them all by what is known of them, which
/// a short log's own error follows only roughly.
const HIDDEN_WORSE: f64 = 1.05;

/// Promise below which another motion decides nothing.
const DECIDES: f64 = 4.0;

/// Standard deviations that some parameter of a change must be from zero.
const CLEAR: f64 = 3.0;

/// Corrected probability by chance of what training log and confirming motion gain together, below
/// which an effect without a margin stands.
const TOGETHER: f64 = 3e-4;

/// Standard deviations by which the gain of such an effect may be short of its promise.
const SHORT: f64 = 2.0;

/// What an effect did on another motion instead of what it promised.
#[derive(Clone, Copy, Debug)]
enum Broken {
    /// Gain in the whitened sum of squares, and what the columns promised.
    Promise { gained: f64, promised: f64 },
    /// Factor by which the plain torque error of its joints grew.
    Worse(f64),
}

impl Broken {
    fn why(self, trained: f64) -> String {
        match self {
            Broken::Promise { gained, promised } => format!(
                "it improves the training log (by {trained:.0}) and does not keep its promise on \
                 the validation log: {gained:.0} of {promised:.0}"
            ),
            Broken::Worse(factor) => format!(
                "it raises the torque error of its joints on the validation log by {:.1} %",
                100.0 * (factor - 1.0)
            ),
        }
    }
}

/// Whether a change of the predicted rows does on another motion what it should: `change` is its
/// product with the residual before, and its square.
fn kept(
    confirm: &Joined,
    joints: &[usize],
    (before, after): (&[Vec<f64>], &[Vec<f64>]),
    (along, promised): (f64, f64),
    hidden: bool,
) -> Result<(), Broken> {
    let gained = 2.0 * along - promised;
    if gained < CONFIRMED * promised - DOUBT * promised.sqrt() {
        return Err(Broken::Promise { gained, promised });
    }
    let error = |rows: &[Vec<f64>]| -> f64 {
        let of_joint = |&joint: &usize| confirm.square_error(joint, rows);
        joints.iter().map(of_joint).sum::<f64>().sqrt()
    };
    // The plain error has slow noise in it, which whitening takes away: it is asked strictly where
    // the gain is not clear, and there is something to gain.
    let clear = promised < DECIDES || gained > 0.5 * promised;
    let worst = if hidden && clear { HIDDEN_WORSE } else { WORSE };
    match error(after) / error(before) {
        factor if factor > worst => Err(Broken::Worse(factor)),
        _ => Ok(()),
    }
}

/// A resonance makes much of the noise of a measured motion, which no simulation without it can
/// stand in for: the share of such a column that is none, where it goes along with what is left.
fn attenuation(along: f64, square: f64) -> f64 {
    let share = along / square.max(f64::MIN_POSITIVE);
    match along > GOES_ALONG * square.sqrt() {
        true => share.min(1.0),
        false => share.clamp(CONFIRMED, 1.0),
    }
}

/// Rows with what others change by.
fn changed(before: &[Vec<f64>], without: &[Vec<f64>], with: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of_joint = |(before, change): (&Vec<f64>, (&Vec<f64>, &Vec<f64>))| -> Vec<f64> {
        let change = change.0.iter().zip(change.1);
        let rows = before.iter().zip(change);
        rows.map(|(b, (without, with))| b + with - without)
            .collect()
    };
    let changes = without.iter().zip(with);
    before.iter().zip(changes).map(of_joint).collect()
}

/// Rows a share of the way from some to others.
fn between(before: &[Vec<f64>], after: &[Vec<f64>], share: f64) -> Vec<Vec<f64>> {
    let of_joint = |(before, after): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        let pairs = before.iter().zip(after);
        pairs.map(|(b, a)| b + share * (a - b)).collect()
    };
    before.iter().zip(after).map(of_joint).collect()
}

impl Stepwise<'_> {
    /// The state with a contender, if it keeps its promise on another motion.
    pub(super) fn confirmed(
        &self,
        contender: &Contender,
        state: &State,
        named: &[Named],
    ) -> Result<State, String> {
        let mut chosen: Vec<(usize, Vec<f64>)> =
            named.iter().map(|n| (n.number, n.shape.clone())).collect();
        chosen.push((
            contender.candidate.number,
            contender.candidate.shape.clone(),
        ));
        let next = self.bench.settle(&chosen, &state.predicted);
        let added = next.effects.last();
        if added.is_some_and(|effect| effect.sigmas.iter().all(Option::is_none)) {
            return Err(
                "along the measured motion nothing but noise is left of its columns".to_owned(),
            );
        }
        self.matters(contender, state, &next)?;
        if let Some(other) = self.confirm {
            self.keeps_its_promise(contender, (state, &next), other)?;
        }
        Ok(next)
    }

    /// Whether what a contender changes is what another motion lacks; `beside` is that motion
    /// without noise.
    fn keeps_its_promise(
        &self,
        contender: &Contender,
        (state, next): (&State, &State),
        (confirm, beside): (&Joined, &Joined),
    ) -> Result<(), String> {
        let joints = contender.candidate.columns.iter();
        let joints: Vec<usize> = joints.flat_map(|c| c.0.iter().map(|p| p.0)).collect();
        let before = self.bench.rows(state, confirm);
        let entry = self.bench.hypotheses[contender.candidate.number].entry;
        let hidden = self.bench.catalogue.entries()[entry].hidden_by_parameters;
        let swings = self.bench.kind(contender.candidate.number) == EntryKind::Yielding;
        let kept = |after: &[Vec<f64>]| -> Result<(), Broken> {
            let (along, square) = self.bench.difference(confirm, (&before, after));
            let share = if swings {
                attenuation(along, square)
            } else {
                1.0
            };
            let after = between(&before, after, share);
            let change = (share * along, share * share * square);
            kept(confirm, &joints, (&before, &after), change, hidden)
        };
        let after = self.bench.rows(next, confirm);
        let smooth = || {
            let [without, with] = [state, next].map(|state| self.bench.rows(state, beside));
            changed(&before, &without, &with)
        };
        if contender.margin <= 0.0 {
            let change = |after: &[Vec<f64>]| self.bench.difference(confirm, (&before, after));
            self.settles(contender, [change(&after), change(&smooth())])?;
        }
        // Along the measured motion, or, where its noise drowns the columns, along one without.
        kept(&after)
            .or_else(|broken| kept(&smooth()).map_err(|_| broken))
            .map_err(|broken| broken.why(contender.gain.square))
    }

    /// Whether another motion settles what the training log alone leaves open: what it gains is what
    /// was promised, along the measured motion as along one without noise, and chance does not gain
    /// as much on both. `changes`: products with the residual, and squares.
    fn settles(&self, contender: &Contender, changes: [(f64, f64); 2]) -> Result<(), String> {
        let short = |&(along, square): &(f64, f64)| along < square - SHORT * square.sqrt();
        let gained = changes.map(|(along, square)| 2.0 * along - square);
        let together = contender.gain.square + gained[0].min(gained[1]);
        let likely = self.by_chance(together, contender.freedom);
        match changes.iter().any(short) || likely > TOGETHER {
            false => Ok(()),
            true => Err(format!(
                "the training log alone does not establish it (gain {:.0}), and the validation log \
                 does not settle it: {:.0} of {:.0}",
                contender.gain.square, gained[0], changes[0].1
            )),
        }
    }

    /// Whether an effect takes enough of the torque error of one of its joints away.
    fn matters(&self, contender: &Contender, state: &State, next: &State) -> Result<(), String> {
        let least = self.bench.least_gain;
        if !self.bench.knows_parameters() {
            return Ok(());
        }
        let train = self.bench.train;
        let [before, after] = [state, next].map(|state| self.bench.rows(state, train));
        let joints = contender.candidate.columns.iter().flat_map(|c| c.0.iter());
        let gain = |&(joint, _): &(usize, Vec<f64>)| {
            let errors = [&before, &after].map(|rows| train.square_error(joint, rows));
            1.0 - (errors[1] / errors[0]).sqrt()
        };
        let gain = joints.map(gain).fold(f64::NEG_INFINITY, f64::max);
        let mut wide = next.clone();
        lasting::widen(&mut wide, train);
        let clear = wide.effects.last().is_some_and(|effect| {
            let mut pairs = effect.values.iter().zip(&effect.sigmas);
            pairs.any(|(value, sigma)| sigma.is_some_and(|sigma| value.abs() > CLEAR * sigma))
        });
        match (gain >= least, clear) {
            (true, true) => Ok(()),
            (true, false) => Err("none of its parameters is far from zero".to_owned()),
            (false, _) => Err(format!(
                "it lowers the torque error of none of its joints by more than {:.1} %",
                100.0 * gain.max(0.0)
            )),
        }
    }
}
