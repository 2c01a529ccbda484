#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# A stranger's first steps in the real window, by mouse and keyboard, with what the window itself offers: a video is
# dropped, its camera calibrated, the scale set from two points, cubes put on floor and wall, and the result exported.
#   ../with_display.sh 1280x720 stranger_window.sh PROGRAM
# Run in an empty folder. The program renders the video from stranger.yaml. Leaves step-1-dropped.png to
# step-5-exporting.png and room.glb; prints a failed expectation and exits with 1.
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
key --window "$window" Escape  # closes the card of the tour

# 2. The menu bar offers a calibration, since the camera is a guess. Its report asks for a yes.
click 366 13
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
mouse_to 700 480
step picked
xdotool click 3
until_true "the menu of the picked points" other_than picked.png
step step-3-two-points
click 764 579  # Set the scale from two points ...
until_true "a field for the length" other_than step-3-two-points.png
xdotool type --delay 30 1.7
xdotool key Return
step scaled

# 4. Each plane has a cube, now with its size in meters. The mouse drags them along floor and wall.
drag 505 198 640 200
drag 596 336 650 400
mouse_to 1000 540
step step-4-cubes

# 5. The menu File exports a scene that other programs open.
click 27 13
mouse_to 110 347
step export-menu
click 324 472  # Export: glTF scene ...
until_true "a field for the file" other_than export-menu.png
xdotool type --delay 30 room.glb
step step-5-exporting
xdotool key Return
until_true "the scene to be written" test -s room.glb
quit || exit 1

# The scene has cubes and is in meters.
python3 - room.glb <<'END' || exit 1
import json, struct, sys
data = open(sys.argv[1], "rb").read()
scene = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])
names = " ".join(node.get("name", "") for node in scene["nodes"])
if "cube" not in names or scene["asset"].get("extras", {}).get("unit") != "meter":
    sys.exit(f"expected: cubes in meters in room.glb, not {names}, {scene['asset']}")
END
