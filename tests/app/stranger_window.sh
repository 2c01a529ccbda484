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
