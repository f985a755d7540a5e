# SPDX-License-Identifier: MIT
"""Tells which things in a 3D scan of a room are one solid object, what holds what up, and what may fall.

    result = topple.parse(points)           # NumPy, (N, 3), metres; or a file, or a folder of depth frames
    for o in result.objects: print(o.id, o.unsafety, o.why)
    result.write("out")

topple.stages has the single stages of a parse, for arrays of your own.

Lengths in metres, masses in kilograms, energies in joules, in the input's frame; ids count from 0, -1 means
unassigned. Object.unsafety, 1 to 10, is NaN where what holds the object was not seen: such objects have no rank, and
a sort by unsafety alone would be left in no order. What goes wrong is raised as topple.Error.
"""
import copyreg
import json
import numbers
import os
import threading
from typing import NamedTuple

from . import _interpreter  # before what it keeps out of other interpreters
import numpy as np

from . import _ask, _described, _labels, _removal, _shown, _snapshot, _spots, _tables, _topple, formats, kernels, plot, stages
from ._arrays import channels as _channels, columns as _columns, has_rows as _has_rows, usage as _usage
from ._ask import FallsWithout, Holder, Unheld
from ._compare import Alignment, ComparedThing, Comparison, compare
from ._device import open_device
from ._frames import Frames as _Frames
from ._options import named as _named, option as _option, options as _options_of
from ._program import generate
from ._removal import RemovalOrder
from ._session import Appeared, LiveScene, Session, Thing
from ._topple import Advice, Alternative, AppliedCorrection, Contact, Device, DirectedBarrier, Error, Fall, Hold, Landscape, Object, Overturning, PossibleThing, Primitive, Support, Why, __version__
from .foxglove import to_mcap
from .rerun_viewer import to_rerun

__all__ = ['Advice', 'Alignment', 'Alternative', 'Appeared', 'AppliedCorrection', 'ComparedThing', 'Comparison', 'Contact', 'Device', 'DeviceInfo', 'DirectedBarrier', 'Error', 'ExportSummary', 'ExportedBody', 'ExportedFront', 'Fall', 'FallsWithout', 'Hold', 'Holder', 'Landscape', 'LiveScene', 'Object', 'Overturning', 'PossibleThing', 'Primitive', 'RemovalOrder', 'Result',
           'Session', 'Support', 'Thing', 'Unheld', 'Why', '__version__', 'compare', 'devices', 'formats', 'generate', 'kernels', 'load', 'open_device', 'parse', 'plot', 'stages', 'to_mcap', 'to_rerun']

_shown.items()
for _kind in _snapshot.ITEMS:  # of a live result: a plain item that stands alone comes back
    copyreg.pickle(_kind, _snapshot.reduced)


class DeviceInfo(NamedTuple):
    """A device of this machine, or why a backend offers none."""
    backend: str
    name: str
    driver: str
    gpu: bool
    usable: bool
    problem: str


class ExportedBody(NamedTuple):
    """What became of an object in an export, or a pad that was made to carry one (docs/export.md)."""
    name: str  # in the export: "object_3", "pad_28"
    object: int  # id; -1 for a pad
    fixed: bool  # part of the world, which nothing moves
    on_pad: bool  # its footing was not seen, or was cut away as it lay in others: it stands on a pad,
    held: bool  # or is held where it is
    struts: int  # of its parts: in the place of feet that were not seen
    moved_m: "list[float]"  # by which it was let down, z up
    parts: int  # convex ones
    mass_kg: float
    solid_m3: float  # of the object as it was parsed
    parts_m3: float  # of its parts: more by what their hulls add
    lost_m3: float  # cut off its parts, so that no two bodies overlap
    excess_share: "Optional[float]"  # how much more parts_m3 is than solid_m3, as a share; None for a pad
    lost_share: "Optional[float]"  # lost_m3 as a share of solid_m3, which may be above 1; None for a pad


class ExportedFront(NamedTuple):
    """A door or a drawer in an export: a body on a joint to its object's, shut as it was scanned (docs/export.md)."""
    name: str  # in the export: "object_3_front_0", and "..._joint" that of its joint
    object: int  # id
    opens: str  # "slide" or "hinge"
    probability: float  # that it is there, and opens so
    middle_m: "list[float]"  # of its outer face, z up
    wide_m: float
    high_m: float
    handle_m: "list[float]"  # the middle of its handle
    mass_kg: float
    axis: "list[float]"  # unit; it opens along it, or around it by the right-hand rule
    at_m: "list[float]"  # a point of a hinge's axis; of a slide middle_m
    most: float  # how far it opens: metres, or radians


class ExportSummary(NamedTuple):
    """What Result.export() made."""
    bodies: "list[ExportedBody]"  # those of the objects by id, then pads
    deepest_overlap_m: float  # of any two bodies
    floor_m: "Optional[float]"  # height of the main level floor; None: there is none
    free_place_m: "Optional[list[float]]"  # the middle of the widest place on it where nothing stands, x, y, z; None: there is none
    free_radius_m: float  # of that place; 0: there is none
    notes: "list[str]"  # what is not as it was parsed, such as bodies that were cut to half
    fronts: "list[ExportedFront]" = []  # doors and drawers, by object

    def __repr__(self):
        fixed = sum(body.fixed for body in self.bodies)
        return (f'<topple.ExportSummary: {len(self.bodies)} bodies, {fixed} of them fixed, that overlap by {_shown.figure(1000 * self.deepest_overlap_m, 2)} mm '
                f'at most; {len(self.notes)} notes>')


def devices():
    """Every device of every backend, as `topple devices` lists them."""
    return [DeviceInfo(*listed) for listed in _topple.list_devices()]


@_described.result
class Result:
    """What a scan holds. Arrays over its points and voxels are the result's own memory, not copies: they keep
    it alive, and writing to them changes what write() writes.

    It can be pickled, and so be sent between processes: objects, primitives, contacts, supports, labels, points, voxels
    and fields come back as they were, objects as plain ones with the same attributes, and of depth frames the path of their
    folder. What write() and export() need is not among them: call these before."""

    def __init__(self, parsed, points, colours=(), frames=None):
        self._parsed = parsed
        self._points = points  # the caller's, where they are theirs
        self._colours = colours
        self._frames = frames  # where those that were parsed are: a folder's path, or the caller's
        self._parts = self._labeller = None  # for spots and labels, once they are asked for
        self._writing = threading.Lock()  # the coordinates are in the result for as long as it takes

    def __getattr__(self, name):
        if name in _described.RESULT:
            raise AttributeError(f'{name}: this result was pickled by an earlier version of topple, which had none')
        raise AttributeError(f"topple.Result has no attribute {name!r}; help(topple.Result) lists what it has", name=name, obj=self)

    def __repr__(self):
        return f'<topple.Result of {self.source}: {len(self.objects)} objects on {self.backend}>'

    def __getstate__(self):
        return {'parsed': _snapshot.frozen(self._parsed), 'points': self._points, 'colours': self._colours,
                'frames': _labels.kept(self._frames, self.source)}

    def __setstate__(self, state):
        self.__init__(state['parsed'], state['points'], state['colours'], state.get('frames', _labels.NOT_KEPT))

    def _whole(self, call):
        """What C++ made, which a pickle does not hold."""
        if isinstance(self._parsed, _snapshot.Item):
            raise _usage(f'{call}: this result was pickled or copied, which leaves out what it takes; call it on the '
                         'result of parse(), before pickling')
        return self._parsed

    def columns(self, what='objects'):
        """What there is, as NumPy arrays by name: one entry for each of `what`, "objects", "primitives", "contacts" or
        "supports", in the order of ids; or "pushes": for each direction of each object, what it takes to push it over, or "blows": for
        each direction and height, the least impulse that makes it fall (Object.barrier_by_direction). Names are those of the items' attributes; of an object's parts with theirs before,
        as overturning_tilt_deg, why_drop_m, advice_hold_N; by disturbance as risk_wind_J, risk_error_wind_J, fall_chance_wind.
        Vectors are (N, 3), sentences and words of dtype object. NaN: none, or not asked for."""
        return _tables.columns(self, what)

    def to_dataframe(self, what='objects'):
        """The columns() as a pandas.DataFrame, vectors as three: center_of_mass_x_m and so on. Raises ImportError where
        pandas is not installed."""
        return _tables.dataframe(self, what)

    def removal_order(self, min_probability=0.5):
        """In which order objects can be taken away one by one, so that nothing loses what carries it: a RemovalOrder. A support counts
        from min_probability on, 0 to 1 (Support.probability): with 0 all do, which is the safe side."""
        return _removal.order(self, min_probability)

    def falls_without(self, items):
        """What falls if objects are taken away, one or a list of them, each an Object or its id, all at once: a FallsWithout. What loses a supporter falls if none is
        left, or if its centre of mass then lies outside of what it stands on; then what rested on it. What hangs on the building stays. It goes
        by supports, each as likely as its probability, and by the solid voxels where things stand on one another. Raises Error of kind "usage"
        for the building and what is fixed to it, and for a result that was pickled."""
        return _ask.falls_without(self, self._whole('falls_without'), items)

    def removal_steps(self, before=None):
        """An order in which everything but the building can be taken away, so that nothing is taken before what it carries: a list of steps, each
        the ids of one object, or of a ring of objects that carry one another and have to go together. With `before`, an Object or its id, what
        has to go so that it can be taken and nothing falls; the last step is that object. Raises Error as falls_without()."""
        return _ask.removal_steps(self, self._whole('removal_steps'), before)

    def held_by(self, item):
        """What holds an object, an Object or its id: a list of Holder, the likeliest first. Empty: the parse has found nothing that does, and
        rests_by says how it is taken to stand. Raises Error as falls_without()."""
        return _ask.held_by(self, self._whole('held_by'), item)

    def _repr_html_(self):
        return _tables.page(self)

    @property
    def xyz(self):
        """The coordinates of the points that the labels are of, (N, 3), metres: a copy. Of arrays that were given, those points that are
        finite."""
        return np.stack(self._axes(), axis=1)

    def _axes(self):
        """They axis by axis, where they lie: of arrays that were given, views of these, unless points were left out."""
        if self._points is None:
            return self._parsed.x, self._parsed.y, self._parsed.z
        index = self._parsed.point_index
        return tuple(c[index] if len(index) else c for c in self._points)

    @property
    def normals(self):
        """Three arrays: unit normals of the points, towards the side that was seen; 0 where there is none."""
        return self._parsed.nx, self._parsed.ny, self._parsed.nz

    def spot(self, item, part=False):
        """A spot for corrections (docs/corrections.md): (3,) float64, metres, in the midst of the largest part of an object, an
        Object or its id; with part=True of a part, a Primitive or its id. A correction of a later parse that names it in
        "at_m" is about that part, also where numbers have changed; of a whole object give spots(). Raises Error where there is
        no solid."""
        return _spots.spot(self, self._solid_parts(), item, part)

    def spots(self, item):
        """A spot of each part of an object that has a solid, the largest part first: a list of (3,) float64, metres."""
        return _spots.spots(self, self._solid_parts(), item)

    def _solid_parts(self):
        if self._parts is None:
            self._parts = _spots.Parts(self)
        return self._parts

    def frame_labels(self, frame=0, *, camera_to_world=None, intrinsics=None, primitives=False):
        """The object that each pixel of a depth frame shows, (height, width) int32: ids, and -1 where the pixel has no reading, or shows
        nothing that the parse knows. With primitives=True the part.

        frame: the number of one that was parsed, from a folder or frames=..., or 0 of an organised .pcd, which is one; or any depth image of the same place, (height, width)
        uint16 or floats as in parse(frames=...), with its camera_to_world, (4, 4), metres, in the frame of the result's points, and
        its intrinsics, a topple.stages.Intrinsics. A pixel shows what the point is of that is nearest to its reading, within the edge of
        a voxel, or three standard deviations of a reading from so far away. Raises Error of kind "usage" where there is no such frame."""
        if camera_to_world is None and intrinsics is None and _labels.numbered(frame) and getattr(self._parsed, 'image_shape', None):
            return _labels.of_image(self, frame, primitives)
        with self._writing:
            if self._labeller is None:
                self._labeller = _labels.labeller(self)
        return _labels.of_frame(self._labeller, self._frames, frame, camera_to_world, intrinsics, primitives)

    def stays(self, item, place_m, way=None, *, force_N=0.0, impulse_Ns=0.0, slack_m=0.02):
        """Whether an object, an Object or its id, stays where it is, to two standard errors of its mass and its foot, when it is pushed
        steadily with force_N newtons, or bumped with impulse_Ns newton seconds (m v of what comes with m kg at v m/s, and up to twice that
        where it bounces back), at place_m, metres in the frame of the result's points, towards `way`, a level unit vector, or to any side
        (None). Push and bump each by itself.

        True: the push is below what tips it there, in the directions next to `way`, and below what friction holds; the bump is below the
        least that makes it fall (barrier_by_direction.blow_Ns; where that is infinite, it brings less energy than the barrier), and sets it
        sliding no farther than slack_m metres. What is of the ground stays whatever is done. False also where nobody knows: what holds it
        was not seen, or is likelier than not something else than was found; it hangs; its barrier is 0; it is likelier than not a piece of
        another object (piece_of: ask about that one), or two in one (joint_probability below 0.5); the place is lower than what it stands on, or higher than its top, by more than a voxel.

        It promises nothing about what the figures leave out: that density and friction are as they were given, and what is solid to topple
        is not hollow; touches beside the line above its centre of mass, which turn it; many of them; what it carries or holds. Raises Error of
        kind "usage" for what makes no sense: a place that is not finite, a way that is not level or not of unit length, a figure that is
        negative or not finite; and for a result that was pickled."""
        return not self.why_moves(item, place_m, way, force_N=force_N, impulse_Ns=impulse_Ns, slack_m=slack_m)

    def why_moves(self, item, place_m, way=None, *, force_N=0.0, impulse_Ns=0.0, slack_m=0.02):
        """Why stays() of the same says False: that it slides, tips or falls, and from which push or bump on; or what nobody knows. "" where it
        stays."""
        given = _option('place_m', place_m), _option('way', way), _option('force_N', force_N), _option('impulse_Ns', impulse_Ns), _option('slack_m', slack_m)
        return _topple.why_moves(self._whole('stays'), _spots.numbered(self.objects, item, 'object').id, *given)

    def stays_up_to_N(self, item, place_m, way=None):
        """The steady push, newtons, up to which an object stays where it is when it is pushed at place_m towards `way`, as stays() has them;
        0 where nobody knows, inf for the ground."""
        return _topple.stays_up_to_N(self._whole('stays_up_to_N'), _spots.numbered(self.objects, item, 'object').id, _option('place_m', place_m), _option('way', way))

    def released_J(self, item, W_J):
        """S(W), the paper's Eq. 6: the most that an object may set free once it is given W_J joules; 0 below its barrier, and for the ground."""
        o = _spots.numbered(self.objects, item, 'object')
        if not (isinstance(W_J, numbers.Real) and W_J >= 0):
            raise _usage(f'W_J: expected joules, 0 or more, not {W_J!r}')
        steps = np.asarray(o.instability, float).reshape(-1, 2)
        return 0.0 if o.grounded else float(max(steps[steps[:, 0] <= W_J, 1], default=0))

    def object_at(self, place_m, within_m):
        """The id of the object at a place, three numbers, metres in the frame of the result's points: that of the nearest point that belongs
        to one. -1: there is none within within_m metres (math.inf: however far). Looks at all points: for the pixels of an image take
        frame_labels(). Of a cloud that was parsed in blocks the points are a sample. Raises Error of kind "usage" for a place that is
        not finite, and a distance that is negative or NaN."""
        place_m, within_m = _option('place_m', place_m), _option('within_m', within_m)
        columns = [np.ascontiguousarray(axis, np.float32) for axis in self._axes()]
        return _topple.object_at(columns, np.ascontiguousarray(self.point_object, np.int32), place_m, within_m)

    def write(self, folder, *, pictures=False, glb=False, octomap=False):
        """Writes the folder of outputs (docs/output.md), which appears whole or not at all: with view-*.png,
        objects.glb and map.bt where they are asked for."""
        with self._writing:
            _topple.write(self._whole('write'), os.fspath(folder), pictures, glb, octomap, self._points or [],
                          list(self._colours))

    def export(self, *, mjcf=None, urdf=None, sdf=None, usd=None, visuals=True, joints=True, threads=0):
        """Writes the scene for simulators, in the formats whose paths are given, and what became of each body as
        bodies.json beside it (docs/export.md); returns an ExportSummary. mjcf, urdf, sdf: the folders for scene.xml
        (MuJoCo's format), scene.urdf and scene.sdf; usd: the file, NAME.usda. visuals: what bodies look like, in the
        scan's colours, beside what collides. joints: doors and drawers, which their handles tell, as bodies on joints.
        Folders are made where they are missing; an earlier export is replaced, a file of others is an Error of kind
        "input". threads: 0 for all cores; the result is the same. Other threads of Python run meanwhile."""
        paths = {'mjcf': mjcf, 'urdf': urdf, 'sdf': sdf, 'usd': usd}
        given = {name: _file(name, path) for name, path in paths.items() if path is not None}
        for name, path in given.items():
            if name != 'usd' and os.path.splitext(path)[1].lower() in ('.xml', '.mjcf', f'.{name}') and not os.path.isdir(path):
                top = {'mjcf': 'scene.xml'}.get(name, f'scene.{name}')
                raise _usage(f'{name}: {path} looks like a file; it is a folder, into which {top} is written: '
                             f'give {name}={os.path.dirname(path) or "."!r}, say')
        visuals, joints, threads = _option('visuals', visuals), _option('joints', joints), _option('threads', threads)
        with self._writing:
            bodies, *rest = _topple.export_scene(self._whole('export'), given, visuals, joints, threads, list(self._points or []),
                                                 list(self._colours))
        *rest, fronts = rest
        return ExportSummary([ExportedBody(*body) for body in bodies], *rest, [ExportedFront(*front) for front in fronts])


def load(folder):
    """The Result that a folder of outputs holds, as Result.write() or `topple parse -o` has written it: objects and all other items, labels,
    points, solid voxels; spots, frame labels, plots and exports can be made of it. Not in such a folder, and so empty: fields,
    point_region and point_index. It can't be written again. Raises Error of kind "input" where the folder or a file of it
    is missing, damaged or of another scan."""
    parsed = _topple.load(_file('folder', folder))
    return Result(parsed, None, frames=parsed.source if os.path.isdir(parsed.source) else None)


def _files(given):
    """The paths of one file, of several, or of None."""
    if given is None:
        return []
    try:
        return [os.fspath(given)] if isinstance(given, (str, os.PathLike)) else [os.fspath(file) for file in given]
    except TypeError:
        raise _usage(f'motion: expected a file or a list of files, not {given!r}') from None


def _file(name, given):
    try:
        given = os.fspath(given)
        given.encode()
        return given
    except (TypeError, AttributeError):
        raise _usage(f'{name}: expected a file, not {given!r}'[:200]) from None
    except UnicodeEncodeError:
        raise _usage(f'{name}: the name {given} is no UTF-8; rename the file') from None


def _corrections_text(corrections):
    """The file's text of a list of corrections; numbers and arrays of NumPy are taken as they are in lists."""
    if isinstance(corrections, dict):
        raise _usage('corrections: expected a file or a list of dicts, not one dict; put [ ] around it')
    def plain(value):
        if hasattr(value, 'tolist'):
            return value.tolist()
        raise _usage(f'corrections: {value!r} is no number, text or list')
    try:
        listed = [dict(c) for c in corrections]
    except (TypeError, ValueError):
        raise _usage(f'corrections: expected a file or a list of dicts, not {corrections!r}'[:200]) from None
    for number, correction in enumerate(listed, 1):
        if 'at_m' not in correction:
            raise _usage(f'corrections: correction {number} ({correction.get("do")}) has no "at_m", the spots of its parts, [[x, y, z], ...]; '
                         'ids change from parse to parse, so give [result.spot(id), ...] of an earlier result')
    return json.dumps({'schema': 'topple.corrections/1', 'corrections': listed}, default=plain)


def _components(accelerogram):
    """The paths of a record's components along, across and up, None where one is not known."""
    one = isinstance(accelerogram, (str, os.PathLike)) or not hasattr(accelerogram, '__iter__')
    given = [accelerogram] if one else list(accelerogram)
    if not 1 <= len(given) <= 3 or given[0] is None or not all(file is None or isinstance(file, (str, os.PathLike)) for file in given):
        raise _usage(f'accelerogram: expected a file, or up to three: along, across and up, not {accelerogram!r}')
    return [None if file is None else os.fspath(file) for file in given + [None] * (3 - len(given))]


@_named
def parse(source=None, *, device=None, voxel_m=0.0, unit_m=1.0, up=None, disturbances=None, people='adults',
          seed=1, max_memory_bytes=0, density_kg_m3=700.0, friction=0.3, contents_kg_m3=68.0, walks=500, motion=None, motion_unit=None,
          motion_rate=None, motion_up=None, wind_m_s=12.0, wind_from_deg=None, pga_m_s2=None, accelerogram=None, accelerogram_unit=None, floor_amplification=1.0, hazard=None, tolerable_J=0.1, stability_level=0.0, grouping_time_s=None, materials=None, corrections=None, cache_file=None, normals=None,
          name=None, viewpoint=None, colours=None, frames=None, camera_to_world=None, intrinsics=None, colour_intrinsics=None,
          tile_m=0.0, space_fields=False, isolate=True, progress=None, cancelled=None):
    """Parses a scan into a Result.

    source: a path, as the command line takes it, or of what topple.formats converts (docs/formats.md: .laz, .e57, bags of ROS,
    COLMAP, Polycam, Record3D); or points in metres: an array of shape (N, 3), records with
    fields x, y, z, a tuple of three arrays, or whatever has __dlpack__. float32 is read where it lies, with any
    strides, and must not change meanwhile; float64 is converted, which takes 12 bytes a point, and integers are
    refused: hardly ever are they metres. A table with columns x, y, z, as a pandas.DataFrame or a dict, is taken, too, and what a masked
    array masks is left out. Points that are not finite are left out: Result.point_index then says
    where the others are.

    frames: instead of a source, depth frames in memory, of which the result is that of the same in a folder: an array of shape (F, H, W),
    a list of (H, W) arrays, or what has a length and gives one for each number, and is asked again where it is needed again. uint16 are
    metres times depth_scale, 0: no reading; floats are metres, and what is not finite, or not above 0, is no reading. float32 and uint16
    are read where they lie. camera_to_world: (F, 4, 4), metres, camera x right, y down, z forward; None for a single frame. intrinsics:
    a topple.stages.Intrinsics. colours: (F, H, W, 3) uint8 sRGB, or a list with None where there is none, seen from the same places;
    colour_intrinsics: of these, where they are not those of depth.

    disturbances: a list of "human", "wind", "earthquake", "reach", which may be empty; or one of these names; or None for
    all that there are. people: who is in the room, "adults", "children", "toddlers", "elderly" or "wheelchair", or a list of
    these; "reach" is what some of them do who reach for things, and comes in only with them.

    device: a Device of open_device(), or a backend's name. motion: a file, or a list of files; where these do not tell it, motion_unit is
    how many metres their unit has, motion_rate how many frames a second, and motion_up what is up in them, three numbers. accelerogram: a
    file, or a tuple of up to three with a record's components along, across and up, None for one that is not known; accelerogram_unit:
    "g", "m/s2" or "cm/s2", else what the file says, else g. hazard: a file. normals: of
    points, as they are given. viewpoint: where the sensor was, three numbers, or (N, 3) where each point was seen from, NaN where it is not
    known, which Result.notes says: of several scans, or a sensor that moved. colours: of points, sRGB as uint8, an array of shape (N, 3),
    records with fields red, green, blue, or a tuple of three arrays; 0, 0, 0 where it is not known. Give them where you have them: they help to
    tell things apart that touch (docs/formats.md). progress(stage, done) is called as stages start and go on: done is about
    how much of the whole parse is done, 0 to 1, and never falls. pga_m_s2: the peak of earthquakes in m/s2, of which 0.3 g are 2.94. contents_kg_m3: of closed furniture, or None where all is solid.
    materials: "household" or a file (docs/disturbances.md): what things weigh by their names or sizes.
    corrections: what you know of the room beside the scan: a file, or a list of dicts such as {"do": "fixed", "at_m":
    [[x, y, z]]} (docs/corrections.md); Result.corrections says what became of each. cache_file: keeps what does not
    depend on them, so that the next parse of that file or folder is quick; of what is in memory nothing is kept, and it is
    refused. tile_m: 5 or more has a cloud in a file parsed in blocks (docs/scale.md), of which as many are read together as lie in a tile
    of that edge, metres. name: of points or frames in memory, what messages, the report and Result.source call them; "points"
    or "frames" without.
    space_fields=True: Result.write() writes fields.vdb, too, how people and wind pass through space (docs/output.md).
    cancelled() is polled, and True stops the parse with an Error of kind "cancelled". Ctrl-C stops it, too, with
    KeyboardInterrupt. isolate=False: meshes, OctoMaps and OpenVDB files are read in this process, not in one of
    its own with limits of memory and time; for large files that you trust. Other threads of Python run meanwhile. The other options
    are those of `topple parse --help-all`.
    """
    given = {'voxel_m': voxel_m, 'unit_m': unit_m, 'up': up, 'people': people, 'seed': seed, 'isolate': isolate, 'space_fields': space_fields, 'max_memory_bytes': max_memory_bytes,
             'density_kg_m3': density_kg_m3, 'friction': friction, 'contents_kg_m3': contents_kg_m3, 'walks': walks,
             'wind_m_s': wind_m_s, 'wind_from_deg': wind_from_deg, 'pga_m_s2': pga_m_s2,
             'floor_amplification': floor_amplification, 'tolerable_J': tolerable_J, 'stability_level': stability_level, 'grouping_time_s': grouping_time_s, 'tile_m': tile_m}
    options = _options_of(disturbances, given)
    device, viewpoints = _option('device', device), []
    if isinstance(source, (str, os.PathLike)) or frames is not None or not _has_rows(viewpoint):
        viewpoint = _option('viewpoint', viewpoint)
    else:
        viewpoint, viewpoints = None, _columns(viewpoint, ('vp_x', 'vp_y', 'vp_z'), 'viewpoint')
    progress, cancelled = _option('progress', progress), _option('cancelled', cancelled)
    body = [_option('motion_unit', motion_unit), _option('motion_rate', motion_rate), _option('motion_up', motion_up)]
    if motion is None and any(value is not None for value in body):
        raise _usage('motion_unit, motion_rate and motion_up: there is no motion that they could be of')
    for file in _files(motion):
        options.read_motion(file, *body)
    accelerogram_unit = _option('accelerogram_unit', accelerogram_unit)
    if accelerogram is not None:
        options.read_accelerogram(*_components(accelerogram), accelerogram_unit)
    elif accelerogram_unit is not None:
        raise _usage('accelerogram_unit: there is no accelerogram whose unit it could be')
    if hazard is not None:
        options.read_hazard_curve(_file('hazard', hazard))
    if materials is not None:
        options.read_materials(_file('materials', materials))
    if isinstance(corrections, (str, os.PathLike)):
        options.read_corrections(os.fspath(corrections))
    elif corrections is not None:
        options.take_corrections(_corrections_text(corrections))
    if cache_file is not None:
        options.set_cache_file(_file('cache_file', cache_file))
    if isinstance(device, str):
        device = open_device(device)
    if (source is None) == (frames is None):
        raise _usage('parse: expected one of a source, which is a path or points, and frames')
    if frames is None and not (camera_to_world is None and intrinsics is None and colour_intrinsics is None):
        raise _usage('camera_to_world, intrinsics and colour_intrinsics are for frames in memory')
    if isinstance(source, (str, os.PathLike)):
        source = _file('source', source)
        if normals is not None or viewpoint is not None or colours is not None or name is not None:
            raise _usage('normals, colours, viewpoint and name are for points in memory; a file brings its own')
        with formats.opened(source, formats.Options(unit_m=unit_m, isolate=isolate), cancelled) as converted:
            if converted is None:
                parsed = _topple.parse_path(source, device, options, progress, cancelled)
                return Result(parsed, None, frames=source)
            if converted.is_sequence:
                options.unit_m = 1.0
            parsed = _topple.parse_path(os.fspath(converted.path), device, options, progress, cancelled)
            _topple.came_from(parsed, source, converted.notes, list(converted.offset * unit_m))
            converted.needed_by = result = Result(parsed, None, frames=os.fspath(converted.path))
            return result
    if name is None:
        name = 'points' if frames is None else 'frames'
    if not isinstance(name, str) or not name.isprintable() or not name.strip():
        raise _usage(f'name: expected a line of text, not {name!r}'[:200])
    if frames is not None:
        if normals is not None or viewpoint is not None:
            raise _usage('normals and viewpoint are for points; frames have camera_to_world')
        given = _Frames(frames, camera_to_world, intrinsics, colours, colour_intrinsics)
        return Result(given.parse(name, device, options, progress, cancelled), None, frames=given)
    points = _columns(source, ('x', 'y', 'z'), 'points')
    directions = [] if normals is None else _columns(normals, ('nx', 'ny', 'nz'), 'normals')
    channels = [] if colours is None else _channels(colours)
    for what, given in (('normals', directions), ('colours', channels), ('viewpoint', viewpoints)):
        if given and len(given[0]) != len(points[0]):
            raise _usage(f'{what}: expected shape ({len(points[0])}, 3), one for each point, not {len(given[0])} of them')
    parsed = _topple.parse_arrays(points, directions, channels, viewpoint, viewpoints, name, device, options, progress, cancelled)
    return Result(parsed, points, channels)
