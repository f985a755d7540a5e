# SPDX-License-Identifier: MIT
# stays.py OUT DIR [--seconds S]: which objects stay where they are in the MuJoCo that Python has, all free at once, against
# what topple says. It needs PyPI's mujoco and numpy. OUT is the output folder of a parse, DIR its export (topple export OUT
# --mjcf DIR). `topple verify` asks the same of the MuJoCo that topple was built with, which may be another version.
import argparse
import json
import os

import mujoco
import numpy as np

STAYS_M, STAYS_DEG = 0.01, 2.0
UNSTABLE = [mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC]


def says(o):
    """What scene.json says of an object: it may be unsure."""
    if not o['seen_enough'] or 0 < o['barrier_J'] < o['barrier_error_J']:
        return 'unsure'
    return 'falls' if o['barrier_J'] == 0 and o['release_J'] > 0 else 'stable'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('out')
    parser.add_argument('export')
    parser.add_argument('--seconds', type=float, default=5)
    arguments = parser.parse_args()
    with open(os.path.join(arguments.out, 'scene.json'), encoding='utf-8') as file:
        objects = json.load(file)['objects']
    model = mujoco.MjModel.from_xml_path(os.path.join(arguments.export, 'scene.xml'))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    free = [b for b in range(1, model.nbody) if model.body_jntnum[b]]
    place, pose = data.xpos[free].copy(), data.xquat[free].copy()
    moved, turned, steps = np.zeros(len(free)), np.zeros(len(free)), round(arguments.seconds / model.opt.timestep)
    for step in range(steps):
        mujoco.mj_step(model, data)
        if any(data.warning[w].number for w in UNSTABLE):
            print(f'unstable after {step * model.opt.timestep:.2f} s')
            break
        moved = np.maximum(moved, np.linalg.norm(data.xpos[free] - place, axis=1))
        cosine = np.abs(np.sum(data.xquat[free] * pose, axis=1)).clip(0, 1)
        turned = np.maximum(turned, 2 * np.degrees(np.arccos(cosine)))
        if step % (steps // 10 or 1) == 0:
            print(f'\r{step / steps:4.0%}', end='', flush=True)
    stays = (moved < STAYS_M) & (turned < STAYS_DEG)
    said = [says(objects[int(model.body(b).name.split('_')[1])]) for b in free]
    print(f'\rMuJoCo {mujoco.mj_versionString()}: {stays.sum()} of {len(free)} objects stay within 1 cm and 2 degrees')
    for word in ('stable', 'unsure', 'falls'):
        of = np.array([w == word for w in said], dtype=bool)
        print(f'topple says {word:6}: {of.sum():3}, of which {(of & stays).sum():3} stay')
    for n in np.flatnonzero(~stays):
        print(f'{model.body(free[n]).name:12} {said[n]:6} moved {100 * moved[n]:6.1f} cm, turned {turned[n]:5.1f} degrees')


if __name__ == '__main__':
    main()
