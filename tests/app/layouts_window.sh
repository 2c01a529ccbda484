#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Drives the real window with a German keyboard layout, then with a French one:
#   ../with_display.sh 1920x1080 layouts_window.sh PROGRAM RECORDING      in an empty folder
# Prints a failed expectation and exits with 1, else with the exit code of the window.
set -u
program=$1
recording=$2
name=$(basename "$recording")

source "$(dirname "$0")/window_driver.sh"
# session FILE REGEX: saves a session and returns whether it has a line like this
session() {
  rm -f "$1"
  type_command "save-session $1"
  until_true "a typed command to be run" test -s "$1"
  grep -q "$2" "$1"
}

export XDG_STATE_HOME=$PWD/state
setxkbmap de
start_program "$program" view "$recording"
until_true "the recording to be opened and inspected" title_is "$name – GPO Inspector"
type_command "set frames 20"
session changed.json '"frames": "20"' || fail "a typed command to change the window"
key ctrl+z
session undone.json '"frames": "30"' || fail "Ctrl+Z to undo with a German layout"
key ctrl+y
session redone.json '"frames": "20"' || fail "Ctrl+Y to redo with a German layout"

setxkbmap fr
key ctrl+a
session french.json '"frames": "20"' || fail "Ctrl+A to do nothing with a French layout"
key ctrl+z
session undone.json '"frames": "30"' || fail "Ctrl+Z to undo with a French layout"
sleep 1.5 # digits choose nothing right after a text field
key ampersand
session first.json '"method": "gpo"' || fail "the key of 1 to choose the first method without Shift"
key eacute
session digit.json '"method": "gpo"' || fail "a digit right after a text field to choose nothing"
sleep 1.5
key eacute
session second.json '"method": "gpo"' && fail "the key of 2 to choose the second method without Shift"
quit
