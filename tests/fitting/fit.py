#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits the models of host/fitted on generated scans and writes their files.

usage: fit.py --topple TOPPLE --features TOPPLE_FEATURES --work FOLDER [--seeds FIRST:LAST] [--mean-with FOLDER]

Makes rooms of every kind, scanned in one way or another (topple generate), keeps them and what the models see
of them (topple_features) in FOLDER, fits the model of the shell, then that of the joints, each by
gradient boosting, calibrates both on rooms that they were not fitted on (Platt's scaling of
out-of-fold log-odds), and writes host/fitted/*.model.json. Same seeds, same files. Takes
python3-sklearn and python3-scipy.

Truth: each sample of a scan belongs to the object of the nearest true surface within 6 cm, and a
primitive to the object that most of its samples belong to. What is built in counts as the room.
"""
import argparse
import concurrent.futures
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import roc_auc_score
from sklearn.model_selection import GroupKFold

FITTED = Path(__file__).resolve().parents[2] / 'host' / 'fitted'
NEAREST_M = 0.06
LEAST_SAMPLES = 5  # of a primitive whose truth is believed


def read_ply(path):
    """The columns of a binary PLY's vertices."""
    types = {'float': '<f4', 'double': '<f8', 'int': '<i4', 'uint': '<u4', 'uchar': 'u1', 'short': '<i2',
             'ushort': '<u2', 'char': 'i1', 'float32': '<f4', 'int32': '<i4', 'uint8': 'u1'}
    with open(path, 'rb') as file:
        fields, count, vertex = [], 0, False
        while (line := file.readline().strip()) != b'end_header':
            words = line.split()
            if words[0] == b'element':
                vertex = words[1] == b'vertex'
                count = int(words[2]) if vertex else count
            elif words[0] == b'property' and vertex:
                fields.append((words[2].decode(), types[words[1].decode()]))
        return np.fromfile(file, dtype=fields, count=count)


class Table:
    """What the models see of one scan, with the truth about it."""

    def __init__(self, scan, folder, room):
        self.room = room  # scans of one room share its number
        about = json.loads((folder / 'table.json').read_text())
        self.node_names, self.joint_names = about['node_names'], about['joint_names']
        self.nodes = np.fromfile(folder / 'nodes.f32', '<f4').reshape(-1, len(self.node_names))
        self.joints = np.fromfile(folder / 'joints.f32', '<f4').reshape(-1, len(self.joint_names))
        self.pairs = np.fromfile(folder / 'pairs.i32', '<i4').reshape(-1, 2)
        samples = np.fromfile(folder / 'samples.f32', '<f4').reshape(-1, 3) @ np.array(about['axes']) + about['origin']
        primitive = np.fromfile(folder / 'primitive.i32', '<i4')
        truth = read_ply(scan / 'truth.ply')
        objects = json.loads((scan / 'truth.json').read_text())['objects']
        built_in = [o['id'] for o in objects if o['fixed'] or o['shell']]
        tree = cKDTree(np.stack([truth['x'], truth['y'], truth['z']], 1))
        distance, nearest = tree.query(samples, distance_upper_bound=NEAREST_M)
        owner = np.full(len(samples), -1)
        owner[np.isfinite(distance)] = truth['object'][nearest[np.isfinite(distance)]]
        owner[np.isin(owner, built_in)] = 0
        # Loose things that nobody told apart are no example of joints; the room's they are not.
        piles = [o['id'] for o in objects if o.get('pile')]
        self.owner = np.full(len(self.nodes), -1)
        self.known = np.zeros(len(self.nodes), bool)
        known = (primitive >= 0) & (owner >= 0)
        votes = np.zeros((len(self.nodes), owner.max(initial=0) + 1), int)
        np.add.at(votes, (primitive[known], owner[known]), 1)
        if votes.size:
            self.owner = votes.argmax(1)
            self.known = votes.sum(1) >= LEAST_SAMPLES
        self.is_shell = self.owner == 0
        a, b = self.pairs.T
        single = self.known & ~np.isin(self.owner, piles)
        self.known_pair = single[a] & single[b]
        self.is_one = self.owner[a] == self.owner[b]

    def with_shell(self, probability):
        """The rows of the joints with these probabilities of the shell instead of the table's."""
        area = self.nodes[:, self.node_names.index('log_area')]
        a, b = self.pairs.T
        a_is_small = area[a] <= area[b]
        rows = self.joints.copy()
        rows[:, self.joint_names.index('shell_small')] = probability[np.where(a_is_small, a, b)]
        rows[:, self.joint_names.index('shell_big')] = probability[np.where(a_is_small, b, a)]
        return rows


def booster(leaves):
    return HistGradientBoostingClassifier(max_iter=300, learning_rate=0.05, max_leaf_nodes=leaves, min_samples_leaf=30,
                                          l2_regularization=2, random_state=1)


def threshold(value):
    """The largest single-precision number not above it, in as many digits as tell it from others: thresholds may be
    values of the rows themselves."""
    single = np.float32(value)
    if single > value:
        single = np.nextafter(single, np.float32(-np.inf))
    return float(f'{single:.9g}')


def trees_of(model):
    """The trees in arrays, children after their parents."""
    trees = []
    for (predictor,) in model._predictors:
        tree = {'feature': [], 'threshold': [], 'missing_left': [], 'left': [], 'right': []}
        for node in predictor.nodes:
            leaf = bool(node['is_leaf'])
            tree['feature'].append(-1 if leaf else int(node['feature_idx']))
            tree['threshold'].append(float(f"{node['value']:.6g}") if leaf else threshold(node['num_threshold']))
            tree['missing_left'].append(0 if leaf else int(node['missing_go_to_left']))
            tree['left'].append(0 if leaf else int(node['left']))
            tree['right'].append(0 if leaf else int(node['right']))
        trees.append(tree)
    return trees


def calibration_error(probability, truth, bins=10):
    """Mean distance of predicted from true shares over bins of equal width, by their counts."""
    at = np.minimum((probability * bins).astype(int), bins - 1)
    return sum(abs(probability[at == k].mean() - truth[at == k].mean()) * (at == k).mean()
               for k in range(bins) if (at == k).any())


def sigmoid(x):
    return 1 / (1 + np.exp(-x))


def fit(rows, truth, group, names, leaves, about):
    """A model, and the calibrated probabilities that models fitted on other rooms give each row."""
    raw = np.zeros(len(truth))
    for train, test in GroupKFold(5).split(rows, truth, group):
        raw[test] = booster(leaves).fit(rows[train], truth[train]).decision_function(rows[test])
    platt = LogisticRegression(C=1e6).fit(raw[:, None], truth)
    scale, offset = float(platt.coef_[0, 0]), float(platt.intercept_[0])
    out_of_fold = sigmoid(scale * raw + offset)
    print(f'{about}: {len(truth)} rows, {truth.mean():.3f} true; AUC {roc_auc_score(truth, out_of_fold):.3f}, '
          f'calibration error {calibration_error(out_of_fold, truth):.3f}; scale {scale:.2f}')
    model = booster(leaves).fit(rows, truth)
    return model, {'schema': 'topple.trees/1', 'about': about, 'features': list(names),
                   'baseline': float(model._baseline_prediction.ravel()[0]), 'scale': scale, 'offset': offset,
                   'trees': trees_of(model)}, out_of_fold


def write(name, model):
    path = FITTED / name
    path.with_suffix('.tmp').write_text(json.dumps(model, separators=(',', ':')) + '\n')
    path.with_suffix('.tmp').rename(path)


def mean_of(models):
    """One model whose log-odds are the mean of those of calibrated ones; their features may differ."""
    names = list(dict.fromkeys(name for model in models for name in model['features']))
    trees, baseline = [], 0
    for model in models:
        share = 1 / len(models)
        at = [names.index(name) for name in model['features']]
        for tree in model['trees']:
            values = [float(f'{share * model["scale"] * value:.6g}') if feature < 0 else value
                      for feature, value in zip(tree['feature'], tree['threshold'])]
            trees.append({**tree, 'threshold': values,
                          'feature': [-1 if feature < 0 else at[feature] for feature in tree['feature']]})
        baseline += share * (model['scale'] * model['baseline'] + model['offset'])
    return {**models[0], 'features': names, 'baseline': baseline, 'scale': 1.0, 'offset': 0.0, 'trees': trees}


def fit_all(tables, mean_with=None):
    rooms = [np.full(len(t.nodes), t.room) for t in tables]
    known = np.concatenate([t.known for t in tables])
    rows = np.concatenate([t.nodes for t in tables])[known]
    shell = np.concatenate([t.is_shell for t in tables])[known]
    group = np.concatenate(rooms)[known]
    _, shell_file, out_of_fold = fit(rows, shell, group, tables[0].node_names, 12, 'shell')
    probability = np.zeros(len(known))
    probability[known] = out_of_fold
    joints, one, of_room, first = [], [], [], 0
    for t in tables:
        mine = t.with_shell(probability[first:first + len(t.nodes)])
        first += len(t.nodes)
        joints.append(mine[t.known_pair])
        one.append(t.is_one[t.known_pair])
        of_room.append(np.full(t.known_pair.sum(), t.room))
    rows, one, of_room = np.concatenate(joints), np.concatenate(one), np.concatenate(of_room)
    # Most scans have no colours: each row counts without them, too.
    plain = rows.copy()
    plain[:, [k for k, name in enumerate(tables[0].joint_names) if 'colour' in name]] = np.nan
    rows, one, of_room = np.concatenate([rows, plain]), np.tile(one, 2), np.tile(of_room, 2)
    _, joint_file, _ = fit(rows, one, of_room, tables[0].joint_names, 15, 'joints')
    for name, model in (('shell.model.json', shell_file), ('joint.model.json', joint_file)):
        if mean_with:
            model = mean_of([json.loads((mean_with / name).read_text()), model])
        write(name, model)


def make(arguments, kind, way, seed):
    """One scan and its table; both are kept."""
    name = f'{kind}-{way}-{seed}'
    scan, table = arguments.work / 'scans' / name, arguments.work / 'tables' / name
    if not (scan / 'truth.json').exists():
        subprocess.run([arguments.topple, 'generate', scan, '--kind', kind, '--scan', way, '--seed', str(seed)],
                       check=True, capture_output=True)
    if not (table / 'table.json').exists():
        cloud = scan / 'cloud.ply'
        done = subprocess.run([arguments.features, cloud if cloud.exists() else scan, table], capture_output=True)
        if done.returncode:
            print(f'{name}: {done.stderr.decode().strip()}', file=sys.stderr)
            return None
    return scan, table


KINDS = ['plain', 'varied', 'kitchen', 'bathroom', 'bedroom', 'living', 'office', 'shop', 'storage', 'corridor',
         'precarious', 'tabletop', 'library', 'meeting', 'lounge', 'laundry', 'depot']
# Bare clouds leave most open: they come twice.
WAYS = ['walk', 'sparse', 'laser', 'sparse', 'cloud', 'single']


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--topple', type=Path, required=True)
    parser.add_argument('--features', type=Path, required=True)
    parser.add_argument('--work', type=Path, required=True)
    parser.add_argument('--seeds', default='1000:1003', help='first and last seed of each kind and way')
    parser.add_argument('--kinds', nargs='+', default=KINDS)
    parser.add_argument('--only-make', action='store_true', help='make the scans and tables, fit nothing')
    parser.add_argument('--ways', nargs='+', default=WAYS, help='of scanning; rooms take them in turn')
    parser.add_argument('--mean-with', type=Path, metavar='FOLDER',
                        help='write the mean log-odds of the fit and of the models in this folder')
    parser.add_argument('--all-ways', action='store_true', help='scan each room in all of them')
    arguments = parser.parse_args()
    first, last = map(int, arguments.seeds.split(':'))
    wanted = []
    for seed in range(first, last + 1):
        for n, kind in enumerate(arguments.kinds):
            # Other rooms teach more than other scans of the same.
            turn = [arguments.ways[(seed + n) % len(arguments.ways)]]
            wanted += [(kind, way, seed) for way in (arguments.ways if arguments.all_ways else turn)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        made = list(pool.map(lambda w: make(arguments, *w), wanted))
    if not arguments.only_make:
        rooms = {(kind, seed): n for n, (kind, _, seed) in enumerate(wanted)}
        fit_all([Table(*m, rooms[kind, seed]) for m, (kind, _, seed) in zip(made, wanted) if m],
                arguments.mean_with)


if __name__ == '__main__':
    main()
