#!/usr/bin/env python3
"""The regressor D of an arm per sample: idim beside Pinocchio and CasADi, in turn, minimum of rounds.

    pip install pin cmeel-eigen casadi numpy
    regressor.py [--idim target/release/idim] [--rounds 7] [ROBOT.toml ...]

Each robot (revolute joints in rows of Denavit-Hartenberg parameters; ur10e and panda by default) is
taken with its rigid-body columns alone. Pinocchio is `computeJointTorqueRegressor`, all 10 columns of
each link: its C++ templates compiled here for this very machine (nothing of the wheel's libraries is
called, so that flags and alignments are our own), and, for what a Python user pays, the wheel's
library called from Python, less the call of the regressor of an arm of one joint, which is timed, too.
Ratios are to the C++. CasADi is the C generated from Newton-Euler's equations in SX, common terms
shared, of all columns and of idim's base columns; idim is its generated C and its generated Rust, one
sample at a time, in lanes as wide as the machine's vectors, and as identification asks for it (signals
of a chunk, planar). Compilers of all these: `-O3 -march=native -DNDEBUG` and `-C target-cpu=native`.
Every one computes sines and cosines itself and writes its whole result, which stays in cache. Results
are compared before times are. Linux, gcc, cargo.
"""
import argparse
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import tomllib

import casadi as ca
import numpy as np
import pinocchio as pin

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SOURCES = HERE / "regressor"
SAMPLES = 264  # no power of two: planar columns would fall on each other in the cache
STANDARD = ["M", "MX", "MY", "MZ", "XX", "XY", "YY", "XZ", "YZ", "ZZ"]  # Pinocchio's order
PINOCCHIO = "pinocchio C++, all columns"
CALL = "pinocchio Python, 1 joint"
FLAGS = ["-O3", "-march=native", "-DNDEBUG"]
# Pinocchio's joint types and arguments are more than Boost's lists hold by default.
LISTS = [f"-DBOOST_{limit}" for limit in ("MPL_LIMIT_LIST_SIZE=30", "MPL_LIMIT_VECTOR_SIZE=30", "MPL_CFG_NO_PREPROCESSED_HEADERS", "FUSION_INVOKE_MAX_ARITY=12")]


def placements(description):
    """Rotation and translation of each joint's frame in its parent's, at q = 0."""
    names = {"pi": math.pi, **description.get("lengths", {})}
    for joint in description["joint"]:
        alpha, d, theta, r = (float(eval(str(joint.get(key, 0)), names)) for key in ("alpha", "d", "theta", "r"))
        ca_, sa, ct, st = (round(f(x), 15) for x in (alpha, theta) for f in (math.cos, math.sin))
        rotation = np.array([[ct, -st, 0], [ca_ * st, ca_ * ct, -sa], [sa * st, sa * ct, ca_]])
        yield rotation, np.array([d, -sa * r, ca_ * r])


def symbolic(arm):
    """Newton-Euler's regressor in the links' frames, n x 10 n (Atkeson, An, Hollerbach 1986)."""
    n = len(arm)
    q, qd, qdd = (ca.SX.sym(name, n) for name in ("q", "qd", "qdd"))
    constant = lambda array: ca.sparsify(ca.SX(ca.DM(array)))
    z, skew = constant([0, 0, 1]), ca.skew
    turned = lambda x: ca.vertcat(  # the matrix A of A [XX XY YY XZ YZ ZZ]' = I x
        ca.horzcat(x[0], x[1], 0, x[2], 0, 0), ca.horzcat(0, x[0], x[1], 0, x[2], 0), ca.horzcat(0, 0, 0, x[0], x[1], x[2]))
    w, wd, a = constant([0, 0, 0]), constant([0, 0, 0]), constant([0, 0, 9.81])
    rows = [[None] * n for _ in range(n)]
    path = []
    for i, (rotation, offset) in enumerate(arm):
        s, c = ca.sin(q[i]), ca.cos(q[i])
        R = constant(rotation) @ ca.sparsify(ca.vertcat(ca.horzcat(c, -s, 0), ca.horzcat(s, c, 0), ca.horzcat(0, 0, 1)))
        p = constant(offset)
        path.append((R, p))
        a = R.T @ (a + ca.cross(wd, p) + ca.cross(w, ca.cross(w, p)))
        w, wd = R.T @ w, R.T @ wd
        wd = wd + ca.cross(w, z * qd[i]) + z * qdd[i]
        w = w + z * qd[i]
        force = ca.horzcat(a, skew(wd) + skew(w) @ skew(w), ca.SX(3, 6))
        moment = ca.horzcat(ca.SX(3, 1), -skew(a), ca.sparsify(turned(wd) + skew(w) @ turned(w)))
        for j in range(i, -1, -1):
            rows[j][i] = moment[2, :]
            R, p = path[j]
            force = R @ force
            moment = R @ moment + skew(p) @ force
    blank = ca.SX(1, 10)
    return (q, qd, qdd), ca.sparsify(ca.vertcat(*(ca.horzcat(*(block if block is not None else blank for block in row)) for row in rows)))


def run(*command, cwd=None, **variables):
    done = subprocess.run([str(word) for word in command], cwd=cwd, env={**os.environ, **variables}, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stderr[-3000:]}")
    return done.stdout


def rigid(robot, folder, idim):
    """The robot without effects, and what idim generates for it; its name and its base columns."""
    text = robot.read_text().split("[[effect]]")[0]
    text = re.sub(r"^effects = .*$", "effects = []", text, flags=re.M)
    toml = folder / "robot.toml"
    toml.write_text(re.sub(r'^name = .*$', 'name = "robot"', text, count=1, flags=re.M))
    for language in ("c", "rust"):
        run(idim, "generate", toml, "--language", language, "--output", f"{folder}/")
    names = re.findall(r"ROBOT_X_([A-Z]+?)R?(\d+) = ", (folder / "robot.h").read_text())
    return tomllib.loads(text), [10 * (int(link) - 1) + STANDARD.index(kind) for kind, link in names]


def crate(folder, target):
    """The generated Rust with those modules of the runtime that it needs."""
    runtime = "".join(f'#[path = "{ROOT}/runtime/src/{name}.rs"] pub mod {name};\n' for name in ("batch", "knowledge", "model", "settings")) + "pub use idim_lanes as lane;\n"
    for path, text in {
        "Cargo.toml": '[package]\nname = "idim-regressor"\nedition = "2024"\n[dependencies]\nidim_runtime.path = "runtime"\n[workspace]\nmembers = ["runtime"]\n',
        "runtime/Cargo.toml": '[package]\nname = "idim_runtime"\nedition = "2024"\n[dependencies]\nidim-lanes.path = "' + str(ROOT) + '/lanes"\nserde = { version = "1", features = ["derive"] }\n',
        "runtime/src/lib.rs": runtime,
        "src/main.rs": (SOURCES / "idim.rs").read_text(),
        "src/robot.rs": (folder / "robot.rs").read_text(),
    }.items():
        file = folder / "rust" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    run("cargo", "build", "--release", cwd=folder / "rust", CARGO_TARGET_DIR=str(target), RUSTFLAGS="-C target-cpu=native")
    return (target / "release" / "idim-regressor").rename(folder / "rust.exe")


def compiled_pinocchio(arm, folder):
    """Compiles its templates with our harness; about a minute."""
    prefix = next(parent for parent in pathlib.Path(pin.__file__).parents if (parent / "include/pinocchio").is_dir())
    rows = ("{" + ",".join(repr(float(x)) for x in (*rotation.ravel(), *offset)) + "}" for rotation, offset in arm)
    (folder / "arm.h").write_text("#define ARM " + ", ".join(rows) + "\n")
    includes = [f"-I{path}" for path in (folder, SOURCES, prefix / "include", prefix / "include/eigen3")]
    run("g++", *FLAGS, *LISTS, *includes, f"-DJOINTS={len(arm)}", SOURCES / "pinocchio.cpp", "-o", folder / "pinocchio.exe")
    return folder / "pinocchio.exe"


def called_pinocchio(arm):
    """Times the call from Python."""
    model, parent = pin.Model(), 0
    for rotation, offset in arm:
        parent = model.addJoint(parent, pin.JointModelRZ(), pin.SE3(rotation, offset), f"joint{parent}")
    data, call = model.createData(), pin.computeJointTorqueRegressor

    def timed(states, results):
        samples = np.ascontiguousarray(np.fromfile(states).reshape(SAMPLES, 3, -1)[:, :, :model.nq])
        np.array([call(model, data, *sample) for sample in samples]).tofile(results)
        best, triples = math.inf, [tuple(sample) for sample in samples]
        for _ in range(20):
            begin = time.perf_counter()
            for q, qd, qdd in triples:
                call(model, data, q, qd, qdd)
            best = min(best, time.perf_counter() - begin)
        return 1e9 * best / SAMPLES
    return timed


def contenders(arm, columns, folder, target):
    """Name -> (command, how its results become rows x base columns)."""
    n = len(arm)
    includes = [f"-I{folder}", f"-I{SOURCES}", f"-DJOINTS={n}", f"-DCOLUMNS={len(columns)}"]
    run("gcc", *FLAGS, *includes, SOURCES / "idim.c", folder / "robot.c", "-lm", "-o", folder / "c.exe")
    rust = crate(folder, target)
    dense = lambda values: values.reshape(SAMPLES, n, -1)
    yield PINOCCHIO, ([compiled_pinocchio(arm, folder)], lambda values: values.reshape(SAMPLES, 10 * n, n).transpose(0, 2, 1)[:, :, columns])
    yield "pinocchio Python, all columns", (called_pinocchio(arm), lambda values: values.reshape(SAMPLES, n, 10 * n)[:, :, columns])
    yield CALL, (called_pinocchio(arm[:1]), None)
    variables, all_columns = symbolic(arm)
    for name, matrix, chosen in (("all", all_columns, columns), ("base", all_columns[:, columns], slice(None))):
        matrix = ca.cse(ca.sparsify(matrix))
        function = ca.Function("regressor", variables, [matrix])
        here = os.getcwd()
        os.chdir(folder)
        function.generate(f"regressor_{name}.c")
        os.chdir(here)
        run("gcc", *FLAGS, *includes, f"-DENTRIES={matrix.nnz()}", SOURCES / "casadi.c", folder / f"regressor_{name}.c", "-lm", "-o", folder / f"casadi_{name}.exe")

        def full(values, places=np.array(matrix.sparsity().get_triplet()), width=matrix.shape[1], chosen=chosen):
            result = np.zeros((SAMPLES, n, width))
            result[:, places[0], places[1]] = values.reshape(SAMPLES, -1)
            return result[:, :, chosen]
        yield f"CasADi C, {name} columns", ([folder / f"casadi_{name}.exe"], full)
    yield "idim C, one sample", ([folder / "c.exe"], dense)
    yield "idim Rust, one sample", ([rust, "one"], dense)
    yield "idim Rust, widest lanes", ([rust, "lanes"], dense)
    yield "idim Rust, chunk of signals", ([rust, "batch"], dense)


def race(robot, arguments):
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        description, columns = rigid(robot, folder, arguments.idim)
        all_ = dict(contenders(list(placements(description)), columns, folder, arguments.target))
        states, results = folder / "states", folder / "results"
        np.random.default_rng(1).uniform(-2, 2, (SAMPLES, 3 * len(description["joint"]))).tofile(states)
        best, reference = dict.fromkeys(all_, math.inf), None
        for _ in range(arguments.rounds):
            for name, (command, values) in all_.items():
                ns = command(states, results) if callable(command) else float(run(command[0], states, results, *command[1:]))
                best[name] = min(best[name], ns)
                if values is None:
                    continue
                result = values(np.fromfile(results))
                reference = result if reference is None else reference
                error = abs(result - reference).max() / abs(reference).max()
                if not error < 1e-13:
                    sys.exit(f"{name}: differs from Pinocchio by {error:.1e} of the largest entry")
        table(robot.stem, len(columns), best)


def table(robot, columns, best):
    pinocchio, casadi = best[PINOCCHIO], best["CasADi C, base columns"]
    load = ", ".join(f"{x:.1f}" for x in os.getloadavg())
    print(f"{robot}, {columns} base columns (load {load} of {os.cpu_count()} cores)")
    print(f"  {'':30}{'ns':>9}{'vs pinocchio':>15}{'vs CasADi base':>16}")
    for name, ns in best.items():
        print(f"  {name:30}{ns:9.1f}{pinocchio / ns:14.1f}x{casadi / ns:15.2f}x")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", type=pathlib.Path, default=[ROOT / f"robots/{name}.toml" for name in ("ur10e", "panda")])
    parser.add_argument("--idim", default="target/release/idim")
    parser.add_argument("--target", type=pathlib.Path, default=ROOT / "target/side_by_side", help="where cargo builds")
    parser.add_argument("--rounds", type=int, default=7)
    arguments = parser.parse_args()
    arguments.target = arguments.target.resolve()
    for robot in arguments.robots:
        race(robot, arguments)


if __name__ == "__main__":
    main()
