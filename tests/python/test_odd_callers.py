# SPDX-License-Identifier: MIT
"""Arrays that are none, damaged pickles, threads, forks and other interpreters: a result or an Error of one printable line, soon."""
import pickle
import subprocess
import sys

import numpy as np
import pytest

import topple
from made_scans import tried


def python(code):
    """What a Python of its own prints."""
    said = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, timeout=60)
    assert said.returncode == 0, said.stderr[-2000:]
    return said.stdout


# Arrays that are none

class Hostile:
    def __init__(self, array=None):
        self.array = array

    def __array__(self, *_, **__):
        if self.array is None:
            raise ValueError('\x1b[2J')
        return self.array

    def __len__(self):
        return 2 ** 62


def cloud(count=200):
    return np.random.default_rng(1).random((count, 3)).astype(np.float32)


ODD_ARRAYS = {
    'objects': np.array([[object()] * 3] * 4), 'nested objects': [[Hostile()] * 3] * 4, 'text': np.array([['a'] * 3] * 4), 'bytes': np.array([[b'a'] * 3] * 4),
    'complex': cloud().astype(complex), 'dates': np.zeros((4, 3), 'M8[s]'), 'bools': np.ones((4, 3), bool), 'integers': np.ones((4, 3), int),
    'no rows': np.zeros((0, 3), np.float32), 'no columns': np.zeros((9, 0), np.float32), 'a scalar': np.float32(1), 'four axes': np.zeros((2, 2, 2, 3), np.float32),
    'NaN': np.full((99, 3), np.nan, np.float32), 'infinite': np.full((99, 3), np.inf, np.float32), 'the largest': np.full((99, 3), 3e38, np.float32),
    'beyond floats': np.full((99, 3), 1e300), 'the least': np.full((99, 3), 1e-45, np.float32), 'far': cloud() * np.float32(1e30),
    'from behind': cloud()[::-1], 'columns from behind': cloud()[:, ::-1], 'by columns': np.asfortranarray(cloud()), 'every third': cloud()[::3],
    'one row a million times': np.broadcast_to(cloud(1), (10 ** 6, 3)), 'one row for ever': np.broadcast_to(cloud(1), (10 ** 13, 3)),
    'unaligned': np.frombuffer(b'x' + cloud().tobytes(), np.float32, offset=1).reshape(-1, 3) if sys.byteorder == 'little' else None,
    'big-endian': cloud().astype('>f4'), 'halves': cloud().astype(np.float16), 'long': cloud().astype(np.longdouble), 'records': np.zeros(9, [('x', 'f4'), ('y', 'f4')]),
    'odd records': np.zeros(9, [('x', 'f4', 3), ('y', 'f4'), ('z', 'f4')]), 'masked': np.ma.masked_all((99, 3), np.float32), 'a generator': (x for x in 'abc'), 'a hostile one': Hostile(),
    'hostile rows': Hostile(np.array(3)), 'ragged': [[1.0, 2, 3], [1.0]], 'columns of lengths': (cloud()[:, 0], cloud(9)[:, 0], cloud()[:, 0]), 'a dict': {'x': [1.0], 'y': Hostile(), 'z': []},
    'a type': np.ndarray, 'nothing': b'', 'a path of NUL': 'a\0b', 'a path of surrogates': '\ud800.laz', 'an endless path': 'a' * 10 ** 6 + '.laz',
    'read-only': np.frombuffer(cloud().tobytes(), np.float32).reshape(-1, 3),
}


@pytest.mark.parametrize('what', ODD_ARRAYS)
def test_arrays_that_are_none(what, device):
    tried(lambda: topple.parse(ODD_ARRAYS[what], device=device, disturbances=[], max_memory_bytes=2 << 30))


def test_results_of_hostile_pickles(result):
    """A pickle runs what it says; one that holds damaged numbers alone does no more than raise."""
    kept = result.__getstate__()
    for name, value in (('point_object', np.full(9, 2 ** 31 - 1, np.int32)), ('point_object', np.full(3, -9)), ('point_primitive', 'text'), ('objects', []),
                        ('objects', [3]), ('voxel_size_m', float('nan')), ('voxel_size_m', 0.0), ('point_index', np.array([2 ** 40])), ('x', np.zeros(3)), ('nx', None)):
        copied = pickle.loads(pickle.dumps(kept))
        setattr(copied['parsed'], name, value)
        damaged = topple.Result.__new__(topple.Result)
        damaged.__setstate__(copied)
        for call in (lambda: damaged.object_at([1, 1, 1], 9.0), lambda: damaged.columns(), lambda: damaged.spot(0), lambda: damaged.removal_order(), lambda: repr(damaged),
                     lambda: damaged.frame_labels(np.ones((8, 8), np.float32), camera_to_world=np.eye(4), intrinsics=topple.stages.Intrinsics(8, 8, 9, 9, 4, 4))):
            try:
                call()
            except (topple.Error, TypeError, ValueError, AttributeError, IndexError, KeyError):
                pass


# Threads, forks, interpreters

FIRST = '''
import sys, threading
import numpy as np, topple
a, b = np.meshgrid(np.arange(40) * .05, np.arange(40) * .05)
points = np.concatenate([np.stack([a.ravel(), b.ravel(), 0 * a.ravel()], 1), np.stack([a.ravel(), 0 * a.ravel(), b.ravel()], 1)]).astype(np.float32)
def parse(device=None):
    return len(topple.parse(points, device=device or topple.open_device('native', 1), disturbances=[]).objects)
'''
THREADS = FIRST + '''
threads = [threading.Thread(target=parse) for _ in range(8)]
for thread in threads: thread.start()
for thread in threads: thread.join()
print('ended')
'''
FORKED = FIRST + '''
import os
device = topple.open_device('native', 2)
found = parse(device)
stop = threading.Event()
def again():
    while not stop.is_set(): parse()
worker = threading.Thread(target=again)
worker.start()
child = os.fork()
if child == 0:
    try: parse(device)
    except topple.Error as error: print(error.kind, 'forked' in str(error), parse() == found, flush=True)
    sys.exit(3)  # by way of all that is done at the end
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
stop.set()
worker.join()
'''
ELSEWHERE = '''
try: import _interpreters as interpreters
except ImportError: import _xxsubinterpreters as interpreters
CODE = """
try: import topple
except ImportError as error: print(error)
"""
def run():
    interpreters.run_string(interpreters.create(), CODE)
run()
import topple
run()
'''


def test_first_parses_in_threads_end():
    assert python(THREADS).split() == ['ended']


def test_a_fork_parses_too():
    assert python(FORKED).splitlines() == ['usage True True', '3']


def test_other_interpreters_are_refused():
    said = python(ELSEWHERE).splitlines()
    assert len(said) == 2 and all('main interpreter' in line for line in said)
