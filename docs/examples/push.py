# SPDX-License-Identifier: MIT
# push.py OUT DIR [--objects 3 7 ...]: what it takes to upset objects, by MuJoCo and by topple, which it needs
# PyPI's mujoco and numpy for. OUT is the output folder of a parse, DIR its export (topple export OUT --mjcf DIR).
#
# Each object gets a sudden horizontal push at its centre of mass, an impulse m v, in 16 directions, while all else
# stays free to move. The least energy m v^2 / 2 that leaves it tilted, dropped, or a metre away is found by bisection,
# and stands beside the barrier of scene.json, which is the least energy of any way out of its place, and beside the
# S(W) of its curve. Two times: with the friction of the parse, and with feet that grip, as on rubber.
#
# The barrier is a lower bound, so that no push should take less, beyond the barrier's error. It may well take more. With
# its own friction, an object that is pushed at its centre often slides and stops. With feet that grip, the jerk of the
# held foot takes a part: of a box of width a and height c, 1/4 and more; ratios of 4/3 (1 + (a/c)^2), 1.3 to 2.7, are right.
import argparse
import json
import os

import mujoco
import numpy as np

DIRECTIONS = 16
GRIP = 5.0  # coefficient of friction
SETTLING_S, WATCHED_S, MOST = 0.3, 2.0, 20  # most: times the barrier


class Room:
    def __init__(self, folder):
        self.model = mujoco.MjModel.from_xml_path(os.path.join(folder, 'scene.xml'))
        self.data = mujoco.MjData(self.model)
        while self.data.time < SETTLING_S:
            mujoco.mj_step(self.model, self.data)
        self.state = np.empty(mujoco.mj_stateSize(self.model, mujoco.mjtState.mjSTATE_INTEGRATION))
        mujoco.mj_getState(self.model, self.data, self.state, mujoco.mjtState.mjSTATE_INTEGRATION)

    def upset(self, body, velocity):
        """Whether the body, set off with that velocity, tilts for good, drops, or ends far away."""
        model, data = self.model, self.data
        mujoco.mj_setState(model, data, self.state, mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_forward(model, data)
        start, up = data.xpos[body].copy(), data.xmat[body].reshape(3, 3)[2].copy()
        dof = model.jnt_dofadr[model.body_jntadr[body]]
        data.qvel[dof:dof + 3] += velocity
        end = data.time + WATCHED_S
        tilt_deg, away = 0.0, np.zeros(3)
        while data.time < end:
            mujoco.mj_step(model, data)
            # The world's z in the body's axes: where it no longer points as it did, the body has tilted.
            tilt_deg = np.degrees(np.arccos(np.clip(data.xmat[body].reshape(3, 3)[2] @ up, -1, 1)))
            away = data.xpos[body] - start
            speed = np.abs(data.qvel[dof:dof + 6]).max()
            if tilt_deg > 60 or away[2] < -0.3 or (speed < 1e-3 and data.time > end - WATCHED_S + 0.1):
                break
        return bool(tilt_deg > 20 or away[2] < -0.05 or np.hypot(*away[:2]) > 1)

    def least_energy(self, name, most_J, grip):
        """The least energy of a push that upsets it, and its direction in degrees; None where even most_J does not."""
        model = self.model
        body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name)
        mass, friction = model.body_mass[body], model.geom_friction.copy()
        if grip:  # of two that touch, the larger coefficient counts
            model.geom_friction[model.geom_bodyid == body, 0] = GRIP
        best, best_direction = most_J, None
        for n in range(DIRECTIONS):
            angle = 2 * np.pi * n / DIRECTIONS
            along = np.array([np.cos(angle), np.sin(angle), 0])

            def upset(energy):
                return self.upset(body, np.sqrt(2 * energy / mass) * along)

            # A direction that isn't better than the best by 3 % takes one trial.
            if not upset(0.97 * best):
                continue
            low, high = 0.0, 0.97 * best
            while high - low > 0.03 * high:
                middle = (low + high) / 2
                low, high = (low, middle) if upset(middle) else (middle, high)
            best, best_direction = high, np.degrees(angle)
        model.geom_friction[:] = friction
        return (best, best_direction) if best_direction is not None else (None, None)


def chosen(scene, ids):
    """Objects to push: those that are named, or what is small, stands free and has a barrier above its error."""
    if ids:
        return [scene['objects'][i] for i in ids]
    carriers = {s['supporter'] for s in scene['supports']}
    found = [o for o in scene['objects'] if not o['grounded'] and o['seen_enough'] and o['id'] not in carriers
             and o['mode'] == 'tip' and o['barrier_J'] > 2 * o['barrier_error_J']]
    return sorted(found, key=lambda o: o['barrier_J'])[:6]


def row(o, feet, energy, direction):
    barrier, error = o['barrier_J'], o['barrier_error_J']
    begin = f"{o['id']:6} {o['mass_kg']:8.3g} {o['mode']:>5} {barrier:8.3g} \u00b1 {error:<5.2g}   {feet:7}"
    if energy is None:
        return f"{begin} {'':8} {'':>5} {'':8} {'> ' + str(MOST):>6}  not upset"
    # What topple says that a push of that energy could set free.
    released = max((step['S_J'] for step in o['instability'] if step['W_J'] <= energy), default=0)
    word = 'less than the barrier' if energy < barrier - error else 'within its error' if energy < barrier + error else 'more'
    return f'{begin} {energy:8.3g} {direction:4.0f}\u00b0 {released:8.3g} {energy / barrier:6.2f}  {word}'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('out')
    parser.add_argument('export')
    parser.add_argument('--objects', type=int, nargs='*', help='their ids; else six that stand free and would tip')
    arguments = parser.parse_args()
    with open(os.path.join(arguments.out, 'scene.json'), encoding='utf-8') as file:
        scene = json.load(file)
    room = Room(arguments.export)
    print(f'MuJoCo {mujoco.mj_versionString()}, pushes in {DIRECTIONS} directions at the centre of mass')
    print(f"{'object':>6} {'mass kg':>8} {'mode':>5} {'barrier J':>16}   {'feet':7} {'push J':>8} {'to':>5} {'S(W) J':>8} {'ratio':>6}")
    for o in chosen(scene, arguments.objects):
        for grip in (False, True):
            energy, direction = room.least_energy(f"object_{o['id']}", MOST * o['barrier_J'], grip)
            print(row(o, 'grip' if grip else 'as is', energy, direction), flush=True)


if __name__ == '__main__':
    main()
