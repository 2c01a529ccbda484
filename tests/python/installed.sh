#!/usr/bin/env bash
# Usage: installed.sh BUILD_DIR [PYTEST_ARGUMENT...]. Tests the Python module as pip installs it from a built tree.
set -euo pipefail
build=$(realpath "$1")
shift
source=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
unset PYTHONPATH
/usr/bin/python3 -m venv --system-site-packages venv
venv/bin/pip install --quiet --disable-pip-version-check --no-index --config-settings=build-dir="$build" "$source"
GPO_INSTALLED=$scratch/venv venv/bin/python -m pytest -q -p no:cacheprovider "$source/tests/python" "$@"
