# SPDX-License-Identifier: MIT
"""A Result for the viewer Rerun."""
import os

import numpy as np

from . import geometry
from ._arrays import usage
from ._optional import needed

RELATIONS = {'fixed': (90, 90, 90), 'support': (60, 130, 240), 'adjacent': (200, 200, 120)}
ARROW_M = 0.15  # of the field's greatest speed


def to_rerun(result, *, save=None, spawn=False, recording=None, frame=None):
    """Logs a Result to Rerun (pip install rerun-sdk): scan/points, scan/objects (coloured by unsafety), solids/object_N (voxels),
    objects/object_N (boxes with labels), objects/object_N/why, contacts, supports, fields/NAME and risk/NAME (J by object id).
    Coordinates are the scan's, in metres.

    save: the .rrd file to write. spawn: opens the viewer. recording: a rerun.RecordingStream to log to, else one of its own;
    returns it. One of the three has to be given. frame: of a scan that is still being made, the number on the timeline "frame" from
    which on this is what there is; without one it is at all times. Raises topple.Error of kind "usage"."""
    if save is None and not spawn and recording is None:
        raise usage("to_rerun: say where to: save='scene.rrd', spawn=True, or recording=...")
    rr = needed('rerun', 'rerun-sdk', 'to_rerun')
    stream = recording if recording is not None else rr.RecordingStream('topple')
    if spawn:
        stream.spawn()
    if save is not None:
        stream.save(os.fspath(save))
    if frame is not None:
        stream.set_time('frame', sequence=frame)
        stream.log('/', rr.Clear(recursive=True))
    log = _Log(rr, stream, result, frame is None)
    for part in (log.axes, log.points, log.solids, log.objects, log.contacts, log.fields, log.risk):
        part()
    stream.flush()
    return stream


class _Log:
    def __init__(self, rr, stream, result, static):
        self.rr, self.stream, self.result, self.static = rr, stream, result, static
        self.turn = geometry.room_axes(result).T

    def put(self, path, what):
        self.stream.log(path, what, static=self.static)

    def axes(self):
        """Which of the scan's axes is up, where one is."""
        up = np.array(self.result.up)
        axis = int(np.abs(up).argmax())
        if abs(up[axis]) > np.cos(np.deg2rad(5)):
            name = f'RIGHT_HAND_{"XYZ"[axis]}_{"UP" if up[axis] > 0 else "DOWN"}'
            self.put('/', getattr(self.rr.ViewCoordinates, name))

    def points(self):
        points = geometry.points_of(self.result)
        self.put('scan/points', self.rr.Points3D(points))
        self.put('scan/objects', self.rr.Points3D(points, colors=geometry.label_colours(self.result, self.result.point_object)))

    def solids(self):
        points, owners = geometry.solid_points(self.result)
        half = [self.result.voxel_size_m / 2] * 3
        turn = self.rr.Quaternion(xyzw=geometry.quaternion(self.turn))
        for o in self.result.objects:
            of = points[owners == o.id]
            if len(of):
                self.put(f'solids/object_{o.id}', self.rr.Boxes3D(
                    centers=of, half_sizes=[half] * len(of), quaternions=[turn] * len(of), fill_mode='solid',
                    colors=[geometry.unsafety_colour(o)] * len(of)))

    def objects(self):
        items = {o.id: o for o in self.result.objects}
        turn = self.rr.Quaternion(xyzw=geometry.quaternion(self.turn))
        for box in geometry.boxes(self.result):
            o = items[box.object]
            self.put(f'objects/object_{o.id}', self.rr.Boxes3D(centers=[box.centre], half_sizes=[box.size / 2], quaternions=[turn],
                                                               labels=[geometry.described(o)], colors=[geometry.unsafety_colour(o)]))
        for o in self.result.objects:
            self.put(f'objects/object_{o.id}/why', self.rr.TextDocument(' '.join(filter(None, [o.why, o.advice]))))

    def contacts(self):
        lines, contacts = geometry.contact_lines(self.result)
        self.put('contacts', self.rr.LineStrips3D(lines, colors=[RELATIONS[c.relation] for c in contacts]))
        pairs = [(s.supporter, s.supported) for s in self.result.supports]
        between = geometry.links(self.result, pairs)
        self.put('supports', self.rr.Arrows3D(origins=between[:, 0], vectors=between[:, 1] - between[:, 0],
                                              labels=[f'{a} carries {b}' for a, b in pairs], show_labels=False))

    def fields(self):
        for name, field in self.result.fields.items():
            origins = np.stack([field[c] for c in 'xyz'], axis=1)
            vectors = np.stack([field[c] for c in ('vx', 'vy', 'vz')], axis=1)
            fastest = np.linalg.norm(vectors, axis=1).max(initial=0)
            if fastest > 0:
                self.put(f'fields/{name}', self.rr.Arrows3D(origins=origins, vectors=vectors * (ARROW_M / fastest)))

    def risk(self):
        for name in self.result.fields:
            self.put(f'risk/{name}', self.rr.BarChart(np.array([o.risk_J.get(name, 0.0) for o in self.result.objects])))
