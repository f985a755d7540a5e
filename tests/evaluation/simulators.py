#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How rooms stand in simulators, from a scan to the last step, all objects free at once.

  simulators.py TOPPLE [--rooms 12] [--kinds kitchen,office] [--scans PATH...] [--bullet] [--warp] [--drop] [--jobs 2]

Generates rooms of each kind, parses them and the scans, exports them, and lets MuJoCo (PyPI's mujoco), with --bullet also
Bullet (pybullet) and with --warp MuJoCo Warp (mujoco-warp), go on for 5 s. An object stays where it moves less than 1 cm and turns less than 2 degrees. With --drop
each body falls alone on a plane, from 8 times its height, and is to rest there within 8 s, not in the plane. A line a room,
then a table. Only what topple says to stand counts as stable; what the export holds in its place is counted apart.
"""
import argparse
import json
import math
import multiprocessing
import os
import shutil
import subprocess
import tempfile
import time
import xml.etree.ElementTree as xml
from collections import Counter

import mujoco
import numpy as np

from rooms import UNSTABLE, add_options, chosen, generate, run

SECONDS = 5
STAYS_M, STAYS_DEG, FAST_M_S = 0.01, 2.0, 1.0
BULLET_LIMIT_S = 150


def turned_deg(one, other):
    return 2 * math.degrees(math.acos(min(1, abs(float(np.dot(one, other))))))


def in_mujoco(folder, names):
    """By name: metres, degrees and the largest speed; then the deepest contact at the start, and times real time."""
    model = mujoco.MjModel.from_xml_path(os.path.join(folder, 'scene.xml'))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    deepest = -min([0.0] + [c.dist for c in data.contact[:data.ncon]])
    body = [model.body(name).id for name in names]
    first = [model.jnt_dofadr[model.body_jntadr[b]] for b in body]
    place, pose, fastest = data.xpos[body].copy(), data.xquat[body].copy(), np.zeros(len(body))
    started = time.process_time()
    for step in range(round(SECONDS / model.opt.timestep)):
        mujoco.mj_step(model, data)
        if step % 5 == 0:
            for n, dof in enumerate(first):
                fastest[n] = max(fastest[n], np.linalg.norm(data.qvel[dof:dof + 3]))
    spent = max(time.process_time() - started, 1e-6)
    if any(data.warning[w].number for w in UNSTABLE):
        fastest[:] = math.inf
    ends = {name: (float(np.linalg.norm(data.xpos[b] - place[n])), turned_deg(data.xquat[b], pose[n]), float(fastest[n]))
            for n, (name, b) in enumerate(zip(names, body))}
    return ends, deepest, SECONDS / spent


def in_bullet(folder, names):
    """As in_mujoco, only the ends; None where it takes too long."""
    import pybullet
    client = pybullet.connect(pybullet.DIRECT)
    try:
        pybullet.setGravity(0, 0, -9.81)
        pybullet.setPhysicsEngineParameter(fixedTimeStep=1 / 480, numSolverIterations=100)
        ids = {}
        for joint in xml.parse(os.path.join(folder, 'scene.urdf')).iter('joint'):
            if joint.find('parent').get('link') != 'world':
                continue
            name = joint.find('child').get('link')
            at = [float(v) for v in joint.find('origin').get('xyz').split()]
            ids[name] = pybullet.loadURDF(os.path.join(folder, 'scene_urdf', name + '.urdf'), at,
                                          flags=pybullet.URDF_USE_INERTIA_FROM_FILE)
        start = {name: pybullet.getBasePositionAndOrientation(ids[name]) for name in names}
        fastest = Counter()
        began = time.monotonic()
        for step in range(SECONDS * 480):
            pybullet.stepSimulation()
            if step % 24 == 0:
                if time.monotonic() - began > BULLET_LIMIT_S:
                    return None
                for name in names:
                    fastest[name] = max(fastest[name], float(np.linalg.norm(pybullet.getBaseVelocity(ids[name])[0])))
        ends = {}
        for name in names:
            at, pose = pybullet.getBasePositionAndOrientation(ids[name])
            ends[name] = (float(np.linalg.norm(np.subtract(at, start[name][0]))), turned_deg(pose, start[name][1]),
                          fastest[name])
        return ends
    finally:
        pybullet.disconnect(client)


def times_asleep(folder):
    """Times real time where what is at rest sleeps, over as long."""
    model = mujoco.MjModel.from_xml_path(os.path.join(folder, 'scene_asleep.xml'))
    data = mujoco.MjData(model)
    started = time.process_time()
    for _ in range(round(SECONDS / model.opt.timestep)):
        mujoco.mj_step(model, data)
    return SECONDS / max(time.process_time() - started, 1e-6)


def in_warp(folder, names):
    """As in_mujoco, only the ends, without speeds: by MuJoCo's kernels for GPUs, here on the processor."""
    import mujoco_warp
    model = mujoco.MjModel.from_xml_path(os.path.join(folder, 'scene.xml'))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    body = [model.body(name).id for name in names]
    place, pose = data.xpos[body].copy(), data.xquat[body].copy()
    on_device = mujoco_warp.put_model(model)
    # Room for contacts: those of the start and more.
    moving = mujoco_warp.put_data(model, data, nconmax=4 * data.ncon + 500, njmax=20 * data.ncon + 2000)
    for _ in range(round(SECONDS / model.opt.timestep)):
        mujoco_warp.step(on_device, moving)
    ended, turned = moving.xpos.numpy()[0], moving.xquat.numpy()[0]
    return {name: (float(np.linalg.norm(ended[b] - place[n])), turned_deg(turned[b], pose[n]))
            for n, (name, b) in enumerate(zip(names, body))}


def rests_after_drop(scene, folder, name):
    """Whether a body that falls alone on a plane, from 8 times its height, rests there within 8 s:
    moves less than 1 mm and turns less than half a degree in half a second."""
    root = xml.fromstring(xml.tostring(scene))
    world, assets = root.find('worldbody'), root.find('asset')
    body = next(b for b in world.findall('body') if b.get('name') == name)
    for child in list(world):
        world.remove(child)
    for geom in body.findall('geom'):
        if geom.get('class') == 'visual':
            body.remove(geom)
    used = {g.get('mesh') for g in body.findall('geom')}
    for asset in list(assets):
        if asset.get('name') not in used:
            assets.remove(asset)
    xml.SubElement(world, 'geom', {'type': 'plane', 'size': '0 0 1', 'class': 'collision'})
    world.append(body)
    for element in root.findall('contact') + root.findall('equality'):
        root.remove(element)
    model = mujoco.MjModel.from_xml_string(xml.tostring(root, encoding='unicode'))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)

    def ends():
        """Lowest and highest z of its geoms."""
        low, high = math.inf, -math.inf
        for g in range(1, model.ngeom):
            turn, at = data.geom_xmat[g].reshape(3, 3), data.geom_xpos[g]
            kind = model.geom_type[g]
            if kind == mujoco.mjtGeom.mjGEOM_MESH:
                mesh = model.geom_dataid[g]
                first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
                z = (model.mesh_vert[first:first + count] @ turn.T)[:, 2] + at[2]
                low, high = min(low, float(z.min())), max(high, float(z.max()))
                continue
            half = model.geom_size[g]
            if kind == mujoco.mjtGeom.mjGEOM_BOX:
                reach = float(np.abs(turn[2]) @ half)
            elif kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
                reach = float(abs(turn[2, 2]) * half[1] + math.hypot(turn[2, 0], turn[2, 1]) * half[0])
            else:
                reach = float(half[0])
            low, high = min(low, at[2] - reach), max(high, at[2] + reach)
        return low, high

    low, high = ends()
    data.qpos[2] += 8 * (high - low) - low
    mujoco.mj_forward(model, data)
    at, pose = data.qpos[:3].copy(), data.qpos[3:].copy()
    every = round(0.5 / model.opt.timestep)
    for step in range(round(8 / model.opt.timestep)):
        mujoco.mj_step(model, data)
        if step % every:
            continue
        if np.linalg.norm(data.qpos[:3] - at) < 0.001 and turned_deg(data.qpos[3:], pose) < 0.5 and data.ncon:
            return -5e-4 < ends()[0] < 5e-3
        at, pose = data.qpos[:3].copy(), data.qpos[3:].copy()
    return False


def judged(topple, name, scan, bullet, warp, drop):
    """A scan's counts, as Counter; times and depths beside."""
    work = tempfile.mkdtemp(prefix='topple-simulators-', dir=os.environ.get('TMPDIR'))
    try:
        if isinstance(scan, tuple):
            scan = generate(topple, *scan, work)
        out, mjcf, urdf = (os.path.join(work, folder) for folder in ('out', 'mjcf', 'urdf'))
        run(topple, 'parse', scan, '-o', out)
        began = time.monotonic()
        run(topple, 'export', out, '--mjcf', mjcf)
        exported_s = time.monotonic() - began
        with open(os.path.join(out, 'scene.json'), encoding='utf-8') as file:
            objects = json.load(file)['objects']
        with open(os.path.join(mjcf, 'bodies.json'), encoding='utf-8') as file:
            bodies = [b for b in json.load(file)['bodies'] if b['object'] >= 0 and b['parts'] > 0 and not objects[b['object']]['grounded']]
        names = [b['name'] for b in bodies if not b['held']]
        stands = {b['name']: objects[b['object']]['barrier_J'] > 0 for b in bodies}
        ends, deepest, times = in_mujoco(mjcf, names)
        stays = lambda end: end[0] < STAYS_M and end[1] < STAYS_DEG
        count = Counter(rooms=1, held=len(bodies) - len(names), pads=sum(b['on_pad'] for b in bodies),
                        stable=sum(stands[n] for n in names), falls=sum(not stands[n] for n in names),
                        stay=sum(stands[n] and stays(ends[n]) for n in names),
                        moved=sum(not stands[n] and not stays(ends[n]) for n in names),
                        fast=sum(ends[n][2] > FAST_M_S for n in names))
        bad = [f'{n}: {ends[n][0]:.3f} m, {ends[n][1]:.0f} deg' for n in names if stands[n] and not stays(ends[n])]
        if bullet:
            run(topple, 'export', out, '--urdf', urdf, '--no-visuals')
            ends = in_bullet(urdf, names)
            if ends is None:
                count['bullet_unfinished'] += 1
            else:
                count.update(bullet_stable=count['stable'], bullet_stay=sum(stands[n] and stays(ends[n]) for n in names),
                             bullet_fast=sum(ends[n][2] > FAST_M_S for n in names))
        if warp:
            ends = in_warp(mjcf, names)
            count.update(warp_stable=count['stable'], warp_stay=sum(stands[n] and stays(ends[n]) for n in names))
        if drop:
            scene = xml.parse(os.path.join(mjcf, 'scene.xml')).getroot()
            scene.find('compiler').set('meshdir', os.path.join(mjcf, 'scene_mjcf'))
            results = {n: rests_after_drop(scene, mjcf, n) for n in names}
            count.update(dropped=len(results), rested=sum(results.values()))
            bad += [f'{n}: no rest after a drop' for n, rests in results.items() if not rests]
        return name, count, deepest, times, times_asleep(mjcf), exported_s, bad
    except subprocess.CalledProcessError as error:
        return name, Counter(failed=1), 0, math.inf, math.inf, 0, [error.stderr.decode(errors='replace')[-300:]]
    finally:
        shutil.rmtree(work, ignore_errors=True)


def share(part, whole):
    return f'{part} of {whole} ({100 * part / whole:.1f} %)' if whole else '-'


def line(c):
    text = f"stay {share(c['stay'], c['stable'])}, held {c['held']}, pads {c['pads']}, fast {c['fast']}"
    text += f", said to fall and moved {c['moved']} of {c['falls']}"
    if c['bullet_stable'] or c['bullet_unfinished']:
        text += f"; Bullet {share(c['bullet_stay'], c['bullet_stable'])}, fast {c['bullet_fast']}"
        text += f", {c['bullet_unfinished']} unfinished" if c['bullet_unfinished'] else ''
    if c['warp_stable']:
        text += f"; MuJoCo Warp {share(c['warp_stay'], c['warp_stable'])}"
    if c['dropped']:
        text += f"; drops {share(c['rested'], c['dropped'])}"
    return text + (f"; {c['failed']} FAILED" if c['failed'] else '')


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    add_options(parser, rooms=12)
    parser.add_argument('--scans', nargs='*', default=[], help='to be judged, too: what `topple parse` takes')
    parser.add_argument('--bullet', action='store_true')
    parser.add_argument('--warp', action='store_true')
    parser.add_argument('--drop', action='store_true')
    a = parser.parse_args()
    rooms = [(kind, f'{kind} {seed}', (kind, seed)) for kind, seed in chosen(a)]
    rooms += [('scans', os.path.relpath(path), path) for path in a.scans]
    total, deepest_m, slowest, slowest_asleep, longest_s = {}, 0, math.inf, math.inf, 0
    with multiprocessing.Pool(a.jobs, maxtasksperchild=1) as pool:
        waiting = [(group, pool.apply_async(judged, (a.topple, name, scan, a.bullet, a.warp, a.drop)))
                   for group, name, scan in rooms]
        for group, result in waiting:
            name, count, deepest, times, asleep, exported_s, bad = result.get()
            total.setdefault(group, Counter()).update(count)
            deepest_m, slowest, slowest_asleep = max(deepest_m, deepest), min(slowest, times), min(slowest_asleep, asleep)
            longest_s = max(longest_s, exported_s)
            print(f'{name}: {line(count)}; deepest {1000 * deepest:.3f} mm, {times:.1f} times real time, {asleep:.1f} '
                  f'asleep, export {exported_s:.1f} s', *bad, sep='\n  ', flush=True)
    print()
    for group, count in total.items():
        print(f'{group:12} {line(count)}')
    generated = sum((c for g, c in total.items() if g != 'scans'), Counter())
    print(f'{"generated":12} {line(generated)}')
    print(f'deepest contact {1000 * deepest_m:.3f} mm, slowest {slowest:.2f} times real time, {slowest_asleep:.2f} asleep, longest export {longest_s:.1f} s')


if __name__ == '__main__':
    main()
