#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Frame at which live initialization in the background is ready, beside that of the synchronous one.

    PYTHONPATH=build/ci/python tests/benchmark/live.py [--busy N] [RECORDING...]

Adds the tracked frames of each recording with their own intervals, after which the background thread has
to keep up. --busy N starts N processes that compute all the time, as a compiler does.
"""
import argparse
import multiprocessing
import pathlib
import time

import gpo

SOURCE = pathlib.Path(__file__).resolve().parents[2]
MOST_FRAMES = 90
RECORDINGS = ["sequences/desk", "sequences/orbit.yaml", "../shared/data/euroc-room", "../shared/data/chessboard-floor",
              "../shared/data/tags-straight"]


def compute():
    while True:
        sum(range(100_000))


def frame_of_ready(recording, frames, background):
    """Returns the number of frames added when `ready` was first reported (None: never) and the time of each call [s]."""
    live = gpo.Initializer(recording.camera, recording.gyroscope, background=background)
    begin, first = time.monotonic(), frames[0][0]
    seconds = []
    for count, frame in enumerate(frames, start=1):
        if background:
            time.sleep(max(0, (frame[0] - first) / 1e9 - (time.monotonic() - begin)))
        before = time.monotonic()
        ready = live.add_frame(*frame).ready
        seconds.append(time.monotonic() - before)
        if ready:
            return count, seconds
    return None, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--busy", type=int, default=0, metavar="N", help="processes that compute meanwhile")
    parser.add_argument("recordings", nargs="*", default=RECORDINGS)
    arguments = parser.parse_args()
    busy = [multiprocessing.Process(target=compute, daemon=True) for _ in range(arguments.busy)]
    for process in busy:
        process.start()
    print("| recording | ready, synchronous [frame] | in the background [frame] | longest call in the background [ms] |\n"
          "| --- | ---: | ---: | ---: |")
    for path in arguments.recordings:
        path = SOURCE / path
        if not path.exists():
            continue
        recording = gpo.open(path)
        frames = gpo.run(recording, frames=min(MOST_FRAMES, len(recording))).frames
        synchronous, _ = frame_of_ready(recording, frames, background=False)
        background, seconds = frame_of_ready(recording, frames, background=True)
        print(f"| {path.name} | {synchronous} | {background} | {1e3 * max(seconds):.1f} |", flush=True)


if __name__ == "__main__":
    main()
