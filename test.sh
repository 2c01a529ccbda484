#!/usr/bin/env bash
# Installs missing packages, builds with warnings as errors and runs all tests except those of
# tests/nightly.sh. Prints CTest's summary and a line about skipped tests; exits with CTest's exit code.
#   ./test.sh ARGS...   passes ARGS to ctest, e.g. -R Gpo
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/.ci/install.sh"
install_packages "${build_packages[@]}" "${python_packages[@]}" "${test_packages[@]}"
cd "$here"
cmake --preset ci
# Ninja's default of two more is an eighth slower on two cores.
cmake --build --preset ci --parallel "$(nproc)"
# The baselines of the snapshots were made with llvmpipe.
export LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=llvmpipe
status=0
# One more than processors, because tests of windows and streams mostly wait.
ctest --test-dir build/ci --output-on-failure -j "$(($(nproc) + 1))" "$@" || status=$?
awk '/: Skipped$/ { getline reason; ++count[reason]; ++all }
  END { for (reason in count) text = text (text ? "; " : "") count[reason] " because " reason
        if (all) print "skipped " all " tests: " text }' build/ci/Testing/Temporary/LastTest.log
exit "$status"
