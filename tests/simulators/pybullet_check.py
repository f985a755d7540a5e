# SPDX-License-Identifier: MIT
"""The single URDFs, placed as scene.urdf says, as Bullet reads and runs them."""
import os
import sys
import tempfile
import xml.etree.ElementTree

from expected import Expected, matrix, near, near_inertia, needed

pybullet = needed('pybullet')
np = needed('numpy')

# Bullet makes hulls so much thicker, but their corners round: its meshes are thinner by that.
MARGIN_M = 0.001


class Heard:
    """What is written to the terminal meanwhile, by C, too."""

    def __enter__(self):
        self.file = tempfile.TemporaryFile('w+')
        sys.stdout.flush()
        self.kept = [os.dup(1), os.dup(2)]
        for stream in (1, 2):
            os.dup2(self.file.fileno(), stream)
        return self

    def __exit__(self, *_):
        for stream, kept in zip((1, 2), self.kept):
            os.dup2(kept, stream)
        self.file.seek(0)
        self.text = self.file.read()


def load(expected):
    out = {}
    for joint in xml.etree.ElementTree.parse(expected.path('scene.urdf')).iter('joint'):
        if joint.find('parent').get('link') != 'world':
            continue
        name = joint.find('child').get('link')
        place = [float(v) for v in joint.find('origin').get('xyz').split()]
        file = expected.path('scene_urdf', name + '.urdf')
        out[name] = pybullet.loadURDF(file, place, flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
    return out


def reach(number, axis, sign):
    """How far a body extends along an axis: by its distance from a plate beyond it."""
    half, place = np.full(3, 20.0), np.zeros(3)
    half[axis], place[axis] = 0.5, sign * 10
    shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half)
    plate = pybullet.createMultiBody(0, shape, basePosition=place)
    distance = min(point[8] for point in pybullet.getClosestPoints(number, plate, 20, linkIndexA=-1))
    pybullet.removeBody(plate)
    return sign * (9.5 - distance)


def check(expected, name, number):
    body = expected.bodies[name]
    mass, friction, moments, _, turn = pybullet.getDynamicsInfo(number, -1)[:5]
    near(name, mass, 0 if body['fixed'] else body['mass'], 1e-5 * body['mass'])
    # Bullet multiplies those of both bodies.
    near(name, friction ** 2, body['friction'], 1e-6)
    place, turned = pybullet.getBasePositionAndOrientation(number)
    near(name, place, body['center'], 1e-5)
    if not body['fixed']:
        near_inertia(name, moments, matrix(turned[3], *turned[:3]), body)
    parts = body['parts'].values()
    for axis in range(3):
        near(name, reach(number, axis, -1), min(p['low'][axis] for p in parts), 0.001 + MARGIN_M)
        near(name, reach(number, axis, 1), max(p['high'][axis] for p in parts), 0.001 + MARGIN_M)
    assert pybullet.getNumJoints(number) == len(body['fronts']), name
    for joint, (front, wanted) in enumerate(sorted(body['fronts'].items())):
        info = pybullet.getJointInfo(number, joint)
        assert (info[1].decode(), info[12].decode()) == (wanted['joint'], front), front
        assert info[2] == (pybullet.JOINT_PRISMATIC if wanted['slides'] else pybullet.JOINT_REVOLUTE), front
        near(front, info[8:10], [0, wanted['most']], 1e-6)
        turned = pybullet.getLinkState(number, joint)[1]  # the axis is told in the frame of principal inertia
        near(front, matrix(turned[3], *turned[:3]) @ info[13], wanted['axis'], 1e-5)
        near(front, pybullet.getDynamicsInfo(number, joint)[0], wanted['mass'], 1e-5 * wanted['mass'])
        near(front, pybullet.getLinkState(number, joint)[0], wanted['center'], 1e-5)
    seen = pybullet.getVisualShapeData(number)
    assert any(shape[4].decode().endswith(name + '.obj') for shape in seen) or not body['colours'], name


expected = Expected(sys.argv[1])
pybullet.connect(pybullet.DIRECT)
pybullet.setGravity(0, 0, -expected.gravity)
with Heard() as heard:
    numbers = load(expected)
assert 'Warning' not in heard.text and 'rror' not in heard.text, heard.text
assert set(numbers) == set(expected.bodies)
for name, number in numbers.items():
    check(expected, name, number)
for _ in range(240):
    pybullet.stepSimulation()
for name, body in expected.bodies.items():
    place = np.array(pybullet.getBasePositionAndOrientation(numbers[name])[0])
    near(f'{name} after a second', place - body['center'], [0, 0, 0], 0.003)
print('pybullet has read all')
