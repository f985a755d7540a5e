# SPDX-License-Identifier: MIT
"""Scans for the tests of formats: a room's depth frames by ray casting, and what must hold of what is parsed."""
import numpy as np
import pytest

import topple
from topple.formats import frames


def colours_of(points):
    return (60 + 150 * (points - points.min(axis=0)) / np.ptp(points, axis=0)).astype(np.uint8)


def face(random, corner, u, v):
    """Points of a rectangle with these sides, along the axes: 2500 a square metre."""
    u, v = np.array(u), np.array(v)
    s, t = random.random((2, int(2500 * u.sum() * v.sum()), 1))
    return np.array(corner) + s * u + t * v


def box(random, low, size):
    """The faces of an upright box without its underside, each as points."""
    low, (x, y, z) = np.array(low), np.diag(size)
    return [face(random, *sides) for sides in ((low + z, x, y), (low, x, z), (low + y, x, z), (low, y, z), (low + x, y, z))]


def parsed(path, device, **options):
    return topple.parse(path, device=device, disturbances=[], **options)


def same_objects(result, expected, within=0.0):
    """That both have the same objects, the figures of what can move alike to a share; those of walls of no thickness depend on
    the last bits."""
    assert len(result.objects) == len(expected.objects) > 2
    for one, other in zip(result.objects, expected.objects):
        assert one.grounded == other.grounded
        if one.grounded:
            continue
        assert one.mass_kg == pytest.approx(other.mass_kg, rel=within, abs=0)
        assert one.center_of_mass_m == pytest.approx(other.center_of_mass_m, abs=within)
        assert one.barrier_J == pytest.approx(other.barrier_J, rel=5 * within, abs=0)


def truncated(path, share=0.6):
    cut = path.with_name('cut-' + path.name)
    cut.write_bytes(path.read_bytes()[:int(path.stat().st_size * share)])
    return cut


def refused(path, device, *parts, kind='input', **options):
    with pytest.raises(topple.Error) as error:
        parsed(path, device, **options)
    message = str(error.value)
    assert error.value.kind == kind and '\n' not in message and str(path) in message and 'topple-' not in message, message
    for part in parts:
        assert part in message


SECRET = 'secret of the user'


def tried(call, *arguments):
    """Whether it returned; else it was an Error of one printable line, that tells no secret."""
    try:
        call(*arguments)
        return True
    except topple.Error as error:
        assert str(error).isprintable() and SECRET not in str(error), error
        return False


BOXES = [([1.0, 0.9, 0], [1.7, 1.5, 0.5]), ([1.2, 1.1, 0.5], [1.45, 1.3, 0.85])]  # low, high corners
ROOM = ([0, 0, 0], [2.8, 2.4, 2.2])
CAMERA = frames.Camera(160, 120, 130.0, 130.0, 79.5, 59.5)


def look(eye, target):
    """Camera to world, z up."""
    forward = np.subtract(target, eye) / np.linalg.norm(np.subtract(target, eye))
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    out = np.eye(4)
    out[:3] = np.column_stack([right, np.cross(forward, right), forward, eye])
    return out


def seen_from(pose):
    """Depth in metres along the camera's axis, (height, width), and what is seen there: 0 the room, 1 and 2 the boxes."""
    u, v = np.meshgrid(np.arange(CAMERA.width), np.arange(CAMERA.height))
    rays = np.stack([(u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy, np.ones(u.shape)], axis=-1) @ pose[:3, :3].T
    with np.errstate(divide='ignore', invalid='ignore'):
        def slabs(low, high):
            a, b = (low - pose[:3, 3]) / rays, (high - pose[:3, 3]) / rays
            return np.minimum(a, b).max(axis=-1), np.maximum(a, b).min(axis=-1)
        depth = slabs(*map(np.array, ROOM))[1]
        what = np.zeros(depth.shape, int)
        for number, (low, high) in enumerate(BOXES, 1):
            near, far = slabs(np.array(low), np.array(high))
            hit = (near < far) & (near > 0) & (near < depth)
            depth, what = np.where(hit, near, depth), np.where(hit, number, what)
    return np.round(depth, 3), what


def photograph(pose, file):
    """Writes a JPEG of twice the depth image's size, and returns its bytes."""
    image = pytest.importorskip('PIL.Image')
    paints = np.array([[190, 190, 180], [170, 60, 40], [40, 70, 160]], np.uint8)
    image.fromarray(paints[seen_from(pose)[1].repeat(2, 0).repeat(2, 1)]).save(file, quality=95)
    return file.read_bytes()


POSES = [look([1.4 + 1.1 * np.cos(a), 1.2 + 0.95 * np.sin(a), 1.2 + 0.4 * np.sin(2 * a)], [1.35, 1.2, 0.4])
         for a in np.linspace(0, 2 * np.pi, 18, endpoint=False)]


def graphics(pose):
    """As phones write poses: the camera's y up, looking along -z."""
    return pose @ np.diag([1.0, -1, -1, 1])


def quaternion(matrix):
    """x y z w of a rotation that is no half turn."""
    w = np.sqrt(max(0, 1 + np.trace(matrix))) / 2
    if w < 1e-3:  # by the eigenvector of 1
        values, vectors = np.linalg.eig(matrix)
        axis = np.real(vectors[:, np.argmin(np.abs(values - 1))])
        return [*axis, 0.0]
    return [(matrix[2, 1] - matrix[1, 2]) / (4 * w), (matrix[0, 2] - matrix[2, 0]) / (4 * w),
            (matrix[1, 0] - matrix[0, 1]) / (4 * w), w]
