# SPDX-License-Identifier: MIT
import os
from typing import Any, Callable, Literal, NamedTuple, Optional, Protocol, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

__version__: str
__all__: list[str]

_Vec3 = Sequence[float]
_Floats = NDArray[np.float32]

class _SupportsDLPack(Protocol):
    def __dlpack__(self, *, stream: Any = ...) -> Any: ...

_Points = Union[NDArray[Any], _SupportsDLPack, Tuple[NDArray[Any], NDArray[Any], NDArray[Any]]]

class Error(RuntimeError):
    kind: Literal["input", "usage", "device", "cancelled"]

class DeviceInfo(NamedTuple):
    backend: str
    name: str
    driver: str
    gpu: bool
    usable: bool
    problem: str

class ExportedBody(NamedTuple):
    name: str
    object: int
    fixed: bool
    on_pad: bool
    held: bool
    struts: int
    moved_m: list[float]
    parts: int
    mass_kg: float
    solid_m3: float
    parts_m3: float
    lost_m3: float

class ExportSummary(NamedTuple):
    bodies: list[ExportedBody]
    deepest_overlap_m: float

class Device:
    @property
    def backend(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def gpu(self) -> bool: ...

class Primitive:
    @property
    def id(self) -> int: ...
    @property
    def object(self) -> int: ...
    @property
    def model(self) -> str: ...
    @property
    def points(self) -> int: ...
    @property
    def solid_voxels(self) -> int: ...
    @property
    def volume_m3(self) -> float: ...
    @property
    def mass_kg(self) -> float: ...
    @property
    def center_of_mass_m(self) -> list[float]: ...

class Object:
    @property
    def id(self) -> int: ...
    @property
    def primitives(self) -> list[int]: ...
    @property
    def grounded(self) -> bool: ...
    @property
    def agreement(self) -> float: ...
    @property
    def mass_kg(self) -> float: ...
    @property
    def center_of_mass_m(self) -> list[float]: ...
    @property
    def barrier_J(self) -> float: ...
    @property
    def barrier_error_J(self) -> float: ...
    @property
    def mass_error_kg(self) -> float: ...
    @property
    def center_of_mass_error_m(self) -> list[float]: ...
    @property
    def footprint_error_m(self) -> float: ...
    @property
    def mass_model(self) -> Literal["solid", "closed"]: ...
    @property
    def inertia_kg_m2(self) -> NDArray[np.float64]: ...  # (3, 3)
    @property
    def release_J(self) -> float: ...
    @property
    def mode(self) -> Literal["tip", "slide", "none"]: ...
    @property
    def direction(self) -> list[float]: ...
    @property
    def risk_J(self) -> dict[str, float]: ...
    @property
    def risk_spread_J(self) -> dict[str, float]: ...
    @property
    def fall_chance(self) -> dict[str, float]: ...
    @property
    def unsafety(self) -> float: ...  # NaN: not seen enough to be ranked
    @property
    def instability(self) -> NDArray[np.float64]: ...  # (steps, 2): W_J, S_J
    @property
    def why(self) -> str: ...
    @property
    def stands_on(self) -> list[int]: ...
    @property
    def advice(self) -> str: ...

class Contact:
    @property
    def a(self) -> int: ...
    @property
    def b(self) -> int: ...
    @property
    def area_m2(self) -> float: ...
    @property
    def normal(self) -> list[float]: ...
    @property
    def relation(self) -> Literal["fixed", "support", "adjacent"]: ...
    @property
    def probability(self) -> float: ...

class Support:
    @property
    def supporter(self) -> int: ...
    @property
    def supported(self) -> int: ...
    @property
    def area_m2(self) -> float: ...
    @property
    def probability(self) -> float: ...

class Result:
    @property
    def source(self) -> str: ...
    @property
    def backend(self) -> str: ...
    @property
    def device(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def voxel_size_m(self) -> float: ...
    @property
    def up(self) -> list[float]: ...
    @property
    def up_method(self) -> str: ...
    @property
    def manhattan_from_input(self) -> list[float]: ...  # row-major 4x4
    @property
    def notes(self) -> list[str]: ...
    @property
    def timings_s(self) -> dict[str, float]: ...
    @property
    def events(self) -> dict[str, float]: ...
    @property
    def objects(self) -> list[Object]: ...
    @property
    def primitives(self) -> list[Primitive]: ...
    @property
    def contacts(self) -> list[Contact]: ...
    @property
    def supports(self) -> list[Support]: ...
    @property
    def xyz(self) -> tuple[_Floats, _Floats, _Floats]: ...
    @property
    def normals(self) -> tuple[_Floats, _Floats, _Floats]: ...
    @property
    def point_primitive(self) -> NDArray[np.int32]: ...
    @property
    def point_object(self) -> NDArray[np.int32]: ...
    @property
    def point_region(self) -> NDArray[np.int32]: ...
    @property
    def point_index(self) -> NDArray[np.uint64]: ...
    @property
    def solid(self) -> dict[str, NDArray[Any]]: ...  # x, y, z, primitive, object, state
    @property
    def fields(self) -> dict[str, dict[str, _Floats]]: ...  # x, y, z, vx, vy, vz, density
    def write(self, folder: Union[str, os.PathLike[str]], *, pictures: bool = ..., glb: bool = ..., octomap: bool = ...) -> None: ...
    def export(self, *, mjcf: Union[str, os.PathLike[str], None] = ..., urdf: Union[str, os.PathLike[str], None] = ..., sdf: Union[str, os.PathLike[str], None] = ..., usd: Union[str, os.PathLike[str], None] = ..., visuals: bool = ..., threads: int = ...) -> ExportSummary: ...

def devices() -> list[DeviceInfo]: ...
def open_device(backend: str = ..., threads: int = ...) -> Device: ...
def parse(
    source: Union[str, os.PathLike[str], _Points],
    *,
    device: Union[Device, str, None] = ...,
    voxel_m: float = ...,
    unit_m: float = ...,
    up: Optional[_Vec3] = ...,
    disturbances: Union[str, Sequence[str]] = ...,
    seed: int = ...,
    max_memory_bytes: int = ...,
    density_kg_m3: float = ...,
    friction: float = ...,
    contents_kg_m3: Optional[float] = ...,
    walks: int = ...,
    motion: Union[str, os.PathLike[str], None] = ...,
    wind_m_s: float = ...,
    wind_from_deg: Optional[float] = ...,
    pga_m_s2: Optional[float] = ...,
    accelerogram: Union[str, os.PathLike[str], None] = ...,
    tolerable_J: float = ...,
    grouping_time_s: Optional[float] = ...,
    normals: Optional[_Points] = ...,
    viewpoint: Optional[_Vec3] = ...,
    colours: Optional[_Points] = ...,
    isolate: bool = ...,
    progress: Optional[Callable[[str, float], object]] = ...,
    cancelled: Optional[Callable[[], bool]] = ...,
) -> Result: ...
