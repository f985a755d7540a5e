# SPDX-License-Identifier: MIT
"""Conversion in a process of its own: packages of others read files of others, and may crash, hang or take all memory."""
import dataclasses
import importlib
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys

import numpy as np

from .._arrays import error as error_of
from .errors import Error, reading, wrong

# Address space and processor time by the size of what is read: several times what sound files take.
LEAST_BYTES, BYTES_A_BYTE = 4 << 30, 40
LEAST_S, S_A_MB = 60, 2
POLL_S = 0.05


def _size(path):
    files = path.rglob('*') if path.is_dir() else [path]
    return sum(file.stat().st_size for file in files if file.is_file())


def convert(module, path, folder, options, cancelled=None):
    """module.convert() in a child. cancelled: is polled; true ends it with an Error of kind "cancelled"."""
    answer = folder.parent / 'answer.json'
    with reading(path, module.FORMAT):
        size = _size(path)
    limits = LEAST_BYTES + BYTES_A_BYTE * size, LEAST_S + S_A_MB * (size >> 20)
    task = {'module': module.__name__, 'path': os.path.abspath(path), 'folder': str(folder), 'answer': str(answer),
            'options': dataclasses.asdict(options), 'limits': limits}
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(os.path.abspath(place) for place in sys.path)}
    try:
        child = subprocess.Popen([sys.executable, '-m', 'topple.formats.apart', json.dumps(task)], env=environment,
                                 stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    except OSError as error:
        raise wrong(path, f'no process can be started to read it in ({sys.executable}: {error.strerror}); isolate=False reads it '
                          'here, for files that you trust', 'usage') from None
    try:
        while True:
            try:
                code = child.wait(timeout=POLL_S)
                break
            except subprocess.TimeoutExpired:
                if cancelled is not None and cancelled():
                    raise wrong(path, 'cancelled', 'cancelled') from None
    finally:
        if child.poll() is None:
            child.kill()
            child.wait()
    if not answer.exists():
        why = signal.Signals(-code).name if code < 0 else f'exit code {code}'
        raise wrong(path, f'is no {module.FORMAT}, damaged or too large: the process that reads it ended by {why}, with limits of '
                          f'{limits[0] >> 20} MiB of address space and {limits[1]} s. isolate=False reads it here, for files that you trust')
    said = json.loads(answer.read_text())
    answer.unlink()
    if 'error' in said:
        raise error_of(said['kind'], said['error'].replace(task['path'], str(path)))
    return pathlib.Path(said['place']), said['notes'], np.array(said['offset'])


def main():
    from . import Options
    task = json.loads(sys.argv[1])
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for what, limit in zip((resource.RLIMIT_AS, resource.RLIMIT_CPU), task['limits']):
        least = [value for value in resource.getrlimit(what) if value != resource.RLIM_INFINITY]
        resource.setrlimit(what, (min([limit, *least]), min([limit + 1, *least])))
    try:
        module = importlib.import_module(task['module'])
        place, notes, offset = module.convert(pathlib.Path(task['path']), pathlib.Path(task['folder']), Options(**task['options']))
        said = {'place': str(place), 'notes': notes, 'offset': [0.0] * 3 if offset is None else [float(v) for v in offset]}
    except Error as error:
        said = {'error': str(error), 'kind': error.kind}
    answer = pathlib.Path(task['answer'])
    unfinished = answer.with_suffix('.part')
    unfinished.write_text(json.dumps(said))
    unfinished.rename(answer)


if __name__ == '__main__':
    main()
