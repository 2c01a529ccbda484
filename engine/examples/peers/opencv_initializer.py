#!/usr/bin/env python3
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two-view initialization by OpenCV as a method of gpo-inspector:

    ./run.sh run sequences/desk --method opencv \
        --method-command opencv='python3 engine/examples/peers/opencv_initializer.py'

Fits a homography and an essential matrix to the reference frame and another one, chooses the better
model by the rule of ORB-SLAM (Mur-Artal et al. 2015, section IV) and decomposes it. The decomposition
with most points in front of both cameras wins if it is clearly better. PnP with the triangulated
points gives the other cameras. gpo-inspector fits the plane to the points. Needs python3-opencv and
python3-numpy. Reads one window per line from standard input and writes one answer per line:
engine/external_methods/README.md.
"""
import json
import sys
import time

import cv2
import numpy as np

SIGMA_PX = 1.0
CHI2_1, CHI2_2 = 3.841, 5.991  # 95 %, one and two degrees of freedom
HOMOGRAPHY_SHARE = 0.40  # of the sum of scores, above which the homography is chosen
MIN_POINTS = 20
MIN_PARALLAX_DEG = 1.0
CLEARLY_FEWER = 0.75  # share of the best points, above which another decomposition is a rival
MIN_SHARE = 0.7  # of the inliers that must become points


class Failed(Exception):
    """The reason why a window, or a pair of its frames, cannot be initialized."""


def homogeneous(points):
    return np.hstack([points, np.ones((len(points), 1))])


def capped(chi2, limit):
    """Returns the score of each match and whether it is an inlier."""
    inlier = chi2 < limit
    return np.where(inlier, CHI2_2 - chi2, 0.0), inlier


def score_homography(H, a, b):
    score, inlier = 0.0, np.ones(len(a), bool)
    for M, p, q in ((H, a, b), (np.linalg.inv(H), b, a)):
        x = homogeneous(p) @ M.T
        chi2 = ((x[:, :2] / x[:, 2:] - q) ** 2).sum(1) / SIGMA_PX**2
        added, good = capped(chi2, CHI2_2)
        score, inlier = score + added.sum(), inlier & good
    return score, inlier


def score_fundamental(F, a, b):
    score, inlier = 0.0, np.ones(len(a), bool)
    for M, p, q in ((F, a, b), (F.T, b, a)):
        line = homogeneous(p) @ M.T
        distance = (line * homogeneous(q)).sum(1) / np.linalg.norm(line[:, :2], axis=1)
        added, good = capped(distance**2 / SIGMA_PX**2, CHI2_1)
        score, inlier = score + added.sum(), inlier & good
    return score, inlier


def triangulate(K, R, t, a, b):
    """Returns points (n, 3) in the first camera, their validity and median parallax [deg]."""
    first = K @ np.eye(3, 4)
    second = K @ np.hstack([R, t.reshape(3, 1)])
    X = cv2.triangulatePoints(first, second, a.T, b.T).T
    with np.errstate(divide="ignore", invalid="ignore"):
        X = X[:, :3] / X[:, 3:]
    in_second = X @ R.T + t
    good = np.isfinite(X).all(1) & (X[:, 2] > 0) & (in_second[:, 2] > 0)
    for P, seen in ((first, a), (second, b)):
        x = homogeneous(np.where(good[:, None], X, 1.0)) @ P.T
        error2 = ((x[:, :2] / x[:, 2:] - seen) ** 2).sum(1)
        good &= error2 < 4 * SIGMA_PX**2
    if not good.any():
        return X, good, 0.0
    to_first, to_second = X[good], X[good] + R.T @ t
    cosine = (to_first * to_second).sum(1) / (
        np.linalg.norm(to_first, axis=1) * np.linalg.norm(to_second, axis=1))
    return X, good, float(np.degrees(np.arccos(np.clip(np.median(cosine), -1, 1))))


def decompose(K, a, b):
    """Returns the decompositions (R, t) of the better model, its inliers and its name."""
    H, _ = cv2.findHomography(a, b, cv2.RANSAC, 3 * SIGMA_PX)
    E, mask = cv2.findEssentialMat(a, b, K, cv2.RANSAC, 0.999, SIGMA_PX)
    if H is None or E is None or E.shape != (3, 3):
        raise Failed("no homography or no essential matrix")
    K_inverse = np.linalg.inv(K)
    score_h, inliers_h = score_homography(H, a, b)
    score_f, inliers_f = score_fundamental(K_inverse.T @ E @ K_inverse, a, b)
    if score_h + score_f > 0 and score_h / (score_h + score_f) > HOMOGRAPHY_SHARE:
        _, rotations, translations, _ = cv2.decomposeHomographyMat(H, K)
        return [(R, t.ravel()) for R, t in zip(rotations, translations)], inliers_h, "homography"
    _, R, t, _ = cv2.recoverPose(E, a, b, K, mask=mask.copy())
    return [(R, t.ravel())], inliers_f, "essential matrix"


def initialize_pair(K, a, b):
    """Returns motions (R, t) and points (n, 3; NaN if unknown) of two frames, and the model."""
    decompositions, inliers, model = decompose(K, a, b)
    if inliers.sum() < MIN_POINTS:
        raise Failed(f"{inliers.sum()} inliers of the {model}, needs at least {MIN_POINTS}")
    tried = []
    for R, t in decompositions:
        X, good, parallax = triangulate(K, R, t, a, b)
        good &= inliers
        tried.append((int(good.sum()), parallax, R, t, np.where(good[:, None], X, np.nan)))
    tried.sort(key=lambda one: -one[0])
    count, parallax, R, t, X = tried[0]
    if count < max(MIN_POINTS, MIN_SHARE * inliers.sum()):
        raise Failed(f"{count} of {inliers.sum()} inliers of the {model} become points")
    if parallax < MIN_PARALLAX_DEG:
        raise Failed(f"median parallax {parallax:.1f} deg, needs at least {MIN_PARALLAX_DEG}")
    rivals = [one for one in tried[1:] if one[0] > CLEARLY_FEWER * count]
    return [(R, t, X)] + [one[2:] for one in rivals], model


def resect(K, X, seen, start):
    """Returns the camera (R, t) of a frame and its reprojection errors; `start`: the previous camera."""
    known = np.isfinite(X).all(1) & np.isfinite(seen).all(1)
    if known.sum() < 6:
        raise Failed("sees too few of the points")
    rotation, translation = cv2.Rodrigues(start[0])[0], start[1].reshape(3, 1).copy()
    _, rotation, translation = cv2.solvePnP(
        X[known], seen[known], K, None, rotation, translation, True, cv2.SOLVEPNP_ITERATIVE)
    x, _ = cv2.projectPoints(X[known], rotation, translation, K, None)
    error = np.linalg.norm(x.reshape(-1, 2) - seen[known], axis=1)
    return (cv2.Rodrigues(rotation)[0], translation.ravel()), error


def resect_all(K, X, tracks, pair, motion):
    """Returns the cameras of all frames from the points of two, and the median error [px]."""
    cameras, errors = [(np.eye(3), np.zeros(3))], []
    for frame in range(1, len(tracks)):
        if frame == pair:
            cameras.append(motion)
            continue
        try:
            camera, error = resect(K, X, tracks[frame], cameras[-1])
        except Failed as why:
            raise Failed(f"frame {frame} {why}") from None
        cameras.append(camera)
        errors.append(error)
    return cameras, float(np.median(np.concatenate(errors))) if errors else 0.0


def reconstruct(K, tracks, pair):
    """Returns the cameras of all frames and the points of all tracks from frames 0 and `pair`."""
    both = np.isfinite(tracks[0]).all(1) & np.isfinite(tracks[pair]).all(1)
    if both.sum() < MIN_POINTS:
        raise Failed(f"{both.sum()} tracks, needs at least {MIN_POINTS}")
    solutions, model = initialize_pair(K, tracks[0][both], tracks[pair][both])
    solved = []
    for R, t, of_both in solutions:
        X = np.full((len(tracks[0]), 3), np.nan)
        X[both] = of_both
        cameras, error = resect_all(K, X, tracks, pair, (R, t))
        solved.append((error, cameras, X))
    solved.sort(key=lambda one: one[0])
    # If two views are ambiguous, the other frames must decide.
    if len(solved) > 1 and solved[1][0] < 1.2 * solved[0][0]:
        raise Failed(f"two decompositions of the {model} fit equally well")
    return solved[0][1], solved[0][2]


def initialize(window):
    K = np.array(window["K"])
    tracks = np.array([[(np.nan, np.nan) if p is None else p for p in frame]
                       for frame in window["tracks"]], dtype=float).reshape(
                           len(window["tracks"]), -1, 2)
    last = len(tracks) - 1
    reasons = []
    for pair in sorted({last, 3 * last // 4, last // 2, last // 4} - {0}, reverse=True):
        try:
            cameras, X = reconstruct(K, tracks, pair)
        except Failed as why:
            reasons.append(f"frame {window['start'] + pair}: {why}")
            continue
        return {
            "cameras": [{"R_wc": R.T.tolist(), "center": (-R.T @ t).tolist()} for R, t in cameras],
            "points": [{"track": j, "position": X[j].tolist()}
                       for j in range(len(X)) if np.isfinite(X[j]).all()],
        }
    raise Failed("no pair to start from: " + (reasons[0] if reasons else "one frame"))


def main():
    for line in sys.stdin:
        window = json.loads(line)
        cv2.setRNGSeed(1)
        begin = time.perf_counter()
        try:
            answer = initialize(window)
            answer["milliseconds"] = 1000 * (time.perf_counter() - begin)
        except Failed as why:
            answer = {"failed": str(why)}
        print(json.dumps({"id": window["id"], **answer}), flush=True)


if __name__ == "__main__":
    main()
