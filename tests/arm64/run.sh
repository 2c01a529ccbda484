#!/usr/bin/env bash
# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Cross-compiles gpo::core and its tests for arm64 and runs them with qemu. Debian's packages for arm64 are unpacked
# into a folder, because they cannot be installed next to those of this machine.
#   tests/arm64/run.sh FOLDER [ARGS of GoogleTest...]   folder for packages and objects
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
mkdir -p "$1"
folder=$(realpath "$1")
shift
sysroot=$folder/sysroot
libraries=$sysroot/usr/lib/aarch64-linux-gnu

# Without the packages of this machine in `status`, apt also downloads the C and C++ libraries.
fetch_packages() {
  local apt=$folder/apt
  mkdir -p "$apt/lists/partial" "$apt/archives/partial"
  : >"$apt/status"
  local options=(-o APT::Architecture=arm64 -o APT::Architectures=arm64 -o "Dir::State::lists=$apt/lists"
    -o "Dir::State::status=$apt/status" -o "Dir::Cache=$apt" -o APT::Sandbox::User=root)
  apt-get -q "${options[@]}" update
  apt-get -q "${options[@]}" install -y --no-install-recommends --download-only \
    libceres-dev libeigen3-dev libfmt-dev libgtest-dev libgmock-dev
  local package
  for package in "$apt"/archives/*.deb; do dpkg -x "$package" "$sysroot"; done
  # libm.so names its target from the root.
  find "$sysroot" -type l -lname '/*' -exec bash -c 'ln -sfn "$1$(readlink "$2")" "$2"' _ "$sysroot" {} \;
}
if [ ! -e "$libraries/libceres.so" ]; then fetch_packages; fi

# The tests that include nothing but core: names of files whose includes, followed, stay in its folders, and so do
# the sources of their headers.
core=(base geometry window methods inertial truth evaluation diagnosis)
core_tests() {
  python3 - "$here" "${core[@]}" <<'PYTHON'
import pathlib, re, sys
root, core = pathlib.Path(sys.argv[1]), tuple(f"engine/{name}/" for name in sys.argv[2:]) + ("tests/",)
def needs_only_core(name, seen):
    if name in seen:
        return True
    seen.add(name)
    if not name.startswith(core):
        return False
    text = (root / name).read_text()
    source = name.removesuffix(".h") + ".cpp"
    if name.startswith("tests/") and (root / source).exists() and not needs_only_core(source, seen):
        return False  # its functions would be undefined
    return not re.search("#include <(opencv2|nlohmann|libav)", text) and all(
        needs_only_core(other, seen) for other in re.findall('#include "((?:engine|tests|ui|app)/[^"]+)"', text))
for path in sorted(root.glob("tests/engine/**/*.cpp")):
    name = str(path.relative_to(root))
    if needs_only_core(name, set()):
        print(name)
PYTHON
}

compile() {
  mkdir -p "objects/$(dirname "$1")"
  aarch64-linux-gnu-g++ -std=c++20 -O2 -Wall -Wextra -Werror -Wno-psabi $ccflags -c "$here/$1" -o "objects/$1.o"
}
export -f compile
export here ccflags="--sysroot=$sysroot -I$here -isystem $sysroot/usr/include/eigen3"
cd "$folder"
{ (cd "$here" && find "${core[@]/#/engine/}" -name '*.cpp'); core_tests; } >sources
xargs -P "${JOBS:-$(nproc)}" -I{} bash -c 'compile {}' <sources
aarch64-linux-gnu-g++ --sysroot="$sysroot" $(sed 's|.*|objects/&.o|' sources) -o core_tests -L"$libraries" \
  -Wl,-rpath-link,"$libraries:$libraries/atlas:$libraries/blas:$libraries/lapack" \
  -lgmock_main -lgmock -lgtest -lceres -lglog -lfmt
qemu-aarch64 -L "$sysroot" -E LD_LIBRARY_PATH="$libraries:$libraries/atlas" ./core_tests "$@"
