# SPDX-License-Identifier: MIT
"""topple.kernels: kernels of a file on NumPy's arrays, on each backend, and what is refused."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

import topple
from topple import kernels

SOURCE = pathlib.Path(__file__).parents[2]
EXAMPLE = SOURCE / 'docs/examples/own-kernel'
BACKENDS = ('native', 'opencl', 'vulkan')
PARAMS = '''
STRUCT(BlendParams) {
    uint count;      // elements
    float strength;  // 0 to 1
    int shift;
} STRUCT_END(BlendParams)
STRUCT(SumParams) {
    uint count;
} STRUCT_END(SumParams)
'''
# Line 10 is the one that computes.
BLEND = '''// Moves values towards others.
KERNEL(blend, 64)
    BUFFER_IN(0, float, src)
    BUFFER_INOUT(1, float, dst)
    BUFFER_OUT(2, int, index)
    PARAMS(BlendParams, p)
BEGIN
    if (GLOBAL_ID < p.count) {
        uint i = GLOBAL_ID;
        dst[i] = dst[i] + p.strength * (src[i] - dst[i]) / 3.0f;
        index[i] = int(i) + p.shift;
    }
END
'''
# Two kernels with a function for both; each group of block_sum adds up its 64 numbers.
SEVERAL = '''FN uint twice(uint value) { return value * 2u; }

KERNEL(block_sum, 64)
    BUFFER_IN(0, uint, src)
    BUFFER_OUT(1, uint, sums)
    PARAMS(SumParams, p)
    SHARED(uint, tile, 64)
BEGIN_GROUP
    LANES
        tile[LOCAL_ID] = GLOBAL_ID < p.count ? twice(src[GLOBAL_ID]) : 0u;
    END_LANES
    for (uint stride = 32u; stride > 0u; stride >>= 1) {
        LANES
            if (LOCAL_ID < stride) { tile[LOCAL_ID] += tile[LOCAL_ID + stride]; }
        END_LANES
    }
    LANES
        if (LOCAL_ID == 0u) { sums[GROUP_ID] = tile[0]; }
    END_LANES
END_GROUP

// Work-items of several elements each.
ITEMS_PER_LANE(16, 4, 8, 2)
KERNEL(double_all, 32)
    BUFFER_INOUT(0, uint, values)
    PARAMS(SumParams, p)
BEGIN
    for (int k = 0; k < ITEMS; k++) {
        uint i = GLOBAL_ID * uint(ITEMS) + uint(k);
        if (i < p.count) { values[i] = twice(values[i]); }
    }
END
'''
USABLE = {listed.backend for listed in topple.devices() if listed.usable}


@pytest.fixture(scope='module', autouse=True)
def cache(tmp_path_factory):
    """Libraries of the tests' own."""
    folder = tmp_path_factory.mktemp('cache')
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv('XDG_CACHE_HOME', str(folder))
        yield folder / 'topple-kernels'


@pytest.fixture(scope='module', params=BACKENDS)
def on(request):
    """A device of each backend; one that is missing is skipped by name."""
    if request.param not in USABLE and os.environ.get('TOPPLE_REQUIRE_BACKENDS') != '1':
        pytest.skip(f'there is no {request.param}')
    return topple.open_device(request.param)


def written(folder, text, name='blend'):
    """A kernel beside the parameters of all; its path."""
    (folder / 'some_params.h').write_text(PARAMS)
    path = folder / f'{name}.kernel'
    path.write_text(text)
    return path


@pytest.fixture
def write(tmp_path):
    return lambda *kernel: written(tmp_path, *kernel)


@pytest.fixture(scope='module')
def blend(tmp_path_factory):
    return kernels.load(written(tmp_path_factory.mktemp('blend'), BLEND))


def blended(src, dst, strength):
    """As the kernel has it, in float32 throughout."""
    return dst + np.float32(strength) * (src - dst) / np.float32(3)


def arrays(count, seed=1):
    random = np.random.default_rng(seed)
    return {'src': random.normal(size=count).astype(np.float32), 'dst': random.normal(size=count).astype(np.float32),
            'index': np.full(count, -7, np.int32)}


def refused(call, *arguments, **options):
    with pytest.raises(topple.Error) as caught:
        call(*arguments, **options)
    return caught.value


@pytest.mark.parametrize('count', [1, 63, 64, 65, 128, 997])
def test_each_backend_gives_the_bits_of_numpy(blend, on, count):
    given = arrays(count)
    expected = blended(given['src'], given['dst'], 0.3)
    source = given['src'].copy()
    assert blend(on, **given, params={'count': count, 'strength': 0.3, 'shift': -2}) is None
    assert given['dst'].tobytes() == expected.tobytes()
    assert np.array_equal(given['index'], np.arange(count) - 2) and np.array_equal(given['src'], source)


def test_the_example_of_the_docs_runs(on, monkeypatch):
    text = (SOURCE / 'docs/python.md').read_text(encoding='utf-8')
    code = re.search(r'\*\*Kernels of your own\.\*\*.*?```python\n(.*?)```', text, re.S)[1]
    monkeypatch.chdir(SOURCE)
    told = {'np': np, 'topple': topple, 'device': on}
    exec(code, told)
    h, w = told['heights'], told['weights']
    near = [np.r_[0, np.arange(99)], np.arange(100), np.r_[np.arange(1, 100), 99]]
    weight = [w[k] for k in near]
    expected = (weight[0] * h[near[0]] + weight[1] * h[near[1]] + weight[2] * h[near[2]]) / (weight[0] + weight[1] + weight[2])
    assert told['smoothed'].tobytes() == expected.tobytes()


def test_what_the_kernel_leaves_alone_stays(blend, on):
    given = arrays(100)
    before = {name: array.copy() for name, array in given.items()}
    blend(on, **given, count=40, strength=1, shift=0)
    assert np.array_equal(given['index'], np.r_[np.arange(40), np.full(60, -7)])
    assert np.array_equal(given['dst'][40:], before['dst'][40:]) and (given['dst'][:40] != before['dst'][:40]).all()


def test_arrays_of_any_shape(blend, on):
    flat, shaped = arrays(60), {name: array.reshape(3, 4, 5) for name, array in arrays(60).items()}
    for given in (flat, shaped):
        blend(on, **given, count=60, strength=0.5, shift=0)
    assert np.array_equal(flat['dst'], shaped['dst'].ravel())


def test_empty_arrays(blend, on):
    blend(on, **arrays(0), count=0, strength=0.5, shift=0)
    given = arrays(5)
    blend(on, **given, count=5, strength=0.5, shift=0, items=0)
    assert (given['index'] == -7).all()


def test_groups_and_several_kernels_of_a_file(write, on):
    path = write(SEVERAL, 'several')
    assert 'has the kernels block_sum, double_all; choose one' in str(refused(kernels.load, path))
    assert "has no kernel 'sum', but block_sum" in str(refused(kernels.load, path, name='sum'))
    total = kernels.load(path, name='block_sum')
    for count in (1, 64, 200):
        values, sums = np.arange(count, dtype=np.uint32), np.zeros(-(-count // 64), np.uint32)
        total(on, src=values, sums=sums, count=count, items=64 * len(sums))
        padded = np.pad(2 * values, (0, 64 * len(sums) - count))
        assert np.array_equal(sums, padded.reshape(-1, 64).sum(1))
    assert 'items: expected a multiple of its group of 64 work-items, not 100; 128 is the next one' in str(
        refused(total, on, src=values, sums=sums, count=1, items=100))
    assert 'items is missing: its number of work-items, a multiple of 64' in str(refused(total, on, src=values, sums=sums, count=1))
    values = np.arange(1001, dtype=np.uint32)
    kernels.load(path, name='double_all')(on, values=values, count=1001)
    assert np.array_equal(values, 2 * np.arange(1001))


# Halves of numbers, and which of two cells of a grid, (0, 0, 0) and (1, 2, 3), (i, 2, 3) is.
WORDS = '''
KERNEL(words, 64)
    BUFFER_IN(0, float, src)
    GRID_IN(1, grid)
    BUFFER_OUT(5, uint, half_of)
    BUFFER_OUT(6, uint, cell)
    PARAMS(SumParams, p)
BEGIN
    if (GLOBAL_ID < p.count) {
        half_of[GLOBAL_ID] = half_bits(src[GLOBAL_ID]);
        GRID_FIND(at, grid, 1u, int(GLOBAL_ID), 2, 3)
        cell[GLOBAL_ID] = at;
    }
END
'''


def test_words_of_halves_and_grids(write, on):
    src = np.random.default_rng(4).normal(size=100).astype(np.float32)
    half_of, cell = np.zeros(100, np.uint32), np.zeros(100, np.uint32)
    leaf = {'grid_leaf_low': [1 << 26], 'grid_leaf_high': [1 << 30 | 1 << 12], 'grid_first': [0, 2],
            'grid_mask': [1, 0, 1 << 19] + 13 * [0]}
    call = kernels.load(write(WORDS, 'words'), sizes={name: len(words) for name, words in leaf.items()})
    call(on, src=src, half_of=half_of, cell=cell, count=100,
         **{name: np.array(words, np.uint32) for name, words in leaf.items()})
    assert np.array_equal(half_of, src.astype(np.float16).view(np.uint16))
    assert cell[1] == 1 and np.all(np.delete(cell, 1) == 0xffffffff)


def test_what_it_declares(blend):
    assert blend.name == 'blend' and blend.group_size == 64
    assert blend.buffers == {'src': ('in', np.float32), 'dst': ('inout', np.float32), 'index': ('out', np.int32)}
    assert blend.parameters == {'count': np.uint32, 'strength': np.float32, 'shift': np.int32}
    assert repr(blend) == ('<topple.kernels.Kernel blend(src: in float32, dst: inout float32, index: out int32; count: uint32, strength: float32, '
                           'shift: int32)>')


READ_ONLY = np.zeros(8, np.float32)
READ_ONLY.flags.writeable = False


@pytest.mark.parametrize('changed, expected', [
    ({'src': np.zeros(8)}, r"buffer src: expected a C-contiguous NumPy array of float32, not float64 of shape \(8,\); src.astype\('float32'\)"),
    ({'index': np.zeros(8, np.uint32)}, r'buffer index: expected a C-contiguous NumPy array of int32, not uint32 of shape \(8,\)$'),
    ({'src': np.zeros(8, '>f4')}, r'buffer src: .* of float32, not >f4'),
    ({'src': [0.0] * 8}, 'buffer src: .* not a list'),
    ({'src': np.ma.zeros(8, np.float32)}, 'buffer src: .* not a MaskedArray'),
    ({'src': np.zeros((2, 8), np.float32)[:, ::2]}, r'buffer src: .* not float32 of shape \(2, 4\) with strides of \(32, 8\) bytes'),
    ({'dst': READ_ONLY}, 'buffer dst: expected an array to write to, not float32 .* read-only'),
    ({'src': np.zeros((1, 7), np.float32)}, r'buffer src: expected 8 elements or more, not float32 of shape \(1, 7\) with 7: one for each item'),
    ({'items': 9}, 'buffer src: expected 9 elements or more'),
    ({'count': 9, 'items': 8}, 'buffer src: expected 9 elements or more'),
    ({'items': -1}, 'items: expected 0 to 4294967295, not -1'),
    ({'items': 2.5}, 'items: expected a whole number, not 2.5'),
    ({'count': -1}, 'parameter count: expected a whole number, 0 to 4294967295, not -1'),
    ({'count': 8.0}, 'parameter count: expected a whole number'),
    ({'shift': 2 ** 31}, 'parameter shift: expected a whole number, -2147483648 to 2147483647, not 2147483648'),
    ({'strength': 1e39}, r'parameter strength: expected a float32, not 1e\+39'),
    ({'strength': '1'}, "parameter strength: expected a float32, not '1'"),
    ({'strenght': 1.0}, "there is no buffer or parameter 'strenght'; did you mean 'strength'"),
    ({'params': {'strenght': 1.0}}, "there is no parameter 'strenght'; did you mean 'strength'"),
    ({'params': {'count': 1}}, 'parameter count is given twice'),
    ({'params': 3}, 'params: expected a dict of count, strength, shift, not 3'),
    ({'strength': None}, 'parameter strength: expected a float32, not None'),
])
def test_wrong_arguments_are_told(blend, device, changed, expected):
    given = {**arrays(8), 'count': 8, 'strength': 0.5, 'shift': 0, **changed}
    error = refused(blend, device, **given)
    assert error.kind == 'usage' and re.search('^kernel blend: .*' + expected, str(error)), str(error)


def test_missing_and_overlapping_arguments_are_told(blend, device):
    given = arrays(8)
    assert 'kernel blend: parameter shift is missing' in str(refused(blend, device, **given, count=8, strength=1))
    src = given.pop('src')
    assert 'buffer src is missing: an array of float32' in str(refused(blend, device, **given, count=8, strength=1, shift=0))
    both = refused(blend, device, src=given['dst'], **given, count=8, strength=1, shift=0)
    assert 'buffers dst and src overlap, and dst is written' in str(both)
    assert "device: expected one of topple.open_device() or a backend's name" in str(refused(blend, 3, src=src, **given, count=8, strength=1, shift=0))
    blend('native', src=src, **given, count=8, strength=1, shift=0)


def test_sizes_say_what_buffers_must_have(write, device):
    path = write(BLEND.replace('src[i] -', 'src[0] -'))
    given = arrays(8)
    given['src'] = given['src'][:1]
    arguments = {'count': 8, 'strength': 1, 'shift': 0}
    kernels.load(path, sizes={'src': 1})(device, **given, **arguments)
    kernels.load(path, sizes={'src': None})(device, **given, **arguments)
    assert 'expected 8 elements or more' in str(refused(kernels.load(path, sizes={'src': 'count'}), device, **given, **arguments))
    assert "no buffer 'source'" in str(refused(kernels.load, path, sizes={'source': 1}))
    assert 'sizes: src: expected a number from 0' in str(refused(kernels.load, path, sizes={'src': 'strength'}))


@pytest.mark.parametrize('wrong, expected', [('3.0', '3.0 is a double in C++ and OpenCL C; write the f behind it'), ('sin(3.0f)', 'sin( differs')])
def test_rules_of_the_dialect_are_told_at_once(write, wrong, expected):
    path = write(BLEND.replace('3.0f', wrong))
    error = refused(kernels.load, path)
    assert error.kind == 'input' and str(error).startswith(f'{path}:10: {expected}'), str(error)


def test_compilers_tell_the_own_line(write, on):
    path = write(BLEND.replace('p.strength', 'p.strenth'))
    error = refused(kernels.load(path), on, **arrays(8), count=8, strength=1, shift=0)
    assert error.kind == ('device' if on.backend == 'opencl' else 'input')
    assert 'kernel blend' in str(error) and f'{path}:10' in str(error) and 'strenth' in str(error), str(error)


@pytest.mark.parametrize('before, after, expected', [
    ('BUFFER_IN(0, float, src)', 'BUFFER_IN(0, bool, src)', 'blend.kernel: buffer src has type bool; a buffer holds float, uint, int'),
    ('KERNEL(blend, 64)', 'KERNEL(blend, 0)', r'KERNEL\(blend, 0\): a group has 1 to 1024 work-items'),
    ('KERNEL(blend, 64)', 'ITEMS_PER_LANE(1, 1, 0, 1) KERNEL(blend, 64)', r'ITEMS_PER_LANE\(1, 1, 0, 1\): expected whole numbers, 1 or more'),
    ('KERNEL(blend, 64)', '', r'blend.kernel: expected one KERNEL\(name, group_size\), found 0'),
    ('END', '', 'blend.kernel: kernel blend has no BEGIN ... END'),
    ('BlendParams', 'OtherParams', r'blend.kernel: STRUCT\(OtherParams\) is in no header \(\*.h\) beside it; name the file'),
    ('float, src', 'float, items', 'a buffer called items has no name of its own'),
])
def test_broken_declarations_are_told(write, before, after, expected):
    error = refused(kernels.load, write(BLEND.replace(before, after)))
    assert error.kind == 'input' and re.search(expected, str(error)), str(error)


def test_headers_are_found_or_named(write, tmp_path, device):
    path = write(BLEND.replace('3.0f', 'third()'))
    (tmp_path / 'other.h').write_text(PARAMS)
    (tmp_path / 'functions').write_text('FN float third() { return 3.0f; }')
    assert 'is in ' in str(refused(kernels.load, path)) and ' and in ' in str(refused(kernels.load, path))
    blend = kernels.load(path, params='other.h', functions='functions')
    given = arrays(8)
    expected = blended(given['src'], given['dst'], 0.25)
    blend(device, **given, count=8, strength=0.25, shift=0)
    assert np.array_equal(given['dst'], expected)
    (tmp_path / 'other.h').write_text(PARAMS.replace('float strength', 'double strength'))
    assert 'other.h: BlendParams.strength has type double' in str(refused(kernels.load, path, params=tmp_path / 'other.h', functions='functions'))
    assert refused(kernels.load, tmp_path / 'none.kernel').kind == 'input'


RUN = '''
import sys
import numpy as np
import topple.kernels
values = np.arange(5, dtype=np.uint32)
try:
    topple.kernels.load(sys.argv[1], name='double_all')(sys.argv[2], values=values, count=5)
    print(values.tolist())
except topple.Error as error:
    print(error.kind, error)
'''


def run(path, backend, **environment):
    """By another process, which has made nothing yet."""
    env = {name: value for name, value in os.environ.items() if name != 'CXX'}
    command = [sys.executable, '-c', RUN, path, backend]
    return subprocess.run(command, env={**env, **environment}, stdout=subprocess.PIPE, text=True, check=True).stdout.strip()


@pytest.mark.parametrize('backend, expected', [
    ('native', 'device kernel double_all: native kernels take a C++ compiler (c++, g++ or clang++), and there is none in PATH'),
    ('vulkan', 'device kernel double_all: Vulkan takes glslangValidator, which is not in PATH: apt-get install glslang-tools'),
])
def test_a_missing_compiler_is_told(write, tmp_path, backend, expected):
    if backend not in USABLE:
        pytest.skip(f'there is no {backend}')
    (tmp_path / 'nothing').mkdir()
    assert run(write(SEVERAL, 'several'), backend, PATH=str(tmp_path / 'nothing')).startswith(expected)


def test_libraries_are_compiled_once(write, tmp_path):
    tools, log = tmp_path / 'tools', tmp_path / 'log'
    tools.mkdir()
    (tools / 'c++').write_text(f'#!/bin/sh\necho "$@" >> {log}\nexec {shutil.which("c++")} "$@"\n')
    (tools / 'c++').chmod(0o755)
    environment = {'PATH': f'{tools}:{os.environ["PATH"]}', 'XDG_CACHE_HOME': str(tmp_path / 'fresh')}
    path = write(SEVERAL, 'several')

    def links():
        return log.read_text().count('-shared')
    for times in (1, 1):
        assert run(path, 'native', **environment) == '[0, 2, 4, 6, 8]' and links() == times
    kept = tmp_path / 'fresh' / 'topple-kernels'
    assert kept.stat().st_mode & 0o777 == 0o700 and [re.sub('-[0-9a-f]{32}', '', file.name) for file in kept.iterdir()] == ['double_all.so']
    path.write_text(SEVERAL.replace('value * 2u', 'value * 3u'))
    assert run(path, 'native', **environment) == '[0, 3, 6, 9, 12]' and links() == 2


def test_a_folder_that_others_may_write_to_is_refused(write, tmp_path):
    base = tmp_path / 'open'
    (base / 'topple-kernels').mkdir(parents=True)
    (base / 'topple-kernels').chmod(0o770)
    path = write(SEVERAL, 'several')
    expected = 'must be a folder of yours that is open to nobody else (mode 700, not 770): remove it, or set XDG_CACHE_HOME'
    assert expected in run(path, 'native', XDG_CACHE_HOME=str(base))
    (base / 'topple-kernels').rmdir()
    (tmp_path / 'elsewhere').mkdir(mode=0o700)
    (base / 'topple-kernels').symlink_to(tmp_path / 'elsewhere')
    assert 'must be a folder of yours' in run(path, 'native', XDG_CACHE_HOME=str(base))


def test_names_of_folders_may_have_spaces_and_accents(write, tmp_path, on):
    folder = tmp_path / 'Größe 3'
    folder.mkdir()
    for file in (write(BLEND), tmp_path / 'some_params.h'):
        shutil.copy(file, folder)
    given = arrays(8)
    kernels.load(folder / 'blend.kernel')(on, **given, count=8, strength=1, shift=0)
    assert given['index'][7] == 7
