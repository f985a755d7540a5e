# SPDX-License-Identifier: MIT
"""The program `topple`, and what is run by it."""
import os
import subprocess

from ._arrays import error as _error


def program():
    """Where the program lies: in the package's folder, as in a wheel; else where it was built or installed with it."""
    folder = os.path.dirname(os.path.abspath(__file__))
    # PREFIX/lib/python3.x/site-packages/topple, and BUILD/python/topple
    for path in ('topple', '../../../../bin/topple', '../../topple'):
        path = os.path.normpath(os.path.join(folder, path))
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    raise _error('input', f'there is no program topple in {folder}, nor beside the package; build it (./dev build), or '
                          'install a wheel, which has it')


def generate(folder, *, seed=1, kind=None, frames=60, single=False):
    """Makes a scan of a furnished room, to try things on: depth frames with their poses, the fused cloud, and the truth
    (truth.json). Returns the folder, a path that parse() takes.

    kind: None for a plain room, or a family of rooms, "kitchen" or "office", say. frames: of the walk through the room.
    single: one frame only, without its pose; not of a kind. `topple generate --help` has more. An earlier such scan in the
    folder is written over. Raises Error where the folder holds other things or can't be written, or an option is wrong."""
    folder = os.fspath(folder)
    held = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    if held and 'truth.json' not in held:
        some = ', '.join(held[:3]) + (', ...' if len(held) > 3 else '')
        raise _error('input', f'{folder}: holds other things than a made scan ({some}); choose a folder that is empty or does not exist')
    command = [program(), 'generate', folder, '--seed', str(seed), '--frames', str(frames)]
    command += ['--kind', kind] if kind is not None else []
    command += ['--single'] if single else []
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors='backslashreplace')
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f'{command[0]} ended with {done.returncode}']
        raise _error('usage' if done.returncode == 2 else 'input', said[0].removeprefix('topple: ').removesuffix(' (see topple --help)'))
    return folder
