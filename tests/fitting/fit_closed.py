#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fits what tells closed furniture (host/physics/closed_furniture.cpp) on generated scans, and prints it.

usage: fit_closed.py --topple TOPPLE --features TOPPLE_FEATURES --work FOLDER [--seeds FIRST:LAST]

Scans and tables are those of fit.py, and are kept in FOLDER. An object's truth is the name of the thing that most of its
samples belong to; closed are those that people keep things in behind doors, or in drawers, and machines. Takes
python3-sklearn and python3-scipy.
"""
import argparse
import concurrent.futures
import json
from pathlib import Path

import numpy as np
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import roc_auc_score
from sklearn.model_selection import GroupKFold

import fit

KINDS = ['plain', 'varied', 'kitchen', 'bathroom', 'bedroom', 'living', 'office', 'storage', 'corridor', 'lounge',
         'meeting', 'laundry']
CLOSED = {'cabinet', 'wardrobe', 'fridge', 'drawers', 'dresser', 'drawer unit', 'dishwasher', 'oven', 'dryer',
          'washing machine', 'cupboard', 'sideboard', 'locker', 'vending machine'}
LEAST_SHARE = 0.6  # of an object's samples that are one thing's
LEAST_SAMPLES = 20
LEAST_FILL = 0.2  # what fills less of its box is none, as closed_furniture.cpp has it


def objects_of(scan, table, room):
    """Of each object that can move and is one thing for the most part: its looks, its name, the room."""
    truth = fit.Table(scan, table, room)
    looks = np.fromfile(table / 'looks.f32', '<f4').reshape(-1, 3)
    of_primitive = np.fromfile(table / 'object.i32', '<i4')
    samples = np.bincount(np.fromfile(table / 'primitive.i32', '<i4').clip(-1) + 1, minlength=len(of_primitive) + 1)[1:]
    names = {o['id']: o['name'] for o in json.loads((scan / 'truth.json').read_text())['objects']}
    for o in np.unique(of_primitive[of_primitive >= 0]):
        votes = {}
        for p in np.flatnonzero(of_primitive == o):
            votes[truth.owner[p]] = votes.get(truth.owner[p], 0) + samples[p]
        if looks[o][1] < LEAST_FILL:
            continue
        best = max(votes, key=votes.get)
        if best <= 0 or votes[best] < max(LEAST_SAMPLES, LEAST_SHARE * sum(votes.values())):
            continue
        yield looks[o], names[best], room


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--topple', type=Path, required=True)
    parser.add_argument('--features', type=Path, required=True)
    parser.add_argument('--work', type=Path, required=True)
    parser.add_argument('--seeds', default='1000:1002', help='first and last seed of each kind')
    parser.add_argument('--kinds', nargs='+', default=KINDS)
    arguments = parser.parse_args()
    first, last = map(int, arguments.seeds.split(':'))
    wanted = [(kind, fit.WAYS[(seed + n) % (len(fit.WAYS) - 1)], seed)
              for seed in range(first, last + 1) for n, kind in enumerate(arguments.kinds)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        made = list(pool.map(lambda w: fit.make(arguments, *w), wanted))
    found = [o for room, m in enumerate(made) if m for o in objects_of(*m, room)]
    rows = np.array([looks.prod() for looks, _, _ in found], dtype=float)[:, None]  # height x fill x backing
    names = np.array([name for _, name, _ in found])
    group = np.array([room for _, _, room in found])
    closed = np.isin(names, sorted(CLOSED))
    out_of_fold = np.zeros(len(closed))
    for train, test in GroupKFold(5).split(rows, closed, group):
        out_of_fold[test] = LogisticRegression(C=10).fit(rows[train], closed[train]).predict_proba(rows[test])[:, 1]
    taken = out_of_fold > 0.5
    print(f'{len(closed)} objects, {closed.sum()} closed; out of fold: AUC {roc_auc_score(closed, out_of_fold):.3f}, '
          f'found {taken[closed].mean():.2f}, right of what is taken {closed[taken].mean():.2f}')
    for name in sorted(set(names[taken & ~closed])):
        print(f'  taken, too: {name} ({(names[taken & ~closed] == name).sum()})')
    model = LogisticRegression(C=10).fit(rows, closed)
    print(f'offset {model.intercept_[0]:.2f}, per metre {model.coef_[0, 0]:.2f}')


if __name__ == '__main__':
    main()
