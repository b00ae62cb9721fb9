//! The tables that are printed.

use std::collections::BTreeMap;
use std::fmt::Write;

use idim::runtime::report::Verdict;

use super::score::Scored;
use super::truth::Category;

/// Evidence from which on a single effect is asked to be named, standard deviations.
const DETECTABLE: f64 = 6.0;

/// Steps of the ladder of strengths.
const LADDER: [f64; 7] = [5.0, 6.0, 8.0, 12.0, 20.0, 40.0, f64::INFINITY];

/// One line for a case.
pub fn line(case: &Scored) -> String {
    let truth = &case.truth;
    let hidden: Vec<String> = truth
        .effects
        .iter()
        .map(|effect| format!("{}{}", effect.effect, at(&effect.joints)))
        .collect();
    let said: Vec<String> = case
        .answer
        .effects
        .iter()
        .map(|said| format!("{}{}", said.effect, at(&said.joints)))
        .collect();
    let note = match truth.category {
        Category::One if case.right() => "",
        Category::One if case.answer.verdict == Verdict::Nothing => "MISSED",
        Category::One if case.related() => "NEAR",
        Category::Two if case.all_named() => "",
        Category::Nothing if case.answer.verdict == Verdict::Nothing => "",
        Category::Outside if case.answer.verdict == Verdict::Unknown => "",
        _ => "WRONG",
    };
    let percent = |part: Option<f64>| match part {
        Some(part) => format!("{:.0} %", 100.0 * part),
        None => String::new(),
    };
    let (closed, position) = (percent(case.closed()), percent(case.position_closed()));
    format!(
        "{} {:8} {:>6.1} {:44} | {:8} {:44} {note:6} {closed:>6} {position:>6} {:.1} s",
        truth.case,
        truth.robot,
        truth.evidence,
        if hidden.is_empty() {
            "nothing".into()
        } else {
            hidden.join(" + ")
        },
        format!("{:?}", case.answer.verdict).to_lowercase(),
        said.join(", "),
        case.answer.seconds,
    )
}

fn at(joints: &[usize]) -> String {
    let numbers: Vec<String> = joints.iter().map(usize::to_string).collect();
    if joints.is_empty() {
        String::new()
    } else {
        format!("@{}", numbers.join("+"))
    }
}

/// What was said for each thing that is hidden.
pub fn confusion(cases: &[Scored]) -> String {
    let mut rows: BTreeMap<&str, BTreeMap<&str, usize>> = BTreeMap::new();
    for case in cases
        .iter()
        .filter(|case| case.truth.category != Category::Two)
    {
        *rows
            .entry(case.hidden())
            .or_default()
            .entry(case.word())
            .or_default() += 1;
    }
    let mut text = String::from("hidden                        said\n");
    for (hidden, said) in rows {
        let all: usize = said.values().sum();
        let right = if hidden == "outside" {
            "unknown"
        } else {
            hidden
        };
        let hits = said.get(right).copied().unwrap_or(0);
        let others: Vec<String> = said
            .iter()
            .filter(|(name, _)| **name != right)
            .map(|(name, count)| format!("{name} {count}"))
            .collect();
        let _ = writeln!(
            text,
            "{hidden:28}  {hits:3} of {all:3}   {}",
            others.join(", ")
        );
    }
    text
}

/// The table of what is to be reached.
pub fn summary(cases: &[Scored]) -> String {
    let of = |category: Category| {
        cases
            .iter()
            .filter(move |case| case.truth.category == category)
    };
    let clear = || of(Category::One).filter(|case| case.truth.evidence >= DETECTABLE);
    let unknown = |case: &Scored| case.answer.verdict == Verdict::Unknown;
    let mut text = String::new();
    let mut row = |what: &str, value: String, aim: &str| {
        let _ = writeln!(text, "{what:52} {value:>20}   {aim}");
    };
    row("", "reached".into(), "to reach");
    row(
        "one effect, first name right",
        share(clear().map(Scored::right)),
        ">= 97 %",
    );
    row(
        "  or among at most three said to be the same",
        share(clear().map(Scored::grouped)),
        "",
    );
    row(
        "  or a near relative",
        share(clear().map(Scored::related)),
        "",
    );
    row(
        "one effect, yet called unknown",
        share(clear().map(unknown)),
        "<= 2 %",
    );
    let further = clear()
        .filter(|case| case.right())
        .map(|case| case.answer.effects.len() > 1);
    row(
        "one effect, right, and more named beside it",
        share(further),
        "",
    );
    let joints = cases.iter().flat_map(Scored::joints);
    row(
        "joint right where the name is right",
        share(joints),
        "100 %",
    );
    let false_alarm = of(Category::Nothing).map(|case| case.answer.verdict != Verdict::Nothing);
    row(
        "nothing hidden, something said",
        share(false_alarm),
        "<= 2 %",
    );
    row(
        "two effects, both named",
        share(of(Category::Two).map(Scored::all_named)),
        "100 %",
    );
    row(
        "outside the catalogue, called unknown",
        share(of(Category::Outside).map(unknown)),
        ">= 90 %",
    );
    row("weakest effects named", weakest(cases), "6");
    row(
        "torque gap closed, median",
        quantile(cases.iter().filter_map(Scored::closed), 0.5),
        ">= 98 %",
    );
    row(
        "  lower quartile",
        quantile(cases.iter().filter_map(Scored::closed), 0.25),
        ">= 95 %",
    );
    let position = || cases.iter().filter_map(Scored::position_closed);
    row(
        "position gap closed, median",
        quantile(position(), 0.5),
        ">= 95 %",
    );
    row("  lower quartile", quantile(position(), 0.25), "");
    let seconds: Vec<f64> = cases.iter().map(|case| case.answer.seconds).collect();
    let mean = seconds.iter().sum::<f64>() / seconds.len().max(1) as f64;
    let longest = seconds.iter().fold(0.0, |a: f64, b| a.max(*b));
    row(
        "time a case, reading included: mean, longest",
        format!("{mean:.1} s, {longest:.1} s"),
        "< 2 s",
    );
    text + &ladder(cases)
}

/// Shares named by strength.
fn ladder(cases: &[Scored]) -> String {
    let mut text = String::from("\nevidence of a single effect    first name right\n");
    for step in LADDER.windows(2) {
        let within = |case: &&Scored| {
            case.truth.category == Category::One
                && (step[0]..step[1]).contains(&case.truth.evidence)
        };
        let named = share(cases.iter().filter(within).map(Scored::right));
        let _ = writeln!(text, "{:5.0} .. {:<5.0} {named:>32}", step[0], step[1]);
    }
    text
}

/// The evidence above which nine of ten neighbours in strength are named.
fn weakest(cases: &[Scored]) -> String {
    let mut single: Vec<(f64, bool)> = cases
        .iter()
        .filter(|case| case.truth.category == Category::One)
        .map(|case| (case.truth.evidence, case.right()))
        .collect();
    single.sort_by(|a, b| a.0.total_cmp(&b.0));
    const NEIGHBOURS: usize = 10;
    let enough =
        |all: &[(f64, bool)]| 10 * all.iter().filter(|(_, right)| *right).count() >= 9 * all.len();
    let windows: Vec<&[(f64, bool)]> = single.windows(NEIGHBOURS).collect();
    let first = windows
        .iter()
        .rposition(|all| !enough(all))
        .map_or(0, |last| last + 1);
    match windows.get(first) {
        Some(all) => format!("{:.1} sigma", all[0].0),
        None => "-".into(),
    }
}

fn share(all: impl Iterator<Item = bool>) -> String {
    let all: Vec<bool> = all.collect();
    let hits = all.iter().filter(|hit| **hit).count();
    match all.len() {
        0 => "-".into(),
        count => format!(
            "{hits} of {count} = {:.1} %",
            100.0 * hits as f64 / count as f64
        ),
    }
}

fn quantile(all: impl Iterator<Item = f64>, part: f64) -> String {
    let mut all: Vec<f64> = all.collect();
    all.sort_by(f64::total_cmp);
    match all.len() {
        0 => "-".into(),
        count => {
            let place = (part * (count - 1) as f64).round() as usize;
            format!("{:.0} % ({count})", 100.0 * all[place])
        }
    }
}
