#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# A stranger's first steps in the real window, by mouse and keyboard, with what the window itself offers: a video is
# dropped, its camera calibrated, the scale set from two points, cubes put on floor and wall, and the result exported.
#   ../with_display.sh 1280x720 stranger_window.sh PROGRAM
# Run in an empty folder. The program renders the video from stranger.yaml. Leaves step-1.png to step-6.png and
# room.glb; prints a failed expectation and exits with 1.
set -u
program=$1
here=$(dirname "$0")
source "$here/window_driver.sh"
export XDG_STATE_HOME=$PWD/state XDG_CACHE_HOME=$PWD/cache

step() { until_true "the window to stop changing ($1)" at_rest; cp before.png "$1.png"; }
opened() { title_is "$1GPO Inspector"; }
click() { mouse_to "$1" "$2"; sleep 0.3; xdotool click "${3:-1}"; }

# The video: only images, without calibration, gyroscope and truth.
"$program" synthesize "$here/stranger.yaml" --output room || exit 1
cat > video.txt <<'END'
set frames 120
tracks off
tails off
cube off
truth off
gravity off
legend off
export-video room.mp4
END
"$program" snapshot room --script video.txt > video.log || exit 1

# 1. The window says what to do; the video is dropped on it.
start_program "$program" view
xdotool windowsize --sync "$window" 1280 720
step empty
/usr/bin/python3 "$here/drop_file.py" "$window" room.mp4 || fail "the window to accept the video"
until_true "the video to be opened" opened "room.mp4 – the camera is a guess – "
step step-1-dropped

# 2. The banner says that the window failed, and offers a calibration. Its report asks for a yes.
click 730 47
until_true "the camera to be calibrated" opened "room.mp4 – "
step step-2-calibrated
click 373 435
step accepted

# 3. Two corners of the rug, which is 1.7 m long. A right click offers what to do with them.
click 715 383  # closes the drawer of the camera
key --window "$window" Home
step reference-frame
pick() { mouse_to "$1" "$2"; sleep 0.3; xdotool keydown alt click 1 keyup alt; sleep 0.5; }
pick 459 476
pick 832 418
click 700 480 3
step step-3-two-points
