# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""What Python's users expect of any module: loading, arguments, saving, stubs."""
import copy
import json
import os
import pathlib
import pickle
import subprocess
import sys

import numpy as np
import pytest

import gpo

ROOT = pathlib.Path(__file__).resolve().parents[2]
DESK = ROOT / "sequences" / "desk"
PROGRAM = os.environ["GPO_PROGRAM"]


def python(script):
    command = [sys.executable, "-c", script]
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout


def test_import_loads_no_library_of_the_window():
    script = """
import json, time
before = time.process_time()
import gpo
seconds = time.process_time() - before
def libraries():
    return sorted({line.split()[-1].split("/")[-1] for line in open("/proc/self/maps") if ".so" in line})
at_import = libraries()
gpo.run("sequences/desk", frames=5)
print(json.dumps({"seconds": seconds, "import": at_import, "run": libraries()}))
"""
    loaded = json.loads(python(script))
    assert loaded["seconds"] < 0.25
    late = ("libvtk", "libopencv_imgcodecs", "libgdal", "libavformat")
    assert not [name for name in loaded["import"] + loaded["run"] if name.startswith(late)]
    assert len(loaded["import"]) < 130 and len(loaded["run"]) < 150


@pytest.mark.skipif("GPO_INSTALLED" not in os.environ, reason="not installed by pip")
def test_module_is_the_installed_one():
    assert gpo.__file__.startswith(os.environ["GPO_INSTALLED"])


def test_stubs_match_the_module(tmp_path):
    pytest.importorskip("mypy")
    # pybind11's metaclass, and its constructor of classes that have none.
    allowed = tmp_path / "allowed.txt"
    allowed.write_text(r"gpo\.[A-Z]\w+(\.__init__)?" + "\n")
    command = [sys.executable, "-m", "mypy.stubtest", "gpo", "--allowlist", str(allowed)]
    checked = subprocess.run(command, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr


@pytest.fixture(scope="module")
def recording():
    return gpo.open(DESK)


@pytest.fixture(scope="module")
def result(recording):
    return gpo.run(recording, frames=12, preset=None, ransac=np.bool_(True))


@pytest.fixture(scope="module")
def window(recording, result):
    return gpo.initialize(recording.camera, result.frames, recording.gyroscope)


def assert_equal(one, other):
    if isinstance(one, gpo.Initialization):
        one, other = one.to_dict(), other.to_dict()
    if isinstance(one, dict):
        assert one.keys() == other.keys()
        for key in one:
            assert_equal(one[key], other[key])
    elif isinstance(one, (list, tuple)):
        assert len(one) == len(other)
        for a, b in zip(one, other):
            assert_equal(a, b)
    else:
        np.testing.assert_array_equal(one, other)


def test_results_can_be_pickled_and_copied(result, window):
    for one in (result, window):
        for restored in (pickle.loads(pickle.dumps(one)), copy.deepcopy(one), copy.copy(one)):
            assert type(restored) is type(one)
            assert_equal(one, restored)
            assert (repr(restored), str(restored)) == (repr(one), str(one))
            with pytest.raises(ValueError):
                restored.R_wc[0, 0, 0] = 2
            assert_equal(one, pickle.loads(pickle.dumps(restored)))
    assert "<table>" in result._repr_html_() and "&lt;" not in result._repr_html_()


def test_inputs_can_be_pickled_and_copied(recording):
    again = pickle.loads(pickle.dumps(recording))
    assert again.name == recording.name and len(again) == len(recording)
    assert copy.deepcopy(recording).name == recording.name
    camera = gpo.Camera(
        recording.camera.K,
        size=(640, 480),
        distortion=[-0.3, 0.1, 0.001, -0.002],
        covariance=np.eye(8) * 1e-4,
        readout_s=0.02,
        readout_direction="left",
    )
    same = pickle.loads(pickle.dumps(camera))
    assert same.__getstate__() == camera.__getstate__()
    assert same.readout_s == 0.02 and same.size == (640, 480)
    np.testing.assert_array_equal(copy.deepcopy(camera).K, camera.K)


def test_live_status_can_be_pickled(recording, result):
    live = gpo.Initializer(recording.camera, recording.gyroscope)
    for frame in result.frames:
        live.add_frame(*frame)
    status = live.wait()
    restored = pickle.loads(pickle.dumps(status))
    assert restored.frames == status.frames and repr(restored) == repr(status)
    if status.answer:
        assert_equal(status.answer, restored.answer)


def test_all_arrays_are_read_only(recording, result, window):
    arrays = [recording.camera.K, recording.camera.distortion, recording.truth["normal"]]
    arrays += [recording.gyroscope["bias_rad_s"], result.normal, result.planes[0]["normal"]]
    arrays += [result.frames[0][1], window.inliers, window.residuals, window.center_covariances]
    for array in arrays:
        assert not array.flags.writeable


def test_residuals_and_inliers_explain_the_rms(result):
    frames, tracks = result.inliers.shape
    assert (frames, tracks) == (12, len(result.ids))
    assert result.residuals.shape == (12, tracks, 2)
    squares = (result.residuals**2).sum(axis=2)
    used = result.inliers & np.isfinite(squares)
    # residuals are distances from one common point, transfers have the reference's noise, too.
    assert 0.3 < np.sqrt(squares[used].mean()) / result.rms_px < 3
    for name in ("transfer_rms_px", "reprojection_rms_px"):
        assert result.json[name] == getattr(result, name) > 0
    assert result.transfer_rms_px > result.reprojection_rms_px
    uncertainty = result.json["uncertainty"]
    np.testing.assert_array_equal(result.center_covariances, uncertainty["center_covariances"])


def test_json_of_tracks_is_that_of_run(recording, result):
    window = gpo.initialize(recording.camera, result.frames, recording.gyroscope, error="transfer")
    mine, expected = window.json, result.json
    for key in ("status", "window", "planes", "plane", "frames", "points", "uncertainty", "verdict"):
        assert mine[key] == expected[key]


def test_paths_and_arrays_are_accepted(recording, result):
    assert gpo.run(DESK, frames=np.int64(5), ransac=np.bool_(False)).frames
    frames = [(t, ids, pixels[:, None]) for t, ids, pixels in result.frames]  # OpenCV's (n, 1, 2)
    window = gpo.initialize(recording.camera, frames)
    plain = gpo.initialize(recording.camera, result.frames)
    np.testing.assert_array_equal(window.normal, plain.normal)
    K = recording.camera.K
    assert recording.camera.undistort(np.ones((4, 1, 2))).shape == (4, 2)
    assert recording.camera.undistort([]).shape == (0, 2)
    assert gpo.Camera(K, distortion=np.zeros((1, 5))).distortion.shape == (5,)  # of cv2.calibrateCamera
    live = gpo.Initializer(K, {"timestamps_ns": [], "rates_rad_s": []})
    assert live.add_frame(0, [], []).frames == 1


def known_answer(window):
    known_answer.windows += 1
    return {"failed": f"saw {len(window['tracks'])} frames"}


def test_initialize_takes_a_callable(recording, result):
    known_answer.windows = 0
    window = gpo.initialize(recording.camera, result.frames, recording.gyroscope, method=known_answer)
    assert known_answer.windows == 1
    assert window.reason == "known_answer: saw 12 frames" and not window.is_ready
    assert window.json["method"] == "known_answer"

    def again(window):
        cameras = [{"R_wc": R, "center": p} for R, p in zip(result.R_wc, result.p_wc)]
        return {"cameras": cameras}

    window = gpo.initialize(recording.camera, result.frames, recording.gyroscope, method=again)
    assert window.ok, window.reason
    np.testing.assert_allclose(window.R_wc, result.R_wc, atol=1e-9)
    with pytest.raises(gpo.InputError, match="'<lambda>=python', expected a callable"):
        gpo.initialize(recording.camera, result.frames, method=lambda window: {})


def test_evaluate_takes_settings_and_methods_of_the_user(tmp_path):
    known_answer.windows = 0

    def identity(window):
        cameras = [{"R_wc": np.array(R), "center": np.zeros(3)} for R in window["rotations"]]
        return {"cameras": cameras}

    def raises(window):
        raise RuntimeError("no <idea>")

    rows = gpo.evaluate(
        [DESK], methods=["gpo", known_answer, identity, raises], lengths=[10], starts=0, rotations="gyro"
    )
    assert list(rows["configuration"]) == [f"{m}+gyro" for m in ("gpo", "known_answer", "identity", "raises")]
    assert known_answer.windows == 1
    assert rows["status"][0] == "ok" and rows["reason"][1] == "known_answer: saw 10 frames"
    assert rows["status"][2] == "failed" and rows["reason"][3] == "raises: RuntimeError: no <idea>"
    assert len(rows[rows["frames"] == 10]) == 4
    assert rows["frames"].dtype == rows["seed"].dtype == np.int64
    assert gpo.run(DESK, frames=10, method=known_answer).reason == "known_answer: saw 10 frames"
    assert known_answer.windows == 2

    poses = tmp_path / "poses.txt"
    program = [PROGRAM, "run", DESK, "--frames", "20", "--trajectory", poses]
    subprocess.run(program, check=True, capture_output=True)
    output = tmp_path / "out"
    script = tmp_path / "mine.py"
    script.write_text("import sys\nfor _ in sys.stdin: print('{\"failed\": \"never\"}', flush=True)\n")
    rows = gpo.evaluate(
        [str(DESK)],
        methods="mine,other",
        lengths="10",
        starts="0",
        method_command={"mine": f"{sys.executable} {script}"},
        result=f"other={poses}",
        output=output,
    )
    assert list(rows["reason"]) == ["mine: never", ""]
    assert {"results.csv", "summary.json", "figures"} <= {file.name for file in output.iterdir()}


def test_export_writes_what_the_command_line_writes(tmp_path):
    result = gpo.run(DESK, frames=10)
    notes = result.export("colmap", tmp_path / "model")
    assert notes[0].startswith("10 images, ") and (tmp_path / "model" / "images.bin").exists()
    result.export("tum", str(tmp_path / "a.txt"))
    command = [PROGRAM, "run", DESK, "--frames", "10", "--export", f"tum={tmp_path / 'b.txt'}"]
    subprocess.run(command, check=True, capture_output=True)
    assert (tmp_path / "a.txt").read_text() == (tmp_path / "b.txt").read_text()
    keys = [key for key, help_text in gpo.export_formats() if help_text]
    assert keys == ["colmap", "gltf", "ply", "foxglove", "tum", "euroc", "kitti"]
    with pytest.raises(gpo.InputError, match="'obj', expected one of colmap, gltf"):
        result.export("obj", tmp_path / "a.obj")
    with pytest.raises(gpo.InputError, match="not empty"):
        result.export("colmap", tmp_path / "model")
    with pytest.raises(gpo.InputError, match="Run again"):
        pickle.loads(pickle.dumps(result)).export("ply", tmp_path / "a.ply")
