#!/usr/bin/env python3
"""The figure that `idim excite` is held against where none is published: BIRDy's search for exciting
motions (TUM-ICS/BIRDy, generateExcitationTrajectory.m), written anew for SciPy.

    excitation.py --idim target/release/idim robots/puma560.toml [--starts 8]

Fourier series at rest in the beginning; cost cond(W'W) + 100 / smallest singular value of W at 100
samples; position, velocity and acceleration within limits at these. BIRDy minimises with Matlab's fmincon
from random coefficients about a fixed pose; here SLSQP minimises the logarithm of the same cost, which
has the same minima, and the pose is free, as it is for `idim excite`. W is the regressor that `idim
generate` writes. Needs numpy and scipy.
"""
import argparse
import importlib.util
import pathlib
import subprocess
import tempfile
import time

import numpy as np
from scipy.linalg import null_space
from scipy.optimize import minimize

SAMPLES = 100
HARMONICS = 5
PERIOD = 10.0
# PUMA 560: ranges of P. Corke's Robotics Toolbox, 2 rad/s and 10 rad/s^2.
LIMITS = np.radians([160.0, 110.0, 135.0, 266.0, 100.0, 266.0]), np.full(6, 2.0), np.full(6, 10.0)


def regressor(program, robot):
    with tempfile.TemporaryDirectory() as folder:
        code = pathlib.Path(folder) / "model.py"
        subprocess.run([program, "generate", robot, "--language", "python", "-o", code], check=True)
        spec = importlib.util.spec_from_file_location("model", code)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return module.D


def basis(samples):
    """Position, velocity and acceleration of a joint by its free numbers: the pose, and what the three
    conditions of rest at the beginning leave of its coefficients."""
    w = 2.0 * np.pi / PERIOD * np.arange(1, HARMONICS + 1)
    times = np.linspace(0.0, PERIOD, samples)
    sin, cos = np.sin(np.outer(times, w)), np.cos(np.outer(times, w))
    none = np.zeros(HARMONICS)
    rest = null_space([[*none, *(1 / w)], [*np.ones(HARMONICS), *none], [*none, *w]])
    parts = np.hstack([sin / w, -cos / w]), np.hstack([cos, sin]), np.hstack([-w * sin, w * cos])
    pose = 1.0, 0.0, 0.0
    return [np.hstack([np.full((samples, 1), p), part @ rest]) for p, part in zip(pose, parts)]


def observation(D, series, x):
    joints = x.reshape(-1, series[0].shape[1]).T
    w = np.asarray(D(*(part @ joints for part in series)))
    return w.reshape(-1, w.shape[-1])


def searched(D, series, noise, steps):
    """One start: numbers at which the cost is least, and whether they keep to the limits."""
    n, width = len(LIMITS[0]), series[0].shape[1]

    def cost(x):
        s = np.linalg.svd(observation(D, series, x), compute_uv=False)
        return np.log((s[0] / s[-1]) ** 2 + 100.0 / s[-1])

    rows = np.vstack([np.kron(np.eye(n), part) / np.repeat(most, len(part))[:, None] for part, most in zip(series, LIMITS)])
    rows = np.vstack([rows, -rows])
    x = noise.uniform(-1.0, 1.0, n * width)
    x *= 0.9 / (rows @ x).max()
    within = {"type": "ineq", "fun": lambda x: 1.0 - rows @ x, "jac": lambda _: -rows}
    found = minimize(cost, x, method="SLSQP", constraints=[within], options={"maxiter": steps})
    return found.x / max(1.0, (rows @ found.x).max())


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--idim", default="target/release/idim")
    parser.add_argument("--starts", type=int, default=8)
    parser.add_argument("--steps", type=int, default=100)
    parser.add_argument("robot", type=pathlib.Path)
    arguments = parser.parse_args()
    D = regressor(arguments.idim, arguments.robot)
    noise, clock, best = np.random.default_rng(1), time.time(), np.inf
    coarse, fine = basis(SAMPLES), basis(10 * SAMPLES)
    for start in range(arguments.starts):
        x = searched(D, coarse, noise, arguments.steps)
        condition = np.linalg.cond(observation(D, fine, x))
        best = min(best, condition)
        print(f"start {start}: cond(W) {condition:.1f}; best {best:.1f} after {time.time() - clock:.0f} s", flush=True)


if __name__ == "__main__":
    main()
