#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Kills the program (SIGKILL) at random moments while it writes, and checks that the next run gives the result of
# an undisturbed one and that no partial output is taken for a whole one.
#   tests/kills.sh PROGRAM [ROUNDS]    ROUNDS kills of each command, default: 25
set -euo pipefail
program=$(realpath "$1")
rounds=${2:-25}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME=$work/cache XDG_STATE_HOME=$work/state LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe

sed 's/count: [0-9]*/count: 6/; s/resolution: .*/resolution: [320, 240]/' sequences/orbit.yaml >"$work/small.yaml"
for ((i = 0; i < 500; ++i)); do printf 'save-session %s\n' "$work/out/session.json"; done >"$work/save.script"
mkdir "$work/images" # without a calibration: it is found in the images, and cached
find sequences/desk/mav0/cam0/data -name '*.jpg' | sort | head -12 | xargs cp -t "$work/images"

# Each command writes to $work/out, or to the cache.
commands=(
  "snapshot sequences/desk --script $work/save.script"
  "calibrate $work/images --from plane --output $work/out/camera.yaml"
  "run $work/images --calibrate auto --frames 10 --trajectory $work/out/images.txt"
  "convert sequences/desk --output $work/out/desk"
  "convert sequences/desk --output $work/out/desk.mcap"
  "synthesize $work/small.yaml --output $work/out/small"
  "evaluate sequences/desk --methods gpo,pnp --lengths 10 --starts 0:20:10 --output $work/out/experiment"
  "run $work/small.yaml --frames 6 --trajectory $work/out/run.txt --points $work/out/run.ply"
)

# Digest of all outputs, except for files with measured times and for unfinished ones of killed runs, which readers
# omit.
digest() {
  (cd "$work/out" && find . -mindepth 1 \( -name '*.partial*' -o -name '*.unfinished' \) -prune -o -type f \
    ! -path '*/windows/*' ! -name 'running_time*' ! -name results.csv ! -name summary.json -print0 | sort -z | xargs -0r sha256sum)
}

# Returns whether a file is there that an undisturbed run would not have written; evaluate continues its own.
torn() {
  [[ $command != evaluate* ]] && [ -n "$(comm -13 <(sort <<<"$expected") <(digest | sort))" ]
}

fresh() { rm -rf "$work/out" "$work/cache" && mkdir -p "$work/out"; }

failed=0
for command in "${commands[@]}"; do
  read -ra words <<<"$command"
  fresh
  begin=$(date +%s%N)
  "$program" "${words[@]}" >"$work/log" 2>&1
  length_ms=$((($(date +%s%N) - begin) / 1000000))
  expected=$(digest)
  killed=0
  for ((i = 0; i < rounds; ++i)); do
    fresh
    "$program" "${words[@]}" >"$work/log" 2>&1 &
    pid=$!
    sleep "$(printf '%d.%03d' $((RANDOM % (length_ms + 1) / 1000)) $((RANDOM % 1000 * (length_ms < 1000 ? length_ms : 1000) / 1000)))"
    kill -9 "$pid" 2>/dev/null && killed=$((killed + 1))
    wait "$pid" 2>/dev/null || true
    if torn; then
      echo "FAILED: a partial output after a kill: $command"
      failed=1
    fi
    # A finished output stays; only what evaluate resumes may exist already.
    [[ $command = convert* || $command = synthesize* ]] && rm -rf "${words[-1]}"
    if ! "$program" "${words[@]}" >"$work/log" 2>&1 || [ "$(digest)" != "$expected" ]; then
      echo "FAILED after a kill: $command"
      tail -3 "$work/log"
      failed=1
      break
    fi
  done
  echo "${words[0]} ${words[-1]##*/}: $killed kills"
done
exit "$failed"
