#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Builds the tests by clang++ with sanitizers and runs them: with the address and the undefined-behavior
# sanitizer all of them, with the thread sanitizer those that start threads.
#   tests/sanitized.sh                      one after the other
#   tests/sanitized.sh asan|tsan ARGS...    one of them; ARGS go to ctest, e.g. -R Worker
# JOBS=n builds and runs n at a time (else as many as there are processors). A test in which anything is
# reported fails. tests/sanitizers holds what is not reported: others' libraries, each with its reason.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source .ci/install.sh
install_packages "${build_packages[@]}" "${python_packages[@]}" "${test_packages[@]}" "${sanitizer_packages[@]}"
jobs=${JOBS:-$(nproc)}
unreported=$PWD/tests/sanitizers

# Tests that build or start something else than what is sanitized here: ./run.sh its own program, the engine alone,
# the installed library, the module for an interpreter that is not sanitized.
elsewhere='^(EngineAlone\.|Python\.|(Readme|RunScript|Install|Library)$)'
# What starts threads: worker, survey, evaluation, caches, calibration, synthesis, and the window with all of them,
# the front door's live form.
threads='^View$|RealWindow|Pictures(Reader|Ahead)|Worker|Survey|Runner|Evaluat|Cache|Calibrat|BoardTruth|Synthes|Renderer|OutputFile|Fetch|WaitingPicture|Movie|Monkey|LiveInitializer'

export LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe
# A quarantine below what the monkey may grow, and memory of threads that is not asked for where it lies: the leak
# sanitizer of clang 14 guesses that from an address alone and may read what is not there.
export ASAN_OPTIONS=detect_leaks=1:quarantine_size_mb=64:intercept_tls_get_addr=0
export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
export TSAN_OPTIONS=halt_on_error=1:suppressions=$unreported/tsan.supp

# The thread sanitizer's map of the memory leaves little room for addresses at random.
fixed_addresses() {
  if setarch "$(uname -m)" -R true 2>/dev/null; then setarch "$(uname -m)" -R "$@"; else "$@"; fi
}
# run PRESET ARGS...
run() {
  local preset=$1
  shift
  cmake --preset "$preset"
  cmake --build --preset "$preset" --parallel "$jobs" \
    --target engine_tests ui_tests monkey_tests fuzz_tests app_tests video_tests
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
