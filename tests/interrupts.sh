#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sends SIGINT and SIGTERM to each command at random moments. It must end within a second, say that it stopped, exit
# with 1 and leave no unfinished file. Closes the window likewise. If more processes run than the machine has
# processors, each gets its share of time only, and the second is longer by that factor.
#   tests/interrupts.sh PROGRAM [ROUNDS]    ROUNDS signals for each command, default: 10
set -euo pipefail
program=$(realpath "$1")
rounds=${2:-10}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export XDG_CACHE_HOME=$work/cache XDG_STATE_HOME=$work/state LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe

# Large inputs, 0.7 GB: 30,000 frames of video, 50,000 images, tables of 60 to 120 MB, a bag. Each in its own folder:
# a video reads the files beside it.
/usr/bin/python3 - "$work" <<'EOF'
import cv2, numpy, os, struct, sys
work = sys.argv[1]
def rows(name, head, row, megabytes):
    os.makedirs(os.path.dirname(name), exist_ok=True)
    with open(name, "w") as file:
        file.write(head)
        i = 0
        while file.tell() < megabytes << 20:
            file.write("".join(row(i + k) for k in range(1000)))
            i += 1000
camera = "resolution: [640, 480]\nintrinsics: [500, 500, 320, 240]\ndistortion_model: none\n"
rows(work + "/tracks/tracks.csv", "frame,track,x,y\n", lambda i: f"{i // 100},{i},{i % 640}.25,{i % 480}.5\n", 60)
open(work + "/tracks/camera.yaml", "w").write(camera)
rows(work + "/logged/gyro.csv", "t,x,y,z\n", lambda i: f"{0.001 * i:.3f},0.{i % 97},0.{i % 89},0.1\n", 60)
open(work + "/logged/camera.yaml", "w").write(camera)
open(work + "/logged/tracks.csv", "w").write("frame,track,x,y\n0,1,2,3\n1,1,2,3\n")
rows(work + "/path.txt", "", lambda i: f"{0.001 * i:.3f} {i % 7} 0 0 0 0 0 1\n", 120)
euroc = work + "/euroc/mav0/cam0"
os.makedirs(euroc + "/data")
open(euroc + "/sensor.yaml", "w").write(camera)
image = open("sequences/desk/mav0/cam0/data/" + sorted(os.listdir("sequences/desk/mav0/cam0/data"))[0], "rb").read()
open(work + "/one", "wb").write(image)
with open(euroc + "/data.csv", "w") as file:
    for i in range(50000):
        name = f"{1000000000 + 33333333 * i}.jpg"
        os.link(work + "/one", f"{euroc}/data/{name}")
        file.write(f"{name[:-4]},{name}\n")
def chunk(kind, data):
    return kind + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)
def listed(kind, data):
    return chunk(b"LIST", kind + data)
def video(name, images, count):  # Motion JPEG in AVI; an encoder would take half a minute
    height, width = images[0].shape[:2]
    jpegs = [chunk(b"00dc", cv2.imencode(".jpg", one, [cv2.IMWRITE_JPEG_QUALITY, 40])[1].tobytes()) for one in images]
    most = max(map(len, jpegs))
    main = struct.pack("<14I", 33333, 30 * most, 0, 0x10, count, 0, 1, most, width, height, 0, 0, 0, 0)
    stream = b"vidsMJPG" + struct.pack("<10I4H", 0, 0, 0, 1, 30, 0, count, most, 10000, 0, 0, 0, width, height)
    format = struct.pack("<IiiHH4s5I", 40, width, height, 1, 24, b"MJPG", width * height * 3, 0, 0, 0, 0)
    head = listed(b"hdrl", chunk(b"avih", main) + listed(b"strl", chunk(b"strh", stream) + chunk(b"strf", format)))
    index, at = [], 4
    for i in range(count):
        size = len(jpegs[i % len(jpegs)])
        index.append(b"00dc" + struct.pack("<3I", 16, at, size - 8))
        at += size
    frames = b"".join(jpegs[i % len(jpegs)] for i in range(count))
    open(name, "wb").write(chunk(b"RIFF", b"AVI " + head + listed(b"movi", frames) + chunk(b"idx1", b"".join(index))))
os.makedirs(work + "/video")
noise = [numpy.random.RandomState(i).randint(0, 255, (24, 32, 3), numpy.uint8) for i in range(4)]
video(work + "/video/video.avi", [cv2.resize(one, (320, 240)) for one in noise], 30000)
EOF
mkdir "$work/bag" "$work/recipe"
"$program" convert sequences/desk --output "$work/bag/desk.bag" 2>"$work/log" >&2
sed 's/count: [0-9]*/count: 6/' sequences/orbit.yaml >"$work/recipe/small.yaml"
printf 'select none\nexport-video %s\n' "$work/out/cube.mp4" >"$work/movie.script"

commands=(
  "info $work/video/video.avi"
  "info $work/tracks"
  "info $work/logged"
  "info $work/euroc"
  "run sequences/desk --frames 30"
  "run sequences/desk --method other --result other=$work/path.txt"
  "run sequences/desk --scan $work/out/scan.csv"
  "snapshot sequences/desk --view compare --output $work/out/compare.png"
  "snapshot sequences/desk --script $work/movie.script"
  "convert $work/bag/desk.bag --output $work/out/desk"
  "convert $work/video/video.avi --output $work/out/video.mcap"
  "synthesize $work/recipe/small.yaml --output $work/out/small"
  "evaluate sequences/desk --methods gpo,pnp --lengths 10 --starts 0:20:10 --output $work/out/experiment"
  "calibrate sequences/desk --output $work/out/camera.yaml"
  "calibrate $work/video/video.avi --board 9x6 --square 0.02 --output $work/out/camera.yaml"
  "calibrate $work/video/video.avi --from plane --output $work/out/camera.yaml"
  "calibrate sequences/desk --gyroscope --output $work/out/gyroscope.yaml"
)

failed=0
first='' # another process, whose files are unfinished
fail() { echo "FAILED: $*"; tail -2 "$work/log"; failed=1; }
now_ms() { echo $(($(date +%s%N) / 1000000)); }
limit_ms() { awk -v of="$(nproc)" '{ print int(1000 * ($1 > of ? $1 / of : 1)) }' /proc/loadavg; }
pause() { sleep "$(printf '%d.%03d' $(($1 / 1000)) $(($1 % 1000)))"; }
fresh() { rm -rf "$work/out" "$work/cache" && mkdir -p "$work/out"; }
unfinished() { find "$work/out" "$work/cache" -name '*.partial*' -o -name '*.unfinished' 2>/dev/null; }

# start WORD... runs the program, whose process is $pid. A script's background processes would ignore SIGINT.
start() {
  env --default-signal=INT "$program" "$@" >"$work/log" 2>&1 &
  pid=$!
}

# check COMMAND SIGNAL CODE: the process ends within a second of the signal, with 0 if it was done, else with CODE. A
# signal before the first line of the program's code ends it at once.
check() {
  local command=$1 signal=$2 code=$3 begin ended result=0
  kill -0 "$pid" 2>/dev/null || { wait "$pid" || true; return 0; }
  begin=$(now_ms)
  kill -"$signal" "$pid" 2>/dev/null || true
  wait "$pid" || result=$?
  ended=$(($(now_ms) - begin))
  [ "$ended" -gt "$slowest" ] && slowest=$ended
  [ "$ended" -le "$(limit_ms)" ] || fail "$ended ms after SIG$signal: $command"
  [ "$result" -gt 128 ] && [ ! -s "$work/log" ] && [ -z "$(ls "$work/out")" ] && return
  [ "$result" = 0 ] || [ "$result" = "$code" ] || fail "exit code $result after SIG$signal: $command"
  [ "$result" != 1 ] || grep -q stopped "$work/log" || fail "no reason after SIG$signal: $command"
  [ -n "$first" ] || [ -z "$(unfinished)" ] || fail "unfinished files after SIG$signal: $command: $(unfinished)"
}

for command in "${commands[@]}"; do
  read -ra words <<<"$command"
  fresh
  begin=$(now_ms)
  timeout 20 "$program" "${words[@]}" >"$work/log" 2>&1 || true
  length_ms=$(($(now_ms) - begin))
  slowest=0
  for ((i = 0; i < rounds; ++i)); do
    fresh
    start "${words[@]}"
    pause $((RANDOM * 32768 % (length_ms + 1) + RANDOM % 50))
    check "$command" "$([ $((i % 2)) = 0 ] && echo INT || echo TERM)" 1
  done
  echo "${words[0]} ${words[1]##*/}: at most $slowest ms"
done

# A signal after the output, while the program exits: the work is done.
for ((i = 0; i < 6 * rounds; ++i)); do
  result=0
  : >"$work/log"  # the last one's would send the signal before the program's first line
  start run sequences/desk --frames 30
  until [ -s "$work/log" ] || ! kill -0 "$pid" 2>/dev/null; do sleep 0.002; done
  kill -TERM "$pid" 2>/dev/null || true
  wait "$pid" || result=$?
  [ "$result" = 0 ] || fail "exit code $result after SIGTERM at the exit of run"
done

# A second process that waits for the same recipe.
fresh
start info sequences/orbit.yaml
first=$pid
pause 300
slowest=0
start info sequences/orbit.yaml
pause 400
check "info orbit.yaml, waiting" INT 1
kill -INT "$first" && wait "$first" || true
first=''

# A pipe never ends.
mkfifo "$work/pipe.mp4" "$work/pipe.csv" "$work/pipe.yaml" "$work/pipe.mcap"
for file in "$work"/pipe.*; do
  result=0
  timeout 5 "$program" info "$file" >"$work/log" 2>&1 || result=$?
  [ "$result" = 2 ] || fail "exit code $result for a pipe: $file"
done

# Closes the window while it opens, computes and studies.
export work program
if command -v Xvfb >/dev/null; then
  for ((i = 0; i < rounds; ++i)); do
    for recording in sequences/desk "$work/video/video.avi" "$work/tracks" sequences/orbit.yaml; do
      tests/with_display.sh 1280x800 bash -c '
        env --default-signal=INT "$program" view "$0" >"$work/log" 2>&1 &
        pid=$!
        sleep "$1"
        begin=$(date +%s%N)
        kill -INT "$pid" 2>/dev/null
        wait "$pid"
        echo $((($(date +%s%N) - begin) / 1000000)) >"$work/ended"
      ' "$recording" "$((RANDOM % 4)).$((RANDOM % 9))"
      [ "$(cat "$work/ended")" -le "$(limit_ms)" ] || fail "$(cat "$work/ended") ms to close the window with $recording"
    done
  done
  echo "view: closed $((4 * rounds)) times"
fi
exit "$failed"
