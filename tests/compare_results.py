#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that a refactoring changed no result: runs two builds of the program and compares them.

    tests/compare_results.py OLD NEW [--tolerance 1e-9] [--ignore KEY,KEY] [RECORDING...]

OLD and NEW are paths of `gpo-inspector`. Runs every method, both presets and some settings on each
recording (default: the bundled ones and those of ../shared/data, if it exists). Numbers of `run
--json` except times must agree up to a relative tolerance, everything else exactly except texts
for people. Snapshots of all views must have the same bytes. Prints one line for each difference
and exits with 1 if there are any.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent
METHODS = "gpo pnp dbscan ba pnp_ba pba fpba closed_form gpo_joint".split()
VARIANTS = [["--preset", "paper"], ["--rotations", "averaging"], ["--rotations", "five-point"],
            ["--frames", "12", "--start", "3"], ["--plane", "2"], ["--no-ransac", "--method", "gpo"],
            ["--gravity", "joint"], ["--solver", "ceres", "--error", "sampson", "--loss", "squared"]]
VIEWS = "image scene normals compare curves window".split()
IGNORED = {"timing_ms", "milliseconds"}


def recordings():
    bundled = [SOURCE / "sequences/desk", *sorted((SOURCE / "sequences/companions").glob("*.yaml")),
               SOURCE / "sequences/orbit.yaml"]
    shared = SOURCE.parent / "shared/data"
    real = [path for path in sorted(shared.glob("*")) if path.is_dir() and path.name not in ("bags", "cases")]
    return bundled + real + sorted((shared / "bags").glob("*.bag"))


def run(program, arguments):
    """Returns exit code, standard output and the last line of standard error."""
    environment = dict(os.environ, LIBGL_ALWAYS_SOFTWARE="1", GALLIUM_DRIVER="llvmpipe")
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, env=environment)
    return done.returncode, done.stdout, done.stderr.strip().split("\n")[-1]


def is_text(old, new):
    """Whether both are texts for people, which may be reworded."""
    return isinstance(old, str) and isinstance(new, str) and " " in old and " " in new


def differences(old, new, tolerance, where=""):
    """Yields the paths at which two JSON values differ."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(old.keys() | new.keys()):
            if key in IGNORED:
                continue
            if key not in old or key not in new:
                yield f"{where}.{key}: only in {'new' if key in new else 'old'}"
            else:
                yield from differences(old[key], new[key], tolerance, f"{where}.{key}")
    elif isinstance(old, list) and isinstance(new, list):
        if len(old) != len(new):
            yield f"{where}: {len(old)} and {len(new)} elements"
        for i, (a, b) in enumerate(zip(old, new)):
            yield from differences(a, b, tolerance, f"{where}[{i}]")
    elif isinstance(old, float) and isinstance(new, (int, float)):
        if not math.isclose(old, new, rel_tol=tolerance, abs_tol=tolerance * 1e-3):
            yield f"{where}: {old!r} and {new!r}"
    elif old != new and not is_text(old, new):
        yield f"{where}: {old!r} and {new!r}"


def compare_runs(options, recording, settings):
    arguments = ["run", recording, "--json", "-", *settings]
    old, new = (run(program, arguments) for program in (options.old, options.new))
    if old[0] != new[0] or bool(old[1]) != bool(new[1]):
        return [f"exit {old[0]} ({old[2]}) and {new[0]} ({new[2]})"]
    if not old[1]:
        return []
    return list(differences(json.loads(old[1]), json.loads(new[1]), options.tolerance))


def compare_snapshots(options, recording, view):
    with tempfile.TemporaryDirectory() as folder:
        images = []
        for name, program in (("old", options.old), ("new", options.new)):
            image = pathlib.Path(folder) / f"{name}.png"
            run(program, ["snapshot", recording, "--view", view, "--frame", 20, "--output", image])
            images.append(image.read_bytes() if image.exists() else None)
        return [] if images[0] == images[1] else [f"snapshot --view {view} differs"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("recordings", nargs="*", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=1e-9)
    parser.add_argument("--ignore", default="", help="keys of the JSON that may differ, with commas")
    options = parser.parse_args()
    IGNORED.update(options.ignore.split(","))
    found = 0

    def report(name, lines):
        nonlocal found
        found += bool(lines)
        for line in lines[:5]:
            print(f"{name}: {line}", flush=True)
        if len(lines) > 5:
            print(f"{name}: and {len(lines) - 5} more", flush=True)

    chosen = options.recordings or recordings()
    for recording in chosen:
        for settings in [["--method", method] for method in METHODS] + VARIANTS:
            report(f"{recording.name} {' '.join(settings)}", compare_runs(options, recording, settings))
    for view in VIEWS:
        report(chosen[0].name, compare_snapshots(options, chosen[0], view))
    print(f"{len(chosen)} recordings, {found} comparisons differ")
    sys.exit(found > 0)


main()
