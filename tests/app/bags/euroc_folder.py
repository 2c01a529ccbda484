# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Converts a recording in the EuRoC layout to ROS messages: (topic, type, time stamp [ns], fields)."""
import csv
import pathlib

import numpy
import yaml


# Ground truth without sensor.yaml is that of the body.
BODY = {"T_BS": {"data": numpy.eye(4).ravel().tolist()}}


def load_yaml(file):
    text = file.read_text()
    return yaml.safe_load(text.replace("%YAML:1.0", "")) or {}


def pose_of(sensor):
    """Returns T_BS as a proper rotation and a translation."""
    T = numpy.array(sensor["T_BS"]["data"], dtype=float).reshape(4, 4)
    U, _, Vt = numpy.linalg.svd(T[:3, :3])
    return U @ Vt, T[:3, 3]


def quaternion_xyzw(R):
    """Uses the one of four formulas that divides by the largest number."""
    squares = [1 + R[0, 0] - R[1, 1] - R[2, 2], 1 - R[0, 0] + R[1, 1] - R[2, 2],
               1 - R[0, 0] - R[1, 1] + R[2, 2], 1 + R[0, 0] + R[1, 1] + R[2, 2]]
    x, y, z, w = (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], squares[3])
    xy, xz, yz = R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1]
    q = [(squares[0], xy, xz, x), (xy, squares[1], yz, y), (xz, yz, squares[2], z), (x, y, z, w)]
    best = numpy.array(q[int(numpy.argmax(squares))], dtype=float)
    return tuple(best / numpy.linalg.norm(best))


def rows(file):
    with open(file) as lines:
        return [row for row in csv.reader(lines) if row and not row[0].startswith("#")]


def transform(parent, child, sensor_a, sensor_b):
    """Returns the pose of B in the frame of A."""
    R_a, p_a = pose_of(sensor_a)
    R_b, p_b = pose_of(sensor_b)
    return {"parent": parent, "child": child, "p": tuple(R_a.T @ (p_b - p_a)),
            "q": quaternion_xyzw(R_a.T @ R_b)}


def picture(file):
    """Returns a PGM as raw pixels, other files unchanged as compressed images."""
    data = file.read_bytes()
    if file.suffix != ".pgm":
        return "sensor_msgs/CompressedImage", {"format": file.suffix[1:], "data": data}
    _, width, height, _ = data.split(maxsplit=4)[:4]
    width, height = int(width), int(height)
    return "sensor_msgs/Image", {"width": width, "height": height, "encoding": "mono8",
                                 "data": data[len(data) - width * height:]}


def messages(folder, pictures):
    """Yields all messages in the order of their time stamps, static ones first."""
    mav = pathlib.Path(folder) / "mav0"
    cam, imu = load_yaml(mav / "cam0/sensor.yaml"), load_yaml(mav / "imu0/sensor.yaml")
    truth = mav / "state_groundtruth_estimate0"
    measured = load_yaml(truth / "sensor.yaml") if (truth / "sensor.yaml").exists() else BODY
    fx, fy, cx, cy = cam["intrinsics"]
    width, height = cam["resolution"]
    frames = rows(mav / "cam0/data.csv")
    start = int(frames[0][0])
    yield "/tf_static", "tf2_msgs/TFMessage", start, {"transforms": [
        transform("imu0", "cam0", imu, cam), transform("marker", "imu0", measured, imu)]}
    yield "/cam0/camera_info", "sensor_msgs/CameraInfo", start, {
        "frame": "cam0", "width": width, "height": height, "model": "plumb_bob",
        "D": [float(k) for k in cam["distortion_coefficients"]] + [0.0],
        "K": [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]}
    all_of_them = []
    for time, name in frames:
        file = mav / "cam0/data" / name
        if pictures:
            file = pathlib.Path(pictures) / (file.stem + ".pgm")
        kind, fields = picture(file)
        all_of_them.append((int(time), "/cam0/image_raw", kind, {"frame": "cam0", **fields}))
    for row in rows(mav / "imu0/data.csv"):
        numbers = [float(value) for value in row[1:7]]
        all_of_them.append((int(row[0]), "/imu0", "sensor_msgs/Imu",
                            {"frame": "imu0", "w": numbers[:3], "a": numbers[3:]}))
    for row in rows(truth / "data.csv"):
        px, py, pz, qw, qx, qy, qz = (float(value) for value in row[1:8])
        all_of_them.append((int(row[0]), "/truth", "geometry_msgs/TransformStamped",
                            {"parent": "world", "child": "marker", "p": (px, py, pz),
                             "q": (qx, qy, qz, qw)}))
    for time, topic, kind, fields in sorted(all_of_them, key=lambda one: one[:2]):
        yield topic, kind, time, fields
