#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Drives the real window by keyboard:
#   ../with_display.sh 1920x1080 drive_window.sh PROGRAM RECORDING      in an empty folder
# Prints a failed expectation and exits with 1, else with the exit code of the window.
set -u
program=$1
recording=$2
name=$(basename "$recording")

source "$(dirname "$0")/window_driver.sh"
saved() { [ -s "$name-$1.png" ] && identify "$name-$1.png" > /dev/null 2>&1; }
later_frame_is_saved() { key s; sleep 0.1; ls "$name"-*.png 2> /dev/null | grep -qv -- -0000; }

export XDG_STATE_HOME=$PWD/state
state=$XDG_STATE_HOME
start_program "$program" view "$recording"
until_true "the recording to be opened and inspected" title_is "$name – GPO Inspector"

key s
until_true "an image of the last frame of the window" saved 0029
key Right s
until_true "Right to show the next frame" saved 0030
key shift+Left s
until_true "Shift+Left to go ten frames back" saved 0020
cmp -s "$name-0029.png" "$name-0030.png" && fail "images of two frames to differ"

until_true "the window to stop changing" long_at_rest
key F1
until_true "F1 to list the keys" other_than before.png
key Escape
until_true "Esc to close the list again" same_as before.png

key r
until_true "R to change the image" other_than before.png
until_true "RANSAC off to be inspected" title_is "$name – GPO Inspector"
key s
until_true "a second image of the frame" saved 0020-2
cmp -s "$name-0020.png" "$name-0020-2.png" && fail "the image without RANSAC to differ"

# Commands typed fast are not lost and do not trigger shortcuts.
commands=30
for i in $(seq 0 $((commands - 1))); do
  type_command "frame $i"
  type_command "bookmark /c1 n$i.mp4"
done
type_command "save-session typed.json"
until_true "typed commands to be run" test -s typed.json
until_true "the session to be saved while the window is open" grep -q '"note": "/c1 n29' "$state/gpo-inspector/last-session.json"
typed=$(grep -c '"note": "/c1 n' typed.json)
[ "$typed" = "$commands" ] || fail "$commands bookmarks of as many commands typed, not $typed"

# Esc closes only a menu, and letters are no shortcuts meanwhile. The mouse rests where there is no tooltip.
xdotool mousemove --window "$window" 700 708
until_true "the window to stop changing" long_at_rest
cp before.png shut.png
xdotool mousemove --window "$window" 30 13 click 1
until_true "a click to open the menu" other_than shut.png
key c r
key Escape
xdotool mousemove --window "$window" 700 708
until_true "Esc to close the menu and letters to do nothing meanwhile" same_as shut.png

rm -f "$name"-*.png
key Home space
until_true "Space to play" later_frame_is_saved

quit
