# SPDX-License-Identifier: MIT
import enum
from typing import Any, NamedTuple, Optional, Sequence, Tuple, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import Device, _Backend, _Points, _Vec3

__all__: list[str]
footprint_dtype: np.dtype[np.void]

_Device = Union[Device, _Backend, None]
_Floats = NDArray[np.float32]

class State(enum.IntEnum):
    EMPTY = 0
    SURFACE = 1
    UNSEEN = 2
    COMPLETED = 3

class Intrinsics(NamedTuple):
    fx: float
    fy: float
    cx: float
    cy: float
    depth_scale: float = ...

class Voxels(NamedTuple):
    i: NDArray[np.int32]
    j: NDArray[np.int32]
    k: NDArray[np.int32]
    label: NDArray[np.int32]
    state: NDArray[np.uint8]

class StandingBody(NamedTuple):
    points: ArrayLike  # (N, 3) float64
    mass_kg: float
    center_of_mass_m: _Vec3

class Barrier(NamedTuple):
    barrier_J: float
    release_J: float
    direction: list[float]
    curve: NDArray[np.float64]  # (steps, 2): W_J, S_J

class Volume:
    def __init__(self, points: _Points, label: ArrayLike, voxel_m: float) -> None: ...
    def carve(self, depth: Union[ArrayLike, Sequence[ArrayLike]], camera_to_world: ArrayLike, intrinsics: Union[Intrinsics, Tuple[float, ...]], *, device: _Device = ...) -> None: ...
    def fill(self, votes: int, hollow: ArrayLike = ..., *, device: _Device = ...) -> int: ...
    @overload
    def state_at(self, i: int, j: int, k: int) -> State: ...
    @overload
    def state_at(self, i: ArrayLike, j: ArrayLike, k: ArrayLike) -> NDArray[np.uint8]: ...
    def solid(self) -> Voxels: ...

def point_spacing(points: _Points) -> float: ...
def normals(points: _Points, cell_m: float, *, eye_m: Union[_Vec3, _Points, None] = ..., device: _Device = ..., out: Optional[_Floats] = ...) -> _Floats: ...  # (N, 3)
def support_functions(vertices: _Points, first: ArrayLike, directions: _Points, *, device: _Device = ..., out: Optional[_Floats] = ...) -> _Floats: ...  # (sets, D)
def barriers(bodies: Sequence[Union[StandingBody, Tuple[ArrayLike, float, _Vec3]]], resolution_m: float, *, device: _Device = ...) -> list[Barrier]: ...
def convolve(primary: ArrayLike, footprint: ArrayLike, first: ArrayLike, *, device: _Device = ..., out: Optional[_Floats] = ...) -> _Floats: ...  # as primary
