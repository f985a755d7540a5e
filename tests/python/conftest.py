# SPDX-License-Identifier: MIT
import numpy as np
import pytest

import topple
from made_scans import CAMERA, POSES, box, colours_of, face, parsed, photograph, seen_from
from topple.formats import cloud, frames


def room_points():
    """Floor, four walls, a crate on the floor and a box on the crate, z up: (N, 3), float32, metres."""
    random = np.random.default_rng(1)
    x, y, z = np.diag([2.8, 2.4, 1.4])
    faces = [face(random, *sides) for sides in (([0, 0, 0], x, y), ([0, 0, 0], y, z), ([0, 0, 0], x, z), (x, y, z), (y, x, z))]
    faces += box(random, [1.0, 0.9, 0], [0.7, 0.6, 0.5]) + box(random, [1.2, 1.1, 0.5], [0.25, 0.2, 0.35])
    return np.concatenate(faces).astype(np.float32)


@pytest.fixture(scope='session')
def points():
    return room_points()


@pytest.fixture(scope='session')
def device():
    return topple.open_device('native')


@pytest.fixture(scope='session')
def result(points, device):
    return topple.parse(points, device=device, disturbances=['wind'])


@pytest.fixture(scope='session')
def ply(points, device, tmp_path_factory):
    path = tmp_path_factory.mktemp('ply') / 'room.ply'
    cloud.write_cloud(path, cloud.Cloud(points.astype(float), colours_of(points)), path)
    return parsed(path, device)


@pytest.fixture(scope='session')
def walk():
    return [(pose, seen_from(pose)[0]) for pose in POSES]


@pytest.fixture(scope='session')
def sequence(walk, device, tmp_path_factory):
    folder = tmp_path_factory.mktemp('frames') / 'walk'
    out = frames.FrameFolder(folder, folder)
    for pose, depth in walk:
        out.add(CAMERA, depth, pose)
    out.finish()
    return parsed(folder, device)


@pytest.fixture(scope='session')
def photographs(tmp_path_factory):
    folder = tmp_path_factory.mktemp('photographs')
    return [photograph(pose, folder / 'seen.jpg') for pose in POSES]


@pytest.fixture(scope='session')
def coloured_sequence(walk, photographs, device, tmp_path_factory):
    folder = tmp_path_factory.mktemp('coloured') / 'walk'
    out = frames.FrameFolder(folder, folder)
    for (pose, depth), seen in zip(walk, photographs):
        out.add(CAMERA, depth, pose, seen)
    out.finish()
    return parsed(folder, device)
