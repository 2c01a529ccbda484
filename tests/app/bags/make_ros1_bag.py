# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""make_ros1_bag.py FOLDER OUTPUT.bag COMPRESSION [PICTURES]: writes a recording in the EuRoC layout to a bag with
the library of ROS. COMPRESSION: none, bz2 or lz4; PICTURES: a folder of its images as PGM."""
import sys

import genpy
import rosbag
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, Imu
from tf2_msgs.msg import TFMessage

from euroc_folder import messages

RECORDED_LATER_NS = 7_000_000  # the time of the measurement counts


def time_of(ns):
    return genpy.Time(ns // 1_000_000_000, ns % 1_000_000_000)


def transform(fields, ns):
    message = TransformStamped()
    message.header.stamp, message.header.frame_id = time_of(ns), fields["parent"]
    message.child_frame_id = fields["child"]
    t, q = message.transform.translation, message.transform.rotation
    t.x, t.y, t.z = fields["p"]
    q.x, q.y, q.z, q.w = fields["q"]
    return message


def with_header(message, fields, ns):
    message.header.stamp, message.header.frame_id = time_of(ns), fields["frame"]
    return message


def camera_info(fields, ns):
    message = with_header(CameraInfo(), fields, ns)
    message.width, message.height = fields["width"], fields["height"]
    message.distortion_model, message.D, message.K = fields["model"], fields["D"], fields["K"]
    return message


def image(fields, ns):
    message = with_header(Image(), fields, ns)
    message.width = message.step = fields["width"]
    message.height, message.encoding = fields["height"], fields["encoding"]
    message.data = fields["data"]
    return message


def compressed_image(fields, ns):
    message = with_header(CompressedImage(), fields, ns)
    message.format, message.data = fields["format"], fields["data"]
    return message


def imu(fields, ns):
    message = with_header(Imu(), fields, ns)
    w, a = message.angular_velocity, message.linear_acceleration
    w.x, w.y, w.z = fields["w"]
    a.x, a.y, a.z = fields["a"]
    return message


MAKERS = {"sensor_msgs/CameraInfo": camera_info, "sensor_msgs/Image": image,
          "sensor_msgs/CompressedImage": compressed_image, "sensor_msgs/Imu": imu,
          "geometry_msgs/TransformStamped": transform,
          "tf2_msgs/TFMessage": lambda fields, ns: TFMessage(
              [transform(one, ns) for one in fields["transforms"]])}


def main(folder, output, compression, pictures=None):
    # Small chunks, so that a short recording has several.
    with rosbag.Bag(output, "w", compression=compression, chunk_threshold=1 << 20) as bag:
        for topic, kind, ns, fields in messages(folder, pictures):
            bag.write(topic, MAKERS[kind](fields, ns), time_of(ns + RECORDED_LATER_NS))


main(*sys.argv[1:])
