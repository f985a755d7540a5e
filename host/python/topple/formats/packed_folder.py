# SPDX-License-Identifier: MIT
"""The files of a folder, or of a zip archive, which is not unpacked to disk."""
import json
import os
import re
import zipfile

from .errors import reading, wrong
from .scan_folder import ScanFolder, regular

LARGEST = 1 << 28  # bytes of one file: images of depth and colour have a few million
LISTING = 1 << 24  # bytes of an archive's list of files, which is its end


class PackedFolder:
    """Files by their paths with /, below `root`: exports have one folder around all, or none."""

    def __init__(self, path, marker, budget):
        """marker: part of a path that tells where the root is, as 'keyframes/depth/'."""
        self.path, self.budget = path, budget
        self.archive = None
        if path.is_dir():
            self.folder = ScanFolder(path)
            names = self.folder.names()
        else:
            with reading(path, 'zip archive'):
                self.archive = zipfile.ZipFile(path)
                names = [info.filename for info in self.archive.infolist() if not info.is_dir()]
        # Hidden files, and those of macOS beside each, are no part of an export.
        names = [name for name in names if not any(part.startswith(('.', '__MACOSX')) for part in name.split('/'))]
        roots = sorted({name[:('/' + name).index('/' + marker)] for name in names if '/' + marker in '/' + name})
        self.root = roots[0] if roots else None
        self.names = sorted(name[len(self.root):] for name in names if name.startswith(self.root)) if roots else []
        self.known = frozenset(self.names)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.archive:
            self.archive.close()

    def list(self, folder, ending):
        """The names without folder and ending, in order."""
        return [name[len(folder):-len(ending)] for name in self.names
                if name.startswith(folder) and name.endswith(ending) and '/' not in name[len(folder):]]

    def has(self, name):
        return name in self.known

    def read(self, name):
        if name not in self.known:
            raise wrong(self.path, f'has no {name}')
        with reading(self.path, f'archive with a sound {name}'), self._opened(self.root + name) as file:
            data = file.read(LARGEST + 1)
            if len(data) > LARGEST:
                raise wrong(self.path, f'{name} has more than {LARGEST >> 20} MiB; no image has')
            return data

    def _opened(self, name):
        if not self.archive:
            return self.folder.open(name)
        self.budget.take(self.archive.getinfo(name).file_size, name)  # more of it zipfile does not give
        return self.archive.open(name)

    def json(self, name):
        """A JSON object."""
        with reading(self.path, f'export with a sound {name}'):
            value = json.loads(self.read(name))
        if not isinstance(value, dict):
            raise wrong(self.path, f'{name} holds no JSON object')
        return value


def holds(path, marker, *endings):
    """Whether a folder, or an archive of such an ending, has a file below the marker."""
    if path.is_dir():
        top = marker.split('/')[0]
        inner = [path / marker] + [sub / marker for sub in path.iterdir() if sub.is_dir() and sub.name != top]
        return any(place.exists() for place in inner)
    if not path.is_file() or path.suffix.lower() not in endings or not zipfile.is_zipfile(path):
        return False
    # As bytes: a list of a million names would take a gigabyte here, in the caller's process.
    with regular(path) as file:
        file.seek(max(0, os.fstat(file.fileno()).st_size - LISTING))
        return re.search(rb'(?:/|PK\x01\x02.{42})' + re.escape(marker.encode()), file.read(LISTING), re.DOTALL) is not None
