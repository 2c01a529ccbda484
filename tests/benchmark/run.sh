#!/usr/bin/env bash
# Installs missing packages, builds, measures, and prints the tables of README.md. Takes minutes, best on an idle
# machine. tests/benchmark/run.sh ARGS... passes ARGS to Google Benchmark.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$here/.ci/install.sh"
install_packages "${build_packages[@]}" "${benchmark_packages[@]}"
cd "$here"
{ cmake --preset benchmark && cmake --build --preset benchmark --target benchmarks; } >&2
# Views are measured without graphics hardware.
export LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe
exec build/benchmark/tests/benchmark/benchmarks "$@"
