# SPDX-License-Identifier: MIT
"""A Result as an MCAP file, for Foxglove and what else reads its schemas."""
import contextlib
import os

import numpy as np

from . import geometry
from ._optional import needed

FRAME, ROOM = 'scan', 'room'
TIME_NS = 1_000_000_000  # all is of one time: a parse has none
ARROW_M = 0.05  # thickness of a support's


def to_mcap(result, path):
    """Writes a Result as MCAP with Foxglove's schemas in protobuf (pip install mcap-protobuf-support foxglove-schemas-protobuf). Topics:
    /points and /solids (PointCloud: x y z, object, unsafety; NaN: no rank), /objects (SceneUpdate: a box, a label and metadata each),
    /supports (SceneUpdate: arrows from what carries to what is carried), /contacts (SceneUpdate: lines), /fields/NAME (PointCloud: x y z,
    vx vy vz in m/s, density), /tf (from the frame "room", z up, to "scan", in which all coordinates are, metres).

    The file appears whole or not at all, and replaces an older one. Raises topple.Error of kind "usage", or OSError."""
    schemas = _Schemas()
    writer_of = needed('mcap_protobuf.writer', 'mcap-protobuf-support', 'to_mcap')
    path = os.fspath(path)
    unfinished = os.path.join(os.path.dirname(path), f'.topple-{os.getpid()}-{os.path.basename(path)}')
    try:
        with open(unfinished, 'xb') as file, writer_of.Writer(file) as writer:
            for topic, message in _messages(result, schemas):
                writer.write_message(topic=topic, message=message, log_time=TIME_NS, publish_time=TIME_NS)
        os.replace(unfinished, path)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(unfinished)
        raise


class _Schemas:
    """Messages of foxglove-schemas-protobuf by their names."""

    def __getattr__(self, name):
        module = needed(f'foxglove_schemas_protobuf.{name}_pb2', 'foxglove-schemas-protobuf', 'to_mcap')
        return getattr(module, name)


def _messages(result, schemas):
    yield '/tf', _transform(result, schemas)
    unsafety = np.array([o.unsafety for o in result.objects] + [np.nan], np.float32)
    points, owners = geometry.points_of(result), result.point_object
    yield '/points', _cloud(schemas, points, {'object': owners, 'unsafety': unsafety[owners]})
    solid, owners = geometry.solid_points(result)
    yield '/solids', _cloud(schemas, solid, {'object': owners, 'unsafety': unsafety[owners]})
    yield '/objects', _objects(result, schemas)
    yield '/supports', _supports(result, schemas)
    yield '/contacts', _contacts(result, schemas)
    for name, field in result.fields.items():
        places = np.stack([field[c] for c in 'xyz'], axis=1)
        yield f'/fields/{name}', _cloud(schemas, places, {c: field[c] for c in ('vx', 'vy', 'vz', 'density')})


def _stamp(message):
    message.timestamp.FromNanoseconds(TIME_NS)
    message.frame_id = FRAME
    return message


def _place(pose, position, turn=(0, 0, 0, 1)):
    pose.position.x, pose.position.y, pose.position.z = map(float, position)
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = map(float, turn)


def _paint(colour, rgb, alpha=1.0):
    colour.r, colour.g, colour.b = (c / 255 for c in rgb)
    colour.a = alpha


def _transform(result, schemas):
    out = schemas.FrameTransform(parent_frame_id=ROOM, child_frame_id=FRAME)
    out.timestamp.FromNanoseconds(TIME_NS)
    x, y, z, w = map(float, geometry.quaternion(geometry.room_axes(result)))
    out.rotation.x, out.rotation.y, out.rotation.z, out.rotation.w = x, y, z, w
    return out


def _cloud(schemas, points, values):
    numbers = schemas.PackedElementField
    columns = {**{name: points[:, axis].astype(np.float32) for axis, name in enumerate('xyz')},
               **{name: np.asarray(v) for name, v in values.items()}}
    kinds = {name: np.dtype('<i4' if v.dtype.kind == 'i' else '<f4') for name, v in columns.items()}
    records = np.empty(len(points), dtype=list(kinds.items()))
    for name, v in columns.items():
        records[name] = v
    out = _stamp(schemas.PointCloud(point_stride=records.itemsize, data=records.tobytes()))
    _place(out.pose, (0, 0, 0))
    for name, kind in kinds.items():
        out.fields.add(name=name, offset=records.dtype.fields[name][1], type=numbers.INT32 if kind.kind == 'i' else numbers.FLOAT32)
    return out


def _objects(result, schemas):
    out = schemas.SceneUpdate()
    items = {o.id: o for o in result.objects}
    turn = geometry.quaternion(geometry.room_axes(result).T)
    for box in geometry.boxes(result):
        o = items[box.object]
        entity = _stamp(out.entities.add(id=f'object_{o.id}'))
        cube = entity.cubes.add()
        _place(cube.pose, box.centre, turn)
        cube.size.x, cube.size.y, cube.size.z = map(float, box.size)
        _paint(cube.color, geometry.unsafety_colour(o), alpha=0.5)
        text = entity.texts.add(billboard=True, font_size=12, scale_invariant=True, text=geometry.described(o))
        _place(text.pose, box.centre + np.array(result.up) * (np.abs(geometry.room_axes(result).T[:, 2]) @ box.size / 2))
        _paint(text.color, (255, 255, 255))
        facts = {'mass_kg': o.mass_kg, 'barrier_J': o.barrier_J, 'release_J': o.release_J, 'mode': o.mode, 'why': o.why,
                 **{f'risk_{name}_J': value for name, value in o.risk_J.items()}}
        for key, value in facts.items():
            entity.metadata.add(key=key, value=value if isinstance(value, str) else f'{value:.6g}')
    return out


def _supports(result, schemas):
    out = schemas.SceneUpdate()
    entity = _stamp(out.entities.add(id='supports'))
    for start, end in geometry.links(result, [(s.supporter, s.supported) for s in result.supports]):
        length = float(np.linalg.norm(end - start))
        if length == 0:
            continue
        arrow = entity.arrows.add(shaft_length=0.8 * length, shaft_diameter=ARROW_M / 2, head_length=0.2 * length, head_diameter=ARROW_M)
        _place(arrow.pose, start, _towards((end - start) / length))
        _paint(arrow.color, (60, 130, 240))
    return out


def _towards(direction):
    """The quaternion x y z w that turns x to a direction."""
    half = direction + [1, 0, 0]
    if np.linalg.norm(half) < 1e-6:
        return 0, 0, 1, 0
    half = half / np.linalg.norm(half)
    return *np.cross([1, 0, 0], half), half[0]


def _contacts(result, schemas):
    out = schemas.SceneUpdate()
    entity = _stamp(out.entities.add(id='contacts'))
    lines, _ = geometry.contact_lines(result)
    line = entity.lines.add(type=schemas.LinePrimitive.LINE_LIST, thickness=2, scale_invariant=True)
    _place(line.pose, (0, 0, 0))
    _paint(line.color, (200, 200, 120))
    for x, y, z in lines.reshape(-1, 3):
        line.points.add(x=x, y=y, z=z)
    return out
