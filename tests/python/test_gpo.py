# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python module against the command line, which it must agree with to the last bit."""
import gc
import json
import os
import pathlib
import signal
import subprocess
import threading
import time

import cv2
import numpy as np
import pytest

import gpo

ROOT = pathlib.Path(__file__).resolve().parents[2]
DESK = str(ROOT / "sequences" / "desk")
PROGRAM = os.environ["GPO_PROGRAM"]


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=True, capture_output=True, text=True).stdout


def without_times(result):
    return {key: value for key, value in result.items() if key not in ("timing_ms", "recording")}


def without_milliseconds(result):
    result = without_times(result)
    result["solver"] = {k: v for k, v in result["solver"].items() if not k.endswith("ms")}
    return result


@pytest.mark.parametrize(
    "settings",
    [{}, {"method": "ba", "start": 10}, {"preset": "paper"}, {"planes": "one", "ransac": False}],
)
def test_gives_the_same_bits_as_the_command_line(settings):
    options = []
    for key, value in settings.items():
        name = key.replace("_", "-")
        options += ["--no-" + name] if value is False else ["--" + name, str(value)]
    told = json.loads(program("run", DESK, "--frames", "20", *options, "--json", "-"))
    result = gpo.run(DESK, frames=20, **settings)
    assert without_milliseconds(result.json) == without_milliseconds(told)


def test_arrays_look_at_the_result():
    result = gpo.run(DESK, frames=12)
    assert result.ok and result.reason == ""
    assert result.R_wc.shape == (12, 3, 3) and result.p_wc.shape == (12, 3)
    told = result.json
    for frame, R, p in zip(told["frames"], result.R_wc, result.p_wc):
        np.testing.assert_array_equal(frame["p_wc"], p)
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(R) > 0
        x, y, z, w = frame["q_wc_xyzw"]
        # The rotation takes the quaternion's axis to itself.
        np.testing.assert_allclose(R @ [x, y, z], [x, y, z], atol=1e-12)
    np.testing.assert_array_equal(result.normal, told["plane"]["normal"])
    assert len(result.points) == len(told["points"])
    # The points of the leading plane lie on it: normal . x + distance = 0.
    on_plane = result.points @ result.normal + 1
    assert np.median(np.abs(on_plane)) < 0.02
    assert result.planes[0]["number"] == 1
    points = result.points
    del result
    gc.collect()
    assert np.isfinite(points).all()
    with pytest.raises(ValueError):
        points[0, 0] = 1


def test_opens_a_recording():
    recording = gpo.open(DESK)
    assert recording.name == "desk" and recording.layout == "EuRoC"
    assert recording.timestamps_ns.shape == (len(recording),)
    assert (np.diff(recording.timestamps_ns) > 0).all()
    files = sorted((ROOT / "sequences/desk/mav0/cam0/data").iterdir())
    picture = recording.frame(3)
    np.testing.assert_array_equal(picture, cv2.imread(str(files[3])))
    assert recording.size == (picture.shape[1], picture.shape[0])
    assert recording.K[0, 2] == pytest.approx(picture.shape[1] / 2, rel=0.1)
    rates = recording.gyroscope["rates_rad_s"]
    assert rates.shape == (len(recording.gyroscope["timestamps_ns"]), 3)
    truth = recording.truth
    assert truth["R_wc"].shape == (len(recording), 3, 3)
    assert np.linalg.norm(truth["normal"]) == pytest.approx(1)
    with pytest.raises(IndexError):
        recording.frame(len(recording))
    assert gpo.run(recording, frames=10).normal.shape == (3,)


def test_evaluates_to_a_structured_array():
    rows = gpo.evaluate([DESK], methods="gpo,ba", lengths="10:20:10", starts="0")
    assert len(rows) == 4
    assert list(rows["configuration"]) == ["gpo", "ba", "gpo", "ba"]
    assert (rows["pne_deg"] < 3).all()
    assert rows["pne_deg"].dtype == np.float64
    one = gpo.run(DESK, method="ba", frames=20, seed=1)
    row = rows[(rows["configuration"] == "ba") & (rows["frames"] == "20")]
    assert row["pne_deg"][0] == one.metrics["pne_deg"]


@pytest.mark.parametrize("view", ["image", "scene", "compare"])
def test_draws_what_the_command_line_draws(view, tmp_path):
    file = tmp_path / "view.png"
    program("snapshot", DESK, "--view", view, "--frames", "10", "--output", str(file))
    picture = gpo.snapshot(DESK, view, frames=10)
    assert picture.dtype == np.uint8
    np.testing.assert_array_equal(picture, cv2.imread(str(file)))


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: gpo.open("no/such"), "no/such: no such file or folder"),
        (lambda: gpo.run(DESK, method="slam"), "expected one of gpo"),
        (lambda: gpo.run(DESK, frames="many"), "frames"),
        (lambda: gpo.run(DESK, speed=3), "speed"),
        (lambda: gpo.run(DESK, start=1000), "start"),
        (lambda: gpo.snapshot(DESK, "kitchen"), "expected one of image"),
        (lambda: gpo.snapshot(DESK, "image", frame=999), "frame: 999 is not in the recording"),
        (lambda: gpo.evaluate([], methods="gpo"), "expected recordings"),
    ],
)
def test_bad_input_is_one_documented_error(call, message):
    with pytest.raises(gpo.InputError, match=message) as error:
        call()
    assert isinstance(error.value, ValueError)
    assert "\n" not in str(error.value)


def test_a_window_that_cannot_be_initialized_is_no_exception():
    result = gpo.run(DESK, frames=2, method="gpo")
    assert not result.ok
    assert result.reason
    assert result.R_wc.shape == (0, 3, 3)


def test_other_threads_run_meanwhile():
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    gpo.run(DESK, frames=40, method="ba")
    done.set()
    thread.join()
    assert counted > 5


def test_control_c_stops_it():
    before = time.monotonic()
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        gpo.evaluate([DESK], lengths="10:60:5", starts="0:end:5")
    assert time.monotonic() - before < 60
    assert gpo.run(DESK, frames=10).ok


def test_two_at_once_do_not_disturb_each_other():
    alone = [gpo.run(DESK, frames=15, start=start).normal.copy() for start in (0, 10)]
    found = [None, None]

    def run(k):
        found[k] = gpo.run(DESK, frames=15, start=10 * k).normal.copy()

    threads = [threading.Thread(target=run, args=(k,)) for k in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    np.testing.assert_array_equal(found, alone)
