# SPDX-License-Identifier: MIT
import os
from typing import Any, Callable, Literal, Mapping, NamedTuple, Optional, Protocol, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from . import formats as formats, plot as plot, stages as stages
from .foxglove import to_mcap as to_mcap
from .rerun_viewer import to_rerun as to_rerun

__version__: str
__all__: list[str]

_Vec3 = Sequence[float]
_Floats = NDArray[np.float32]

class _SupportsDLPack(Protocol):
    def __dlpack__(self, *, stream: Any = ...) -> Any: ...

_Points = Union[NDArray[Any], _SupportsDLPack, Tuple[NDArray[Any], NDArray[Any], NDArray[Any]]]

_Path = Union[str, os.PathLike[str]]
_Disturbance = Literal["human", "wind", "earthquake"]
_Backend = Literal["auto", "native", "opencl", "vulkan"]
_What = Literal["objects", "primitives", "contacts", "supports", "pushes", "blows"]

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
    excess_share: Optional[float]
    lost_share: Optional[float]

class ExportSummary(NamedTuple):
    bodies: list[ExportedBody]
    deepest_overlap_m: float
    floor_m: Optional[float]
    free_place_m: Optional[list[float]]
    free_radius_m: float
    notes: list[str]

class RemovalOrder(NamedTuple):
    layers: list[list[int]]
    entangled: list[int]

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
    def name(self) -> str: ...  # given by hand to what is fixed to the ground
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
    def center_of_mass_m(self) -> NDArray[np.float64]: ...  # (3,)

class Overturning:  # all NaN where it can't tip
    @property
    def tilt_deg(self) -> float: ...
    @property
    def tilt_error_deg(self) -> float: ...
    @property
    def direction(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def push_N(self) -> float: ...
    @property
    def push_error_N(self) -> float: ...
    @property
    def slide_N(self) -> float: ...
    @property
    def shake_g(self) -> float: ...
    @property
    def hand_push_N(self) -> float: ...
    @property
    def hand_push_error_N(self) -> float: ...
    @property
    def hand_height_m(self) -> float: ...
    @property
    def gust_m_s(self) -> float: ...
    @property
    def gust_error_m_s(self) -> float: ...

class DirectedBarrier:  # direction n is towards the azimuth n * 22.5 degrees; inf: no fall was found
    @property
    def height_m(self) -> NDArray[np.float64]: ...
    @property
    def push_J(self) -> NDArray[np.float64]: ...  # (16,)
    @property
    def blow_Ns(self) -> NDArray[np.float64]: ...  # (16, heights)
    @property
    def blow_J(self) -> NDArray[np.float64]: ...  # (16, heights)
    @property
    def direction(self) -> NDArray[np.float64]: ...  # (16, 3), in the scan's frame
    @property
    def push_N(self) -> NDArray[np.float64]: ...  # (16,)
    @property
    def push_error_N(self) -> NDArray[np.float64]: ...  # (16,)

class Why:
    @property
    def azimuth_deg(self) -> float: ...  # NaN: any
    @property
    def edge_m(self) -> NDArray[np.float64]: ...  # (2, 3) or (0, 3)
    @property
    def W_J(self) -> float: ...
    @property
    def S_J(self) -> float: ...
    @property
    def way_m(self) -> float: ...
    @property
    def drop_m(self) -> float: ...
    @property
    def lands_on(self) -> int: ...
    @property
    def stands_on(self) -> list[int]: ...
    @property
    def sentence(self) -> str: ...

class Advice:
    @property
    def kind(self) -> Literal["", "see", "check", "move", "fix"]: ...
    @property
    def move_m(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def risk_J(self) -> float: ...
    @property
    def hold_N(self) -> float: ...
    @property
    def hold_height_m(self) -> float: ...
    @property
    def sentence(self) -> str: ...
    @property
    def action(self) -> str: ...  # what to do about it, so that it agrees with the category

class Fragility:  # of earthquakes; NaN: few fall at the strongest that is tried
    @property
    def pga_g(self) -> float: ...
    @property
    def pga_dispersion(self) -> float: ...
    @property
    def firm_pga_g(self) -> float: ...  # where its foot can't slide
    @property
    def pgv_m_s(self) -> float: ...
    @property
    def pgv_dispersion(self) -> float: ...
    @property
    def counted(self) -> NDArray[np.float64]: ...  # (steps, 2): pga_g, chance
    @property
    def falls_per_year(self) -> float: ...  # NaN without a hazard curve
    @property
    def return_years(self) -> float: ...

class Landscape:  # by pose, by rising energy
    @property
    def now(self) -> int: ...
    @property
    def up(self) -> NDArray[np.float64]: ...  # (poses, 3)
    @property
    def energy_J(self) -> NDArray[np.float64]: ...
    @property
    def joins_at_J(self) -> NDArray[np.float64]: ...
    @property
    def joins(self) -> NDArray[np.int32]: ...
    @property
    def probability(self) -> NDArray[np.float64]: ...

class Fall:
    @property
    def falls(self) -> bool: ...
    @property
    def lands_m(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def drop_m(self) -> float: ...
    @property
    def lands_on(self) -> int: ...
    @property
    def leans_on(self) -> int: ...
    @property
    def takes_along(self) -> list[int]: ...
    @property
    def hits_J(self) -> float: ...
    @property
    def people_share(self) -> Optional[float]: ...  # of walks; None: nobody walks, or nobody was asked for

class AppliedCorrection:
    @property
    def do(self) -> str: ...
    @property
    def held(self) -> bool: ...
    @property
    def outcome(self) -> str: ...  # "held", or what kept it from that
    @property
    def objects(self) -> list[int]: ...  # that it is about

class Object:
    @property
    def id(self) -> int: ...
    @property
    def name(self) -> str: ...  # given by hand; mostly ""
    @property
    def corrected(self) -> list[int]: ...  # numbers of the corrections about it, from 1
    @property
    def primitives(self) -> list[int]: ...
    @property
    def grounded(self) -> bool: ...
    @property
    def agreement(self) -> float: ...
    @property
    def mass_kg(self) -> float: ...
    @property
    def center_of_mass_m(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def support_height_m(self) -> float: ...  # of what it stands on, along Result.up; NaN: not known, or the ground
    @property
    def center_height_m(self) -> float: ...  # of its centre of mass above that
    @property
    def size_m(self) -> NDArray[np.float64]: ...  # (3,), along the room's axes, the third upright
    @property
    def box_middle_m(self) -> NDArray[np.float64]: ...  # (3,), of that box; NaN: nothing of it is solid
    @property
    def piece_of(self) -> int: ...  # the larger object that it is likelier than not a piece of; -1: none
    @property
    def piece_probability(self) -> float: ...  # of the likeliest such joint
    @property
    def joint_probability(self) -> float: ...  # of the least likely joint inside it; 1: none
    @property
    def weakest_joint(self) -> list[int]: ...  # its two primitives; -1: none
    @property
    def barrier_J(self) -> float: ...
    @property
    def barrier_error_J(self) -> float: ...
    @property
    def mass_error_kg(self) -> float: ...
    @property
    def center_of_mass_error_m(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def footprint_error_m(self) -> float: ...
    @property
    def mass_model(self) -> Literal["solid", "closed", "hollow"]: ...
    @property
    def inertia_kg_m2(self) -> NDArray[np.float64]: ...  # (3, 3)
    @property
    def release_J(self) -> float: ...
    @property
    def overturning(self) -> Overturning: ...
    @property
    def fragility(self) -> Fragility: ...
    @property
    def barrier_by_direction(self) -> DirectedBarrier: ...
    @property
    def landscape(self) -> Landscape: ...
    @property
    def drop_m(self) -> float: ...  # of its easiest way; 0: it stays on its support
    @property
    def mode(self) -> Literal["tip", "slide", "none"]: ...
    @property
    def direction(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def risk_J(self) -> dict[str, float]: ...
    @property
    def risk_spread_J(self) -> dict[str, float]: ...
    @property
    def risk_error_J(self) -> dict[str, float]: ...
    @property
    def fall_chance(self) -> dict[str, float]: ...
    @property
    def unsafety(self) -> float: ...  # NaN: not seen enough to be ranked, or no disturbance given
    @property
    def unsafety_category(self) -> Optional[Literal["none", "low", "medium", "high"]]: ...  # None: not seen enough, or no disturbance given
    @property
    def unsafety_certain(self) -> bool: ...
    @property
    def seen_enough(self) -> bool: ...
    @property
    def rests_by(self) -> Literal["seen", "near", "leaning", "hidden", "none", "ground"]: ...
    @property
    def rest_probability(self) -> float: ...
    @property
    def instability(self) -> NDArray[np.float64]: ...  # (steps, 2): W_J, S_J
    @property
    def why(self) -> str: ...
    @property
    def why_figures(self) -> Why: ...
    @property
    def fall(self) -> Fall: ...
    @property
    def stands_on(self) -> list[int]: ...
    @property
    def advice(self) -> str: ...
    @property
    def action(self) -> str: ...
    @property
    def advice_figures(self) -> Advice: ...

class Contact:
    @property
    def a(self) -> int: ...
    @property
    def b(self) -> int: ...
    @property
    def area_m2(self) -> float: ...
    @property
    def normal(self) -> NDArray[np.float64]: ...  # (3,)
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
    def offset_m(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def up(self) -> NDArray[np.float64]: ...  # (3,)
    @property
    def up_method(self) -> str: ...
    @property
    def manhattan_from_input(self) -> NDArray[np.float64]: ...  # (4, 4)
    @property
    def density_kg_m3(self) -> float: ...
    @property
    def friction(self) -> float: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def corrections(self) -> list[AppliedCorrection]: ...  # those that were given, in their order
    @property
    def in_blocks(self) -> bool: ...
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
    def image_shape(self) -> Optional[tuple[int, int]]: ...  # height, width
    @property
    def solid(self) -> dict[str, NDArray[Any]]: ...  # x, y, z, primitive, object, state
    @property
    def fields(self) -> dict[str, dict[str, _Floats]]: ...  # x, y, z, vx, vy, vz, density
    def spot(self, item: Union[Object, Primitive, int], part: bool = ...) -> NDArray[np.float64]: ...  # (3,)
    def spots(self, item: Union[Object, int]) -> list[NDArray[np.float64]]: ...  # (3,) each
    def frame_labels(self, frame: Union[int, NDArray[Any], _SupportsDLPack] = ..., *, camera_to_world: Optional[NDArray[np.floating[Any]]] = ..., intrinsics: Optional[stages.Intrinsics] = ..., primitives: bool = ...) -> NDArray[np.int32]: ...  # (H, W)
    def stays(self, item: Union[Object, int], place_m: _Vec3, way: Optional[_Vec3] = ..., *, force_N: float = ..., impulse_Ns: float = ..., slack_m: float = ...) -> bool: ...
    def object_at(self, place_m: _Vec3, within_m: float) -> int: ...  # -1: none
    def columns(self, what: _What = ...) -> dict[str, NDArray[Any]]: ...  # (N,), vectors (N, 3)
    def removal_order(self, min_probability: float = ...) -> RemovalOrder: ...
    def to_dataframe(self, what: _What = ...) -> Any: ...  # pandas.DataFrame
    def write(self, folder: _Path, *, pictures: bool = ..., glb: bool = ..., octomap: bool = ...) -> None: ...
    def export(self, *, mjcf: Optional[_Path] = ..., urdf: Optional[_Path] = ..., sdf: Optional[_Path] = ..., usd: Optional[_Path] = ..., visuals: bool = ..., threads: int = ...) -> ExportSummary: ...

def devices() -> list[DeviceInfo]: ...
def open_device(backend: _Backend = ..., threads: int = ...) -> Device: ...
def load(folder: _Path) -> Result: ...
def generate(folder: _Path, *, seed: int = ..., kind: Optional[str] = ..., frames: int = ..., single: bool = ...) -> str: ...
def parse(
    source: Union[_Path, _Points, None] = ...,
    *,
    device: Union[Device, _Backend, None] = ...,
    voxel_m: float = ...,
    unit_m: float = ...,
    up: Optional[_Vec3] = ...,
    disturbances: Union[_Disturbance, Sequence[_Disturbance], None] = ...,
    seed: int = ...,
    max_memory_bytes: int = ...,
    density_kg_m3: float = ...,
    friction: float = ...,
    contents_kg_m3: Optional[float] = ...,
    walks: int = ...,
    motion: Union[_Path, Sequence[_Path], None] = ...,
    motion_unit: Optional[float] = ...,
    motion_rate: Optional[float] = ...,
    motion_up: Optional[_Vec3] = ...,
    wind_m_s: float = ...,
    wind_from_deg: Optional[float] = ...,
    pga_m_s2: Optional[float] = ...,
    accelerogram: Union[_Path, Sequence[Optional[_Path]], None] = ...,
    accelerogram_unit: Optional[Literal["g", "m/s2", "cm/s2"]] = ...,
    floor_amplification: float = ...,
    hazard: Optional[_Path] = ...,
    tolerable_J: float = ...,
    grouping_time_s: Optional[float] = ...,
    corrections: Union[str, os.PathLike[str], Sequence[Mapping[str, Any]], None] = ...,
    cache_file: Union[str, os.PathLike[str], None] = ...,
    normals: Optional[_Points] = ...,
    name: Optional[str] = ...,
    viewpoint: Union[_Vec3, _Points, None] = ...,
    colours: Union[_Points, Sequence[Optional[NDArray[np.uint8]]], None] = ...,
    frames: Union[NDArray[Any], Sequence[NDArray[Any]], None] = ...,
    camera_to_world: Optional[NDArray[np.floating[Any]]] = ...,
    intrinsics: Optional[stages.Intrinsics] = ...,
    colour_intrinsics: Optional[stages.Intrinsics] = ...,
    tile_m: float = ...,
    isolate: bool = ...,
    progress: Optional[Callable[[str, float], object]] = ...,
    cancelled: Optional[Callable[[], bool]] = ...,
) -> Result: ...
