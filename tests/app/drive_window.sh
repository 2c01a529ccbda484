#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Drives the real window with a keyboard, in a display of its own:
#   xvfb-run drive_window.sh PROGRAM RECORDING      in an empty folder
# Says what it expected where it was disappointed, and ends with 1; else with the window's exit code.
set -u
program=$1
recording=$2
name=$(basename "$recording")

fail() { echo "expected: $1" >&2; kill "$pid" 2> /dev/null; exit 1; }
# Runs a command until it succeeds, for at most five minutes: a machine may have other work.
until_true() {
  local what=$1
  shift
  for _ in $(seq 3000); do
    "$@" && return
    kill -0 "$pid" 2> /dev/null || fail "$what (the program has ended)"
    sleep 0.1
  done
  fail "$what"
}
title_is() { [ "$(xdotool getwindowname "$window" 2> /dev/null)" = "$1" ]; }
window_is_there() { window=$(xdotool search --name 'GPO Inspector' 2> /dev/null | head -1); [ -n "$window" ]; }
key() { xdotool key --window "$window" "$@"; }
saved() { [ -s "$name-$1.png" ] && identify "$name-$1.png" > /dev/null 2>&1; }
other_than() { import -window "$window" now.png; ! cmp -s "$1" now.png; }
at_rest() { import -window "$window" before.png; sleep 0.3; same_as before.png; }
same_as() { import -window "$window" now.png; cmp -s "$1" now.png; }
later_frame_is_saved() { key s; sleep 0.1; ls "$name"-*.png 2> /dev/null | grep -qv -- -0000; }

"$program" view "$recording" &
pid=$!
until_true "a window" window_is_there
xdotool windowfocus "$window" 2> /dev/null
until_true "the recording to be opened and inspected" title_is "$name – GPO Inspector"

key s
until_true "a picture of the window's last frame" saved 0029
key Right s
until_true "Right to show the next frame" saved 0030
key shift+Left s
until_true "Shift+Left to go ten frames back" saved 0020
cmp -s "$name-0029.png" "$name-0030.png" && fail "pictures of two frames to differ"

until_true "a window that comes to rest" at_rest
key F1
until_true "F1 to list the keys" other_than before.png
key Escape
until_true "Esc to close the list again" same_as before.png

key r
until_true "R to change the picture" other_than before.png
until_true "RANSAC off to be inspected" title_is "$name – GPO Inspector"
key s
until_true "a second picture of the frame" saved 0020-2
cmp -s "$name-0020.png" "$name-0020-2.png" && fail "the picture without RANSAC to differ"

# Commands typed as fast as hands and pasting programs do: none is lost, none is a shortcut.
type_command() { xdotool key --delay 10 ctrl+p; xdotool type --delay 10 "$1"; xdotool key --delay 10 Return; }
commands=30
for i in $(seq 0 $((commands - 1))); do
  type_command "frame $i"
  type_command "bookmark /c1 n$i.mp4"
done
type_command "save-session typed.json"
until_true "typed commands to be run" test -s typed.json
typed=$(grep -c '"note": "/c1 n' typed.json)
[ "$typed" = "$commands" ] || fail "$commands bookmarks of as many commands typed, not $typed"

# Esc shuts a menu and nothing else; its letters are no shortcuts.
# Where the mouse rests on nothing that tells of itself.
xdotool mousemove --window "$window" 700 708
until_true "a window that comes to rest" at_rest
cp before.png shut.png
xdotool mousemove --window "$window" 30 13 click 1
until_true "a click to open the menu" other_than shut.png
key c r
key Escape
xdotool mousemove --window "$window" 700 708
until_true "Esc to shut the menu, and letters to do nothing meanwhile" same_as shut.png

rm -f "$name"-*.png
key Home space
until_true "Space to play" later_frame_is_saved

key ctrl+q
wait "$pid"
