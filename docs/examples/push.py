# SPDX-License-Identifier: MIT
# push.py OUT DIR [--objects 3 7 ...]: what it takes to upset objects in MuJoCo, against what topple says. It needs PyPI's
# mujoco and numpy. OUT is the output folder of a parse, DIR its export (topple export OUT --mjcf DIR).
#
# The barrier of scene.json is the least energy of any way out of its place: a lower bound for every one. Two are tried,
# while all else stays free to move, and the least energy that leaves the object tilted, dropped, or a metre away is found
# by bisection, to 3 %:
#   push: an impulse m v at the centre of mass, in the best of 16 directions; its energy is m v^2 / 2. It should take the
#         barrier or more, and mostly takes far more: things slide on 0.3 of friction, and the jerk at their feet is lost.
#   turn: the object starts to turn over the edge that topple names, with nothing lost: this should take the barrier.
# S(W) is what scene.json says that the energy of the push could set free; `cut`, of bodies.json, is the share of the object
# that the export had to cut off, so that it lies in no other: where that took or made a foot, the object stands otherwise
# there than in the scan, and its barrier is another.
import argparse
import json
import os
import sys

import mujoco
import numpy as np

DIRECTIONS = 16
MOST = 20  # times the barrier
SETTLING_S, WATCHED_S = 0.3, 4.0
STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class Room:
    def __init__(self, folder):
        self.model = mujoco.MjModel.from_xml_path(os.path.join(folder, 'scene.xml'))
        self.data = mujoco.MjData(self.model)
        self.step(SETTLING_S)
        self.state = np.empty(mujoco.mj_stateSize(self.model, STATE))
        mujoco.mj_getState(self.model, self.data, self.state, STATE)

    def step(self, seconds):
        for _ in range(round(seconds / self.model.opt.timestep)):
            mujoco.mj_step(self.model, self.data)

    def body(self, o):
        return mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, f"object_{o['id']}")

    def freedom(self, body):
        first = self.model.jnt_dofadr[self.model.body_jntadr[body]]
        return slice(first, first + 6)

    def upset(self, body, motion):
        """Whether the body, set off with these velocities, tilts for good, drops, or ends far away."""
        model, data, its = self.model, self.data, self.freedom(body)
        mujoco.mj_setState(model, data, self.state, STATE)
        mujoco.mj_forward(model, data)
        start, up = data.xpos[body].copy(), data.xmat[body].reshape(3, 3)[2].copy()
        data.qvel[its] += motion
        # By steps: where numbers overflow, MuJoCo sets its clock back.
        steps, some = round(WATCHED_S / model.opt.timestep), round(0.3 / model.opt.timestep)
        for step in range(steps):
            mujoco.mj_step(model, data)
            # The world's z in the body's axes: where it no longer points as it did, the body has tilted.
            tilt_deg = np.degrees(np.arccos(np.clip(data.xmat[body].reshape(3, 3)[2] @ up, -1, 1)))
            away = data.xpos[body] - start
            if tilt_deg > 60 or away[2] < -0.3:
                return True
            if step > some and np.abs(data.qvel[its]).max() < 1e-3:
                break
        return bool(tilt_deg > 20 or away[2] < -0.05 or np.hypot(*away[:2]) > 1)

    def least(self, body, unit, best):
        """The least energy below `best` with which this motion, of a joule, upsets the body; `best` where none does."""
        low, high = 0.0, 0.97 * best
        if not self.upset(body, np.sqrt(high) * unit):
            return best
        while high - low > 0.03 * high:
            middle = (low + high) / 2
            low, high = (low, middle) if self.upset(body, np.sqrt(middle) * unit) else (middle, high)
        return high

    def push(self, o):
        """The least energy of a push at the centre of mass, or None above MOST barriers."""
        body, best = self.body(o), MOST * o['barrier_J']
        for tried, angle in enumerate(2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS):
            print(f"\robject {o['id']}: direction {tried + 1} of {DIRECTIONS}", end="", file=sys.stderr, flush=True)
            unit = np.zeros(6)
            unit[:2] = np.sqrt(2 / self.model.body_mass[body]) * np.array([np.cos(angle), np.sin(angle)])
            best = self.least(body, unit, best)
        return best if best < MOST * o['barrier_J'] else None

    def turn(self, o, world_from_input):
        """The least energy with which it turns over the edge of its `why`, or None."""
        if len(o['why']['edge_m']) != 2:
            return None
        ends = [(world_from_input @ np.append(end, 1))[:3] for end in o['why']['edge_m']]
        model, data, body = self.model, self.data, self.body(o)
        mujoco.mj_setState(model, data, self.state, STATE)
        mujoco.mj_forward(model, data)
        axis = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        arm = data.xpos[body] - ends[0]
        over = ends[0] - data.xpos[body]
        over -= (over @ axis) * axis
        if np.cross(axis, arm) @ [*over[:2], 0] < 0:
            axis = -axis
        data.qvel[:] = 0
        its = self.freedom(body)
        data.qvel[its] = [*np.cross(axis, arm), *(data.xmat[body].reshape(3, 3).T @ axis)]
        mujoco.mj_energyVel(model, data)
        unit = data.qvel[its] / np.sqrt(data.energy[1])
        best = self.least(body, unit, MOST * o['barrier_J'])
        return best if best < MOST * o['barrier_J'] else None


def chosen(scene, ids):
    """Objects to push: those that are named, or the six of the lowest barriers among what stands free and would tip."""
    if ids:
        return [scene['objects'][i] for i in ids]
    carriers = {s['supporter'] for s in scene['supports']}
    found = [o for o in scene['objects'] if not o['grounded'] and o['seen_enough'] and o['id'] not in carriers
             and o['mode'] == 'tip' and o['barrier_J'] > 2 * o['barrier_error_J']]
    return sorted(found, key=lambda o: o['barrier_J'])[:6]


def against(o, energy):
    """An energy, how many barriers it is, and whether the barrier's error explains the difference."""
    barrier, error = o['barrier_J'], o['barrier_error_J']
    if energy is None:
        return f"{'-':>8} {'> ' + str(MOST):>5} {'':8}"
    word = 'less' if energy < barrier - 2 * error else 'agrees' if energy < barrier + 2 * error else 'more'
    return f'{energy:8.3g} {energy / barrier:5.2f} {word:8}'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('out')
    parser.add_argument('export')
    parser.add_argument('--objects', type=int, nargs='*', help='their ids; else six that stand free and would tip')
    arguments = parser.parse_args()
    with open(os.path.join(arguments.out, 'scene.json'), encoding='utf-8') as file:
        scene = json.load(file)
    with open(os.path.join(arguments.export, 'bodies.json'), encoding='utf-8') as file:
        bodies = {b['object']: b for b in json.load(file)['bodies']}
    world_from_input = np.array(scene['manhattan_from_input'])
    room = Room(arguments.export)
    print(f'MuJoCo {mujoco.mj_versionString()}; a ratio is over the barrier, which agrees within two standard errors')
    print(f"{'object':>6} {'mass kg':>8} {'barrier J':>18} {'turn J':>8} ratio {'':8} {'push J':>8} ratio {'':8} {'S(W) J':>7} {'cut':>5}")
    objects = chosen(scene, arguments.objects)
    if not objects:
        print('none: no object stands free, was seen enough and would tip before it slides, with a barrier above twice its error; --objects names others')
    for o in objects:
        turn, push = room.turn(o, world_from_input), room.push(o)
        print('\r' + 40 * ' ' + '\r', end='', file=sys.stderr, flush=True)
        sets_free = max((s['S_J'] for s in o['instability'] if push and s['W_J'] <= push), default=0)
        cut = bodies[o['id']]['lost_m3'] / bodies[o['id']]['solid_m3']
        print(f"{o['id']:6} {o['mass_kg']:8.3g} {o['barrier_J']:9.3g} \u00b1 {o['barrier_error_J']:<6.2g} {against(o, turn)} "
              f'{against(o, push)} {sets_free:7.3g} {cut:5.1%}', flush=True)


if __name__ == '__main__':
    main()
