#!/usr/bin/env bash
# Installs missing packages, builds and starts gpo-inspector.
#   ./run.sh            opens the bundled recording; without a display writes images of it to out/
#   ./run.sh ARGS...    runs gpo-inspector ARGS
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/.ci/install.sh"
build_log="$here/build/release.log"

# Prints the path of an up-to-date program of ./run.sh or ./test.sh: no source is newer than it. Asking CMake
# would take longer than starting the program.
current_program() {
  local preset program whole
  for preset in release ci; do
    program="$here/build/$preset/app/gpo-inspector"
    whole="$here/build/$preset/libexec/gpo-inspector/gpo-inspector"  # linked after a change of any module
    [ -x "$program" ] && [ -x "$whole" ] || continue
    [ -z "$(cd "$here" && find -H CMakeLists.txt CMakePresets.json app engine ui assets -newer "$whole" -type f ! -name '*.md' -print -quit)" ] || continue
    echo "$program"
    return
  done
}

build() {
  install_packages "${build_packages[@]}"
  mkdir -p "$here/build"
  echo "building, which takes some minutes the first time (log: $build_log)" >&2
  if ! (cd "$here" && cmake --preset release && cmake --build --preset release --parallel "$(nproc)") >"$build_log" 2>&1; then
    tail -n 30 "$build_log" >&2
    exit 1
  fi
  touch "$here/build/release/libexec/gpo-inspector/gpo-inspector"
}

program=$(current_program)
if [ -z "$program" ]; then
  build
  program=$(current_program)
fi

if [ $# -gt 0 ]; then exec "$program" "$@"; fi
desk="$here/sequences/desk"
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then exec "$program" view "$desk"; fi

out="$here/out"
mkdir -p "$out"
"$program" run "$desk"
for view in image scene window; do
  "$program" snapshot "$desk" --view "$view" --output "$out/$view.png" >/dev/null
done
echo "no display: image.png, scene.png and window.png are in $out"
