#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Runs the tests that are too slow for ./test.sh. Prints one line for each part: its name, the result (passed,
# failed or skipped with a reason) and the time.
#   tests/nightly.sh            runs all parts
#   tests/nightly.sh PART...    runs these parts in this order
# Parts:
#   clone       ./test.sh in a clone of the last commit with nothing beside it, as a new user has it
#   fuzz        builds tests/fuzz under libFuzzer and mutates the inputs of each parser
#   asan        all tests with the address and undefined-behavior sanitizers
#   tsan        the tests that start threads, with the thread sanitizer
#   monkey      many random inputs to the window
#   first-steps a stranger's first steps in the real window, by mouse and keyboard
#   hostile     opens small files that ask for much, with limits for memory and time, and simulates a live hour
#   kills       kills the program while it writes
#   interrupts  stops each command and the window with signals
#   nine        all nine rendered recordings with every method, conversions of all cases, halves of calibrations
#   browser     opens a report in Chromium and turns its scene by the mouse
#   gcc         builds with GCC, the others use clang, with warnings as errors, and runs all tests
#   flags       links a program to the library with compiler flags that change Eigen's alignment
#   exports     COLMAP, assimp, Blender and Foxglove's reader read our exports and compute the same numbers
#   headers     compiles each header of the engine alone
#   packages    builds, installs and uses the Debian packages; needs root and changes the machine
#   arm64       runs the tests of gpo::core for arm64 with qemu
# JOBS=n sets the number of parallel jobs (default: number of processors). Logs are in build/nightly/PART.log.
# Exits with 1 if a part failed.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source .ci/install.sh
export JOBS=${JOBS:-$(nproc)} LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe
all=(clone nine monkey first-steps hostile kills interrupts browser fuzz asan tsan gcc flags exports headers arm64 packages)
logs=$PWD/build/nightly
kSkipped=77

# skip REASON ends the part.
skip() { echo "$1" >"$logs/reason"; exit "$kSkipped"; }

# Builds the same as ./test.sh.
build_ci() {
  cmake --preset ci && cmake --build --preset ci --parallel "$JOBS"
}

# Targets and numbers of mutations, about a minute each.
mutations="answer 100000  bag 15000  calibration 50000  experiment 25000  library 1500  logs 50000  message 100000  picture 100000
  poses 100000  recipe 30000  recording 2500  results 75000  script 25000  session 50000  sidecars 50000  tables 150000
  video 10000"

# Uncommitted changes are not tested.
clone() {
  git rev-parse --verify -q HEAD || skip "these sources are not a git repository"
  local folder status=0
  folder=$(mktemp -d) && git clone --depth 1 "file://$PWD" "$folder/gpo-inspector" || return 1
  "$folder/gpo-inspector/test.sh" || status=$?
  rm -rf "$folder"
  return "$status"
}

fuzz() {
  install_packages "${build_packages[@]}" "${sanitizer_packages[@]}"
  cmake --preset fuzz && cmake --build --preset fuzz --parallel "$JOBS" || return 1
  XDG_CACHE_HOME=$PWD/build/fuzz/cache xargs -P "$JOBS" -n 2 bash -c 'fuzz_target "$@"' _ <<<"$mutations"
}
fuzz_target() {
  local target=$1 runs=$2 inputs=("tests/fuzz/seeds/$1") corpus=build/fuzz/corpus/$1
  [ -d "tests/fuzz/crashes/$target" ] && inputs+=("tests/fuzz/crashes/$target")
  mkdir -p "$corpus"
  # A small quarantine, so that freed memory does not count towards the memory limit of a parser.
  GPO_FUZZ_TARGET=$target ASAN_OPTIONS=quarantine_size_mb=64 build/fuzz/tests/fuzz/fuzz_parsers \
    -rss_limit_mb=1024 -timeout=60 -runs="$runs" -max_len=4096 -artifact_prefix="build/nightly/$target-" \
    "$corpus" "${inputs[@]}" && return
  echo "FAILED: fuzz target $target"
  return 1
}
export -f fuzz_target

asan() { tests/sanitized.sh asan; }
tsan() { tests/sanitized.sh tsan; }

monkey() {
  install_packages "${build_packages[@]}" "${test_packages[@]}"
  build_ci || return 1
  local seed
  for seed in 1 2 3; do
    XDG_CACHE_HOME=$PWD/build/ci/test-output/cache GPO_MONKEY_SEED=$seed GPO_MONKEY_TURNS=5000 build/ci/tests/monkey_tests || return 1
  done
}

first-steps() {
  install_packages "${build_packages[@]}" "${test_packages[@]}"
  build_ci || return 1
  local folder=$logs/first-steps here=$PWD
  rm -rf "$folder" && mkdir -p "$folder" && cd "$folder" || return 1
  "$here/tests/with_display.sh" 1280x720 "$here/tests/app/stranger_window.sh" "$here/build/ci/app/gpo-inspector"
}

# Without these programs, as in ./test.sh, the tests are skipped.
exports() {
  install_packages "${build_packages[@]}" "${test_packages[@]}" "${export_packages[@]}"
  build_ci || return 1
  local log=build/nightly/exports.txt
  ctest --test-dir build/ci --verbose -R '^(ColmapExport|GltfExport)$' | tee "$log"
  [ "${PIPESTATUS[0]}" -eq 0 ] && ! grep -q 'SKIPPED' "$log" && foxglove
}
foxglove() {
  local folder=$PWD/build/nightly/foxglove
  command -v npm >/dev/null || install_packages npm
  rm -rf "$folder" && mkdir -p "$folder" && cp tests/engine/exports/foxglove_messages.mjs "$folder" || return 1
  build/ci/app/gpo-inspector run sequences/desk --export foxglove="$folder/desk.mcap" &&
    npm install --prefix "$folder" @mcap/core @mcap/nodejs @mcap/support @foxglove/schemas ajv &&
    node "$folder/foxglove_messages.mjs" "$folder/desk.mcap"
}

nine() {
  install_packages "${build_packages[@]}" "${test_packages[@]}"
  build_ci || return 1
  GPO_ALL_RECORDINGS=1 ctest --test-dir build/ci --output-on-failure -R 'NineRecordings|NineUncertainties|RealRooms|LiveRecordings|FilesOfPeople|HeldOutHalves'
}

hostile() {
  install_packages "${build_packages[@]}" "${test_packages[@]}"
  build_ci || return 1
  XDG_CACHE_HOME=$PWD/build/ci/test-output/cache GPO_HOSTILE=1 build/ci/tests/app_tests --gtest_filter='HostileSizes.*' &&
    GPO_LIVE_FRAMES=108000 build/ci/tests/engine_tests --gtest_filter='LiveHour.*'
}

kills() {
  install_packages "${build_packages[@]}"
  build_ci && tests/kills.sh build/ci/app/gpo-inspector
}

interrupts() {
  install_packages "${build_packages[@]}" "${test_packages[@]}"
  build_ci && tests/interrupts.sh build/ci/app/gpo-inspector
}

browser() {
  install_packages "${build_packages[@]}" "${test_packages[@]}" "${nightly_packages[@]}"
  build_ci || return 1
  ctest --test-dir build/ci --output-on-failure -R ReportInChromium
}

# Readme and RunScript start the program of ./test.sh.
gcc() {
  install_packages "${build_packages[@]}" "${python_packages[@]}" "${test_packages[@]}"
  cmake --preset ci -B build/gcc -DCMAKE_C_COMPILER=gcc -DCMAKE_CXX_COMPILER=g++ &&
    cmake --build build/gcc --parallel "$JOBS" &&
    ctest --test-dir build/gcc --output-on-failure -j "$((JOBS + 1))" -E '^(Readme|RunScript)$'
}

flags() {
  install_packages "${build_packages[@]}" g++
  tests/flags/run.sh build/nightly/flags
}

headers() {
  install_packages "${build_packages[@]}" g++
  find engine -name '*.h' ! -path 'engine/examples/*' -print0 | xargs -0 -P "$JOBS" -I{} sh -c \
    'echo "#include \"{}\"" | g++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only -I. \
      -isystem /usr/include/eigen3 -isystem /usr/include/opencv4 -x c++ - || { echo "FAILED: {}"; exit 1; }'
}

packages() {
  [ "$(id -u)" = 0 ] || skip "installing packages needs root"
  tests/packages.sh
}

# Runs the tests of gpo::core, and compiles the frontend: OpenCV's headers are the same on all architectures.
arm64() {
  [ "$(uname -m)" = aarch64 ] && skip "this machine is arm64; the other parts test it"
  install_packages "${build_packages[@]}" g++-aarch64-linux-gnu qemu-user
  local folder=build/nightly/arm64
  tests/arm64/run.sh "$folder" || return 1
  mkdir -p "$folder/include" && ln -sfn /usr/include/opengv "$folder/include/opengv"
  find engine/tracking engine/planes engine/rotations engine/pipeline -name '*.cpp' -print0 |
    xargs -0 -P "$JOBS" -n 1 aarch64-linux-gnu-g++ -std=c++20 -O2 -Wall -Wextra -Werror -Wno-psabi --sysroot="$folder/sysroot" \
      -I. -isystem "$folder/sysroot/usr/include/eigen3" -isystem /usr/include/opencv4 -isystem "$folder/include" -S -o /dev/null
}

mkdir -p "$logs"
parts=("$@")
[ $# -gt 0 ] || parts=("${all[@]}")
for part in "${parts[@]}"; do
  [[ " ${all[*]} " = *" $part "* ]] || { echo "unknown part '$part', expected one of ${all[*]}" >&2; exit 2; }
done
failed=0
for part in "${parts[@]}"; do
  begin=$SECONDS
  : >"$logs/reason"
  ("$part") >"$logs/$part.log" 2>&1
  case $? in
    0) result=passed ;;
    "$kSkipped") result="skipped ($(cat "$logs/reason"))" ;;
    *) result="failed (see build/nightly/$part.log)"; failed=1 ;;
  esac
  printf '%-10s %s, %d s\n' "$part" "$result" $((SECONDS - begin))
done
exit "$failed"
