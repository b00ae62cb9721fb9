#!/usr/bin/env python3
"""Exported URDFs in other programs: inverse dynamics of pinocchio and MuJoCo beside idim's own.

    urdf.py --idim target/release/idim ROBOT.toml...

Each robot is taken without friction and rotors, which URDF readers treat each in their own way, is
given parameters that no bodies have exactly, exported, and loaded by both; torques of random states
must agree with the regressor that `idim generate` writes, to 1e-9 of the largest. Needs numpy,
pinocchio (pip: pin) and mujoco.
"""
import argparse
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile

import mujoco
import numpy as np
import pinocchio

STATES = 200
WORST = 1e-9


def idim(program, *words):
    run = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
    if run.returncode:
        sys.exit(f"idim {' '.join(map(str, words))}: {run.stderr}")
    return run.stdout


def bare(text):
    """The description without effects, drives and settings."""
    kept, keeping = [], True
    for line in text.splitlines():
        if line.startswith("["):
            keeping = line.startswith(("[[joint]]", "[lengths]"))
        if keeping and not line.startswith("effects"):
            kept.append(line)
    return "\n".join(["effects = []", *kept]) + "\n"


def exported(program, robot, folder):
    """URDF, base parameters in it, and the module of the regressor."""
    description = folder / robot.name
    description.write_text(bare(robot.read_text()))
    model = json.loads(idim(program, "describe", description, "--json", "-"))
    noise = np.random.default_rng(1)
    sizes = {"kg m^2": 0.3, "kg m": 0.5, "kg": 3.0}
    values = [f"{p['name']} = {sizes[p['unit']] * noise.uniform(-0.3, 1.0)!r}" for p in model["base_parameters"]]
    parameters = folder / "parameters.toml"
    parameters.write_text("[parameters]\n" + "\n".join(values) + "\n")
    urdf, report, code = folder / "robot.urdf", folder / "report.json", folder / "model.py"
    idim(program, "export", description, "--parameters", parameters, "-o", urdf, "--json", report, "--quiet")
    idim(program, "generate", description, "--language", "python", "-o", code)
    spec = importlib.util.spec_from_file_location("model", code)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    names = [joint["name"] for joint in model["joints"]]
    x = np.array([p["exported"] for p in json.loads(report.read_text())["parameters"]])
    return urdf, x, module, names


def by_pinocchio(urdf, names, states):
    model = pinocchio.buildModelFromUrdf(str(urdf))
    data = model.createData()
    joints = [model.joints[model.getJointId(name)] for name in names]
    torques = []
    for q, qd, qdd in states:
        full, v, a = pinocchio.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        for joint, *values in zip(joints, q, qd, qdd):
            # Joints without limits are points of a circle.
            full[joint.idx_q : joint.idx_q + joint.nq] = values[0] if joint.nq == 1 else (np.cos(values[0]), np.sin(values[0]))
            v[joint.idx_v], a[joint.idx_v] = values[1:]
        tau = pinocchio.rnea(model, data, full, v, a)
        torques.append([tau[joint.idx_v] for joint in joints])
    return np.array(torques)


def by_mujoco(urdf, names, states):
    model = mujoco.MjModel.from_xml_path(str(urdf))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    data = mujoco.MjData(model)
    joints = [model.joint(name) for name in names]
    places = [(joint.qposadr[0], joint.dofadr[0]) for joint in joints]
    torques = []
    for q, qd, qdd in states:
        for (at, dof), *values in zip(places, q, qd, qdd):
            data.qpos[at], data.qvel[dof], data.qacc[dof] = values
        mujoco.mj_inverse(model, data)
        torques.append([data.qfrc_inverse[dof] for _, dof in places])
    return np.array(torques)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--idim", default="target/release/idim")
    parser.add_argument("robots", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    worst = 0.0
    for robot in arguments.robots:
        with tempfile.TemporaryDirectory() as folder:
            urdf, x, module, names = exported(arguments.idim, robot, pathlib.Path(folder))
            noise = np.random.default_rng(2)
            states = noise.uniform(-2.0, 2.0, (STATES, 3, len(names)))
            own = np.array([np.asarray(module.D(*state)) @ x for state in states])
            own = own.reshape(STATES, len(names))
            for other in (by_pinocchio, by_mujoco):
                error = np.abs(other(urdf, names, states) - own).max() / np.abs(own).max()
                worst = max(worst, error)
                print(f"{robot.stem:10} {other.__name__[3:]:10} {error:.1e} of the largest torque")
    if not worst < WORST:
        sys.exit(f"they differ by {worst:.1e}, more than {WORST}")


if __name__ == "__main__":
    main()
