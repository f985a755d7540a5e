#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits the model of how likely an object is one thing, whole (graph::whole_probability), and writes host/fitted/whole.model.json.

usage: fit_whole.py --topple PROGRAM --work FOLDER --scans FOLDER ...

Parses every scan below the FOLDERs that has truth.json and truth.ply, and asks of each object whether it and a true one
share more than half of the points that either has. Fit it after the models of joints, whose probabilities it takes.
"""
import argparse
import json
import subprocess
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from fit import fit, read_ply, write

LEAST_POINTS = 20  # of an object that is asked for
FEATURES = ('piece', 'joint', 'log_voxels')


def places(points):
    return np.stack([points['x'], points['y'], points['z']], 1)


def objects_of(scan, out):
    """Rows and truth of one parsed scan's objects."""
    scene, points = json.loads((out / 'scene.json').read_text()), read_ply(out / 'points.ply')
    truth = read_ply(scan / 'truth.ply')
    owner = truth['object'][cKDTree(places(truth)).query(places(points))[1]]
    size = np.bincount(owner[owner >= 0])
    voxels = {p['id']: p['solid_voxels'] for p in scene['primitives']}
    rows, is_one = [], []
    for thing in scene['objects']:
        own = owner[points['object'] == thing['id']]
        if thing['grounded'] or len(own) < LEAST_POINTS:
            continue
        votes = np.bincount(own)
        most = votes.argmax()
        rows.append([thing['piece_probability'], thing['joint_probability'], np.log1p(sum(voxels[p] for p in thing['primitives']))])
        is_one.append(votes[most] > 0.5 * (len(own) + size[most] - votes[most]))
    return rows, is_one


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--topple', type=Path, required=True)
    parser.add_argument('--work', type=Path, required=True)
    parser.add_argument('--scans', type=Path, nargs='+', required=True)
    arguments = parser.parse_args()
    rows, truth, world = [], [], []
    for scan in sorted(path.parent for folder in arguments.scans for path in folder.rglob('truth.json')):
        out, cloud = arguments.work / scan.name, scan / 'cloud.ply'
        if not (out / 'scene.json').exists():
            subprocess.run([arguments.topple, 'parse', cloud if cloud.exists() else scan, '-o', out, '--no-cache', '--quiet'], check=True)
        of_scan, is_one = objects_of(scan, out)
        rows += of_scan
        truth += is_one
        world += [scan.name.rsplit('-', 1)[0]] * len(is_one)
    group = np.unique(world, return_inverse=True)[1]
    _, model, _ = fit(np.array(rows, np.float32), np.array(truth), group, FEATURES, 4, 'whole')
    write('whole.model.json', model)


if __name__ == '__main__':
    main()
