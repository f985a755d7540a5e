#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What `topple ask --without` says beside MuJoCo: of generated rooms each object that carries another is taken out of the
export, and what then falls within 2 s is compared with what was said.

usage: removals.py TOPPLE WORK [--rooms N] [--first SEED]     (a Python with MuJoCo 3.2 or later: build/venv/bin/python3)

An object falls where its centre comes down by more than 3 cm or it turns by more than 10 degrees, and it does not without
anything being taken away. What stands on pads or is held in the export is left out: it has no footing of its own there, and
where it is said to fall it is taken out, too, since it would hang there and hold others.
"""
import argparse
import json
import math
import os
import subprocess

import mujoco

KINDS = ('kitchen', 'office', 'library', 'shop', 'storage', 'bedroom', 'living', 'meeting', 'depot', 'laundry', 'tabletop', 'lounge')
SECONDS, DROP_M, TURN_COS = 2.0, 0.03, math.cos(math.radians(10) / 2)


def fallen(folder, without):
    """The objects that fall within SECONDS once these are taken out of the scene."""
    spec = mujoco.MjSpec.from_file(os.path.join(folder, 'scene.xml'))
    for one in without:
        spec.delete(spec.body(f'object_{one}'))
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    free = [b for b in range(model.nbody) if model.body_dofnum[b] == 6 and model.body(b).name.startswith('object_')]
    start = {b: (data.xipos[b].copy(), data.xquat[b].copy()) for b in free}
    while data.time < SECONDS:
        mujoco.mj_step(model, data)
    return {int(model.body(b).name[7:]) for b in free
            if start[b][0][2] - data.xipos[b][2] > DROP_M or abs(float(start[b][1] @ data.xquat[b])) < TURN_COS}


def judge(topple, work, kind, seed):
    """Of one room: falls that were said and came, that were said alone, that came alone; and removals."""
    scan, out, sim = (os.path.join(work, f'{kind}-{seed}-{what}') for what in ('scan', 'out', 'sim'))
    subprocess.run([topple, 'generate', scan, '--kind', kind, '--scan', 'walk', '--seed', str(seed)], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([topple, 'parse', scan, '-o', out, '--backend', 'native', '--quiet', '--no-cache'], check=True)
    subprocess.run([topple, 'export', out, '--mjcf', sim], check=True, stdout=subprocess.DEVNULL)
    with open(os.path.join(out, 'scene.json'), encoding='utf-8') as file:
        scene = json.load(file)
    with open(os.path.join(sim, 'bodies.json'), encoding='utf-8') as file:
        propped = {b['object'] for b in json.load(file)['bodies'] if b['on_pad'] or b['held']}
    loose = {o['id'] for o in scene['objects'] if not o['grounded']}
    carriers = sorted({s['supporter'] for s in scene['supports'] if s['supporter'] in loose and s['supported'] in loose})
    restless = fallen(sim, ())
    both = said_alone = came_alone = 0
    for carrier in carriers:
        if carrier in propped | restless:
            continue
        answer = json.loads(subprocess.run([topple, 'ask', out, '--without', str(carrier), '--json'], check=True, capture_output=True, text=True).stdout)
        counted, falls = loose - propped - restless - set(answer['unsure']) - {carrier}, {f['object'] for f in answer['falls']}
        said, came = falls & counted, fallen(sim, {carrier} | falls & propped) & counted
        both, said_alone, came_alone = both + len(said & came), said_alone + len(said - came), came_alone + len(came - said)
    return both, said_alone, came_alone, len(carriers)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('topple')
    parser.add_argument('work')
    parser.add_argument('--rooms', type=int, default=12)
    parser.add_argument('--first', type=int, default=301)
    a = parser.parse_args()
    os.makedirs(a.work, exist_ok=True)
    total = [0, 0, 0, 0]
    for n in range(a.rooms):
        kind, seed = KINDS[n % len(KINDS)], a.first + n
        found = judge(a.topple, a.work, kind, seed)
        total = [t + f for t, f in zip(total, found)]
        print(f'{kind:9} {seed}: {found[0]} said and fell, {found[1]} said alone, {found[2]} fell alone; {found[3]} removals', flush=True)
    both, said, came, removals = total
    print(f'{removals} removals: precision {both / max(1, both + said):.2f}, recall {both / max(1, both + came):.2f} of {both + came} falls')


if __name__ == '__main__':
    main()
