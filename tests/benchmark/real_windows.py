#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Coverage of real windows: how often the error of the normal exceeds the claimed uncertainty.

    tests/benchmark/real_windows.py [--program PATH] [--data FOLDER] [OPTION_OF_RUN...]

Initializes windows of 20 frames from every start below and divides the error of the normal by its
standard deviation, with that of the truth added. Recordings that FOLDER lacks are left out.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[2]
# Recording: (end of the starts, their step, uncertainty of the true normal [deg] if no file has it).
RECORDINGS = {"euroc-room": (41, 5, 0.7), "chessboard-floor": (230, 20, 0), "chessboard-dark": (280, 20, 0),
              "tags-straight": (280, 20, 0.2), "tags-mountain": (560, 20, 0.2)}


def result(program, recording, start, options):
    command = [program, "run", recording, "--start", str(start), "--frames", "20", "--json", "-", *options]
    out = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    return json.loads(out) if out else {"status": "failed"}


def error_and_ratio(found, truth_deg):
    """Returns the error of the normal [deg] and the same in standard deviations; None if unsolved."""
    if found["status"] != "ok" or found["metrics"]["pne_deg"] is None:
        return None
    claimed = found["uncertainty"]
    sigma = claimed["typical_lens_sigma_deg"] or claimed["normal_sigma_deg"]
    error = found["metrics"]["pne_deg"]
    return error, error / math.hypot(sigma, truth_deg or found["truth"].get("normal_sigma_deg", 0))


def line(name, windows, solved):
    ratios = [ratio for _, ratio in solved]
    middle = [statistics.median(column) for column in zip(*solved)] if solved else [math.nan] * 2
    print(f"| {name} | {windows} | {len(solved)} | {middle[0]:.3f} | {middle[1]:.2f} | "
          f"{sum(r > 3 for r in ratios)} | {sum(r > 4 for r in ratios)} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default=str(SOURCE / "build/release/app/gpo-inspector"))
    parser.add_argument("--data", type=pathlib.Path, default=SOURCE.parent / "shared/data")
    arguments, options = parser.parse_known_args()
    print("| recording | windows | solved | median error [deg] | median ratio | > 3 sigma | > 4 sigma |\n"
          "| --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    windows, solved = 0, []
    for name, (end, step, truth_deg) in RECORDINGS.items():
        if not (arguments.data / name).exists():
            continue
        starts = range(0, end, step)
        found = [result(arguments.program, str(arguments.data / name), start, options) for start in starts]
        ratios = [one for one in (error_and_ratio(each, truth_deg) for each in found) if one]
        line(name, len(starts), ratios)
        windows += len(starts)
        solved += ratios
    line("all", windows, solved)


if __name__ == "__main__":
    main()
