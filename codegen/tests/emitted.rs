//! The emitted C and Python, compiled and run by what this machine has, against the interpreter.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test fails by panicking, and says why it skipped"
)]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use idim_codegen::builder;
use idim_codegen::emit::signals::signals;
use idim_codegen::emit::{self, signature};
use idim_codegen::expr::Expr;
use idim_codegen::expr::tape::{Batch, Tape};
use idim_codegen::functions::{Extent, Group};
use idim_codegen::robot::{Output, Robot};
use rand::{RngExt, SeedableRng};

#[path = "robots/humanoid.rs"]
mod made_up;

/// Rounding of the functions of another library, through sums of some hundred terms.
const TOLERANCE: f64 = 1e-13;
const SAMPLES: usize = 100;
const FUNCTIONS: [Group; 2] = [Group::Dynamics, Group::Kinematics];

fn built_in(name: &str) -> Robot {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots");
    builder::read(&path.join(format!("{name}.toml")))
        .unwrap()
        .robot
}

/// Thirty joints: long functions, which come in parts.
fn humanoid() -> Robot {
    let text = made_up::urdf();
    builder::read_texts(&[("humanoid.urdf", &text)]).unwrap_or_else(|error| panic!("{error}"))
}

/// Two joints with everything that an expression can hold, and names that mean to break out.
fn odd() -> Robot {
    let text = r#"
        name = "odd"
        effects = ["viscous", { kind = "coulomb", smoothing = 0.05 }, "offset", "rotor_inertia"]
        [lengths]
        double = 0.3
        np = 0.2
        fn = 0.7
        s2 = 0.1
        [[joint]]
        name = 'first"*/ ??/ joint \'
        kind = "revolute"
        ant = 0
        theta = 0.3
        alpha = 0.2
        [[joint]]
        name = '"""'
        kind = "revolute"
        ant = 1
        alpha = "pi/2"
        d = "double"
        r = "fn"
        theta = -0.4
        [[joint]]
        name = "third"
        kind = "prismatic"
        ant = 2
        alpha = 0.1
        d = "np"
        r = "s2"
        [[effect]]
        kind = "stribeck"
        joint = '"""'
        velocity = 0.3
        [[effect]]
        kind = "torque_ripple"
        joint = '"""'
        N = 7
        [[effect]]
        kind = "presliding"
        joint = "third"
        zs = 0.001
    "#;
    builder::read_texts(&[("odd.toml", text)]).unwrap_or_else(|error| panic!("{error}"))
}

/// A loop that the crank turns through at every angle, and a joint that follows at half its speed.
fn closed() -> Robot {
    let text = r#"
        name = "closed"
        [[joint]]
        name = "crank"
        kind = "revolute"
        [[joint]]
        name = "coupler"
        kind = "revolute"
        d = 0.2
        passive = true
        [[joint]]
        name = "tool"
        kind = "revolute"
        alpha = 0.7
        d = 0.3
        mimic = { joint = "crank", multiplier = -0.5, offset = 0.3 }
        [[joint]]
        name = "rocker"
        kind = "revolute"
        ant = 0
        d = 0.7
        passive = true
        [[loop]]
        cut = { ant = 2, d = 0.6 }
        meets = { ant = 4, d = 0.5 }
    "#;
    builder::read_texts(&[("closed.toml", text)]).unwrap_or_else(|error| panic!("{error}"))
}

/// Random states, sample by sample: q, qd, qdd, slip, joint by joint, then base parameters.
fn states(robot: &Robot) -> Vec<Vec<f64>> {
    let mut random = rand::rngs::StdRng::seed_from_u64(6);
    let joints = robot.mechanism.driven;
    let limits = [3.0, 2.0, 5.0, 1.0];
    (0..SAMPLES)
        .map(|_| {
            let draw = |k: usize| limits[k / joints];
            let mut state: Vec<f64> = (0..4 * joints)
                .map(|k| random.random_range(-draw(k)..draw(k)))
                .collect();
            let parameters = robot.base.parameters.iter();
            state.extend(parameters.map(|_| random.random_range(-1.0..1.0)));
            state
        })
        .collect()
}

/// All outputs of the interpreter, rounded like C and Python, sample by sample, in the order of the
/// functions, row by row.
fn interpreted(robot: &Robot, states: &[Vec<f64>]) -> Vec<Vec<Vec<f64>>> {
    let (n, nb) = (robot.mechanism.driven, robot.base.parameters.len());
    let values = |values: &[Expr], state: &[f64]| {
        let mut out = vec![0.0; values.len()];
        let batch = Batch {
            len: 1,
            q: &state[..n],
            qd: &state[n..2 * n],
            qdd: &state[2 * n..3 * n],
            slip: &state[3 * n..4 * n],
        };
        let tape = Tape::plain(&robot.graph, values).with_parameters(&state[4 * n..]);
        tape.run(&batch, &mut out);
        out
    };
    let model = |state: &[f64], signature: &signature::Signature| {
        let signals = signals(robot, signature.output);
        let values = values(&signals.values, state);
        let mut dense = vec![0.0; if signature.matrix { n * nb } else { nb }];
        for (row, column, signal) in signals.entries {
            dense[row * nb + column] = values[signal];
        }
        dense
    };
    let all = |state: &Vec<f64>| {
        let models = signature::ALL.iter().map(|s| model(state, s));
        let beside = robot.functions.iter().map(|function| {
            let entries: Vec<Expr> = function.entries.iter().flatten().copied().collect();
            values(&entries, state)
        });
        models.chain(beside).collect()
    };
    states.iter().map(all).collect()
}

/// Numbers separated by spaces.
fn text(states: &[Vec<f64>]) -> String {
    let mut text = String::new();
    for value in states.iter().flatten() {
        write!(text, "{value:e} ").unwrap();
    }
    text
}

fn run(command: &mut Command, input: &str, folder: &Path) -> String {
    let file = folder.join("states.txt");
    std::fs::write(&file, input).unwrap();
    let output = command
        .stdin(Stdio::from(std::fs::File::open(file).unwrap()))
        .output()
        .unwrap();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{complaint}");
    assert_eq!(complaint, "");
    String::from_utf8(output.stdout).unwrap()
}

/// The largest difference of each output, relative to its largest entry in that state.
fn compare(robot: &Robot, states: &[Vec<f64>], printed: &str) {
    let mut numbers = printed
        .split_whitespace()
        .map(|n| n.parse::<f64>().unwrap());
    for (sample, outputs) in interpreted(robot, states).iter().enumerate() {
        for (signature, expected) in signature::prototypes(robot).iter().zip(outputs) {
            let scale = expected.iter().fold(0.0f64, |scale, x| scale.max(x.abs()));
            for (place, expected) in expected.iter().enumerate() {
                let found = numbers.next().unwrap();
                assert!(
                    (found - expected).abs() <= TOLERANCE * scale,
                    "{} of {}, sample {sample}, entry {place}: {found:e} for {expected:e}",
                    signature.name,
                    robot.mechanism.name
                );
            }
        }
    }
    assert_eq!(numbers.next(), None);
}

/// A program that reads states and prints all outputs.
fn c_program(robot: &Robot) -> String {
    let name = &robot.mechanism.name;
    let upper = name.to_uppercase();
    let mut calls = String::new();
    for signature in &signature::prototypes(robot) {
        let parameters = signature.parameters.then_some("X");
        let inputs: Vec<&str> = signature.all_signals().chain(parameters).collect();
        let extent = |extent| match extent {
            Extent::Joints => "N".to_owned(),
            Extent::Parameters => "NB".to_owned(),
            Extent::Number(number) => number.to_string(),
        };
        let columns = extent(signature.columns);
        let (rows, value, count) = match signature.rows.map(extent) {
            Some(rows) => (
                format!("[{rows}]"),
                format!("out[k / {columns}][k % {columns}]"),
                format!("{rows} * {columns}"),
            ),
            None => (String::new(), "out[k]".to_owned(), columns.clone()),
        };
        // What was there before must not stay.
        let function = &signature.name;
        write!(
            calls,
            "{{ double out{rows}[{columns}]; for (int k = 0; k < {count}; k++) {value} = 99.0;\n\
             {name}_{function}({}, out);\n\
             for (int k = 0; k < {count}; k++) printf(\"%.17g \", {value}); }}\n",
            inputs.join(", ")
        )
        .unwrap();
    }
    format!(
        "#include <stdio.h>\n#include \"{name}.h\"\n\
         #define N {upper}_JOINTS\n#define NB {upper}_PARAMETERS\n\
         int main(void) {{\n\
         double all[4 * N + NB]; const double *q = all, *qd = all + N, *qdd = all + 2 * N;\n\
         const double *slip = all + 3 * N, *X = all + 4 * N; (void)slip; (void)X;\n\
         if (sizeof {name}_columns / sizeof {name}_columns[0] != NB) return 2;\n\
         for (;;) {{ for (int k = 0; k < 4 * N + NB; k++) if (scanf(\"%lf\", all + k) != 1) return 0;\n\
         {calls} }} }}\n"
    )
}

/// The compiler of this machine, or none, which is said.
fn compiler() -> Option<&'static str> {
    let found = ["cc", "gcc", "clang"]
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok());
    if found.is_none() {
        eprintln!("skipped: no cc, gcc or clang to compile the emitted C with");
    }
    found
}

fn check_c(robot: &Robot) {
    let Some(compiler) = compiler() else { return };
    let folder = tempfile::tempdir().unwrap();
    for file in emit::c(robot) {
        std::fs::write(folder.path().join(file.name), file.text).unwrap();
    }
    std::fs::write(folder.path().join("main.c"), c_program(robot)).unwrap();
    std::fs::write(folder.path().join("one.c"), emit::c_in_one(robot)).unwrap();
    let strict = [
        "-std=c99",
        "-O1",
        "-Wall",
        "-Wextra",
        "-Wshadow",
        "-Werror",
        "-pedantic",
    ];
    let compile = |arguments: &[&str]| {
        let mut command = Command::new(compiler);
        command
            .current_dir(folder.path())
            .args(strict)
            .args(arguments);
        run(&mut command, "", folder.path());
    };
    compile(&["-c", "one.c", "-o", "one.o"]);
    let source = format!("{}.c", robot.mechanism.name);
    compile(&["main.c", &source, "-o", "main", "-lm"]);
    let states = states(robot);
    let printed = run(
        &mut Command::new(folder.path().join("main")),
        &text(&states),
        folder.path(),
    );
    compare(robot, &states, &printed);
}

/// A Python that has numpy, or none, which is said.
fn python() -> Option<String> {
    let name = std::env::var("IDIM_PYTHON").unwrap_or_else(|_| "python3".into());
    let numpy = Command::new(&name).args(["-c", "import numpy"]).output();
    match numpy {
        Ok(output) if output.status.success() => Some(name),
        Ok(_) => {
            eprintln!(
                "skipped: `{name}` has no numpy to run the emitted Python with (IDIM_PYTHON)"
            );
            None
        }
        Err(error) => {
            eprintln!("skipped: no `{name}` to run the emitted Python with: {error} (IDIM_PYTHON)");
            None
        }
    }
}

const PYTHON_PROGRAM: &str = "
import sys
import numpy as np
import MODULE as robot

n, nb = robot.JOINTS, robot.PARAMETERS
states = np.array(sys.stdin.read().split(), dtype=float).reshape(-1, 4 * n + nb)
q, qd, qdd, slip = np.moveaxis(states[:, : 4 * n].reshape(-1, 4, n), 1, 0)
X = states[:, 4 * n :]
extra = [slip] if HAS_SLIP else []
many = [robot.D(q, qd, qdd, *extra)]
many += [f(q, qd, *extra) for f in (robot.P, robot.R, robot.h, robot.dh)]
assert [x.shape for x in many] == [(len(q), n, nb)] * 3 + [(len(q), nb)] * 2
CALLS
one = robot.D(list(q[0]), qd[0], qdd[0], *[x[0] for x in extra])
assert one.shape == (n, nb) and np.allclose(one, many[0][0], rtol=1e-14, atol=1e-14)
assert len(robot.COLUMNS) == nb == len(robot.NOMINAL) and len(robot.JOINT_NAMES) == n
try:
    robot.P(q[:, 1:], qd)
except ValueError as error:
    assert f'({n},)' in str(error)
else:
    raise AssertionError('a wrong shape was accepted')
for sample in zip(*many):
    for output in sample:
        print(*(repr(float(x)) for x in output.ravel()))
";

fn check_python(robot: &Robot) {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = emit::python(robot);
    std::fs::write(folder.path().join(file.name), file.text).unwrap();
    let slip = if signature::has_slip(robot) {
        "True"
    } else {
        "False"
    };
    let calls: String = (signature::prototypes(robot)
        .iter()
        .skip(signature::ALL.len()))
    .map(|signature| {
        let slip = if signature.slip { ", *extra" } else { "" };
        let parameters = signature.parameters.then_some("X");
        let inputs: Vec<&str> = signature
            .signals
            .iter()
            .copied()
            .chain(parameters)
            .collect();
        format!(
            "many.append(robot.{}({}{slip}))\n",
            signature.name,
            inputs.join(", ")
        )
    })
    .collect();
    let program = PYTHON_PROGRAM
        .replace("CALLS", &calls)
        .replace("MODULE", &robot.mechanism.name)
        .replace("HAS_SLIP", slip);
    std::fs::write(folder.path().join("main.py"), program).unwrap();
    let states = states(robot);
    let mut command = Command::new(python);
    command
        .args(["-W", "error"])
        .arg(folder.path().join("main.py"));
    let printed = run(&mut command, &text(&states), folder.path());
    compare(robot, &states, &printed);
}

macro_rules! robots {
    ($($name:ident: $robot:expr;)*) => {$(
        mod $name {
            use super::*;

            #[test]
            fn c_compiles_without_warning_and_equals_the_interpreter() {
                check_c(&$robot);
            }

            #[test]
            fn python_equals_the_interpreter() {
                check_python(&$robot);
            }
        }
    )*};
}

robots! {
    scara: built_in("scara");
    ur10e: built_in("ur10e");
    panda: built_in("panda");
    thirty_joints_with_functions: humanoid().with(&FUNCTIONS);
    every_function_and_odd_names: odd().with(&FUNCTIONS);
    loop_and_follower_with_functions: closed().with(&FUNCTIONS);
}

#[test]
fn every_output_has_its_function() {
    let outputs: Vec<Output> = signature::ALL.iter().map(|s| s.output).collect();
    assert_eq!(outputs, Output::ALL);
}

#[test]
fn same_robot_gives_the_same_c_and_python() {
    let (first, second) = (built_in("panda"), built_in("panda"));
    assert_eq!(emit::c(&first), emit::c(&second));
    assert_eq!(emit::python(&first), emit::python(&second));
}

/// Thirty joints, derived side by side: no clock, address or hash order reaches the text.
#[test]
fn same_robot_gives_the_same_bytes_in_every_thread() {
    let texts = || {
        let robot = humanoid();
        let [header, source] = emit::c(&robot);
        let python = emit::python(&robot);
        (emit::rust(&robot).unwrap(), header, source, python)
    };
    let other = std::thread::spawn(texts);
    assert_eq!(texts(), other.join().unwrap());
}

#[test]
fn long_functions_come_in_parts_of_bounded_length() {
    let rust = emit::rust(&humanoid()).unwrap();
    let parts_of_rust = rust.matches("\nstruct explicit_").count();
    assert!(parts_of_rust > 2, "{parts_of_rust}");
    for part in rust.split("> for explicit_").skip(1) {
        let body = part.split("\n}").next().unwrap();
        assert!(operators(body) <= 1000, "{}", operators(body));
    }
    let python = emit::python(&humanoid()).text;
    let functions: Vec<&str> = python.split("\ndef ").skip(1).collect();
    let parts = functions.iter().filter(|text| text.starts_with("_D_"));
    assert_eq!(parts.count(), parts_of_rust);
    for function in functions {
        let most = if function.starts_with('_') {
            1000
        } else {
            1500
        };
        assert!(operators(function) <= most, "{}", operators(function));
    }
}

fn operators(text: &str) -> usize {
    let operators = [" * ", " + ", " - "].map(|o| text.matches(o).count());
    operators.iter().sum()
}

/// The description is read by Rust too: the words that break it are the same kind.
#[test]
fn rust_of_a_robot_with_odd_names_is_rust() {
    emit::rust(&odd().with(&FUNCTIONS)).unwrap_or_else(|error| panic!("{error}"));
}
