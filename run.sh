#!/usr/bin/env bash
# Installs what is missing, builds, and starts gpo-inspector.
#   ./run.sh            the window on the bundled recording; without a display: pictures of it in out/
#   ./run.sh ARGS...    gpo-inspector ARGS
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/.ci/install.sh"
build_log="$here/build/release.log"

# Asking CMake costs more than the start itself: a program is current where no source is newer (pages
# are none). What ./test.sh built is as good as what is built here.
current_program() {
  local preset program
  for preset in release ci; do
    program="$here/build/$preset/app/gpo-inspector"
    [ -x "$program" ] || continue
    [ -z "$(cd "$here" && find -H CMakeLists.txt CMakePresets.json app engine ui assets -newer "$program" -type f ! -name '*.md' -print -quit)" ] || continue
    echo "$program"
    return
  done
}

build() {
  install_packages "${build_packages[@]}"
  mkdir -p "$here/build"
  echo "building; some minutes the first time (log: $build_log)" >&2
  if ! (cd "$here" && cmake --preset release && cmake --build --preset release) >"$build_log" 2>&1; then
    tail -n 30 "$build_log" >&2
    exit 1
  fi
  touch "$here/build/release/app/gpo-inspector"
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
