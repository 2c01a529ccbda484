# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Monocular initialization on planar scenes: GPO, its baselines, and tools to inspect them.

    import gpo
    result = gpo.run("sequences/desk", frames=30)
    print(result.normal, result.metrics)

World: the reference camera of the window; unit: the distance of the leading plane.
"""
from ._gpo import (
    Camera,
    Initialization,
    Initialized,
    Initializer,
    InputError,
    LiveStatus,
    Recording,
    Result,
    __version__,
    evaluate,
    initialize,
    open,
    run,
    snapshot,
)

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
    "initialize",
    "open",
    "run",
    "snapshot",
]
