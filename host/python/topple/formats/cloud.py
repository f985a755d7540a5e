# SPDX-License-Identifier: MIT
"""Points on their way into a file that topple reads."""
import dataclasses
from typing import List, Optional

import numpy as np

from .errors import wrong

# Where 32-bit coordinates resolve less than half a millimetre, the points are moved, as those of LAS are.
NEAR_M = 4096.0
# Of each point, as PCL calls them.
VIEWPOINT = ('vp_x', 'vp_y', 'vp_z')
MESSAGE_TYPES = {1: 'i1', 2: 'u1', 3: 'i2', 4: 'u2', 5: 'i4', 6: 'u4', 7: 'f4', 8: 'f8'}  # of fields of sensor_msgs/PointCloud2


@dataclasses.dataclass
class Cloud:
    """Points of one file, in its frame and unit."""
    points: np.ndarray  # (N, 3) float64
    colours: Optional[np.ndarray] = None  # (N, 3) uint8, sRGB; 0, 0, 0 where it is not known
    viewpoint: Optional[np.ndarray] = None  # (3,): where the sensor was; (N, 3): for each point, NaN where it is not known
    offset: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(3))  # the file's points are these plus this
    notes: List[str] = dataclasses.field(default_factory=list)

    def moved_near(self, unit_m):
        """The same near the origin, if its first point lies far from it; a unit has unit_m metres."""
        finite = np.isfinite(self.points).all(axis=1)
        if not finite.any():
            return self
        first = self.points[finite.argmax()]
        if (np.abs(first) * unit_m <= NEAR_M).all():
            return self
        shift = np.floor(first)
        said = ', '.join(f'{-s * unit_m:.10g}' for s in shift)
        return dataclasses.replace(
            self, points=self.points - shift, offset=self.offset + shift,
            viewpoint=None if self.viewpoint is None else self.viewpoint - shift,
            notes=self.notes + [f"The file's coordinates lie far from the origin, and were moved by ({said}) m; "
                                'offset_m in scene.json has the exact way back.'])


def write_cloud(path, cloud, source):
    """Writes a binary .ply, or a binary .pcd, which has a place for that of one sensor. source: the file to name in errors."""
    if len(cloud.points) == 0:
        raise wrong(source, 'has no points')
    fields = [('x', '<f4'), ('y', '<f4'), ('z', '<f4')]
    pcd = path.suffix == '.pcd'
    seen_from = cloud.viewpoint is not None and cloud.viewpoint.ndim == 2
    if seen_from:
        fields += [(name, '<f4') for name in VIEWPOINT]
    if cloud.colours is not None:
        fields += [('rgb', '<u4')] if pcd else [('red', 'u1'), ('green', 'u1'), ('blue', 'u1')]
    records = np.empty(len(cloud.points), dtype=fields)
    for axis, name in enumerate('xyz'):
        records[name] = cloud.points[:, axis]
        if seen_from:
            records['vp_' + name] = cloud.viewpoint[:, axis]
    if cloud.colours is not None and pcd:
        red, green, blue = (cloud.colours[:, c].astype(np.uint32) for c in range(3))
        records['rgb'] = red << 16 | green << 8 | blue
    elif cloud.colours is not None:
        for c, name in enumerate(('red', 'green', 'blue')):
            records[name] = cloud.colours[:, c]
    with open(path, 'wb') as out:
        out.write((_pcd_header(records, None if seen_from else cloud.viewpoint) if pcd else _ply_header(records)).encode())
        records.tofile(out)


def kept(cloud, path, folder, options):
    """What convert() of a format returns of a cloud, which it writes into the folder. path: the scan."""
    out = folder / f'points{options.ending}'
    write_cloud(out, cloud, path)
    return out, cloud.notes, cloud.offset


def _ply_header(records):
    kinds = {'f': 'float', 'u': 'uchar'}
    return '\n'.join(['ply', 'format binary_little_endian 1.0', f'element vertex {len(records)}',
                      *(f'property {kinds[records.dtype[name].kind]} {name}' for name in records.dtype.names), 'end_header', ''])


def _pcd_header(records, viewpoint):
    """viewpoint: that of all points, or None."""
    # A quaternion of 1 0 0 0 at the origin would say that the place is not known; its negative turns as little.
    place = '0 0 0 1 0 0 0' if viewpoint is None else ' '.join(repr(float(v)) for v in viewpoint) + ' -1 0 0 0'
    names = records.dtype.names
    kinds = [records.dtype[name].kind.upper() for name in names]
    return '\n'.join(['# .PCD v0.7', 'VERSION 0.7', 'FIELDS ' + ' '.join(names), 'SIZE' + ' 4' * len(names), 'TYPE ' + ' '.join(kinds),
                      'COUNT' + ' 1' * len(names), f'WIDTH {len(records)}', 'HEIGHT 1', f'VIEWPOINT {place}', f'POINTS {len(records)}',
                      'DATA binary', ''])


def message_points(message, path):
    """Points (N, 3) float64, and colours (N, 3) uint8 or None, of a sensor_msgs/PointCloud2. path: what errors name."""
    fields = {field.name: field for field in message.fields}
    missing = [name for name in 'xyz' if name not in fields]
    if missing:
        raise wrong(path, f'has a PointCloud2 without field {missing[0]}')
    order = '>' if message.is_bigendian else '<'
    names = ['x', 'y', 'z'] + [name for name in ('rgb', 'rgba') if name in fields][:1]
    kinds = ['u4' if name.startswith('rgb') else MESSAGE_TYPES[fields[name].datatype] for name in names]
    layout = np.dtype({'names': names, 'formats': [order + kind for kind in kinds],
                       'offsets': [fields[name].offset for name in names], 'itemsize': message.point_step})
    data = np.frombuffer(message.data, np.uint8)
    row = message.width * message.point_step
    if message.row_step < row or len(data) < message.row_step * message.height:
        raise wrong(path, f'has a PointCloud2 of {message.width} x {message.height} points in {len(data)} bytes')
    rows = data[:message.row_step * message.height].reshape(message.height, message.row_step)[:, :row]
    records = np.ascontiguousarray(rows).reshape(-1).view(layout)
    points = np.stack([records[axis].astype(float) for axis in 'xyz'], axis=1)
    if len(names) == 3:
        return points, None
    packed = records[names[3]]
    return points, np.stack([packed >> 16 & 255, packed >> 8 & 255, packed & 255], axis=1).astype(np.uint8)
