#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the planes of a recording's first twenty frames in the image and in 3-D:

    PYTHONPATH=build/package/python python3 engine/examples/planes_of_a_room.py RECORDING [FIGURE.png]

Cells start with # %% for editors that run them one by one. Needs python3-matplotlib.
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import gpo

# %% A window of twenty frames
recording = gpo.open(sys.argv[1] if len(sys.argv) > 1 else "sequences/desk")
result = gpo.run(recording, frames=20)
print(f"{recording.name}: {result.verdict or result.reason}")
if not result.ok:
    sys.exit(1)
timestamp_ns, ids, pixels = result.frames[0]
camera = recording.camera

# %% The image with its tracks; gray ones are on no plane
figure = plt.figure(figsize=(13, 5))
image = figure.add_subplot(1, 2, 1)
image.imshow(recording.frame(0)[:, :, ::-1])
image.scatter(*pixels.T, c="lightgray", s=8)
image.set_xlabel("x [px]")
image.set_ylabel("y [px]")
image.set_title(f"{result.readiness}: {result.verdict}", fontsize=8, wrap=True)

# %% Tracks on their planes, and the cameras; y points down in the image, z up in the figure
space = figure.add_subplot(1, 2, 2, projection="3d")


def drawn(xyz):
    x, y, z = np.asarray(xyz).T
    return x, z, -y


space.plot(*drawn(result.p_wc), color="black", label="cameras")
for plane in result.planes:
    normal, distance = plane["normal"], plane["distance"]
    color = plt.get_cmap("tab10")(plane["number"])
    seen = pixels[np.isin(ids, plane["tracks"])]
    image.scatter(*seen.T, color=color, s=12)
    # A ray r meets the plane n . x + d = 0 at -d / (n . r) r.
    homogeneous = np.column_stack([camera.undistort(seen), np.ones(len(seen))])
    rays = homogeneous @ np.linalg.inv(camera.K).T
    points = rays * (-distance / (rays @ normal))[:, None]
    label = f"plane {plane['number']}: {len(seen)} tracks, {distance:.2f} d away"
    if plane["normal_covariance_rad2"] is not None:
        sigma_deg = np.degrees(np.sqrt(np.trace(plane["normal_covariance_rad2"])))
        label += f", normal uncertainty {sigma_deg:.2f} deg"
    space.scatter(*drawn(points), color=color, s=6, label=label)
    middle = np.median(points, axis=0)
    space.plot(*drawn([middle, middle + 0.5 * normal]), color=color)
space.set_xlabel("x [d]")
space.set_ylabel("z [d]")
space.set_zlabel("-y [d]")
space.set_aspect("equal")
space.view_init(elev=20, azim=-70)
space.legend(loc="upper left", fontsize=8)

# %%
target = sys.argv[2] if len(sys.argv) > 2 else "planes.png"
figure.tight_layout()
figure.savefig(target, dpi=100)
print(f"wrote {target}")
