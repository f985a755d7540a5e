# SPDX-License-Identifier: MIT
"""LAZ, compressed LAS (laspy with lazrs): unpacked to LAS, which topple reads with all that it has."""
from .errors import needs, reading, wrong

FORMAT = 'LAZ file'
PORTION = 1_000_000  # points at a time


def recognises(path):
    return path.is_file() and path.suffix.lower() == '.laz'


def convert(path, folder, options):
    """Returns the .las and no notes: topple says what there is to say of its coordinates."""
    needs('lazrs', 'laspy[lazrs]', path)
    laspy = needs('laspy', 'laspy[lazrs]', path)
    with open(path, 'rb') as file:
        start = file.read(4)
    if start != b'LASF':
        raise wrong(path, f'starts with {start!r}, where a LAZ file starts with "LASF"')
    out = folder / 'points.las'
    with reading(path, FORMAT), laspy.open(path) as packed:
        promised, read = packed.header.point_count, 0
        with laspy.open(out, mode='w', header=packed.header) as unpacked:
            for points in packed.chunk_iterator(PORTION):
                unpacked.write_points(points)
                read += len(points)
        if read != promised:
            raise wrong(path, f'promises {promised} points, but has {read}; it is cut short')
    return out, [], None
