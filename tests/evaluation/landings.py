#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Where things land that fall, in MuJoCo, beside `fall.lands_m` of scene.json.

  landings.py TOPPLE [--rooms 2] [--kinds kitchen,office] [--turn] [--keep DIR] [--jobs 1]

Generates rooms of each kind, parses and exports them. Each object whose fall is said to happen and that is free in the export
is struck in the direction of its fall, all others being free as well: by impulses of rising energy, at the height at which the
least falls by topple's table (at its centre of mass where it would slide), until it ends tilted by 5 degrees or 2 cm lower. Its
first landing is where its centre of mass, 2 cm lower or tilted by 20 degrees, first loses half of the speed at which it sinks;
where it leans on something at once, where it ends.
Of things that move while the room comes to rest, or that no blow upsets, there is nothing to compare; they are counted.
--turn: what tips starts to turn over the edge that topple names, with nothing lost, as docs/examples/push.py does.
--keep: scans, outputs and exports are put there, by kind and seed, and taken from there where they are.
"""
import argparse
import json
import math
import multiprocessing
import os
import tempfile
from collections import Counter

import mujoco
import numpy as np

from rooms import UNSTABLE, add_options, chosen, generate, run

SETTLING_S, WATCHED_S = 0.5, 3.0
MOVED_M, MOVED_DEG = 0.01, 2.0
FELL_DEG, LIES_DEG, FELL_M, SINKS_M_S = 5.0, 20.0, 0.02, 0.1
WITHIN_M = 0.3
TIMES = (1.05, 1.4, 2, 3, 4.5, 7, 10, 15, 25, 40)  # what the table says
STATE = mujoco.mjtState.mjSTATE_INTEGRATION


def made(topple, kind, seed, folder, *options):
    """The folders of a room's output and export; options: of the parse."""
    out, mjcf = (os.path.join(folder, name) for name in ('out', 'mjcf'))
    if not os.path.exists(os.path.join(mjcf, 'bodies.json')):
        run(topple, 'parse', generate(topple, kind, seed, folder), '-o', out, *options)
        run(topple, 'export', out, '--mjcf', mjcf)
    return out, mjcf


class Room:
    def __init__(self, out, mjcf):
        with open(os.path.join(out, 'scene.json'), encoding='utf-8') as file:
            scene = json.load(file)
        with open(os.path.join(mjcf, 'bodies.json'), encoding='utf-8') as file:
            export = json.load(file)
        self.bodies = {b['object']: b for b in export['bodies'] if b['object'] >= 0 and b['parts'] > 0}
        self.floor_m = export['floor_m'] or 0.0
        self.objects, self.to_world = scene['objects'], np.array(scene['manhattan_from_input'])
        spec = mujoco.MjSpec.from_file(os.path.join(mjcf, 'scene.xml'))
        # Where the scan has no floor things would fall for good.
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], pos=[0, 0, self.floor_m - 0.02])
        self.model = spec.compile()
        self.model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP  # four times as fast, with the same ends
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)
        place, pose = self.data.xpos.copy(), self.data.xquat.copy()
        mujoco.mj_step(self.model, self.data, round(SETTLING_S / self.model.opt.timestep))
        self.moved = {n for n in range(self.model.nbody) if np.linalg.norm(self.data.xpos[n] - place[n]) > MOVED_M or
                      2 * math.degrees(math.acos(min(1, abs(self.data.xquat[n] @ pose[n])))) > MOVED_DEG}
        self.state = np.empty(mujoco.mj_stateSize(self.model, STATE))
        mujoco.mj_getState(self.model, self.data, self.state, STATE)

    def world(self, point):
        return (self.to_world @ np.append(point, 1))[:3]

    def body(self, o):
        return self.model.body(f"object_{o['id']}").id

    def blow(self, o):
        """Direction, height above its base and energy of the least blow that makes it fall, as topple has it."""
        way = (self.to_world[:3, :3] @ o['direction'])[:2]
        length = np.linalg.norm(way)
        if length < 0.1:
            return None
        table = o['barrier_by_direction']
        least = max(o['barrier_J'], 1e-4)
        if o['mode'] == 'slide' or not table['blow_J']:
            return way / length, None, least
        blows = table['blow_J'][round(math.degrees(math.atan2(way[0], way[1])) / 22.5) % 16]
        falls = [(W, z) for W, z in zip(blows, table['height_m']) if W is not None]
        if not falls:
            return way / length, None, least
        W, height = min(falls)
        return way / length, height, max(W, least)

    def strike(self, body, way, above, energy):
        """The body's motion by an impulse `above` its centre of mass."""
        model, data = self.model, self.data
        push = np.array([*way, 0])
        spin = np.cross([0, 0, above], push)
        turn = data.ximat[body].reshape(3, 3)
        turning = turn @ ((turn.T @ spin) / model.body_inertia[body])
        mass = model.body_mass[body]
        impulse = math.sqrt(2 * energy / (1 / mass + spin @ turning))
        return np.concatenate([impulse * push / mass, data.xmat[body].reshape(3, 3).T @ (impulse * turning)])

    def turn(self, o, body, way, energy):
        """The body's motion if it starts to turn over the edge of its `why`."""
        edge = np.mean([self.world(end) for end in o['why']['edge_m']], axis=0)
        axis = np.array([-way[1], way[0], 0.0])
        speed = np.cross(axis, self.data.xipos[body] - edge)
        turn = self.data.ximat[body].reshape(3, 3)
        turning = turn.T @ axis
        unit = 2 / (self.model.body_mass[body] * speed @ speed + turning @ (self.model.body_inertia[body] * turning))
        return math.sqrt(unit * energy) * np.concatenate([speed, self.data.xmat[body].reshape(3, 3).T @ axis])

    def fall(self, o, way, height, energy, turn):
        """Where its centre of mass first lands and how much it is then tilted, or None where it stays up."""
        model, data, body = self.model, self.data, self.body(o)
        mujoco.mj_setState(model, data, self.state, STATE)
        mujoco.mj_forward(model, data)
        first = model.jnt_dofadr[model.body_jntadr[body]]
        start, up = data.xipos[body].copy(), data.xmat[body].reshape(3, 3)[2].copy()
        above = 0 if height is None else self.base(body) + height - start[2]
        data.qvel[first:first + 6] += (self.turn(o, body, way, energy) if turn and len(o['why']['edge_m']) == 2
                                       and o['mode'] == 'tip' else self.strike(body, way, above, energy))
        mujoco.mj_forward(model, data)

        def tilt():
            return math.degrees(math.acos(np.clip(data.xmat[body].reshape(3, 3)[2] @ up, -1, 1)))

        lands, fastest, unstable = None, 0.0, sum(data.warning[w].number for w in UNSTABLE)
        for step in range(round(WATCHED_S / model.opt.timestep)):
            mujoco.mj_step(model, data)
            sinks = -data.qvel[first + 2]
            if lands is None and (tilt() > LIES_DEG or data.xipos[body][2] < start[2] - FELL_M):
                fastest = max(fastest, sinks)
                if fastest > SINKS_M_S and sinks < fastest / 2:
                    lands = data.xipos[body].copy(), tilt()
            if step % 25 == 0 and step > 100 and np.abs(data.qvel[first:first + 6]).max() < 0.01:
                break
        if sum(data.warning[w].number for w in UNSTABLE) > unstable:  # it says nothing
            raise OverflowError
        if tilt() < FELL_DEG and data.xipos[body][2] > start[2] - FELL_M:
            return None
        return lands or (data.xipos[body].copy(), tilt())

    def high(self, body):
        """Of its centre of mass above its lowest point."""
        mujoco.mj_setState(self.model, self.data, self.state, STATE)
        mujoco.mj_forward(self.model, self.data)
        return float(self.data.xipos[body][2] - self.base(body))

    def base(self, body):
        """The height of its lowest point, of its parts."""
        model, data, low = self.model, self.data, math.inf
        for g in range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body]):
            if model.geom_contype[g] == 0:
                continue
            box = model.geom_aabb[g]
            turn = data.geom_xmat[g].reshape(3, 3)
            low = min(low, data.geom_xpos[g][2] + turn[2] @ box[:3] - np.abs(turn[2]) @ box[3:])
        return low

    def through(self, start, end):
        """Whether what is fixed stands between two places, at all heights from the lower to the higher."""
        model, data = self.model, self.data
        mujoco.mj_setState(model, data, self.state, STATE)
        mujoco.mj_forward(model, data)
        way = np.array([*(end - start)[:2], 0.0])
        far = np.linalg.norm(way)
        if far < 1e-3:
            return False
        for height in np.linspace(min(start[2], end[2]) + 0.02, max(start[2], end[2]), 4):
            at, left = np.array([start[0], start[1], height]), far
            while True:
                hit = np.array([-1], np.int32)
                met = mujoco.mj_ray(model, data, at, way / far, np.array([0, 0, 0, 1, 0, 0], np.uint8), 1, -1, hit)
                if met < 0 or met > left:
                    return False
                if model.body_dofnum[model.geom_bodyid[hit[0]]] == 0:
                    break
                at, left = at + (met + 1e-4) * way / far, left - met - 1e-4
        return True


def judged(topple, kind, seed, keep, turn):
    """Of each object that is said to fall a row, or the word for why there is none."""
    with tempfile.TemporaryDirectory(prefix='topple-landings-') as work:
        room = Room(*made(topple, kind, seed, os.path.join(keep or work, f'{kind}-{seed}')))
    rows, none = [], Counter()
    for o in room.objects:
        if o['grounded'] or not o['fall']['falls'] or o['fall']['lands_m'][0] is None:
            continue
        body = room.bodies.get(o['id'])
        if body is None or body['fixed'] or body['held'] or not body['parts']:
            none['not free'] += 1
            continue
        n = room.body(o)
        if n in room.moved:
            none['moved by itself'] += 1
            continue
        blow = room.blow(o)
        if blow is None:
            none['no direction'] += 1
            continue
        start, said = room.world(o['center_of_mass_m']), room.world(o['fall']['lands_m'])
        way, height, energy = blow
        if turn and o['mode'] == 'tip':
            energy = max(o['barrier_J'], 1e-4)
        high = room.high(n)
        found = None
        try:
            for times in TIMES:
                found = room.fall(o, way, height, times * energy, turn)
                if found is not None:
                    break
        except OverflowError:
            none["MuJoCo's numbers overflow"] += 1
            continue
        if found is None:
            none['not upset'] += 1
            continue
        lands, tilt = found
        rows.append({'room': f'{kind} {seed}', 'object': o['id'], 'mode': o['mode'], 'leans': o['fall']['leans_on'],
                     'drop_m': o['fall']['drop_m'], 'times': times, 'tilt': tilt,
                     'off_m': float(np.linalg.norm((lands - said)[:2])),
                     'said': [float(v) for v in ((said - start)[:2] @ way, (said - start)[:2] @ [-way[1], way[0]])],
                     'went': [float(v) for v in ((lands - start)[:2] @ way, (lands - start)[:2] @ [-way[1], way[0]])],
                     'height_m': high, 'start_z': float(start[2]), 'end_z': float(lands[2]),
                     'mass_kg': o['mass_kg'], 'lower_m': float(said[2] - lands[2]), 'through': bool(room.through(start, said))})
    return rows, none


def line(rows):
    if not rows:
        return 'none fell'
    within = sum(r['off_m'] <= WITHIN_M for r in rows)
    far = [r for r in rows if math.hypot(*r['went']) > WITHIN_M]
    return (f"{len(rows)} fell, {within} ({100 * within / len(rows):.1f} %) within {100 * WITHIN_M:.0f} cm, median "
            f"{100 * np.median([r['off_m'] for r in rows]):.0f} cm, of the {len(far)} that went farther than that "
            f"{sum(r['off_m'] <= WITHIN_M for r in far)}; "
            f"{sum(r['lower_m'] > WITHIN_M for r in rows)} that much lower than said; {sum(r['through'] for r in rows)} said to land beyond a wall")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    add_options(parser, rooms=2)
    parser.add_argument('--keep', help='folder for scans, outputs and exports')
    parser.add_argument('--turn', action='store_true', help='set off turning over their edge, not by blows')
    parser.add_argument('--json', help='file for all of them')
    a = parser.parse_args()
    rooms = chosen(a)
    rows, none = [], Counter()
    with multiprocessing.Pool(a.jobs, maxtasksperchild=1) as pool:
        waiting = [pool.apply_async(judged, (a.topple, kind, seed, a.keep, a.turn)) for kind, seed in rooms]
        for (kind, seed), result in zip(rooms, waiting):
            its, without = result.get()
            rows += its
            none.update(without)
            print(f'{kind} {seed}: {line(its)}; {dict(without)}', flush=True)
            for r in its:
                if r['off_m'] > WITHIN_M or r['through']:
                    print(f"  object {r['object']}: off by {r['off_m']:.2f} m; said {r['said'][0]:.2f} ahead, went "
                          f"{r['went'][0]:.2f} and {r['went'][1]:.2f} beside, {r['tilt']:.0f} degrees" +
                          (', beyond a wall' if r['through'] else ''))
    print()
    for name, part in (('over an edge', [r for r in rows if r['mode'] == 'tip' and r['leans'] < 0]),
                       ('leaning', [r for r in rows if r['mode'] == 'tip' and r['leans'] >= 0]),
                       ('sliding', [r for r in rows if r['mode'] == 'slide']), ('all', rows)):
        print(f'{name:13} {line(part)}')
    print('not compared:', ', '.join(f'{count} {why}' for why, count in none.items()))
    if a.json:
        with open(a.json, 'w', encoding='utf-8') as file:
            json.dump(rows, file)


if __name__ == '__main__':
    main()
