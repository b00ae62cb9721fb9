#!/usr/bin/env python3
"""Identification from a CSV log: idim beside a Python pipeline, one after the other, minimum of rounds.

    run.py --pipeline PIPELINE.py --log LOG.csv [--idim target/release/idim] [--rounds 5] [--loop]

PIPELINE.py is the reference (`ident --log LOG --style tuned|loop` prints one JSON line with its stage times);
LOG.csv comes from its `gen`. Both identify the explicit model with the same filters, from the file to
parameters with standard deviations; results are compared before times are. Linux; needs what the
reference needs.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
import time


def timed(command):
    """Seconds of the whole process, peak resident MiB, standard output."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    out = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"{' '.join(command)} failed")
    return time.perf_counter() - start, usage.ru_maxrss / 1024, out


def idim(arguments, models):
    robot = os.path.join(os.path.dirname(os.path.abspath(__file__)), "ur10.toml")
    with tempfile.NamedTemporaryFile(suffix=".json") as result:
        command = [arguments.idim, "identify", robot, arguments.log, "--models", models, "--quiet", "--json", result.name]
        seconds, memory, _ = timed(command)
        return seconds, memory, json.load(open(result.name))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--pipeline", required=True)
    parser.add_argument("--log", required=True)
    parser.add_argument("--idim", default="target/release/idim")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--loop", action="store_true", help="the loop style, too (slow)")
    arguments = parser.parse_args()
    styles = ["tuned", "loop"] if arguments.loop else ["tuned"]
    best = {}

    def keep(name, seconds, memory, **more):
        old = best.get(name)
        if old is None or seconds < old["seconds"]:
            best[name] = dict(seconds=round(seconds, 3), memory_mib=round(memory, 1), **more)

    for round_ in range(arguments.rounds):
        for models in ("explicit", "explicit,implicit,power"):
            seconds, memory, result = idim(arguments, models)
            keep(f"idim {models}", seconds, memory, condition=result["models"][0]["condition"], rel_pct=result["models"][0]["fit"]["total_pct"])
        for style in styles if round_ == 0 or arguments.rounds <= 3 else styles[:1]:
            command = [sys.executable, arguments.pipeline, "ident", "--log", arguments.log, "--style", style]
            seconds, memory, out = timed(command)
            result = json.loads(out)
            stages = result["stages"]
            keep(f"python {style}", seconds, memory, computing=round(result["total"] - stages["read"], 3), condition=result["cond"],
                 residual_pct=100 * result["rel_residual"])
    for name, row in best.items():
        print(json.dumps({"what": name, **row}))
    own = best["idim explicit"]["seconds"]
    for style in styles:
        print(f"python {style} / idim explicit: {best['python ' + style]['seconds'] / own:.1f}x")


if __name__ == "__main__":
    main()
