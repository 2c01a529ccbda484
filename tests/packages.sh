#!/usr/bin/env bash
# Builds the Debian packages, installs them and uses them outside of the source tree: program, C++ examples,
# Python. Changes the machine, so run it in a container or virtual machine.
#   tests/packages.sh [FOLDER]   tests the packages in FOLDER; default: builds them
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$here/.ci/install.sh"
given=${1:+$(realpath "$1")}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
install_packages lintian file dpkg-dev
if [ -n "$given" ]; then
  cp "$given"/*.deb .
else
  install_packages "${build_packages[@]}" "${python_packages[@]}"
  (cd "$here" && cmake --preset package && cmake --build --preset package)
  cpack --config "$here/build/package/CPackConfig.cmake"
fi
lintian --fail-on error ./*.deb
apt-get install -y --no-install-recommends ./*.deb >apt.log || { tail -n 20 apt.log; exit 1; }

echo "== program"
desk=/usr/share/gpo-inspector/sequences/desk
gpo-inspector --version
gpo-inspector run "$desk"
gpo-inspector snapshot "$desk" --view image --output image.png
gpo-inspector snapshot "$desk" --view window --output window.png
test -s image.png && test -s window.png
gunzip -c /usr/share/man/man1/gpo-inspector.1.gz | head -n 1
for file in applications/gpo-inspector.desktop icons/hicolor/scalable/apps/gpo-inspector.svg mime/packages/gpo-inspector.xml \
  bash-completion/completions/gpo-inspector zsh/vendor-completions/_gpo-inspector; do
  test -e "/usr/share/$file" || { echo "missing: $file"; exit 1; }
done
! dpkg-deb -f gpo-inspector_*.deb Depends | grep -e '-dev' || { echo "the program needs no headers"; exit 1; }

echo "== C++"
install_packages g++ cmake ninja-build
cmake -S /usr/share/doc/libgpo-dev/examples -B examples -G Ninja
cmake --build examples
awk 'BEGIN { for (i = 0; i < 12; ++i) for (j = 0; j < 60; ++j) {
  x = (j % 10 - 4.5) / 5 - 0.05 * i; y = (int(j / 10) - 2.5) / 3 - 0.01 * i; z = 2 - 0.02 * i
  printf "%d,%d,%.9f,%.9f\n", i, j, 500 * x / z + 320, 500 * y / z + 240 } }' >tracks.csv
examples/tracks_to_pose tracks.csv 500 500 320 240

echo "== Python"
install_packages python3-pytest python3-opencv python3-numpy
GPO_PROGRAM=/usr/bin/gpo-inspector PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m pytest -q -p no:cacheprovider "$here/tests/python"
if [ -z "$given" ]; then
  echo "== pip"
  install_packages python3-pip python3-venv mypy python3-typeshed
  GPO_PROGRAM=/usr/bin/gpo-inspector "$here/tests/python/installed.sh" "$here/build/package"
fi
echo "packages: ok"
