//! The geometry of a `.par`: frames with their antecedents.

use super::super::angle;
use super::super::check;
use super::super::code;
use super::super::description::{Drive, Limits, LoopSpec, MdhRow, Motion, Quantity, Snap};
use super::super::findings::{Findings, finding};
use super::document::Item;
use super::values::Values;

/// More links than any robot has.
const MAX_LINKS: usize = 10_000;

/// How many links, and how many joints that are cut to make a tree of closed loops.
#[derive(Clone, Copy, Debug)]
pub(super) struct Counts {
    /// NL.
    pub(super) links: usize,
    /// NJ - NL.
    pub(super) cuts: usize,
}

/// The numbers of links and cuts; `None` where the robot is none that is modelled, which is
/// reported.
pub(super) fn counts(values: &Values<'_, '_>, to: &mut Findings) -> Option<Counts> {
    let Some(item) = values.scalar("nl") else {
        let found = finding(
            code::KEY_MISSING,
            "`NL`, the number of moving links, is missing",
        );
        to.error_at(Default::default(), found);
        return None;
    };
    let links = count(values, item, "`NL`", (1, MAX_LINKS), to)?;
    let joints = match values.scalar("nj") {
        Some(item) => count(values, item, "`NJ`", (links, 2 * MAX_LINKS), to)?,
        None => links,
    };
    let closed = values.scalar("type").filter(|item| item.text == "2");
    if let Some(item) = closed.filter(|_| joints == links) {
        let message = "`Type = 2` is a closed loop, but no joint is cut: NJ is NL";
        let help = "NJ counts the cut joints too; a tree has Type = 1";
        to.error(item.offset, finding(code::CLOSED_LOOP, message).help(help));
        return None;
    }
    let cuts = joints - links;
    ["is_floating", "is_mobile"]
        .iter()
        .all(|key| stands(values, key, to))
        .then_some(Counts { links, cuts })
}

/// Whether the base stands still.
fn stands(values: &Values<'_, '_>, key: &str, to: &mut Findings) -> bool {
    let Some(item) = values.scalar(key) else {
        return true;
    };
    match item.text.to_ascii_lowercase().as_str() {
        "0" | "false" => true,
        "1" | "true" => {
            let message = format!("`{key}`: a base that moves is not modelled");
            to.error(item.offset, finding(code::JOINT_UNSUPPORTED, message));
            false
        }
        other => {
            let message = format!("`{key}` is `{other}`, neither True nor False");
            to.error(item.offset, finding(code::WORD_UNKNOWN, message));
            false
        }
    }
}

fn count(
    values: &Values<'_, '_>,
    item: Item<'_>,
    what: &str,
    (low, high): (usize, usize),
    to: &mut Findings,
) -> Option<usize> {
    let value = values.number(item, what, to)?;
    if value.fract() == 0.0 && (low as f64..=high as f64).contains(&value) {
        return Some(value as usize);
    }
    let message = format!(
        "{what} is {}, not a whole number from {low} to {high}",
        item.text
    );
    to.error(item.offset, finding(code::NUMBER_RANGE, message));
    None
}

/// The rows without inertial values, those of the links and behind them the two sides of each cut
/// joint, and the angles taken as multiples of pi/2.
pub(super) fn read(
    values: &Values<'_, '_>,
    counts: Counts,
    to: &mut Findings,
) -> (Vec<MdhRow>, Vec<Snap>) {
    let frames = counts.links + 2 * counts.cuts;
    let keys = [
        "ant", "sigma", "gamma", "b", "alpha", "d", "theta", "r", "mu",
    ];
    let lists = keys.map(|key| values.list(key, frames, to));
    let mut reader = Reader {
        values,
        snaps: Vec::new(),
    };
    let rows = (0..frames).map(|index| {
        let item = |key: usize| lists[key].and_then(|list| list.get(index)).copied();
        let row = reader.row(index, item, to);
        let unmoved = item(8).is_some_and(|mu| mu.text == "0");
        let drive = match counts.cuts > 0 && (unmoved || index >= counts.links) {
            true => Drive::Passive,
            false => Drive::Own,
        };
        MdhRow { drive, ..row }
    });
    let rows = rows.collect();
    (rows, reader.snaps)
}

/// Takes the two sides of each cut joint from behind the rows of the links.
pub(super) fn loops(rows: &mut Vec<MdhRow>, counts: Counts) -> Vec<LoopSpec> {
    let cuts = rows.split_off(counts.links.min(rows.len()));
    let sides = cuts.iter().zip(cuts.iter().skip(counts.cuts)).enumerate();
    sides
        .map(|(index, (cut, meets))| {
            let first = counts.links + index + 1;
            LoopSpec {
                name: format!("{first} = {}", first + counts.cuts),
                cut: cut.clone(),
                meets: meets.clone(),
                flipped: false,
                span: cut.span,
            }
        })
        .collect()
}

struct Reader<'v, 'd, 't> {
    values: &'v Values<'d, 't>,
    snaps: Vec<Snap>,
}

impl Reader<'_, '_, '_> {
    fn row<'t>(
        &mut self,
        index: usize,
        item: impl Fn(usize) -> Option<Item<'t>>,
        to: &mut Findings,
    ) -> MdhRow {
        let name = format!("joint{}", index + 1);
        let motion = self.motion(item(1), index, to);
        let (turns, slides) = (motion == Motion::Revolute, motion == Motion::Prismatic);
        let mut angle = |key: &str, item, variable| {
            self.angle(
                &format!("`{key}` of frame {}", index + 1),
                &name,
                item,
                variable,
                to,
            )
        };
        let [gamma, alpha] =
            [("gamma", 2), ("alpha", 4)].map(|(key, at)| angle(key, item(at), false));
        let theta = angle("theta", item(6), turns);
        let mut length = |key: &str, item, variable| {
            let what = format!("`{key}` of frame {}", index + 1);
            let found = self.quantity(&what, item, variable, to);
            if let Some(item) = item.filter(|_| found.value.abs() > check::DOUBTFUL_LENGTH) {
                to.warn(item.offset, check::doubtful_length(&what, found.value));
            }
            found
        };
        let [b, d] = [("b", 3), ("d", 5)].map(|(key, at)| length(key, item(at), false));
        let r = length("r", item(7), slides);
        let ant = self.antecedent(item(0), index, to);
        let offset = item(0).or(item(1)).map_or(0, |item| item.offset);
        MdhRow {
            name,
            motion,
            ant,
            gamma,
            b,
            alpha,
            d,
            theta,
            r,
            inertial: None,
            drive: Drive::Own,
            limits: Limits::default(),
            span: to.span(offset),
        }
    }

    fn antecedent(&self, item: Option<Item<'_>>, index: usize, to: &mut Findings) -> usize {
        let Some(item) = item else { return index };
        let what = format!("`ant` of frame {}", index + 1);
        let Some(value) = self.values.number(item, &what, to) else {
            return index;
        };
        if value.fract() == 0.0 && (0.0..=index as f64).contains(&value) {
            return value as usize;
        }
        let message = format!("{what} is {}, which is not an earlier frame", item.text);
        let help = format!("0 is the base, 1 the first frame; here 0 to {index} are possible");
        to.error(item.offset, finding(code::ANTECEDENT, message).help(help));
        index
    }

    fn motion(&self, item: Option<Item<'_>>, index: usize, to: &mut Findings) -> Motion {
        match item.map(|item| (item.text, item.offset)) {
            None | Some(("0", _)) => Motion::Revolute,
            Some(("1", _)) => Motion::Prismatic,
            Some(("2", _)) => Motion::Fixed,
            Some((text, offset)) => {
                let message = format!("`sigma` of frame {} is `{text}`", index + 1);
                let help = "0 is revolute, 1 prismatic, 2 fixed";
                to.error(
                    offset,
                    finding(code::JOINT_TYPE_UNKNOWN, message).help(help),
                );
                Motion::Revolute
            }
        }
    }

    /// A number; where the joint variable may stand (`th3`, `th3 + pi/2`), what is added to it.
    fn quantity(
        &self,
        what: &str,
        item: Option<Item<'_>>,
        variable: bool,
        to: &mut Findings,
    ) -> Quantity {
        let nothing = Quantity {
            value: 0.0,
            text: "0".to_owned(),
        };
        let Some(item) = item else { return nothing };
        let symbol = self.values.symbol(item).filter(|_| variable);
        let Some(symbol) = symbol else {
            let value = self.values.number(item, what, to);
            return value.map_or(nothing, |value| Quantity {
                value,
                text: item.text.to_owned(),
            });
        };
        let mut at = |value| {
            let more = [(symbol.to_owned(), value)];
            self.values.evaluate(item, what, &more, to)
        };
        let Some(zero) = at(0.0) else { return nothing };
        let one = at(1.0).unwrap_or(zero);
        if (one - zero - 1.0).abs() > 1e-9 {
            let message = format!("{what} is not the joint variable `{symbol}` plus a constant");
            to.error(item.offset, finding(code::EXPRESSION, message));
        }
        Quantity {
            value: zero,
            text: format!("{zero}"),
        }
    }

    fn angle(
        &mut self,
        what: &str,
        joint: &str,
        item: Option<Item<'_>>,
        variable: bool,
        to: &mut Findings,
    ) -> Quantity {
        let found = self.quantity(what, item, variable, to);
        if let Some(item) = item.filter(|_| found.value.abs() > check::DOUBTFUL_ANGLE) {
            to.warn(item.offset, check::doubtful_angle(what, found.value));
        }
        let (value, Some(turns)) = angle::snap(found.value) else {
            return found;
        };
        let text = angle::quarter_turns(turns);
        if (value - found.value).abs() > angle::REPORTED {
            self.snaps.push(Snap {
                joint: joint.to_owned(),
                from: found.value,
                to: text.clone(),
            });
        }
        Quantity { value, text }
    }
}
