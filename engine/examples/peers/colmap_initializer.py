#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Structure from motion by COLMAP as a method of gpo-inspector:

    ./run.sh run sequences/desk --method colmap --method-timeout 600 \
        --method-command colmap='python3 engine/examples/peers/colmap_initializer.py'

Runs COLMAP's features, matching and mapper on the window's images with the recording's fixed lens.
The answer has the cameras of the largest model. gpo-inspector fits the plane to the window's tracks
triangulated from these cameras. Needs only COLMAP (apt install colmap). Reads one window per line
from standard input and writes one answer per line: engine/external_methods/README.md.
"""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time

FEATURES = 1000  # per image
OVERLAP = 8  # number of next images that each image is matched with
MIN_ANGLE_DEG = 4  # of the initial pair; windows this short do not reach COLMAP's default of 16


class Failed(Exception):
    """The reason why a window cannot be initialized."""


def colmap(command, **options):
    words = ["colmap", command]
    for key, value in options.items():
        words += ["--" + key.replace("__", "."), str(value)]
    environment = dict(os.environ, QT_QPA_PLATFORM="offscreen")
    done = subprocess.run(words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        lines = [line for line in done.stdout.splitlines() if line.strip()]
        raise Failed(f"colmap {command}: {lines[-1] if lines else done.returncode}")


def lens(camera):
    """Returns COLMAP's model and parameters. COLMAP's top left pixel has its corner at (0, 0), ours its
    center."""
    fx, fy, cx, cy = camera["intrinsics"]
    k = list(camera["coefficients"])
    kind = camera["distortion"]
    if kind == "none":
        model, k = "PINHOLE", []
    elif kind == "equidistant":
        model = "OPENCV_FISHEYE"
    elif len(k) == 4:
        model = "OPENCV"
    else:
        model, k = "FULL_OPENCV", k + [0] * (8 - len(k))
    return model, ",".join(str(p) for p in [fx, fy, cx + 0.5, cy + 0.5] + k)


def poses(model):
    """Reads images.bin. Returns quaternion and translation, world to camera, by name."""
    with open(os.path.join(model, "images.bin"), "rb") as file:
        data = file.read()
    (count,), at, found = struct.unpack_from("<Q", data), 8, {}
    for _ in range(count):
        _, *numbers, _ = struct.unpack_from("<I7dI", data, at)
        end = data.index(b"\0", at + 64)
        found[data[at + 64 : end].decode()] = numbers
        (points,) = struct.unpack_from("<Q", data, end + 1)
        at = end + 9 + 24 * points
    return found


def camera_to_world(numbers):
    w, x, y, z, *t = numbers
    R_cw = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    R_wc = [list(column) for column in zip(*R_cw)]
    return {"R_wc": R_wc, "center": [-sum(a * b for a, b in zip(row, t)) for row in R_wc]}


def largest_model(folder):
    models = [os.path.join(folder, one) for one in os.listdir(folder)]
    if not models:
        raise Failed("colmap found no model")
    return max((poses(model) for model in models), key=len)


def initialize(window):
    if shutil.which("colmap") is None:
        raise Failed("colmap is not installed: apt install colmap")
    if "pictures" not in window:
        raise Failed("the recording has no image files: write them with ./run.sh convert")
    with tempfile.TemporaryDirectory() as work:
        images, models = os.path.join(work, "images"), os.path.join(work, "models")
        os.mkdir(images)
        os.mkdir(models)
        names = []
        for i, file in enumerate(window["pictures"]):
            names.append(f"{i:04}{os.path.splitext(file)[1]}")
            os.symlink(file, os.path.join(images, names[-1]))
        both = {"database_path": os.path.join(work, "database"), "image_path": images}
        model, parameters = lens(window["camera"])
        colmap(
            "feature_extractor", **both, ImageReader__single_camera=1, ImageReader__camera_model=model,
            ImageReader__camera_params=parameters, SiftExtraction__use_gpu=0,
            SiftExtraction__max_num_features=FEATURES,
        )
        colmap(
            "sequential_matcher", database_path=both["database_path"], SiftMatching__use_gpu=0,
            SequentialMatching__overlap=OVERLAP,
        )
        colmap(
            "mapper", **both, output_path=models, Mapper__ba_refine_focal_length=0,
            Mapper__ba_refine_extra_params=0, Mapper__init_min_tri_angle=MIN_ANGLE_DEG,
        )
        found = largest_model(models)
    if names[0] not in found:
        raise Failed(f"colmap's model has {len(found)} of {len(names)} images, but not the first one")
    return {"cameras": [camera_to_world(found[name]) if name in found else None for name in names]}


def main():
    for line in sys.stdin:
        window = json.loads(line)
        begin = time.perf_counter()
        try:
            answer = initialize(window)
        except Failed as why:
            answer = {"failed": str(why)}
        answer["id"] = window["id"]
        if "failed" not in answer:
            answer["milliseconds"] = 1e3 * (time.perf_counter() - begin)
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
