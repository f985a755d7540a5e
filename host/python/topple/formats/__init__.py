# SPDX-License-Identifier: MIT
"""Scans in other programs' formats, for topple.parse and as `python3 -m topple.formats convert IN OUT`.

Each format is a module: recognises(path) tells by name and place whether a path is of it, and convert(path, folder, options)
writes what topple reads itself into a folder, a cloud's file or a sequence of depth frames, and returns where that is, notes, and
what to add to its coordinates to have the scan's own (None: nothing). Packages that a format takes are imported when it is met."""
import contextlib
import dataclasses
import os
import pathlib
import shutil
import tempfile
import time
import weakref
from typing import List, Optional

import numpy as np

from . import apart, colmap, e57, laz, polycam, record3d, ros_bag
from .._arrays import printable
from .errors import Error, reading, wrong

FORMATS = (laz, e57, ros_bag, colmap, polycam, record3d)
NOTES = 'topple-notes.txt'  # as host/points/formats/scan_notes.h has it


@dataclasses.dataclass(frozen=True)
class Options:
    unit_m: float = 1.0  # metres of a unit of the scan's coordinates, where its format leaves that open
    topic: Optional[str] = None  # of a ROS bag, rather than the one of most messages
    ending: str = '.pcd'  # of a cloud's file: .ply, or .pcd, which keeps the sensor's place
    isolate: bool = True  # in a process of its own, with limits of memory and time


@dataclasses.dataclass
class Converted:
    """A scan as topple reads it: a file or a folder, which is there within opened(), or as long as what needs it."""
    path: pathlib.Path
    notes: List[str]
    offset: np.ndarray  # (3,), in the scan's unit: its own coordinates are the converted ones plus this
    format: str  # what the scan was, for messages
    needed_by: object = None  # a Result of a cloud in blocks, which reads its points again when it is written

    @property
    def is_sequence(self):
        """Whether it is frames, whose unit is the metre already."""
        return self.path.is_dir()


def format_of(path):
    """The module of a path's format; None where topple reads it itself, or nobody does. Raises topple.Error for an archive that is none
    of the known exports."""
    path = pathlib.Path(path)
    try:
        if not path.exists():
            return None
        if not (path.is_file() or path.is_dir()):
            raise wrong(path, 'is no regular file')
        if (path / 'intrinsics.json').exists():  # topple's own folder of frames
            return None
        found = next((module for module in FORMATS if module.recognises(path)), None)
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        raise wrong(path, getattr(error, 'strerror', None) or str(error)) from None
    if found is None and path.suffix.lower() == '.zip' and path.is_file():
        raise wrong(path, "is no raw data of Polycam (keyframes/depth/) and no EXR export of Record3D (metadata.json, depth/, rgb/); "
                          'unpack it, and give the scan that is in it')
    return found


@contextlib.contextmanager
def opened(path, options=Options(), cancelled=None):
    """The scan at a path, converted in a temporary folder, or None where topple reads it itself. Errors from within the block that
    name the temporary file name the scan instead. cancelled: is polled while it is converted; true ends that."""
    path = pathlib.Path(path)
    module = format_of(path)
    if module is None:
        yield None
        return
    made, converted = tempfile.mkdtemp(prefix='topple-'), None
    place = folder = pathlib.Path(made) / 'scan'
    try:
        folder.mkdir()
        if options.isolate:
            place, notes, offset = apart.convert(module, path, folder, options, cancelled)
        else:
            with reading(path, module.FORMAT), np.errstate(all='ignore'):  # of damaged numbers; a library says nothing
                place, notes, offset = module.convert(path, folder, options)
            notes = [printable(note) for note in notes]
        if place.is_dir() and options.unit_m != 1 and module is not colmap:
            raise wrong(path, f'unit_m is for clouds and COLMAP; the depth of a {module.FORMAT} is in metres', 'usage')
        converted = Converted(place, notes, np.zeros(3) if offset is None else offset, module.FORMAT)
        yield converted
    except Error as error:
        if made not in str(error):
            raise
        said = str(error).replace(str(place), str(path)).replace(made, str(path))
        raise wrong(path, said.removeprefix(f'{path}: '), error.kind) from None
    finally:
        if converted is None or converted.needed_by is None:
            shutil.rmtree(made, ignore_errors=True)
        else:
            weakref.finalize(converted.needed_by, shutil.rmtree, made, ignore_errors=True)


def convert(path, out, options=Options()):
    """Writes the scan at a path as topple reads it: to a file of a cloud (.ply, .pcd, which keeps the sensor's place, or .las of a
    .laz), or a folder of depth frames, whichever the format has. Its notes go into topple-notes.txt within the folder, or into
    OUT.topple-notes.txt beside the file, where each parse of the scan takes them from. Returns the Converted. Raises topple.Error; out
    must not be there yet, and appears whole or not at all."""
    path, out = pathlib.Path(path), pathlib.Path(out)
    _check_new(out)
    if out.suffix in ('.ply', '.pcd'):
        options = dataclasses.replace(options, ending=out.suffix)
    with opened(path, options) as converted:
        if converted is None:
            raise wrong(path, 'needs no conversion: topple reads it itself, or not at all' if path.exists() else 'is not there')
        _check_ending(out, converted)
        with reading(out, 'place to write to'):
            beside = tempfile.mkdtemp(prefix='.topple-', dir=out.absolute().parent)
            try:
                kept = pathlib.Path(beside) / 'scan'
                (shutil.copytree if converted.is_sequence else shutil.copyfile)(converted.path, kept)
                _keep_notes(kept, out, converted)
                kept.rename(out)
            finally:
                shutil.rmtree(beside)
        return dataclasses.replace(converted, path=out)


def play(path, out, rate=1.0, topic=None):
    """Plays the depth frames of a bag of ROS at their pace, `rate` times as fast, into a folder that `topple live` may follow meanwhile,
    and must not be there yet; or, where `out` is a file opened to write bytes, as the messages that `topple live -` takes: these may be
    of a bag's clouds, too. Reads in this process, without limits of memory and time. Returns the notes. Raises topple.Error."""
    path = pathlib.Path(path)
    if not hasattr(out, 'write'):
        out = pathlib.Path(out)
        _check_new(out)
    if not (isinstance(rate, (int, float)) and 0 < rate < float('inf')):
        raise wrong(path, f'rate {rate}: expected a number above 0', 'usage')
    if format_of(path) is not ros_bag:
        raise wrong(path, 'is no bag of ROS (.bag, .mcap, .db3 or a folder of one)' if path.exists() else 'is not there')
    begun = []

    def wait(recorded_ns):
        if not begun:
            begun.extend((recorded_ns, time.monotonic()))
        due = begun[1] + (recorded_ns - begun[0]) / 1e9 / rate
        time.sleep(max(0.0, due - time.monotonic()))

    with reading(path, ros_bag.FORMAT), np.errstate(all='ignore'):
        return [printable(note) for note in ros_bag.play(path, out, Options(topic=topic, isolate=False), wait)]


def _check_new(out):
    """That something may be made there."""
    if os.path.lexists(out):
        raise wrong(out, 'is there already; name another, or delete it', 'usage')
    if not out.absolute().parent.is_dir():
        raise wrong(out, 'its folder is not there', 'usage')


def _keep_notes(kept, out, converted):
    """The notes, a line each, where topple looks for them: before the scan is there, so that no parse of it misses them."""
    text = ''.join(' '.join(note.split()) + '\n' for note in converted.notes)
    place = kept / NOTES if converted.is_sequence else out.with_name(f'{out.name}.{NOTES}')
    if text:
        made = kept.with_name(NOTES)
        made.write_text(text, encoding='utf-8')
        made.replace(place)  # whatever is there, a link to another file, say
    else:
        place.unlink(missing_ok=True)  # of another scan that had this name


def _check_ending(out, converted):
    """That a cloud is not named like a folder, or like another kind of file."""
    if converted.is_sequence:
        if out.suffix in ('.ply', '.pcd', '.las'):
            raise wrong(out, f'the {converted.format} is of depth frames, which go into a folder: leave out the ending', 'usage')
    elif out.suffix != converted.path.suffix:
        endings = '.las' if converted.path.suffix == '.las' else '.ply or .pcd'
        raise wrong(out, f'the {converted.format} is a cloud: name a file that ends in {endings}', 'usage')
