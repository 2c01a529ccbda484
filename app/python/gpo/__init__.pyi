# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
from typing import Any, Iterable, Optional, Sequence, Tuple, TypedDict, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class InputError(ValueError): ...

class Gyroscope(TypedDict):
    timestamps_ns: NDArray[np.int64]
    rates_rad_s: NDArray[np.float64]
    accelerations_m_s2: Optional[NDArray[np.float64]]
    R_gyro_camera: NDArray[np.float64]
    time_offset_ns: int
    bias_rad_s: NDArray[np.float64]
    bias_sigma_rad_s: float
    bias_known: bool
    noise_density: float
    p_gyro_camera_m: Optional[NDArray[np.float64]]

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
    tracks: NDArray[np.int64]

class Inertial(TypedDict):
    gravity_m_s2: NDArray[np.float64]
    gravity_sigma_deg: float
    scale: float
    log_scale_sigma: float
    scale_known: bool
    reason: str
    velocities_m_s: NDArray[np.float64]
    timestamps_ns: NDArray[np.int64]
    accelerometer_bias_m_s2: NDArray[np.float64]

class Camera:
    K: NDArray[np.float64]
    size: tuple[int, int]
    distortion: NDArray[np.float64]
    readout_s: Optional[float]
    readout_sigma_s: Optional[float]
    def __init__(
        self,
        K: ArrayLike,
        size: tuple[int, int] = ...,
        distortion: Sequence[float] = ...,
        model: str = ...,
        covariance: Optional[ArrayLike] = ...,
        readout_s: Optional[float] = ...,
        readout_sigma_s: Optional[float] = ...,
        readout_direction: Optional[str] = ...,
    ) -> None: ...
    def undistort(self, pixels: ArrayLike) -> NDArray[np.float64]: ...

class Recording:
    name: str
    layout: str
    path: str
    notes: list[str]
    timestamps_ns: NDArray[np.int64]
    camera: Camera
    camera_source: str
    gyroscope: Optional[Gyroscope]
    truth: Optional[Truth]
    def __len__(self) -> int: ...
    def frame(self, frame: int) -> NDArray[np.uint8]: ...

# (timestamp_ns, ids (n,), pixels (n, 2)[, R_wc (3, 3)])
Frame = Union[Tuple[int, ArrayLike, ArrayLike], Tuple[int, ArrayLike, ArrayLike, Optional[ArrayLike]]]

class Initialization:
    ok: bool
    reason: str
    readiness: Optional[str]
    verdict: str
    R_wc: NDArray[np.float64]
    p_wc: NDArray[np.float64]
    points: NDArray[np.float64]
    point_tracks: NDArray[np.int32]
    normal: NDArray[np.float64]
    normal_sigma_deg: Optional[float]
    typical_lens_sigma_deg: Optional[float]
    bias_rad_s: Optional[NDArray[np.float64]]
    planes: list[PlaneEstimate]
    inertial: Optional[Inertial]
    ids: NDArray[np.int64]

class Initialized(Initialization):
    is_ready: bool
    why_not_ready: str
    rotations: str
    rotations_note: str

class Result(Initialization):
    method: str
    frames: list[tuple[int, NDArray[np.int64], NDArray[np.float64]]]
    metrics: Optional[dict[str, Any]]
    json: dict[str, Any]

class LiveStatus:
    ready: bool
    metric: bool
    reference: int
    frames: int
    ready_frames: int
    solved_frames: int
    pending: int
    waiting: int
    started_anew: bool
    reason: str
    answer: Optional[Initialized]

class Initializer:
    status: LiveStatus
    def __init__(
        self,
        camera: Union[Camera, ArrayLike],
        gyroscope: Optional[dict[str, Any]] = ...,
        background: bool = ...,
        most_frames: int = ...,
        least_tracks: int = ...,
        least_share: float = ...,
        **settings: Any,
    ) -> None: ...
    def add_gyroscope(self, timestamp_ns: int, rate_rad_s: ArrayLike) -> None: ...
    def add_imu(
        self, timestamp_ns: int, rate_rad_s: ArrayLike, acceleration_m_s2: ArrayLike
    ) -> None: ...
    def add_frame(
        self, timestamp_ns: int, ids: ArrayLike, pixels: ArrayLike, R_wc: Optional[ArrayLike] = ...
    ) -> LiveStatus: ...
    def wait(self) -> LiveStatus: ...

def initialize(
    camera: Union[Camera, ArrayLike],
    frames: Iterable[Frame],
    gyroscope: Optional[dict[str, Any]] = ...,
    camera_is_guess: bool = ...,
    **settings: Any,
) -> Initialized: ...
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
