#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Functions to drive the real window, for scripts that source this file. `pid` is the process, `window` its window.

fail() { echo "expected: $1 (images in $PWD)" >&2; kill "$pid" 2> /dev/null; exit 1; }
# Runs a command until it succeeds, for at most five minutes because the machine may be busy.
until_true() {
  local what=$1 until=$((SECONDS + 300))
  shift
  while [ "$SECONDS" -lt "$until" ]; do
    "$@" && return
    kill -0 "$pid" 2> /dev/null || fail "$what (the program has ended)"
    sleep 0.1
  done
  fail "$what"
}
start_program() {
  "$@" &
  pid=$!
  until_true "a window" window_is_there
  xdotool windowfocus "$window" 2> /dev/null
}
window_is_there() { window=$(xdotool search --name 'GPO Inspector' 2> /dev/null | head -1); [ -n "$window" ]; }
title_is() { [ "$(xdotool getwindowname "$window" 2> /dev/null)" = "$1" ]; }
key() { xdotool key --window "$window" "$@"; }
same_as() { import -window "$window" now.png; cmp -s "$1" now.png; }
other_than() { import -window "$window" now.png; ! cmp -s "$1" now.png; }
at_rest() { import -window "$window" before.png; sleep 0.3; same_as before.png; }
# Waits also until messages have vanished, which takes twelve seconds.
long_at_rest() { at_rest && sleep 13 && same_as before.png; }
# Closes the window and returns the exit code of the program.
quit() {
  local until=$((SECONDS + 300))
  key ctrl+q
  while kill -0 "$pid" 2> /dev/null; do
    [ "$SECONDS" -lt "$until" ] || fail "Ctrl+Q to end the program"
    sleep 0.1
  done
  wait "$pid"
}
# Types as fast as pasting programs do.
type_command() { xdotool key --delay 10 ctrl+p; xdotool type --delay 10 "$1"; xdotool key --delay 10 Return; }
mouse_to() { xdotool mousemove --window "$window" "$1" "$2"; }
# drag X Y TO_X TO_Y drags with the left mouse button.
drag() {
  mouse_to "$1" "$2"
  sleep 0.2
  xdotool mousedown 1
  for step in 1 2 3 4 5; do
    sleep 0.05
    mouse_to $(($1 + ($3 - $1) * step / 5)) $(($2 + ($4 - $2) * step / 5))
  done
  until_true "the window to follow the mouse" at_rest
  xdotool mouseup 1
}
