# SPDX-License-Identifier: MIT
"""Conversion in a process of its own: packages of others read files of others, and may crash, hang or take all memory.

Nothing that lies beside a scan, or where the caller is, is run there: it is Python alone that starts, isolated, and it looks for packages
where this one does, but for those places."""
import contextlib
import dataclasses
import importlib
import json
import math
import os
import pathlib
import resource
import signal
import stat
import subprocess
import sys
import sysconfig
import time

import numpy as np

from .. import _topple
from .._arrays import error as error_of, printable
from . import limits
from .errors import Error, reading, wrong

POLL_S = 0.05
LONGEST_ANSWER, MOST_NOTES, LONGEST_NOTE = 1 << 20, 50, 1000
KINDS = ('input', 'usage', 'device', 'cancelled')
PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# Loads this package from where it lies, as the folder around it may be one of those that are left out.
START = '''import importlib.util, json, sys
task = json.loads(sys.argv[1])
sys.path[:] = task['places']
spec = importlib.util.spec_from_file_location('topple', task['package'] + '/__init__.py', submodule_search_locations=[task['package']])
sys.modules['topple'] = topple = importlib.util.module_from_spec(spec)
spec.loader.exec_module(topple)
from topple.formats import apart
apart.answer(task)'''
# What Python needs to start; no PYTHON*, LD_PRELOAD or the like. Threads' heaps and stacks would count as address space.
KEPT = ('LD_LIBRARY_PATH', 'LANG', 'TZ')
ONE_THREAD = {'OPENBLAS_NUM_THREADS': '1', 'OMP_NUM_THREADS': '1', 'MALLOC_ARENA_MAX': '1'}


def _places(path):
    """Where packages are looked for: as in this process, but neither in the current folder, nor in or above that of the scan."""
    scan, here = os.path.realpath(path), ''
    with contextlib.suppress(OSError):  # it may have been deleted
        here = os.path.realpath(os.getcwd())
    above = scan if os.path.isdir(scan) else os.path.dirname(scan)

    def trusted(place):
        real = os.path.realpath(place)
        return real != here and os.path.commonpath([real, above]) not in (real, scan)

    return [place for place in sys.path if isinstance(place, str) and os.path.isabs(place) and trusted(place)]


def _environment(folder):
    kept = {name: value for name, value in os.environ.items() if name in KEPT or name.startswith('LC_') or name.endswith('SAN_OPTIONS')}
    return {**kept, **ONE_THREAD, 'TMPDIR': str(folder)}


def _started(task, folder):
    if not os.path.isabs(sys.executable or ''):
        raise OSError(0, 'there is no Python')
    command = [sys.executable, '-I', '-B', '-X', f'utf8={sys.flags.utf8_mode}', '-c', START, json.dumps(task)]
    return subprocess.Popen(command, env=_environment(folder), cwd='/', stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL, start_new_session=True)


def convert(module, path, folder, options, cancelled=None):
    """module.convert() in a child. cancelled: is polled; true ends it with an Error of kind "cancelled"."""
    answer = folder.parent / 'answer.json'
    with reading(path, module.FORMAT):
        size = limits.size_of(path)
        there = os.path.abspath(path)
        task = {'module': module.__name__, 'path': there, 'folder': str(folder), 'answer': str(answer), 'options': dataclasses.asdict(options),
                'bytes': limits.LEAST_BYTES + limits.BYTES_A_BYTE * size, 'seconds': limits.LEAST_S + limits.S_A_MB * (size >> 20),
                'file_bytes': limits.LEAST_UNPACKED + limits.UNPACKED_A_BYTE * size,
                'package': PACKAGE, 'places': _places(path), 'parent': os.getpid()}
    try:
        child = _started(task, folder.parent)
    except OSError as error:
        raise wrong(path, f'no process can be started to read it in ({sys.executable}: {error.strerror}); isolate=False reads it '
                          'here, for files that you trust', 'usage') from None
    # A busy machine gives it a share of its time.
    latest = time.monotonic() + 60 + 10 * task['seconds']
    try:
        while True:
            with contextlib.suppress(subprocess.TimeoutExpired):
                code = child.wait(timeout=POLL_S)
                break
            if cancelled is not None and cancelled():
                raise wrong(path, 'cancelled', 'cancelled') from None
            if time.monotonic() > latest:
                child.kill()
    finally:
        if child.poll() is None:
            child.kill()
            child.wait()
    with reading(path, module.FORMAT):
        said = _answered(answer)
    if said is None:
        why = signal.Signals(-code).name if code < 0 else f'exit code {code}'
        raise wrong(path, f'is no {module.FORMAT}, damaged or too large: the process that reads it ended by {why}, with limits of '
                          f'{task["bytes"] >> 20} MiB of memory and {task["seconds"]} s. isolate=False reads it here, for files that you trust')
    if isinstance(said.get('error'), str) and said.get('kind') in KINDS:
        raise error_of(said['kind'], said['error'].replace(printable(there), printable(str(path))))
    return _checked(said, path, folder, module)


def _answered(answer):
    """What the child wrote, None: nothing."""
    try:
        descriptor = os.open(answer, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except FileNotFoundError:
        return None
    with open(descriptor, 'rb') as file:
        said = json.loads(file.read(LONGEST_ANSWER))
    os.unlink(answer)
    return said if isinstance(said, dict) else {}


def _checked(said, path, folder, module):
    """The place, notes and offset that a child answered, who may have been taken over by what it read: what it made is in its folder, or
    the scan's own, and is files and folders alone."""
    place, notes, offset = said.get('place'), said.get('notes'), said.get('offset')
    sound = isinstance(place, str) and isinstance(notes, list) and all(isinstance(note, str) for note in notes)
    sound = sound and isinstance(offset, list) and len(offset) == 3 and all(isinstance(v, float) and math.isfinite(v) for v in offset)
    if sound:
        own = [os.path.join(path, name) for name in getattr(module, 'FUSED', ())]
        place = pathlib.Path(place)
        sound = place == folder or place.parent == folder or str(place) in map(os.path.abspath, own)
        sound = sound and all(stat.S_IFMT(os.lstat(os.path.join(where, name)).st_mode) in (stat.S_IFREG, stat.S_IFDIR)
                              for where, folders, files in os.walk(folder) for name in folders + files) and place.exists()
    if not sound:
        raise wrong(path, f'is no sound {module.FORMAT}: the process that reads it gave an answer that makes no sense')
    return place, [printable(note, LONGEST_NOTE) for note in notes[:MOST_NOTES]], np.array(offset)


def _take_limits(task):
    with open('/proc/self/statm', encoding='ascii') as file:
        own = int(file.read().split()[0]) * resource.getpagesize()
    for what, limit in ((resource.RLIMIT_CORE, 0), (resource.RLIMIT_AS, own + task['bytes']), (resource.RLIMIT_CPU, task['seconds']),
                        (resource.RLIMIT_FSIZE, task['file_bytes'])):
        least = [value for value in resource.getrlimit(what) if value != resource.RLIM_INFINITY]
        resource.setrlimit(what, (min([limit, *least]), min([limit + (what == resource.RLIMIT_CPU), *least])))


def _readable(path):
    """What may be read: the scan, and what packages are made of."""
    libraries = ['/lib', '/lib64', '/usr/lib', '/usr/lib64', '/usr/local/lib', '/etc/ld.so.cache', '/dev/null', '/dev/urandom', '/usr/share/zoneinfo',
                 '/sys/devices/system/cpu', *os.environ.get('LD_LIBRARY_PATH', '').split(os.pathsep)]
    python = [sysconfig.get_config_var('LIBDIR') or '', *sysconfig.get_paths().values(), sys.prefix, PACKAGE, *sys.path]
    return [path, *(place for place in libraries + python if os.path.isabs(place))]


def answer(task):
    """In the child: converts, and writes what came of it."""
    from . import Options
    path, folder = pathlib.Path(task['path']), pathlib.Path(task['folder'])
    _take_limits(task)
    _topple.confine(_readable(task['path']), [str(folder.parent)], task['parent'])
    try:
        module = importlib.import_module(task['module'])
        with reading(path, module.FORMAT), np.errstate(all='ignore'):
            place, notes, offset = module.convert(path, folder, Options(**task['options']))
        said = {'place': str(place), 'notes': notes[:MOST_NOTES], 'offset': [0.0] * 3 if offset is None else [float(v) for v in offset]}
    except Error as error:
        said = {'error': str(error), 'kind': error.kind}
    unfinished = pathlib.Path(task['answer'] + '.part')
    unfinished.write_text(json.dumps(said), encoding='ascii')
    unfinished.rename(task['answer'])
