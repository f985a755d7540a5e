#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of fit.py: what it writes is what it fitted, and truth is told as it says.

Leaves with 77, which ctest takes for skipped, where python3-sklearn or python3-scipy is missing.
"""
import contextlib
import io
import json
import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

os.environ.setdefault('OMP_NUM_THREADS', '1')  # threads would only wait for one another

try:
    import numpy as np
    import scipy  # noqa: F401
    import sklearn  # noqa: F401
except ImportError as missing:
    print(f'skipped: {missing}; apt-get install python3-sklearn python3-scipy')
    sys.exit(77)

import fit


def log_odds(model, row):
    """As host/fitted/boosted_trees.cpp says."""
    total = model['baseline']
    for tree in model['trees']:
        n = 0
        while tree['feature'][n] >= 0:
            value = row[tree['feature'][n]]
            left = tree['missing_left'][n] if np.isnan(value) else value <= np.float32(tree['threshold'][n])
            child = tree['left'][n] if left else tree['right'][n]
            assert child > n, 'children come after their parents'
            n = child
        total += tree['threshold'][n]
    return model['scale'] * total + model['offset']


def examples(count, seed=1):
    """Rows of three figures, the last often not known, and a truth that depends on the first two."""
    random = np.random.default_rng(seed)
    rows = random.normal(size=(count, 3)).astype('f4')
    truth = rows[:, 0] + rows[:, 1] ** 2 + random.normal(size=count) > 1
    rows[random.random(count) < 0.4, 2] = np.nan
    rows[random.random(count) < 0.1, 0] = np.nan
    return rows, truth, np.arange(count) % 10


booster = fit.booster


def few_trees(leaves):
    """As fit.booster, but soon done."""
    return booster(leaves).set_params(max_iter=25, learning_rate=0.2)


def fitted(count):
    rows, truth, group = examples(count)
    with contextlib.redirect_stdout(io.StringIO()), mock.patch.object(fit, 'booster', few_trees):
        return rows, truth, *fit.fit(rows, truth, group, ['a', 'b', 'c'], 6, 'test')


def write_ply(path, columns):
    types = {'<f8': 'double', '<i4': 'int'}
    rows = np.rec.fromarrays([np.array(values, dtype) for _, dtype, values in columns],
                             dtype=[(name, dtype) for name, dtype, _ in columns])
    header = ['ply', 'format binary_little_endian 1.0', f'element vertex {len(rows)}']
    header += [f'property {types[dtype]} {name}' for name, dtype, _ in columns] + ['end_header', '']
    path.write_bytes('\n'.join(header).encode() + rows.tobytes())


class Fitting(unittest.TestCase):
    def test_the_file_is_the_model(self):
        rows, _, model, file, _ = fitted(600)
        file = json.loads(json.dumps(file))
        self.assertEqual(file['schema'], 'topple.trees/1')
        self.assertEqual(file['features'], ['a', 'b', 'c'])
        expected = file['scale'] * model.decision_function(rows) + file['offset']
        self.assertLess(max(abs(log_odds(file, row) - e) for row, e in zip(rows, expected)), 1e-2)

    def test_the_mean_of_models_has_the_mean_of_their_log_odds(self):
        rows, _, _, one, _ = fitted(600)
        other = {**one, 'features': ['c', 'b', 'd'], 'scale': 0.5, 'offset': 1.0, 'trees': one['trees'][:9]}
        mean = json.loads(json.dumps(fit.mean_of([one, other])))
        self.assertEqual(mean['features'], ['a', 'b', 'c', 'd'])
        last = rows[:, 0][::-1]
        for row, d in zip(rows, last):
            expected = (log_odds(one, row) + log_odds(other, [row[2], row[1], d])) / 2
            self.assertAlmostEqual(log_odds(mean, [*row, d]), expected, places=4)

    def test_probabilities_are_calibrated_on_what_was_not_fitted(self):
        _, truth, _, _, out_of_fold = fitted(2000)
        self.assertEqual(out_of_fold.shape, truth.shape)
        self.assertLess(fit.calibration_error(out_of_fold, truth), 0.06)
        self.assertGreater(((out_of_fold > 0.5) == truth).mean(), 0.7)

    def test_calibration_error_is_the_mean_distance_of_shares(self):
        truth = np.array([True, False, False, False])
        self.assertAlmostEqual(fit.calibration_error(np.full(4, 0.25), truth), 0)
        self.assertAlmostEqual(fit.calibration_error(np.full(4, 0.75), truth), 0.5)
        self.assertAlmostEqual(fit.calibration_error(np.array([0.75, 0.05, 0.05, 0.05]), truth),
                               (0.25 + 3 * 0.05) / 4)

    def test_truth_is_that_of_the_nearest_surface(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            # The room's floor, a shelf on its wall, two boxes; samples of five primitives, turned.
            places = {0: [0, 0, 0], 1: [1, 0, 1], 2: [2, 0, 0], 3: [3, 0, 0]}
            write_ply(folder / 'truth.ply', [(axis, '<f8', [p[a] for p in places.values()])
                                             for a, axis in enumerate('xyz')] + [('object', '<i4', list(places))])
            (folder / 'truth.json').write_text(json.dumps({'objects': [
                {'id': n, 'fixed': n == 1, 'shell': n == 0, 'pile': False} for n in places]}))
            axes, origin = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]], 'f8'), np.array([0.3, -2, 1.5])
            of = [0] * 6 + [1] * 6 + [2] * 6 + [3] * 2 + [4] * 6
            where = [0] * 6 + [1] * 6 + [2] * 4 + [3] * 2 + [3] * 2 + [2] * 6
            seen = np.array([places[w] for w in where]) + [0, 0, 0.02]
            seen[-6:-3] += 0.5  # half of the last far from all that is known
            ((seen - origin) @ axes.T).astype('<f4').tofile(folder / 'samples.f32')
            np.array(of, '<i4').tofile(folder / 'primitive.i32')
            np.array([[0, 1], [1, 2], [2, 4], [2, 3]], '<i4').tofile(folder / 'pairs.i32')
            np.array([[2], [1], [4], [3], [5]], '<f4').tofile(folder / 'nodes.f32')
            np.zeros((4, 2), '<f4').tofile(folder / 'joints.f32')
            (folder / 'table.json').write_text(json.dumps(
                {'node_names': ['log_area'], 'joint_names': ['shell_small', 'shell_big'], 'axes': axes.tolist(), 'origin': origin.tolist()}))
            table = fit.Table(folder, folder, 0)
        self.assertEqual(table.owner[:3].tolist(), [0, 0, 2])
        self.assertEqual(table.is_shell[:3].tolist(), [True, True, False])
        # Two samples are too few to tell, and so are three.
        self.assertEqual(table.known.tolist(), [True, True, True, False, False])
        self.assertEqual(table.known_pair.tolist(), [True, True, False, False])
        self.assertEqual(table.is_one[:2].tolist(), [True, False])
        rows = table.with_shell(np.array([0.1, 0.2, 0.3, 0.4, 0.5]))
        np.testing.assert_allclose(rows, [[0.2, 0.1], [0.2, 0.3], [0.3, 0.5], [0.4, 0.3]], rtol=1e-6)


if __name__ == '__main__':
    unittest.main()
