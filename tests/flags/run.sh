#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Links a program to the installed library, static and shared, by pkg-config, with compiler flags that change
# Eigen's alignment, and runs it.
#   tests/flags/run.sh FOLDER   folder for builds and installations
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$1" && cd "$1"
flags=("-O0" "-O3 -march=native" "-O1 -fsanitize=address,undefined" "-O2 -march=native -fsanitize=address")
for extension in avx "avx2 -mfma" avx512f; do
  if grep -qw "${extension%% *}" /proc/cpuinfo; then flags+=("-O2 -m$extension"); fi
done

for shared in OFF ON; do
  prefix=$PWD/shared-$shared
  cmake -S "$here" -B "build-$shared" -G Ninja -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DGPO_UI=OFF -DGPO_TESTS=OFF \
    -DGPO_COMPONENTS='core;frontend' -DBUILD_SHARED_LIBS=$shared >/dev/null
  cmake --build "build-$shared" --parallel "${JOBS:-$(nproc)}"
  cmake --install "build-$shared" --prefix "$prefix" >/dev/null
  PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name gpo.pc)")
  export PKG_CONFIG_PATH
  cflags=$(pkg-config --cflags gpo)
  libs=$(pkg-config --libs gpo)
  for flag in "${flags[@]}"; do
    g++ -std=c++20 $flag "$here/tests/flags/flags.cpp" -o flags $cflags $libs -Wl,-rpath,"$(pkg-config --variable=libdir gpo)"
    ./flags || { echo "fails with shared $shared, $flag"; exit 1; }
  done
  if g++ -std=c++20 -march=native -fsyntax-only $(pkg-config --cflags-only-I gpo) "$here/tests/flags/flags.cpp" 2>message; then
    echo "compiles with another alignment"; exit 1
  fi
  grep -q "Eigen's alignment differs" message
done
