# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
from typing import Any, Optional, Sequence, TypedDict, Union

import numpy as np
from numpy.typing import NDArray

__version__: str

class InputError(ValueError): ...

class Gyroscope(TypedDict):
    timestamps_ns: NDArray[np.int64]
    rates_rad_s: NDArray[np.float64]
    accelerations_m_s2: Optional[NDArray[np.float64]]
    R_gyro_camera: NDArray[np.float64]
    time_offset_ns: int
    bias_rad_s: NDArray[np.float64]

class Truth(TypedDict, total=False):
    R_wc: NDArray[np.float64]
    p_wc: NDArray[np.float64]
    normal: NDArray[np.float64]
    distance: float

class PlaneEstimate(TypedDict):
    number: int
    normal: NDArray[np.float64]
    distance: float
    normal_covariance_rad2: Optional[NDArray[np.float64]]

class Recording:
    name: str
    layout: str
    path: str
    notes: list[str]
    timestamps_ns: NDArray[np.int64]
    K: NDArray[np.float64]
    distortion: NDArray[np.float64]
    size: tuple[int, int]
    camera_source: str
    gyroscope: Optional[Gyroscope]
    truth: Optional[Truth]
    def __len__(self) -> int: ...
    def frame(self, frame: int) -> NDArray[np.uint8]: ...

class Result:
    ok: bool
    reason: str
    method: str
    R_wc: NDArray[np.float64]
    p_wc: NDArray[np.float64]
    points: NDArray[np.float64]
    normal: NDArray[np.float64]
    planes: list[PlaneEstimate]
    metrics: Optional[dict[str, Any]]
    json: dict[str, Any]

def open(path: str) -> Recording: ...
def run(recording: Union[Recording, str], **settings: Any) -> Result: ...
def evaluate(
    recordings: Sequence[Union[Recording, str]],
    methods: str = ...,
    lengths: str = ...,
    starts: str = ...,
    seed: int = ...,
    jobs: int = ...,
) -> NDArray[np.void]: ...
def snapshot(
    recording: Union[Recording, str],
    view: str = ...,
    frame: Optional[int] = ...,
    size: Optional[tuple[int, int]] = ...,
    methods: Optional[str] = ...,
    **settings: Any,
) -> NDArray[np.uint8]: ...
