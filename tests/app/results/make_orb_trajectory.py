#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes CameraTrajectory.txt in the format of a monocular run of ORB-SLAM3's SaveTrajectoryEuRoC:

    python3 tests/app/results/make_orb_trajectory.py sequences/desk > tests/app/results/CameraTrajectory.txt

Each line has the time in nanoseconds with six decimals, the position and the quaternion x y z w of the camera in
the frame of the first keyframe, in an arbitrary scale. The poses are the true ones of the first 30 frames, moved
by a random walk of the size of tracking errors; two frames are lost.
"""
import csv
import sys

import numpy as np

FRAMES, LOST, SCALE = 30, (11, 12), 3.7
T_BS = np.array([[0, -1, 0, 0.021], [-1, 0, 0, 0.058], [0, 0, -1, -0.004], [0, 0, 0, 1]])


def matrix(p, q):
    w, x, y, z = q
    T = np.eye(4)
    T[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    T[:3, 3] = p
    return T


def quaternion(R):
    w = np.sqrt(max(0, 1 + np.trace(R))) / 2
    return np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], 4 * w * w]) / (4 * w)


def main():
    random = np.random.default_rng(1)
    with open(sys.argv[1] + "/mav0/state_groundtruth_estimate0/data.csv") as file:
        rows = [row for row in csv.reader(file) if not row[0].startswith("#")][:FRAMES]
    cameras = [matrix([float(v) for v in r[1:4]], [float(v) for v in r[4:8]]) @ T_BS for r in rows]
    walk = np.cumsum(random.normal(0, 1, (FRAMES, 6)) * ([2e-5] * 3 + [2e-5] * 3), axis=0)
    for i, (row, camera) in enumerate(zip(rows, cameras)):
        if i in LOST:
            continue
        T = np.linalg.inv(cameras[0]) @ camera
        turn = matrix([0, 0, 0], np.r_[1, walk[i, 3:] / 2] / np.linalg.norm(np.r_[1, walk[i, 3:] / 2]))
        R, p = T[:3, :3] @ turn[:3, :3], SCALE * (T[:3, 3] + walk[i, :3])
        numbers = " ".join(f"{v:.9f}" for v in [*p, *quaternion(R)])
        print(f"{float(row[0]):.6f} {numbers}")


if __name__ == "__main__":
    main()
