# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the Python module with the command line, whose results must be identical."""
import gc
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
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
def test_run_is_identical_to_the_command_line(settings):
    options = []
    for key, value in settings.items():
        name = key.replace("_", "-")
        options += ["--no-" + name] if value is False else ["--" + name, str(value)]
    expected = json.loads(program("run", DESK, "--frames", "20", *options, "--json", "-"))
    result = gpo.run(DESK, frames=20, **settings)
    assert without_milliseconds(result.json) == without_milliseconds(expected)


def test_arrays_match_the_json_result():
    result = gpo.run(DESK, frames=12)
    assert result.ok and result.reason == ""
    assert result.R_wc.shape == (12, 3, 3) and result.p_wc.shape == (12, 3)
    expected = result.json
    for frame, R, p in zip(expected["frames"], result.R_wc, result.p_wc):
        np.testing.assert_array_equal(frame["p_wc"], p)
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(R) > 0
        x, y, z, w = frame["q_wc_xyzw"]
        # The rotation leaves the axis of the quaternion unchanged.
        np.testing.assert_allclose(R @ [x, y, z], [x, y, z], atol=1e-12)
    np.testing.assert_array_equal(result.normal, expected["plane"]["normal"])
    assert len(result.points) == len(expected["points"])
    # Points on the leading plane: normal . x + distance = 0.
    on_plane = result.points @ result.normal + 1
    assert np.median(np.abs(on_plane)) < 0.02
    assert result.planes[0]["number"] == 1
    assert [list(p["tracks"]) for p in result.planes] == [p["tracks"] for p in expected["planes"]]
    points = result.points
    del result
    gc.collect()
    assert np.isfinite(points).all()
    with pytest.raises(ValueError):
        points[0, 0] = 1


def same(one, other):
    for name in ("R_wc", "p_wc", "points", "normal", "point_tracks", "bias_rad_s"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    assert one.verdict == other.verdict and one.normal_sigma_deg == other.normal_sigma_deg
    assert len(one.planes) == len(other.planes)


@pytest.mark.parametrize("settings", [{}, {"method": "ba"}, {"planes": "one"}, {"rotations": "averaging"}])
def test_initialize_is_identical_to_run(settings):
    recording = gpo.open(DESK)
    whole = gpo.run(recording, frames=20, start=5, **settings)
    # These tracks are anchored, so those of the reference frame are exact.
    window = gpo.initialize(recording.camera, whole.frames, recording.gyroscope, error="transfer", **settings)
    assert window.ok and window.is_ready == (whole.readiness == "ready")
    same(window, whole)
    np.testing.assert_array_equal(window.ids, whole.ids)
    assert set(window.point_tracks) <= set(range(len(window.ids)))


def test_initialize_accepts_lists_of_undistorted_pixels():
    """A plane at z = 2 and a camera that moves sideways and rotates, in closed form."""
    rng = np.random.default_rng(3)
    points = np.column_stack([rng.uniform(-1, 1, (60, 2)), np.full(60, 2.0)])
    K = np.array([[500.0, 0, 320], [0, 500, 240], [0, 0, 1]])
    frames = []
    for i in range(12):
        a = 0.01 * i
        R = np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
        center = np.array([0.05 * i, 0.01 * i, 0.02 * i])
        seen = (points - center) @ R @ K.T
        frames.append((i * 33_000_000, list(range(60)), (seen[:, :2] / seen[:, 2:]).tolist(), R))
    window = gpo.initialize(K.tolist(), frames, method="gpo")
    assert window.ok, window.reason
    assert window.rotations == "truth"
    np.testing.assert_allclose(window.normal, [0, 0, -1], atol=1e-6)
    np.testing.assert_allclose(window.p_wc[-1], np.array([0.55, 0.11, 0.22]) / 2, atol=1e-6)


def test_live_window_is_ready_together_with_run():
    recording = gpo.open(DESK)
    whole = gpo.run(recording, frames=30)
    live = gpo.Initializer(recording.camera, recording.gyroscope, background=False, error="transfer")
    for i, frame in enumerate(whole.frames):
        status = live.add_frame(*frame)
        if status.ready:
            break
    assert status.ready and status.ready_frames == i + 1 and status.answer.is_ready
    fresh = gpo.run(recording, frames=i + 1)
    assert fresh.readiness == "ready"
    same(status.answer, fresh)
    beside = gpo.Initializer(recording.camera, recording.gyroscope)
    for frame in whole.frames[: i + 1]:
        beside.add_frame(*frame)
    assert beside.wait().ready


def test_live_gyroscope_accepts_samples():
    recording = gpo.open(DESK)
    whole = gpo.run(recording, frames=12)
    samples = dict(recording.gyroscope)
    times, rates = samples.pop("timestamps_ns"), samples.pop("rates_rad_s")
    live = gpo.Initializer(recording.camera, samples, background=False)
    for time_ns, rate in zip(times, rates):
        live.add_gyroscope(int(time_ns), rate)
    assert live.add_frame(*whole.frames[0]).frames == 1
    assert live.status.frames == 1 and not live.status.ready and live.status.waiting == 0


def test_window_that_is_not_ready_has_a_reason():
    recording = gpo.open(DESK)
    frames = gpo.run(recording, frames=30).frames
    good = gpo.initialize(recording.camera, frames, recording.gyroscope, error="transfer")
    assert good.is_ready and good.why_not_ready == ""
    guessed = gpo.initialize(recording.camera, frames, recording.gyroscope, camera_is_guess=True, error="transfer")
    assert guessed.why_not_ready == "the camera is a guess: calibrate it"
    assert [one["key"] for one in guessed.findings] == ["guessed-camera"] and good.findings == []
    samples = dict(recording.gyroscope, timestamps_ns=[], rates_rad_s=np.zeros((0, 3)))
    del samples["accelerations_m_s2"]
    assert gpo.initialize(recording.camera, frames, samples).rotations_note.startswith("the gyroscope has no samples")


def test_initialize_notes_a_gyroscope_with_a_wrong_clock():
    recording = gpo.open(DESK)
    frames = gpo.run(recording).frames
    late = dict(recording.gyroscope, time_offset_ns=recording.gyroscope["time_offset_ns"] + 50_000_000)
    found = gpo.initialize(recording.camera, frames, late, error="transfer")
    assert "its clock is about -50 ms off, corrected in this window" in found.rotations_note


def test_masked_pixels_are_not_seen():
    recording = gpo.open(DESK)
    frames = gpo.run(recording, frames=12).frames
    hidden = [pixels[:, 0] < 100 for _, _, pixels in frames]
    masked = [
        (time_ns, ids, np.ma.masked_array(pixels, np.stack([mask, mask], 1)))
        for (time_ns, ids, pixels), mask in zip(frames, hidden)
    ]
    left_out = [(time_ns, ids[~mask], pixels[~mask]) for (time_ns, ids, pixels), mask in zip(frames, hidden)]
    same(gpo.initialize(recording.camera, masked), gpo.initialize(recording.camera, left_out))


def test_inertial_has_gravity_and_scale():
    recording = gpo.open(DESK)
    result = gpo.run(recording)
    expected = result.json["inertial"]
    inertial = result.inertial
    np.testing.assert_array_equal(inertial["gravity_m_s2"], expected["gravity"])
    np.testing.assert_array_equal(inertial["velocities_m_s"], expected["velocities"])
    assert inertial["scale"] == expected["scale"] and inertial["scale_known"]
    assert inertial["log_scale_sigma"] == expected["sigma"]
    window = gpo.initialize(recording.camera, result.frames, gyroscope=recording.gyroscope, error="transfer")
    assert window.inertial["scale"] == inertial["scale"]
    assert gpo.run(recording, gravity="off").inertial is None
    without = gpo.initialize(recording.camera, result.frames, gravity="off", gyroscope=recording.gyroscope)
    assert without.inertial is None


def test_live_window_reports_when_the_scale_is_known():
    recording = gpo.open(DESK)
    gyro = dict(recording.gyroscope)
    samples = list(zip(gyro["timestamps_ns"], gyro["rates_rad_s"], gyro["accelerations_m_s2"]))
    for key in ("timestamps_ns", "rates_rad_s", "accelerations_m_s2"):
        del gyro[key]
    live = gpo.Initializer(recording.camera, gyroscope=gyro, background=False)
    metric = []
    for time_ns, ids, pixels in gpo.run(recording, frames=60).frames:
        while samples and samples[0][0] <= time_ns + gyro["time_offset_ns"] + 10_000_000:
            live.add_imu(*samples.pop(0))
        status = live.add_frame(time_ns, ids, pixels)
        metric.append(status.metric)
    assert status.ready and not metric[2] and metric[-1]
    inertial = status.answer.inertial
    # The true scale, from the same recording.
    truth = gpo.run(recording, frames=60).metrics["scale"]
    assert abs(inertial["scale"] / truth - 1) < 4 * inertial["log_scale_sigma"]
    with pytest.raises(gpo.InputError, match="expected an acceleration with each sample"):
        live.add_gyroscope(2 * 10**18, [0, 0, 0])


def test_short_recording_is_taken_whole(tmp_path):
    camera = tmp_path / "mav0/cam0"
    camera.mkdir(parents=True)
    desk = pathlib.Path(DESK) / "mav0/cam0"
    (camera / "data").symlink_to(desk / "data")
    (camera / "sensor.yaml").write_text((desk / "sensor.yaml").read_text())
    lines = (desk / "data.csv").read_text().splitlines(keepends=True)
    (camera / "data.csv").write_text("".join(lines[:21]))
    assert len(gpo.run(tmp_path).frames) == 20
    assert gpo.snapshot(tmp_path, "image").ndim == 3
    with pytest.raises(gpo.InputError, match="21 frames from frame 0 on do not fit"):
        gpo.run(tmp_path, frames=21)


def test_open_reads_a_recording():
    recording = gpo.open(DESK)
    assert recording.name == "desk" and recording.layout == "EuRoC"
    assert recording.timestamps_ns.shape == (len(recording),)
    assert (np.diff(recording.timestamps_ns) > 0).all()
    files = sorted((ROOT / "sequences/desk/mav0/cam0/data").iterdir())
    picture = recording.frame(3)
    np.testing.assert_array_equal(picture, cv2.imread(str(files[3])))
    assert recording.camera.size == (picture.shape[1], picture.shape[0])
    assert recording.camera.K[0, 2] == pytest.approx(picture.shape[1] / 2, rel=0.1)
    rates = recording.gyroscope["rates_rad_s"]
    assert rates.shape == (len(recording.gyroscope["timestamps_ns"]), 3)
    truth = recording.truth
    assert truth["R_wc"].shape == (len(recording), 3, 3)
    assert np.linalg.norm(truth["normal"]) == pytest.approx(1)
    with pytest.raises(IndexError):
        recording.frame(len(recording))
    lens = gpo.Camera(recording.camera.K, distortion=[-0.3, 0.1, 0.001, -0.002, 0.01])
    pixels = np.array([[100.0, 50], [300, 200], [10, 400]])
    criteria = (cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 200, 1e-12)
    expected = cv2.undistortPointsIter(
        pixels[:, None], lens.K, lens.distortion, np.eye(3), lens.K, criteria
    )
    np.testing.assert_allclose(lens.undistort(pixels), expected[:, 0], atol=1e-6)
    assert gpo.run(recording, frames=10).normal.shape == (3,)


def test_limits_of_open_hold_from_then_on_in_the_process(tmp_path):
    desk = tmp_path / "desk"
    shutil.copytree(DESK, desk)
    with (desk / "mav0/cam0/sensor.yaml").open("a") as calibration:
        calibration.write("#" * (1 << 20))
    script = """if True:
        import gpo, pickle, sys
        for limits in (None, 0.5, 4, None):
            try:
                given = {} if limits is None else {"limits": limits}
                opened = gpo.open(sys.argv[1], **given)
                print(len(opened), len(pickle.loads(pickle.dumps(opened))))
            except gpo.InputError as error:
                print(error)
    """
    run = subprocess.run(
        [sys.executable, "-c", script, str(desk)], check=True, capture_output=True, text=True
    )
    first, wrong, raised, after = run.stdout.splitlines()
    assert "sensor.yaml" in first and "--limits allows more" in first
    assert wrong == "limits: found 0.5, expected a number of at least 1"
    assert raised == after == "60 60"


def test_example_draws_a_room(tmp_path):
    pytest.importorskip("matplotlib")
    room = ROOT.parent / "shared/data/euroc-room"
    recording, planes = (room, 2) if room.exists() else (DESK, 1)
    figure = tmp_path / "planes.png"
    script = ROOT / "engine/examples/planes_of_a_room.py"
    output = subprocess.run(
        [sys.executable, script, recording, figure], check=True, capture_output=True, text=True
    ).stdout
    assert output.splitlines()[-1] == f"wrote {figure}"
    picture = cv2.imread(str(figure))
    assert picture.shape == (500, 1300, 3)
    # matplotlib's tab10 of plane k, as BGR
    colors = [(14, 127, 255), (44, 160, 44)][:planes]
    assert all((picture == color).all(axis=2).sum() > 100 for color in colors)


def test_evaluate_returns_a_structured_array():
    rows = gpo.evaluate([DESK], methods="gpo,ba", lengths="10:20:10", starts="0")
    assert len(rows) == 4
    assert list(rows["configuration"]) == ["gpo", "ba", "gpo", "ba"]
    assert (rows["pne_deg"] < 3).all()
    assert rows["pne_deg"].dtype == np.float64
    one = gpo.run(DESK, method="ba", frames=20, seed=1)
    row = rows[(rows["configuration"] == "ba") & (rows["frames"] == 20)]
    assert row["pne_deg"][0] == one.metrics["pne_deg"]


def test_evaluate_reads_results_of_other_programs(tmp_path):
    program("run", DESK, "--frames", "60", "--true-trajectory", str(tmp_path / "desk.txt"))
    for result in (f"slam={tmp_path}/{{recording}}.txt,scale=metric", {"slam": tmp_path / "desk.txt"}):
        rows = gpo.evaluate([DESK], methods="gpo,slam", result=result, lengths="10:20:10", starts="0")
        assert list(rows["configuration"]) == ["gpo", "slam", "gpo", "slam"]
        slam = rows[rows["configuration"] == "slam"]
        assert (slam["status"] == "ok").all()
        assert (slam["ate_m"] < 1e-6).all()
        assert (rows["ate_m"][rows["configuration"] == "gpo"] > 1e-6).all()
    with pytest.raises(gpo.InputError, match="no such file"):
        gpo.evaluate([DESK], methods="slam", result=f"slam={tmp_path}/none.txt")


def test_result_names_the_clock_and_scale_of_an_imported_result(tmp_path):
    program("run", DESK, "--frames", "60", "--true-trajectory", str(tmp_path / "desk.txt"))
    found = gpo.run(DESK, method="slam", result=f"slam={tmp_path}/desk.txt,scale=metric,offset=auto")
    imported = found.to_dict()["json"]["imported"]
    assert imported == found.json["imported"]
    assert imported["time_offset_s"] == pytest.approx(0, abs=1e-4)
    assert imported["applied_time_offset_s"] == imported["time_offset_s"]
    assert found.json["metric_scale"]["source"] == "result"
    assert abs(found.metrics["scale_error_percent"]) < 0.01


@pytest.mark.parametrize("view", ["image", "scene", "compare"])
def test_snapshot_is_identical_to_the_command_line(view, tmp_path):
    file = tmp_path / "view.png"
    program("snapshot", DESK, "--view", view, "--frames", "10", "--output", str(file))
    picture = gpo.snapshot(DESK, view, frames=10)
    assert picture.dtype == np.uint8
    np.testing.assert_array_equal(picture, cv2.imread(str(file)))


def test_report_has_the_result_of_the_command_line(tmp_path):
    assert gpo.report([gpo.open(DESK)], tmp_path / "python.html", methods="gpo,pnp_ba", frames=10)
    program("report", DESK, "--methods", "gpo,pnp_ba", "--frames", "10", "--output", str(tmp_path / "program.html"))

    def results(name):
        page = (tmp_path / name).read_text()
        found = [json.loads(text) for text in re.findall(r'class="result"[^>]*>(.*?)</script>', page, re.DOTALL)]
        return [(one["method"], one["plane"], one["frames"]) for one in found]

    assert len(results("python.html")) == 2
    assert results("python.html") == results("program.html")


def test_two_points_set_the_scale():
    result = gpo.run(DESK, scale_points=(137, 231, 432, 334), scale_length=0.3)
    assert result.json["metric_scale"]["source"] == "points"
    assert result.json["settings"]["scale_length"] == 0.3


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: gpo.open("no/such"), "no/such: no such file or folder"),
        (lambda: gpo.open(DESK, topics={"image": "/x"}), "without topics, expected a bag for --topic"),
        (lambda: gpo.open(DESK, {"picture": "/x"}), "expected one of image, camera_info, imu, truth, gyroscope"),
        (lambda: gpo.run(DESK, method="slam"), "expected one of gpo"),
        (lambda: gpo.run(DESK, frames="many"), "frames"),
        (lambda: gpo.run(DESK, speed=3), "speed"),
        (lambda: gpo.run(DESK, start=1000), "start"),
        (lambda: gpo.run(DESK, scale_points=(5, 5, 6, 6), scale_length=1), "point .5, 5. is on no plane"),
        (lambda: gpo.snapshot(DESK, "kitchen"), "expected one of image"),
        (lambda: gpo.snapshot(DESK, "image", frame=999), "frame: 999 is not in the recording"),
        (lambda: gpo.evaluate([], methods="gpo"), "needs at least one recording"),
        (lambda: gpo.initialize(np.eye(3), []), "a window of 0 frames"),
        (lambda: gpo.initialize(np.zeros((3, 3)), [(0, [], np.zeros((0, 2)))] * 2), "camera: fx 0"),
        (lambda: gpo.initialize(np.eye(3), [(0, [1], [[1, 2, 3]])]), r"frame 0: expected ids \(n,\)"),
        (lambda: gpo.initialize(np.eye(3), [(0, [1], "here")]), "frame 0: pixels: expected numbers"),
        (lambda: gpo.initialize(np.eye(3), [(0, [1], [["1", "2"]])]), "frame 0: pixels: expected numbers, found <U1"),
        (lambda: gpo.initialize(np.eye(3), [(0, [1], [[1j, 2]])]), "frame 0: pixels: expected numbers, found complex128"),
        (lambda: gpo.initialize(np.eye(3), [None]), "frame 0: expected numbers"),
        (lambda: gpo.initialize(np.eye(3), [(0, [1])]), "frame 0: expected"),
        (lambda: gpo.initialize(np.eye(3), [], start=3), "start: applies to recordings"),
        (lambda: gpo.initialize(np.eye(3), [], speed=3), "speed"),
        (lambda: gpo.initialize(np.eye(3), [], {"rates_rad_s": [1, 2]}), r"rates_rad_s \(3,\), or \(m, 3\)"),
        (lambda: gpo.initialize(np.eye(3), [], {"bias_rad_s": "none"}), "bias_rad_s has another type"),
        (lambda: gpo.Initializer(np.eye(2)), r"expected K \(3, 3\)"),
        (lambda: gpo.Camera(np.eye(3), model="mirror"), "model: mirror, expected none"),
        (lambda: gpo.Camera(np.eye(3), covariance=np.eye(3)), "expected the upper triangle of a positive"),
        (lambda: gpo.Camera(np.eye(3), covariance=np.ones((2, 3))), r"expected covariance \(n, n\)"),
        (lambda: gpo.Camera([[500, 1, 0], [0, 500, 0], [0, 0, 1]]), "pixels have no skew"),
        (lambda: gpo.Camera(np.eye(3), distortion=[0.1, 0, 0]), "found 3 coefficients, radial-tangential has 2, 4"),
        (lambda: gpo.initialize(np.eye(3), [(0, [1.5], [[1, 2]])]), "frame 0: ids: expected integers, found float64"),
        (lambda: gpo.initialize(np.eye(3), [(0, [2**63], [[1, 2]])]), r"frame 0: ids: expected integers below 2\^63"),
        (lambda: gpo.initialize(np.eye(3), [], {"R_gyro_cam": np.eye(3)}), "gyroscope: unknown key 'R_gyro_cam'"),
        (lambda: gpo.evaluate([DESK], ransac_threshold_px=3), "ransac_threshold_px: evaluate does not take it"),
        (lambda: gpo.evaluate([DESK], speed=3), "speed"),
        (lambda: gpo.evaluate([DESK], methods=[lambda window: {}]), "methods: '<lambda>=python', expected a callable"),
        (lambda: gpo.run(DESK, method_command="mine"), "mine"),
        (lambda: gpo.Camera(np.eye(3), readout_direction="in"), "unknown value 'in', expected one of down"),
        (lambda: gpo.evaluate([DESK], jobs=-1), "jobs: -1, expected 0 to 1024"),
        (lambda: gpo.run(DESK, method_timeout=0), "method_timeout: 0, expected 0.01 to 100000"),
        (lambda: gpo.run(DESK, method=print, method_timeout=1), "method_timeout: applies to method_command"),
        (lambda: gpo.run(DESK, method=print, method_resample=True), "method_resample: applies to method_command"),
        (lambda: gpo.evaluate([DESK], methods="gpo", starts=[0, 55], lengths=10), "starts: no window fits from frame 55"),
        (lambda: gpo.run(DESK, frames=10).export("ply", "a.ply", cube_side=-1), "cube_side: -1, expected 0 to"),
        (lambda: gpo.Camera(np.eye(3) * np.nan), "camera: fx nan"),
        (lambda: gpo.Camera(np.eye(3), size=(-1, 5)), "camera: width -1"),
        (lambda: gpo.Camera(np.eye(3), size=(640.0, 480.0)), r"size: expected integers \(width, height\)"),
        (lambda: gpo.Camera(np.eye(3), readout_s=0.02), "readout_s: expected the camera's size"),
        (lambda: gpo.Camera(np.eye(3), readout_sigma_s=0.01), "readout_sigma_s: expected readout_s"),
        (lambda: gpo.Camera(np.eye(3), distortion=[0.1], model="none"), "found 1 coefficient, model none has none"),
        (lambda: gpo.snapshot(DESK, "scene", frames=10, size=(-5, 10)), "size: '-5x10', expected WIDTHxHEIGHT"),
        (lambda: gpo.initialize(gpo.Camera(np.eye(3), readout_s=2), [(0, [], np.zeros((0, 2)))] * 2), "camera: readout seconds 2"),
    ],
)
def test_bad_input_raises_input_error(call, message):
    with pytest.raises(gpo.InputError, match=message) as error:
        call()
    assert isinstance(error.value, ValueError)
    assert "\n" not in str(error.value)


def test_camera_without_uncertainty_has_a_typical_one():
    recording = gpo.open(DESK)
    frames = gpo.run(recording).frames
    given = dict(size=recording.camera.size, distortion=recording.camera.distortion)
    unknown = gpo.initialize(gpo.Camera(recording.camera.K, **given), frames)
    stated = gpo.initialize(gpo.Camera(recording.camera.K, covariance=np.zeros((8, 8)), **given), frames)
    assert unknown.typical_lens_sigma_deg > unknown.normal_sigma_deg
    assert stated.typical_lens_sigma_deg is None
    assert stated.normal_sigma_deg == pytest.approx(unknown.normal_sigma_deg, rel=1e-4)


def test_failed_initialization_raises_nothing():
    result = gpo.run(DESK, frames=2, method="gpo")
    assert not result.ok
    assert result.reason
    assert result.R_wc.shape == (0, 3, 3)


def test_other_threads_keep_running():
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


@pytest.mark.parametrize(
    "call",
    [
        lambda: gpo.evaluate([DESK], lengths="10:60:5", starts="0:end:5"),
        lambda: gpo.snapshot(DESK, "curves"),
        lambda: gpo.snapshot(DESK, "compare", frames=60),
    ],
)
def test_control_c_interrupts(call):
    # A shell makes background processes ignore SIGINT.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    gpo.snapshot  # loads its libraries
    sent = []
    threading.Timer(0.5, lambda: (sent.append(time.monotonic()), os.kill(os.getpid(), signal.SIGINT))).start()
    with pytest.raises(KeyboardInterrupt):
        call()
    assert time.monotonic() - sent[0] < 1
    assert gpo.run(DESK, frames=10).ok


def test_concurrent_runs_are_independent():
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
