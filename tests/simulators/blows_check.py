# SPDX-License-Identifier: MIT
"""The least energy of a level blow that makes a thing fall, in MuJoCo, beside that of topple's table.

blows_check.py FILE: the things of blows_test.cpp, as boxes, and for each direction and height what the table says.
A blow is an impulse: it gives the thing its speed and its turning at once. It falls where its centre of mass comes to
be lower by a voxel within four seconds.
"""
import json
import math
import sys

from expected import needed

mujoco = needed('mujoco')
np = needed('numpy')

GRAVITY = 9.80665
STEP_S = 0.001
RISE, MOST = 1.25, 12  # blows of more than so many times the barrier are not tried


def geom(box, extra):
    low, high = np.array(box[0::2]), np.array(box[1::2])
    middle, half = (low + high) / 2, (high - low) / 2
    return (f'<geom type="box" pos="{middle[0]} {middle[1]} {middle[2]}" size="{half[0]} {half[1]} {half[2]}" '
            f'solref="0.004 1" {extra}/>')


class Struck:
    def __init__(self, thing, friction, density, voxel_m):
        rub = f'friction="{friction} 0 0"'
        self.model = mujoco.MjModel.from_xml_string(
            f'<mujoco><option timestep="{STEP_S}" gravity="0 0 {-GRAVITY}" cone="elliptic" impratio="10" '
            'integrator="implicitfast"/><worldbody>' + ''.join(geom(b, rub) for b in thing['fixed']) +
            '<body><freejoint/>' + ''.join(geom(b, f'{rub} density="{density}"') for b in thing['parts']) +
            '</body></worldbody></mujoco>')
        self.data = mujoco.MjData(self.model)
        self.base = min(b[4] for b in thing['parts'])
        self.voxel_m = voxel_m
        for _ in range(300):
            mujoco.mj_step(self.model, self.data)
        self.rest = self.data.qpos.copy()
        mujoco.mj_forward(self.model, self.data)
        self.mass = self.model.body_mass[1]
        turn = self.data.ximat[1].reshape(3, 3)
        self.inverse = turn @ np.diag(1 / self.model.body_inertia[1]) @ turn.T
        self.center = self.data.xipos[1].copy()

    def falls(self, way, height, energy):
        data, model = self.data, self.model
        mujoco.mj_resetData(model, data)
        data.qpos[:] = self.rest
        push = np.array([way[0], way[1], 0])
        spin = np.cross([0, 0, self.base + height - self.center[2]], push)
        turning = self.inverse @ spin
        impulse = math.sqrt(2 * energy / (1 / self.mass + spin @ turning))
        turning = impulse * turning
        # A free joint has the velocity of its frame's origin, and turns about its own axes, which are the world's.
        data.qvel[:3] = impulse * push / self.mass - np.cross(turning, self.center - self.rest[:3])
        data.qvel[3:] = turning
        for step in range(int(4 / STEP_S)):
            mujoco.mj_step(model, data)
            if step % 20:
                continue
            if data.xipos[1][2] < self.center[2] - self.voxel_m:
                return True
            if step > 100 and abs(data.qvel).max() < 2e-3:
                return False
        return False

    def least(self, way, height, barrier):
        # Rising: a blow that is far too strong may turn a thing right round, or knock its foot away and leave it standing.
        low, high = barrier / RISE, barrier
        while not self.falls(way, height, high):
            low, high = high, RISE * high
            if low >= MOST * barrier:
                return math.inf
        while high > 1.04 * low:
            between = math.sqrt(low * high)
            if self.falls(way, height, between):
                high = between
            else:
                low = between
        return high


def ranks(values):
    order = np.argsort(values)
    out = np.empty(len(values))
    out[order] = np.arange(len(values))
    for value in set(values):  # the mean of their places where they are equal
        same = np.array(values) == value
        out[same] = out[same].mean()
    return out


def main():
    with open(sys.argv[1], encoding='utf-8') as file:
        scene = json.load(file)
    own, theirs, high = [], [], []
    for thing in scene['things']:
        struck = Struck(thing, scene['friction'], scene['density_kg_m3'], scene['voxel_m'])
        barrier = max(thing['barrier_J'], 1e-4)
        for blow in thing['blows']:
            table = math.inf if blow['W_J'] is None else blow['W_J']
            least = struck.least(blow['way'], blow['height_m'], barrier)
            own.append(min(table, MOST * barrier) / barrier)
            theirs.append(min(least, MOST * barrier) / barrier)
            high.append((barrier, blow['height_m'] + struck.base >= struck.center[2]))
    own, theirs = np.array(own), np.array(theirs)
    scale, above = np.array([h[0] for h in high]), np.array([h[1] for h in high])
    near = np.maximum(own / theirs, theirs / own) <= 1.25
    falls = (own < MOST) | (theirs < MOST)
    rank = np.corrcoef(ranks(list(own * scale)), ranks(list(theirs * scale)))[0, 1]
    print(f'{len(own)} blows: rank correlation {rank:.3f}; within 25 %: {100 * near.mean():.1f} % of all, '
          f'{100 * near[falls].mean():.1f} % of those that fall by {MOST} barriers in either, '
          f'{100 * near[falls & above].mean():.1f} % of those that meet it above its centre')
    return 0 if rank >= 0.95 and near.mean() >= 0.85 else 1


if __name__ == '__main__':
    sys.exit(main())
