# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Monocular initialization on planar scenes: GPO, its baselines, and tools to inspect them.

    import gpo
    result = gpo.run("sequences/desk", frames=30)
    print(result.normal, result.metrics)

World: the reference camera of the window; unit: the distance of the leading plane.
"""
import importlib as _importlib

from ._gpo import (
    Camera,
    Initialization,
    Initialized,
    Initializer,
    InputError,
    LiveStatus,
    __version__,
    initialize,
)

# Loaded when first used, because their libraries take long to load.
_MODULES = {
    "Recording": "_recordings",
    "Result": "_recordings",
    "evaluate": "_recordings",
    "export_formats": "_recordings",
    "open": "_recordings",
    "report": "_views",
    "run": "_recordings",
    "snapshot": "_views",
}

__all__ = [
    "Camera",
    "Initialization",
    "Initialized",
    "Initializer",
    "InputError",
    "LiveStatus",
    "Recording",
    "Result",
    "evaluate",
    "export_formats",
    "initialize",
    "open",
    "report",
    "run",
    "snapshot",
]


def __getattr__(name):
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(_importlib.import_module("." + _MODULES[name], __name__), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted({*globals(), *__all__})
