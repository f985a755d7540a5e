#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tests of embed_models.py: damaged models end the build by name, and numbers come out as they are.

usage: embed_models_test.py FOLDER   the folder with embed_models.py and the models
"""
import copy
import json
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FITTED = Path(sys.argv.pop(1))
MODEL = {
    'schema': 'topple.trees/1', 'about': 'a test', 'features': ['gap', 'area'], 'baseline': 0.5, 'scale': 2, 'offset': -1,
    'trees': [{'feature': [1, 0, -1, -1, -1], 'threshold': [2, 0.1, 1, -2, 3], 'missing_left': [0, 1, 0, 0, 0],
               'left': [1, 2, 0, 0, 0], 'right': [4, 3, 0, 0, 0]},
              {'feature': [-1], 'threshold': [0.25], 'missing_left': [0], 'left': [0], 'right': [0]}]}
SCALING = {'low': [0, -1], 'high': [1, 2], 'mean': [0.5, 0], 'deviation': [0.25, 1]}
# Of one round, 32 wide: layers of 3 inputs with one flag, and of 2.
CONTEXT = {
    'schema': 'topple.context/1', 'about': 'a test', 'width': 32, 'rounds': 1,
    'nodes': {'names': ['area', 'shell'], 'missing': [], **SCALING}, 'joints': {'names': ['gap', 'length'], 'missing': [1], **SCALING},
    'weights': [0.1] * 32 * (3 + 33 + 4 + 33 + 2 * (65 + 33) + 2 * (97 + 33)), 'joint_out': [0.5] * 34, 'shell_out': [0.25] * 34}
ARRAYS = ('feature', 'threshold', 'missing_left', 'left', 'right')


def embed(text):
    """(exit code, what it said, the code)."""
    with tempfile.TemporaryDirectory() as folder:
        model, out = Path(folder) / 'test.json', Path(folder) / 'out.cpp'
        model.write_text(text)
        done = subprocess.run([sys.executable, FITTED / 'embed_models.py', out, f'test={model}'], capture_output=True, text=True)
        return done.returncode, done.stderr, out.read_text() if out.exists() else ''


class EmbedModels(unittest.TestCase):
    def refused(self, model, *words):
        code, said, out = embed(model if isinstance(model, str) else json.dumps(model))
        self.assertNotEqual(code, 0)
        self.assertEqual(out, '')
        self.assertEqual(len(said.splitlines()), 1, said)
        for word in ('test.json', *words):
            self.assertIn(word, said)

    def test_constants_are_the_numbers_of_the_file(self):
        code, said, out = embed(json.dumps(MODEL))
        self.assertEqual((code, said), (0, ''))
        self.assertIn('{1, 2.0f, false, 1, 4},', out)
        self.assertIn('{-1, 0.25f, false, 0, 0},', out)
        self.assertIn('"gap",', out)
        self.assertIn('0.5, 2.0, -1.0}', out)
        tenth = out[out.index('{0, ') + 4:].split('f,')[0]
        self.assertEqual(struct.pack('f', float(tenth)), struct.pack('f', 0.1))

    def test_what_is_no_model_is_refused(self):
        self.refused('')
        self.refused('{')
        self.refused('[]', 'topple.trees/1')
        self.refused({**MODEL, 'schema': 'topple.trees/2'}, 'topple.trees/1')
        for key in ('features', 'trees', 'baseline', 'scale', 'offset'):
            self.refused({k: v for k, v in MODEL.items() if k != key}, key)
        self.refused({**MODEL, 'baseline': 'much'}, 'baseline')
        self.refused({**MODEL, 'features': [1, 2]}, 'features')

    def test_damaged_trees_are_told_by_number(self):
        for key in ARRAYS:
            less = copy.deepcopy(MODEL)
            less['trees'][0][key].pop()
            self.refused(less, 'tree 0')
            none = copy.deepcopy(MODEL)
            del none['trees'][1][key]
            self.refused(none, 'tree 1')
        for key, at, value in (('feature', 0, 2), ('left', 0, 0), ('left', 1, 0), ('right', 0, 5), ('left', 1, -1)):
            other = copy.deepcopy(MODEL)
            other['trees'][0][key][at] = value
            self.refused(other, 'tree 0')
        empty = copy.deepcopy(MODEL)
        empty['trees'][1] = {key: [] for key in ARRAYS}
        self.refused(empty, 'tree 1')

    def test_a_network_comes_out_as_it_is(self):
        code, said, out = embed(json.dumps(CONTEXT))
        self.assertEqual((code, said), (0, ''))
        self.assertIn('test_nodes_deviation, {}}, {test_joints_names,', out)  # nothing of a node is missing
        self.assertIn('test_joints_missing}, 32, 1,', out)
        self.assertEqual(out.count('    0.25f,'), 34 + 2)

    def test_damaged_networks_are_refused(self):
        self.refused({**CONTEXT, 'weights': CONTEXT['weights'][1:]}, 'weights', str(len(CONTEXT['weights'])))
        self.refused({**CONTEXT, 'weights': [float('nan'), *CONTEXT['weights'][1:]]}, 'weight')
        self.refused({**CONTEXT, 'width': 31}, 'width')
        self.refused({**CONTEXT, 'rounds': 0}, 'rounds')
        self.refused({**CONTEXT, 'joint_out': [1]}, 'joint_out')
        self.refused({k: v for k, v in CONTEXT.items() if k != 'nodes'}, 'nodes')
        for key, value in (('missing', [2]), ('deviation', [0, 1]), ('low', [0])):
            self.refused({**CONTEXT, 'joints': {**CONTEXT['joints'], key: value}}, 'joints')

    def test_the_models_of_the_build_are_sound(self):
        for path in FITTED.glob('*.model.json'):
            self.assertEqual(embed(path.read_text())[0], 0, path)


if __name__ == '__main__':
    unittest.main()
