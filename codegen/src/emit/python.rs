//! Python: one module over numpy, for one state or for many at once.

use super::File;
use super::function::{Line, Part};
use super::language::Language;
use super::signature::{Prototype, prototypes};
use super::summary::summary;
use super::text::{number, quoted, remark};
use crate::expr::{Function, Input};
use crate::functions::Extent;
use crate::knowledge::Knowledge;
use crate::robot::Robot;

/// Words that a local variable cannot have: keywords, arguments, what a function calls.
const RESERVED: &str = "False None True and as assert async await break class continue def del \
    elif else except finally for from global if import in is lambda nonlocal not or pass raise \
    return try while with yield match case type np out live q qd qdd slip D P R h dh X tau M g T J \
    JOINTS PARAMETERS _signals";

/// Python as a [`Language`].
struct Python {
    joints: usize,
}

impl Language for Python {
    fn reserved(&self) -> Vec<String> {
        let words = RESERVED.split_whitespace().map(str::to_owned);
        let inputs = ["q", "qd", "qdd", "slip"];
        let joints = 1..=self.joints;
        let inputs = joints.flat_map(|joint| inputs.map(|input| format!("{input}{joint}")));
        words.chain(inputs).collect()
    }

    fn input(&self, input: Input) -> String {
        let (signal, place) = place(input);
        match input {
            Input::Parameter(_) => format!("{signal}[..., {place}]"),
            _ => format!("{signal}{}", place + 1),
        }
    }

    fn trig(&self, name: &str) -> String {
        name.to_owned()
    }

    fn number(&self, value: f64) -> String {
        number(value)
    }

    fn computes_trig(&self) -> bool {
        true
    }

    fn call(&self, function: Function, x: &str, _: &str) -> String {
        match function {
            Function::Sign => format!("np.sign({x})"),
            Function::Abs => format!("np.abs({x})"),
            Function::Tanh => format!("np.tanh({x})"),
            Function::Bell => format!("np.exp(-np.square({x}))"),
            Function::Power(p) => format!("np.power(np.abs({x}), {})", number(f64::from_bits(p))),
            Function::Sine => format!("np.sin({x})"),
            Function::Cosine => format!("np.cos({x})"),
            Function::Reciprocal => format!("np.reciprocal({x})"),
            Function::Root => format!("np.sqrt({x})"),
            Function::RootOfOpposite => format!("np.sqrt(-({x}))"),
        }
    }
}

/// The array and the place of an input.
fn place(input: Input) -> (&'static str, usize) {
    match input {
        Input::Q(joint) => ("q", joint),
        Input::Qd(joint) => ("qd", joint),
        Input::Qdd(joint) => ("qdd", joint),
        Input::Slip(joint) => ("slip", joint),
        Input::Parameter(column) => ("X", column),
    }
}

/// The module of a robot.
pub fn python(robot: &Robot) -> File {
    let mut text = String::from("\"\"\"");
    for line in summary(robot, "change the description and generate again") {
        text.push_str(&remark(&line));
        text.push('\n');
    }
    text.push_str(USE);
    text.push_str(&tables(robot));
    text.push_str(HELPERS);
    for signature in &prototypes(robot) {
        text.push_str(&definition(robot, signature));
    }
    File {
        name: format!("{}.py", robot.mechanism.name),
        text,
    }
}

const USE: &str = "
tau = D(q, qd, qdd) @ X, with X in the order of COLUMNS. Signals are SI and have the shape (n,) for
one state or (N, n) for many, outputs (n, nb) or (N, n, nb): n = JOINTS, nb = PARAMETERS. Any
further axes in front are kept.
\"\"\"

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class Column(NamedTuple):
    \"\"\"A base parameter; `relation` are the standard parameters that it stands for.\"\"\"

    name: str
    unit: str
    joint: int
    meaning: str
    relation: str


";

const HELPERS: &str = "

def _signals(*signals: ArrayLike) -> tuple[NDArray[np.float64], ...]:
    \"\"\"The signals as arrays of one shape (..., n).\"\"\"
    arrays = [np.asarray(signal, dtype=np.float64) for signal in signals]
    for array in arrays:
        if array.ndim == 0 or array.shape[-1] != JOINTS:
            raise ValueError(
                f\"signals must have the shape ({JOINTS},) or (N, {JOINTS}), not {array.shape}\"
            )
    return tuple(np.broadcast_arrays(*arrays))
";

fn tables(robot: &Robot) -> String {
    let columns: String = (robot.base.parameters.iter())
        .map(|parameter| {
            format!(
                "    Column(\n        {},\n        {},\n        {},\n        {},\n        {},\n    ),\n",
                quoted(&parameter.name),
                quoted(&parameter.unit),
                parameter.link + 1,
                quoted(&parameter.meaning),
                quoted(&parameter.relation_text())
            )
        })
        .collect();
    let joints: String = (robot.mechanism.driven().iter())
        .map(|joint| format!("    {},\n", quoted(&joint.name)))
        .collect();
    let values: String = (Knowledge::of(robot).nominal.iter())
        .zip(&robot.base.parameters)
        .map(|(value, parameter)| {
            let value = value.map_or("np.nan".to_owned(), number);
            format!("        {value},  # {}\n", parameter.name)
        })
        .collect();
    format!(
        "NAME = {}\nJOINTS = {}\nPARAMETERS = {}\nDESCRIPTION_HASH = {}\n\n\
         # In the order of q.\nJOINT_NAMES = (\n{joints})\n\n\
         # In the order of the columns of every output.\nCOLUMNS = (\n{columns})\n\n\
         # X of the description; not a number where it gives no value.\n\
         NOMINAL = np.array(\n    [\n{values}    ]\n)\n",
        quoted(&robot.mechanism.name),
        robot.mechanism.driven,
        robot.base.parameters.len(),
        quoted(&robot.description.hash)
    )
}

fn definition(robot: &Robot, signature: &Prototype<'_>) -> String {
    let language = Python {
        joints: robot.mechanism.driven,
    };
    let body = signature.body(robot, "out", &language);
    let mut text = String::new();
    let mut calls = String::new();
    if let [only] = body.parts.as_slice() {
        calls = statements(only);
    } else {
        calls.push_str("    live: dict[int, NDArray[np.float64]] = {}\n");
        for (index, part) in body.parts.iter().enumerate() {
            let name = format!("_{}_{}", signature.name, index + 1);
            let given = arguments(signature, part);
            text.push_str(&self::part(signature, &name, &given, part));
            calls.push_str(&format!("    {name}({})\n", given.join(", ")));
        }
    }
    format!("{text}{}{calls}    return out\n", opening(signature))
}

/// A part of a long function: it takes what it reads, and what the parts hand on to each other.
fn part(signature: &Prototype<'_>, name: &str, given: &[&str], part: &Part) -> String {
    let given: Vec<String> = (given.iter())
        .map(|&argument| match argument {
            "live" => "live: dict[int, NDArray[np.float64]]".to_owned(),
            array => format!("{array}: NDArray[np.float64]"),
        })
        .collect();
    format!(
        "\n\ndef {name}(\n    {},\n) -> None:\n    \"\"\"A part of `{}`.\"\"\"\n{}",
        given.join(",\n    "),
        signature.name,
        statements(part)
    )
}

/// What a part reads and writes, in the order of the function's own arguments.
fn arguments<'a>(signature: &Prototype<'a>, part: &Part) -> Vec<&'a str> {
    let parameters = signature.parameters.then_some("X");
    let all = signature.all_signals().chain(parameters);
    let reads = |argument: &&str| part.inputs.iter().any(|&input| place(input).0 == *argument);
    let read = all.filter(reads).chain(["live"]);
    read.chain(part.outputs()).collect()
}

/// Signals, sines and cosines, then the lines of a function or a part.
fn statements(part: &Part) -> String {
    let mut text = String::new();
    let signals = part.inputs.iter();
    for &input in signals.filter(|input| !matches!(input, Input::Parameter(_))) {
        let (signal, joint) = place(input);
        text.push_str(&format!(
            "    {signal}{} = {signal}[..., {joint}]\n",
            joint + 1
        ));
    }
    for trig in &part.trig {
        let angle = trig.code(|joint| format!("q{}", joint + 1), number);
        for (name, function) in [(&trig.sine, "sin"), (&trig.cosine, "cos")] {
            if let Some(name) = name {
                text.push_str(&format!("    {name} = np.{function}({angle})\n"));
            }
        }
    }
    text.extend(part.lines.iter().map(line));
    text
}

/// `def`, docstring, and what every function begins with.
fn opening(signature: &Prototype<'_>) -> String {
    let Prototype {
        name,
        summary,
        unit,
        ..
    } = signature;
    let signals = signature.signals.join(", ");
    let parameters = signature.parameters.then_some("X");
    let arguments: Vec<String> = (signature.signals.iter().copied().chain(parameters))
        .map(|argument| format!("{argument}: ArrayLike"))
        .collect();
    let arguments = arguments.join(", ");
    let (slip, told, used) = match signature.slip {
        true => (", slip: ArrayLike | None = None", SLIP, ", slip"),
        false => ("", "", ""),
    };
    let prepared = match signature.slip {
        true => "    slip = np.sign(qd) if slip is None else slip\n",
        false => "",
    };
    let (values, wanted) = match signature.parameters {
        true => ("    X = np.asarray(X, dtype=np.float64)\n", WANTED),
        false => ("", ""),
    };
    // One signal comes back as a tuple, too.
    let comma = if signature.signals.len() == 1 {
        ","
    } else {
        ""
    };
    let [one, many, shape] = shapes(signature);
    format!(
        "\n\ndef {name}({arguments}{slip}) -> NDArray[np.float64]:\n    \
         \"\"\"{summary}.\n\n    \
         Takes {signals} of shape (n,) or (N, n), in rad or m and s.{told}{wanted}\n    \
         Returns the shape {one} or {many}, {unit}.\n    \"\"\"\n\
         {prepared}    {signals}{used}{comma} = _signals({signals}{used})\n{values}    \
         out = np.zeros({shape})\n"
    )
}

/// The shape for one state, for many, and as an expression.
fn shapes(signature: &Prototype<'_>) -> [String; 3] {
    let short = |extent: Extent| match extent {
        Extent::Joints => "n".to_owned(),
        Extent::Parameters => "nb".to_owned(),
        Extent::Number(number) => number.to_string(),
    };
    let long = |extent: Extent| match extent {
        Extent::Joints => "JOINTS".to_owned(),
        Extent::Parameters => "PARAMETERS".to_owned(),
        Extent::Number(number) => number.to_string(),
    };
    let columns = signature.columns;
    match signature.rows {
        Some(rows) => {
            let (r, c) = (short(rows), short(columns));
            let whole = match (rows, columns) {
                (Extent::Joints, Extent::Parameters) => "q.shape + (PARAMETERS,)".to_owned(),
                _ => format!("q.shape[:-1] + ({}, {})", long(rows), long(columns)),
            };
            [format!("({r}, {c})"), format!("(N, {r}, {c})"), whole]
        }
        None => {
            let c = short(columns);
            let whole = format!("q.shape[:-1] + ({},)", long(columns));
            [format!("({c},)"), format!("(N, {c})"), whole]
        }
    }
}

/// What the docstrings of functions of base parameters say of them.
const WANTED: &str = "
    X are base parameters in the order of COLUMNS, of shape (nb,) or (N, nb).";

/// What the docstrings of a robot whose friction has a memory say of it.
const SLIP: &str = " Presliding
    states `slip`, z/zs with dz/dt = qd - |qd| z/zs, are those of sliding if not given.";

fn line(line: &Line) -> String {
    match line {
        Line::Section(title) => format!("\n    # {}\n", remark(title)),
        Line::Load { name, place } => format!("    {name} = live[{place}]\n"),
        Line::Keep { name, place } => format!("    live[{place}] = {name}\n"),
        Line::Constant { name, value } => format!("    {name} = {}\n", number(*value)),
        Line::Value { name, value } => format!("    {name} = {value}\n"),
        Line::Store {
            argument,
            row,
            column,
            value,
            parameter,
        } => {
            let row = row.map_or(String::new(), |row| format!("{row}, "));
            let note = match parameter.as_str() {
                "" => String::new(),
                parameter => format!("  # {parameter}"),
            };
            format!("    {argument}[..., {row}{column}] = {value}{note}\n")
        }
    }
}
