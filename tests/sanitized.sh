#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the tests with clang++ and sanitizers and runs them: all with the address and undefined-behavior
# sanitizers, those that start threads with the thread sanitizer.
#   tests/sanitized.sh                      runs both
#   tests/sanitized.sh asan|tsan ARGS...    runs one of them; ARGS go to ctest, e.g. -R Worker
# JOBS=n sets the number of parallel jobs (default: number of processors). Any report fails its test.
# tests/sanitizers has suppressions for third-party libraries, each with its reason.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source .ci/install.sh
install_packages "${build_packages[@]}" "${python_packages[@]}" "${test_packages[@]}" "${sanitizer_packages[@]}"
jobs=${JOBS:-$(nproc)}
unreported=$PWD/tests/sanitizers

# Excludes tests that build or start programs without sanitizers: ./run.sh, the engine alone, the installed
# library, the Python module.
elsewhere='^(EngineAlone\.|Python\.|(Readme|RunScript|Install|Library)$)'
# Tests that start threads or processes: worker, survey, evaluation, caches, calibration, synthesis, window, live
# initialization, own methods.
threads='^(View|Initialize|Engine|ChildProcess|FolderLister)$|RealWindow|Images(Reader|Ahead)|Worker|Survey|Runner|Evaluat|Cache|Calibrat|BoardTruth|Synthes|Renderer|OutputFile|Fetch|WaitingImage|Movie|Monkey|LiveInitializer|LiveHost|BackgroundJob|InTheBackground|CommandMethod'

export LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe
# The quarantine must stay below the memory limit of the monkey test. intercept_tls_get_addr=0 avoids invalid reads
# of the leak sanitizer of clang 14, which guesses the location of thread-local memory.
export ASAN_OPTIONS=detect_leaks=1:quarantine_size_mb=64:intercept_tls_get_addr=0
export LSAN_OPTIONS=print_suppressions=0:suppressions=$unreported/lsan.supp
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export TSAN_OPTIONS=halt_on_error=1:suppressions=$unreported/tsan.supp

# The memory layout of the thread sanitizer leaves little room for randomized addresses.
fixed_addresses() {
  if setarch "$(uname -m)" -R true 2>/dev/null; then setarch "$(uname -m)" -R "$@"; else "$@"; fi
}
# run PRESET ARGS... builds and runs the tests of a preset.
run() {
  local preset=$1
  shift
  cmake --preset "$preset"
  cmake --build --preset "$preset" --parallel "$jobs" \
    --target engine_tests ui_tests monkey_tests fuzz_tests app_tests video_tests live_tests live_app_tests
  local preload=
  if [ "$preset" = asan ]; then
    preload=$PWD/build/asan/keep_loaded.so
    clang -shared -fPIC -o "$preload" tests/sanitizers/keep_loaded.c
  fi
  LD_PRELOAD=$preload fixed_addresses ctest --preset "$preset" -j "$jobs" -E "$elsewhere" "$@"
}

case ${1:-both} in
  asan) run "$@" ;;
  tsan) shift; run tsan -R "$threads" "$@" ;;
  both) run asan; run tsan -R "$threads" ;;
  *) sed -n '7,8p' "$0"; exit 2 ;;
esac
