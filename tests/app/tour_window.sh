#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# A tour of the real window by mouse and keyboard:
#   ../with_display.sh 1920x1080 tour_window.sh PROGRAM RECORDING OTHER_RECORDING [WIDTHxHEIGHT [COMMANDS]]
# Run in an empty folder; it leaves an image of each step for inspection. OTHER_RECORDING is dropped on the
# window; COMMANDS is the number of commands typed at 10 ms a key. Prints a failed expectation and exits with 1.
set -u
program=$1 recording=$(realpath "$2") other=$3 size=${4:-1366x768} commands=${5:-20}
width=${size%x*} height=${size#*x}
name=$(basename "$recording")
here=$(dirname "$0")
source "$here/window_driver.sh"

stop() { until_true "the window to stop changing ($1)" at_rest; cp before.png "$1.png"; }
has_size() { import -window "$window" now.png; [ "$(identify -format %wx%h now.png)" = "$size" ]; }
opened() { title_is "$1 – GPO Inspector"; }
# state FILE KEYS... prints a value of a session.
state() { python3 -c 'import json, sys; v = json.load(open(sys.argv[1]))
for k in sys.argv[2:]: v = v[k]
print(v)' "$@"; }
sessions=0
# Saves the current session to now.json.
save() {
  sessions=$((sessions + 1))
  type_command "save-session s$sessions.json"
  until_true "a session" test -s "s$sessions.json"
  mv "s$sessions.json" now.json
}
# expect WHAT LOW HIGH KEYS... checks that a number of the session is within limits.
expect() {
  local what=$1 low=$2 high=$3
  shift 3
  save
  local value
  value=$(state now.json "$@")
  python3 -c 'import sys; v, a, b = map(float, sys.argv[1:]); sys.exit(not a <= v <= b)' "$value" "$low" "$high" ||
    fail "$what: $* from $low to $high, not $value"
}

export XDG_STATE_HOME=$PWD/state
start_program "$program" view
until_true "the window to stop changing" at_rest
key Escape  # closes the card of the first run
xdotool windowsize --sync "$window" "$width" "$height"
until_true "a window of $size" has_size
stop empty

# Opens the recording in the browser by typing part of its path.
xdotool key ctrl+o
until_true "Ctrl+O to open the browser" other_than empty.png
xdotool type --delay 10 "$(dirname "$recording")/"
sleep 0.5
xdotool type --delay 10 "$name"
stop browser
xdotool key Return
until_true "the recording chosen in the browser to be opened" opened "$name"
stop opened

# Each menu opens by a click and closes by Esc; letters are no shortcuts meanwhile.
mouse_to $((width * 3 / 4)) $((height - 8))
until_true "the window to stop changing before the menus" long_at_rest
stop shut
for menu in 30 80 130 180; do
  mouse_to "$menu" 13
  xdotool click 1
  until_true "a click at $menu to open a menu" other_than shut.png
  stop "menu-$menu"
  key c r
  key Escape
  mouse_to $((width * 3 / 4)) $((height - 8))
  until_true "Esc to close the menu at $menu and letters to do nothing meanwhile" same_as shut.png
done

# Drags the lines between the parts.
drag 292 300 392 300
expect "the column dragged by 100" 386 398 division column_px
stop column
mouse_to 392 300
xdotool click --repeat 2 --delay 60 1
expect "a double click to reset the width of the column" 0 0 division column_px

# Drags the end of the window on the time line from frame 30 to about 20, then undoes it.
frames=$(state now.json settings frames)
count=60
left=238 right=$((width - 160)) y=$((height - 26 - 76 + 26))
x=$((left + (right - left) * frames / count))
drag "$x" "$y" $((left + (right - left) * 20 / count)) "$y"
until_true "the shorter window to be inspected" opened "$name"
expect "the window's end dragged" 18 22 settings frames
stop time-line
key --window "$window" ctrl+z
until_true "the window to be inspected again" opened "$name"
expect "Ctrl+Z to restore the window" "$frames" "$frames" settings frames

# Selects a frame on the time line.
mouse_to $((left + (right - left) * 81 / 120)) "$y"
xdotool click 1
expect "a click on the time line to go to frame 40" 39 41 frame

# A right click opens a menu and changes nothing. Its entries are commands.
cube() { save; python3 -c 'import json; s = json.load(open("now.json")); print(s.get("cube_ray"), s["settings"])'; }
before=$(cube)
mouse_to $((width * 2 / 5)) $((height * 2 / 5))
stop pointed
xdotool click 3  # pressed and released at once, and no event follows
until_true "a fast right click to open a menu" other_than pointed.png
stop context-image
key Escape
mouse_to "$x" "$y"
xdotool click 3
stop context-time-line
key Escape
mouse_to 200 $((height / 2 + 120))
xdotool click 3
stop context-number
key Escape
[ "$(cube)" = "$before" ] || fail "right clicks to change nothing, not $(cube)"
type_command "put-cube 0.1 0.2 1"
[ "$(cube)" != "$before" ] || fail "put-cube to move the cube"
stop cube
key --window "$window" ctrl+z
[ "$(cube)" = "$before" ] || fail "Ctrl+Z to put the cube back"

# Two drawers, the pages of the help, and the tour.
type_command "view curves"
type_command "view-beside table"
stop two-drawers
type_command "view no-drawer"
for page in glossary manual about; do
  type_command "$page"
  stop "$page"
  key Escape
done
type_command "tour 2"
stop tour
type_command "tour off"
# Sets the scale from two pixels of the desk, moves its cube, and picks two points by Alt+click.
type_command "frame 0"
type_command "set-scale 0.3 137 231 432 334"
expect "set-scale to set the length" 0.3 0.3 settings scale_length
type_command "put-cube 432 334"
mouse_to $((292 + (width - 292) / 6)) $((height / 2))
xdotool keydown alt click 1 keyup alt
stop scale

# Exports, saves an image of a view, and opens the last saved session.
for line in "export result out.json" "export gltf out.glb" "screenshot out.png scene 640x480"; do
  type_command "$line"
done
for file in out.json out.glb out.png; do until_true "$file to be written" test -s $file; done
save
cp now.json opened.json
type_command "set frames 12"
expect "set frames to change the window" 12 12 settings frames
type_command "open $PWD/opened.json"
until_true "the session to be opened" opened "$name"
expect "open to restore the session" "$frames" "$frames" settings frames
stop reopened

# Types commands fast and counts the bookmarks after each fifty.
for batch in $(seq 1 $(((commands + 99) / 100))); do
  for i in $(seq 0 49); do
    [ $((100 * (batch - 1) + 2 * i)) -lt "$commands" ] || break
    type_command "frame $i"
    type_command "bookmark /c$batch n$i.mp4"
    marks=$((i + 1))
  done
  save
  typed=$(grep -c "\"note\": \"/c$batch n" now.json)
  [ "$typed" = "$marks" ] || fail "$marks bookmarks of as many commands typed, not $typed"
done
stop typed

# Drops a file from another program.
/usr/bin/python3 "$here/drop_file.py" "$window" "$other" || fail "the window to accept a dropped file"
until_true "the dropped recording to be opened" opened "$(basename "$other")"
stop dropped

# Over a view that is slow to draw, all key events arrive within one frame and none after it.
mouse_to $((width * 2 / 5)) $((height * 2 / 5))
stop hovering
quit || exit 1

# A new window continues with what was open.
start_program "$program" view
until_true "the window to stop changing" at_rest
type_command continue
until_true "continue to open what was open last" opened "$(basename "$other")"
stop continued
quit
