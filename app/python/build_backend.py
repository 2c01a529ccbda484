# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Builds wheels for pip (PEP 517) with the standard library alone, because Debian 12 lacks scikit-build-core.

The config setting `build-dir` names a configured build folder to use instead of build/wheel-cp3XX.
"""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = f"cp{sys.version_info.major}{sys.version_info.minor}"


def _project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    header = (ROOT / "engine/version.h").read_text()
    numbers = re.findall(r"define GPO_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header)
    return {**project, "version": ".".join(numbers)}


def _metadata(project):
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {project['name']}",
        f"Version: {project['version']}",
        f"Summary: {project['description']}",
        f"License: {project['license']['text']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {name}" for name in project["dependencies"]),
    ]
    return "\n".join(lines) + "\n"


def _build(config_settings, prefix):
    """Installs the module below `prefix`. Returns the folder that contains it."""
    folder = (config_settings or {}).get("build-dir")
    if folder is None:
        folder = ROOT / "build" / f"wheel-{PYTHON}"
        # The flags of the program, whose numbers those of the module equal.
        preset = ["--preset", "release", "-DGPO_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", *preset, "-B", folder], cwd=ROOT, check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "_gpo"], cwd=ROOT, check=True)
    install = ["cmake", "--install", folder, "--component", "python", "--strip", "--prefix", prefix]
    subprocess.run(install, cwd=ROOT, check=True)
    found = list(pathlib.Path(prefix).glob("**/gpo/__init__.py"))
    if not found:
        raise SystemExit("CMake found no pybind11: install pybind11-dev and python3-dev")
    return found[0].parents[1]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    project = _project()
    platform = re.sub("[-.]", "_", sysconfig.get_platform())
    tag = f"{PYTHON}-{PYTHON}-{platform}"
    name = f"{project['name']}-{project['version']}"
    info = f"{name}.dist-info"
    wheel = f"{name}-{tag}.whl"
    records = []
    with tempfile.TemporaryDirectory() as prefix:
        package = _build(config_settings, prefix)
        files = {str(f.relative_to(package)): f.read_bytes() for f in package.glob("gpo/*") if f.is_file()}
    files[f"{info}/METADATA"] = _metadata(project).encode()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: gpo\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    )
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        records.append(f"{path},sha256={digest},{len(content)}")
    records.append(f"{info}/RECORD,,")
    files[f"{info}/RECORD"] = "".join(f"{record}\n" for record in records).encode()
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in files.items():
            archive.writestr(path, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise NotImplementedError("install from a clone: pip install .")
