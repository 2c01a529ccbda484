# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""make_ros2_db3.py FOLDER OUTPUT.db3 [PICTURES]: writes a recording in the EuRoC layout to a ROS 2 bag. PICTURES: a
folder of its images as PGM."""
import sqlite3
import struct
import sys

from euroc_folder import messages

RECORDED_LATER_NS = 7_000_000  # the time of the measurement counts


class Cdr:
    """Little-endian; numbers are aligned to their size after the four header bytes."""

    def __init__(self):
        self.bytes = bytearray()

    def number(self, kind, value):
        size = struct.calcsize(kind)
        self.bytes += bytes(-len(self.bytes) % size) + struct.pack("<" + kind, value)

    def doubles(self, values):
        for value in values:
            self.number("d", value)

    def text(self, value):
        stored = value.encode() + b"\0"
        self.number("I", len(stored))
        self.bytes += stored

    def data(self, value):
        self.number("I", len(value))
        self.bytes += value

    def header(self, ns, frame):
        self.number("i", ns // 1_000_000_000)
        self.number("I", ns % 1_000_000_000)
        self.text(frame)

    def message(self):
        return b"\x00\x01\x00\x00" + bytes(self.bytes)


def transform(cdr, fields, ns):
    cdr.header(ns, fields["parent"])
    cdr.text(fields["child"])
    cdr.doubles(fields["p"])
    cdr.doubles(fields["q"])


def transforms(cdr, fields, ns):
    cdr.number("I", len(fields["transforms"]))
    for one in fields["transforms"]:
        transform(cdr, one, ns)


def camera_info(cdr, fields, ns):
    cdr.header(ns, fields["frame"])
    cdr.number("I", fields["height"])
    cdr.number("I", fields["width"])
    cdr.text(fields["model"])
    cdr.number("I", len(fields["D"]))
    cdr.doubles(fields["D"] + fields["K"] + [1, 0, 0, 0, 1, 0, 0, 0, 1] + [0.0] * 12)
    for kind in "IIIIIIB":  # binning, region of interest
        cdr.number(kind, 0)


def image(cdr, fields, ns):
    cdr.header(ns, fields["frame"])
    cdr.number("I", fields["height"])
    cdr.number("I", fields["width"])
    cdr.text(fields["encoding"])
    cdr.number("B", 0)
    cdr.number("I", fields["width"])
    cdr.data(fields["data"])


def compressed_image(cdr, fields, ns):
    cdr.header(ns, fields["frame"])
    cdr.text(fields["format"])
    cdr.data(fields["data"])


def imu(cdr, fields, ns):
    cdr.header(ns, fields["frame"])
    cdr.doubles([0, 0, 0, 1] + [0] * 9 + fields["w"] + [0] * 9 + fields["a"] + [0] * 9)


WRITERS = {"sensor_msgs/CameraInfo": camera_info, "sensor_msgs/Image": image,
           "sensor_msgs/CompressedImage": compressed_image, "sensor_msgs/Imu": imu,
           "geometry_msgs/TransformStamped": transform, "tf2_msgs/TFMessage": transforms}


def main(folder, output, pictures=None):
    database = sqlite3.connect(output)
    database.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,"
                     "type TEXT NOT NULL,serialization_format TEXT NOT NULL,"
                     "offered_qos_profiles TEXT NOT NULL)")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,"
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    database.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    topics = {}
    for topic, kind, ns, fields in messages(folder, pictures):
        if topic not in topics:
            topics[topic] = len(topics) + 1
            database.execute("INSERT INTO topics VALUES(?,?,?,'cdr','')",
                             (topics[topic], topic, kind.replace("/", "/msg/")))
        cdr = Cdr()
        WRITERS[kind](cdr, fields, ns)
        database.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)",
                         (topics[topic], ns + RECORDED_LATER_NS, cdr.message()))
    database.commit()
    database.close()


main(*sys.argv[1:])
