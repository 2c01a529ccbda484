#!/bin/bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs a command with its own display and exits with the exit code of the command:
#   with_display.sh WIDTHxHEIGHT COMMAND...
# Xvfb chooses the display number itself, because two `xvfb-run -a` started together may choose the same one.
# With -noreset it does not refuse a program that connects just after the last other client has left.
set -u
size=$1
shift
folder=$(mktemp -d)
mkfifo "$folder/number"
Xvfb -displayfd 3 -screen 0 "${size}x24" -nolisten tcp -noreset 3> "$folder/number" > "$folder/log" 2>&1 &
server=$!
trap 'kill "$server" 2> /dev/null; wait "$server"; rm -rf "$folder"' EXIT
if ! read -r number < "$folder/number"; then
  echo "Xvfb did not start:" >&2
  cat "$folder/log" >&2
  exit 1
fi
unset WAYLAND_DISPLAY XAUTHORITY
DISPLAY=:$number "$@"
