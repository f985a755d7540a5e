# SPDX-License-Identifier: MIT
"""What reading a scan may take, by the bytes of its files: sound ones stay far below."""
import os
import stat

from .errors import wrong

# Address space beside what Python itself takes, and processor time.
LEAST_BYTES, BYTES_A_BYTE = 1 << 30, 40
LEAST_S, S_A_MB = 20, 2
# Of what is packed, in all that is unpacked of it: images of plain walls have a fortieth of their pixels.
LEAST_UNPACKED, UNPACKED_A_BYTE = 64 << 20, 100


def size_of(path):
    """Bytes of a file, or of all regular files in a folder: those that are written, which a file with holes has less of."""
    if not path.is_dir():
        return _written(path.stat())
    found = (os.lstat(os.path.join(place, name)) for place, _, names in os.walk(path) for name in names)
    return sum(_written(status) for status in found if stat.S_ISREG(status.st_mode))


def _written(status):
    return min(status.st_size, 512 * status.st_blocks + 4096)


class Budget:
    """Counts what is unpacked of a scan."""

    def __init__(self, path, options):
        self.path = path
        self.whole = LEAST_UNPACKED + UNPACKED_A_BYTE * size_of(path) if options.isolate else float('inf')
        self.left = self.whole

    def take(self, count, what):
        """Before so many bytes are made of `what`, in words."""
        self.left -= count
        if self.left < 0:
            raise wrong(self.path, f'{what} would make more than {self.whole >> 20} MiB of it, which no sound scan of its size holds; '
                                   'isolate=False reads it, if you trust it')
