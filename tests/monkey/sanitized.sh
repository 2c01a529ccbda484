#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# The monkey under the address sanitizer: builds it in a tree of its own and lets it play for so many
# turns with each seed.
#   tests/monkey/sanitized.sh [TURNS] [SEED...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
turns=${1:-400}
shift $(($# > 0 ? 1 : 0))
cmake --preset asan > /dev/null
cmake --build --preset asan --target monkey_tests | tail -n 1
export LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe
# What grows is measured by the monkey itself; what libraries keep at the end is not ours.
export ASAN_OPTIONS=detect_leaks=0:quarantine_size_mb=16
for seed in "${@:-1}"; do
  GPO_MONKEY_TURNS=$turns GPO_MONKEY_SEED=$seed build/asan/tests/monkey_tests --gtest_brief=1
done
