#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What people pull, push and climb over, in MuJoCo, beside `holds` of scene.json.

  reach.py TOPPLE [--rooms 2] [--kinds bedroom,office] [--people children,toddlers] [--keep DIR] [--jobs 1]

Generates rooms of each kind, parses and exports them. On each object that is free in the export as it was scanned, without struts
or a pad and with parts that fill no half more than it, that stands by itself and whose barrier is above its error, its `holds` act one by one; what carries it stays where it is, and other loose
things, on which topple says that nothing leans for good, do not stand in its way. A hand pulls at the object's middle, at the height of the hold, with a force that grows in a second and
follows what moves at 0.3 m/s at most, for an arm's length. A climber's weight, and that of drawers, grows in a second at its place
before the front, and goes along. Who falls gives the object an impulse within 20 ms. The object falls where its centre of mass ends 5 mm lower, within 5 s: S(W) is what comes free.
"""
import argparse
import json
import math
import multiprocessing
import os
import sys
import tempfile
from collections import Counter

import mujoco
import numpy as np

from landings import STATE, UNSTABLE, Room, made
from rooms import add_options, chosen

GROWS_S, WATCHED_S, HAND_M_S, BLOW_S = 1.0, 5.0, 0.3, 0.02
LOWER_M, FELL_M = 0.005, 0.05
RESTS_M_S, RESTS_S = 0.005, 0.3  # slower for so long, it stays as it is
ARM_M = {'children': 0.51, 'toddlers': 0.38, 'elderly': 0.73}


def carriers(room, o):
    """The bodies of an object, and of what it stands on, down to the floor."""
    found, todo = set(), [o['id']]
    while todo:
        n = todo.pop()
        if n not in found:
            found.add(n)
            todo += room.objects[n]['why']['stands_on']
    return {room.body(room.objects[n]) for n in found if n in room.bodies}


def falls(room, o, hold):
    """Whether the hold upsets the object."""
    model, data, body = room.model, room.data, room.body(o)
    loose = (model.body_dofnum[model.geom_bodyid] > 0) & ~np.isin(model.geom_bodyid, list(carriers(room, o)))
    model.geom_contype[:] = np.where(loose, 0, room.contype)
    model.geom_conaffinity[:] = np.where(loose, 0, room.conaffinity)
    mujoco.mj_setState(model, data, room.state, STATE)
    mujoco.mj_forward(model, data)
    blow = hold['act'] == 'fall'
    force, point = room.to_world[:3, :3] @ (np.array(hold['impulse_Ns']) / BLOW_S if blow else hold['force_N']), room.world(hold['place_m'])
    most = np.linalg.norm(force)
    way = force / most
    turn = data.xmat[body].reshape(3, 3)
    local, start = turn.T @ (point - data.xpos[body]), data.xipos[body].copy()
    hangs = hold['act'] in ('climb', 'open')
    if not hangs:  # at its middle, as it has settled
        point[:2] = start[:2]
        local = turn.T @ (point - data.xpos[body])
    unstable, released = sum(data.warning[w].number for w in UNSTABLE), False
    last, rests = point, 0
    first, place = model.jnt_dofadr[model.body_jntadr[body]], model.jnt_qposadr[model.body_jntadr[body]]
    others, moving = np.ones(model.nq, bool), np.ones(model.nv, bool)
    others[place:place + 7], moving[first:first + 6] = False, False
    still = data.qpos[others].copy()
    for step in range(round(WATCHED_S / model.opt.timestep)):
        at = data.xpos[body] + data.xmat[body].reshape(3, 3) @ local
        speed = (at - last) @ way / model.opt.timestep
        last = at
        data.qfrc_applied[:] = 0
        grown = most * min(1.0, step * model.opt.timestep / GROWS_S)
        if blow:
            grown = most if step * model.opt.timestep < BLOW_S else 0.0
        elif not hangs:
            released = released or (at - point) @ way > ARM_M[hold['by']]
            # Not so stiff that it throws what is light.
            stiff = 0.1 * model.body_mass[body] / model.opt.timestep
            grown = 0.0 if released else np.clip(stiff * (HAND_M_S - speed), 0, grown)
        mujoco.mj_applyFT(model, data, grown * way, np.zeros(3), at, body, data.qfrc_applied)
        mujoco.mj_step(model, data)
        data.qpos[others], data.qvel[moving] = still, 0
        if data.xipos[body][2] < start[2] - FELL_M:
            break
        rests = rests + 1 if np.abs(data.qvel[first:first + 6]).max() < RESTS_M_S and step * model.opt.timestep > GROWS_S else 0
        if rests * model.opt.timestep > RESTS_S:
            break
    data.qfrc_applied[:] = 0
    if sum(data.warning[w].number for w in UNSTABLE) > unstable:
        raise OverflowError
    return data.xipos[body][2] < start[2] - LOWER_M


def judged(topple, kind, seed, keep, people, most):
    """A row of each hold, at most so many evenly chosen, and why others have none."""
    with tempfile.TemporaryDirectory(prefix='topple-reach-') as work:
        folder = os.path.join(keep or work, f'{kind}-{seed}')
        room = Room(*made(topple, kind, seed, folder, '--people', people, '--disturbance', 'reach', '--quiet'))
    room.model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)  # what is held still would wake
    room.contype, room.conaffinity = room.model.geom_contype.copy(), room.model.geom_conaffinity.copy()
    rows, none, holds = [], Counter(), []
    for o in room.objects:
        body = room.bodies.get(o['id'])
        if not o.get('holds') or body is None or body['fixed'] or body['held'] or not body['parts']:
            none['not free'] += len(o.get('holds', []))
            continue
        n = room.body(o)
        if n in room.moved:
            none['moves by itself'] += len(o['holds'])
            continue
        if body['struts'] or body['on_pad'] or body['excess_share'] > 0.5:
            none['another shape'] += len(o['holds'])
            continue
        if o['barrier_J'] <= o['barrier_error_J'] or o['rest_probability'] < 0.5:
            none['hardly seen to stand'] += len(o['holds'])
            continue
        holds += [(o, hold) for hold in o['holds']]
    for o, hold in holds[::math.ceil(len(holds) / most)] if holds else []:
        try:
            rows.append({'room': f'{kind} {seed}', 'object': o['id'], 'mass_kg': o['mass_kg'], 'size_m': o['size_m'],
                         'by': hold['by'], 'act': hold['act'], 'topple': hold['fall_chance'] > 0, 'mode': o['mode'],
                         'simulator': bool(falls(room, o, hold))})
        except OverflowError:
            none["MuJoCo's numbers overflow"] += 1
    return rows, none


def share(some, all_):
    return f'{100 * some / all_:.1f} %' if all_ else 'none'


def line(rows):
    both = sum(r['topple'] and r['simulator'] for r in rows)
    alike = sum(r['topple'] == r['simulator'] for r in rows)
    return (f"{len(rows)} holds: {share(alike, len(rows))} alike; {both} fall in both, {len(rows) - alike} in one; "
            f"precision {share(both, sum(r['topple'] for r in rows))}, recall {share(both, sum(r['simulator'] for r in rows))}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    add_options(parser, rooms=1)
    parser.add_argument('--people', default='children,toddlers')
    parser.add_argument('--most', type=int, default=1000, help='holds of a room (1000)')
    parser.add_argument('--keep', help='folder for scans, outputs and exports')
    parser.add_argument('--least', type=float, default=0.9, help='share that must be alike (0.9)')
    parser.add_argument('--json', help='file for all of them')
    a = parser.parse_args()
    rows, none = [], Counter()
    with multiprocessing.Pool(a.jobs, maxtasksperchild=1) as pool:
        waiting = [(kind, seed, pool.apply_async(judged, (a.topple, kind, seed, a.keep, a.people, a.most))) for kind, seed in chosen(a)]
        for kind, seed, result in waiting:
            its, without = result.get()
            rows += its
            none.update(without)
            print(f'{kind} {seed}: {line(its)}; {dict(without)}', flush=True)
    for r in rows:
        if r['topple'] != r['simulator']:
            print(f"  {r['room']} object {r['object']} ({r['mass_kg']:.1f} kg, {' x '.join(f'{s:.2f}' for s in r['size_m'])} m, {r['mode']}): "
                  f"{r['by']} {r['act']}, falls in {'topple' if r['topple'] else 'MuJoCo'} alone")
    for act in ('pull', 'lean', 'climb', 'open', 'fall'):
        print(f"{act}: {line([r for r in rows if r['act'] == act])}")
    print(f'all: {line(rows)}; without: {dict(none)}')
    if a.json:
        with open(a.json, 'w', encoding='utf-8') as file:
            json.dump(rows, file)
    return 0 if rows and sum(r['topple'] == r['simulator'] for r in rows) >= a.least * len(rows) else 1


if __name__ == '__main__':
    sys.exit(main())
