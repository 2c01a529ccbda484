#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints how the verdicts on windows of real recordings change if a threshold moves by 30 %.

usage: thresholds.py PROGRAM FOLDER   (FOLDER: the recordings of WINDOWS)
"""
import json
import subprocess
import sys
from collections import Counter

# Recording: first start, last start, step, frames.
WINDOWS = {"euroc-room": (0, 40, 5, 20), "chessboard-dark": (0, 280, 20, 20),
           "chessboard-floor": (0, 220, 20, 20), "tags-mountain": (0, 560, 20, 20),
           "tags-straight": (0, 280, 20, 20), "painting": (0, 40, 10, 20),
           "postcard": (0, 140, 20, 20), "cards-tracks": (1, 301, 50, 15),
           "phone-street": (0, 80, 20, 20)}
TUNING = {"euroc-room", "chessboard-floor"}
# engine/diagnosis/limits.h and normal_checks.cpp
VERDICT = {"kDegenerateRotationToNoise": 1.26, "kDegenerateSigma_deg": 10.0,
           "kDegenerateTranslation": 0.015, "kReadyTranslation": 0.06, "kWeakSigma_deg": 0.5}


def result(program, folder, window, *more):
    name, start, frames = window
    command = [program, "run", f"{folder}/{name}", "--start", str(start), "--frames", str(frames),
               "--json", "-", *more]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return json.loads(done.stdout)


def judged(verdict, k):
    """Repeats `judged` of normal_checks.cpp; other reasons for a failure stay."""
    numbers = [verdict.get(x) for x in ("rotation_rms_px", "noise_px", "normal_sigma_deg",
                                        "largest_translation")]
    if None in numbers:
        return verdict["readiness"]
    rotation_px, noise_px, sigma_deg, translation = numbers
    if (rotation_px < k["kDegenerateRotationToNoise"] * noise_px or
            sigma_deg > k["kDegenerateSigma_deg"] or translation < k["kDegenerateTranslation"]):
        return "degenerate"
    ready = translation >= k["kReadyTranslation"] and sigma_deg <= k["kWeakSigma_deg"]
    return "ready" if ready else "weak"


def readiness(found):
    """A window that fails for a reason of its own is no result, whatever its verdict."""
    verdict = found.get("verdict") or {"readiness": "degenerate"}
    failed = found["status"] != "ok" and verdict["readiness"] not in ("degenerate", "no plane")
    return "failed" if failed else verdict["readiness"]


def changes(windows, before, after):
    counted = Counter((windows[i][0] in TUNING, before[i], after[i])
                      for i in range(len(windows)) if before[i] != after[i])
    return ", ".join(f"{n} {a} to {b} ({'tuning' if tuning else 'test'})"
                     for (tuning, a, b), n in sorted(counted.items())) or "none"


def main():
    program, folder = sys.argv[1:]
    windows = [(name, start, frames) for name, (first, last, step, frames) in WINDOWS.items()
               for start in range(first, last + 1, step)]
    found = [result(program, folder, w) for w in windows]
    before = [readiness(f) for f in found]
    print(len(windows), "windows:", dict(Counter(before)))
    for name, value in VERDICT.items():
        for factor in (0.7, 1.3):
            moved = {**VERDICT, name: factor * value}
            after = [b if b == "failed" else judged(f["verdict"], moved) if f.get("verdict") else b
                     for b, f in zip(before, found)]
            print(f"{name} {factor * value:g}: {changes(windows, before, after)}")
    for factor in (0.7, 1.3):
        value = f"{factor * 2:g}"
        after = [readiness(result(program, folder, w, "--ransac-threshold-px", value))
                 for w in windows]
        print(f"--ransac-threshold-px {value}: {changes(windows, before, after)}")


main()
