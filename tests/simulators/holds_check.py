# SPDX-License-Identifier: MIT
"""Whether what pulls at a thing or climbs it makes it fall, in MuJoCo, beside what topple says.

holds_check.py FILE: the things of holds_test.cpp, as boxes, and the loads on them. A hand's force grows in a second, follows what
moves at 0.3 m/s at most, and lets go after an arm's length; a climber's weight, a fifth of the thing's, hangs as far before the
edge as its moment says.
"""
import json
import sys

from blows_check import GRAVITY, STEP_S, Struck, mujoco, np

GROWS_S, HAND_M_S, WATCHED_S = 1.0, 0.3, 4.0


class Held(Struck):
    def gives(self, hold):
        data, model = self.data, self.model
        mujoco.mj_resetData(model, data)
        data.qpos[:] = self.rest
        mujoco.mj_forward(model, data)
        climbs = hold['climber_Nm'] > 0
        level = np.array([*hold['way'], 0.0])
        most = 0.2 * self.mass * GRAVITY if climbs else hold['force_N']
        way = np.array([0, 0, -1.0]) if climbs else level
        point = np.array([*self.center[:2], self.base + hold['height_m']])
        if climbs:
            point += (hold['half_base_m'] + hold['climber_Nm'] / most) * level
        local = data.xmat[1].reshape(3, 3).T @ (point - data.xpos[1])
        last, released = point, False
        for step in range(int(WATCHED_S / STEP_S)):
            at = data.xpos[1] + data.xmat[1].reshape(3, 3) @ local
            speed, last = (at - last) @ way / STEP_S, at
            force = most * min(1.0, step * STEP_S / GROWS_S)
            if not climbs:
                released = released or (at - point) @ way > hold['arm_m']
                force = 0.0 if released else force * np.clip((HAND_M_S - speed) / (0.2 * HAND_M_S), 0, 1)
            data.qfrc_applied[:] = 0
            mujoco.mj_applyFT(model, data, force * way, np.zeros(3), at, 1, data.qfrc_applied)
            mujoco.mj_step(model, data)
            if data.xipos[1][2] < self.center[2] - self.voxel_m:
                return True
        return False


def main():
    with open(sys.argv[1], encoding='utf-8') as file:
        scene = json.load(file)
    rows = []
    for thing in scene['things']:
        held = Held(thing, scene['friction'], scene['density_kg_m3'], scene['voxel_m'])
        rows += [(hold['falls'], held.gives(hold)) for hold in thing['holds']]
    own, theirs = np.array(rows).T
    both, alike = (own & theirs).sum(), (own == theirs).mean()
    print(f'{len(own)} holds: {100 * alike:.1f} % alike, {both} fall in both; precision {100 * both / own.sum():.1f} %, '
          f'recall {100 * both / theirs.sum():.1f} %')
    return 0 if alike >= 0.9 and both >= 0.2 * len(own) else 1


if __name__ == '__main__':
    sys.exit(main())
