# Names of the required Debian packages and a function that installs missing ones. Sourced by run.sh,
# test.sh and tests/*.sh.

build_packages=(
  clang lld cmake ninja-build pkg-config
  libeigen3-dev libceres-dev libopencv-dev libopengv-dev libvtk9-dev
  libglfw3-dev libdecor-0-plugin-1-cairo libimgui-dev libcairo2-dev libstb-dev libglew-dev libgl-dev libegl-dev libgl1-mesa-dri libegl1
  libyaml-cpp-dev libtinyxml2-dev zlib1g-dev nlohmann-json3-dev libcli11-dev libfmt-dev
  libavformat-dev libavcodec-dev libavutil-dev libswscale-dev libavdevice-dev
  libpng-dev libjpeg-dev libbz2-dev liblz4-dev libzstd-dev libsqlite3-dev libexiv2-dev
)
python_packages=(python3-dev pybind11-dev python3-numpy)
test_packages=(
  g++  # compiles programs that link the installed library
  libgtest-dev libgmock-dev xvfb xdotool imagemagick x11-apps python3-xlib
  # bags written by ROS
  python3-rosbag python3-sensor-msgs python3-geometry-msgs python3-tf2-msgs python3-numpy python3-yaml
  python3-opencv python3-jsonschema  # an external initializer
  python3-pytest python3-pip python3-venv mypy python3-typeshed  # the Python module
  python3-matplotlib  # engine/examples/planes_of_a_room.py
  groff-base bsdextrautils zsh  # the manual page, completions
)
export_packages=(colmap assimp-utils blender)  # programs that read our exports; tests/nightly.sh
nightly_packages=(chromium)  # opens a report; large, its test skips without it
benchmark_packages=(libbenchmark-dev)
sanitizer_packages=(libclang-rt-dev)  # tests/nightly.sh

# install_packages NAME... installs missing packages by apt, as root or with sudo. If it cannot, it prints the
# command to type and exits with 2.
install_packages() {
  local missing=() name
  for name in "$@"; do
    dpkg-query -W -f '${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  local line="apt-get install -y --no-install-recommends ${missing[*]}"
  local as_root=()
  if ! command -v apt-get >/dev/null; then
    echo "missing packages, and no apt-get; on Debian: $line" >&2
    exit 2
  fi
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || ! sudo -v 2>/dev/null; then
      echo "missing packages; type: sudo $line" >&2
      exit 2
    fi
    as_root=(sudo)
  fi
  echo "installing ${#missing[@]} packages" >&2
  local log
  log=$(mktemp)
  if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive $line; } >"$log" 2>&1; then
    tail -n 5 "$log" >&2
    echo "could not install; type: sudo apt-get update && sudo $line" >&2
    exit 2
  fi
  rm -f "$log"
}
