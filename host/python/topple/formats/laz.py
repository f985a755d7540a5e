# SPDX-License-Identifier: MIT
"""LAZ, compressed LAS (laspy with lazrs): unpacked to LAS, which topple reads with all that it has."""
import os
import struct

from .errors import needs, reading, wrong
from .limits import Budget
from .scan_folder import regular

FORMAT = 'LAZ file'
PORTION = 1_000_000  # points at a time


def recognises(path):
    return path.is_file() and path.suffix.lower() == '.laz'


def _check_header(path):
    """That the records before and after the points fit into the file: laspy goes through as many as are promised, at its end too."""
    with reading(path, FORMAT), regular(path) as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(375)
        if head[:4] != b'LASF':
            raise wrong(path, f'starts with {head[:4]!r}, where a LAZ file starts with "LASF"')
        minor, = struct.unpack_from('<B', head, 25)
        length, _, records = struct.unpack_from('<HII', head, 94)
        later = struct.unpack_from('<QI', head, 235) if minor >= 4 else (0, 0)
        if length + 54 * records > size or (later[1] and later[0] + 60 * later[1] > size):
            raise wrong(path, f'promises {records} records before its points and {later[1]} behind them, more than its {size} bytes '
                              'hold; it is cut short or damaged')


def convert(path, folder, options):
    """Returns the .las and no notes: topple says what there is to say of its coordinates."""
    needs('lazrs', 'laspy[lazrs]', path)
    laspy = needs('laspy', 'laspy[lazrs]', path)
    _check_header(path)
    out = folder / 'points.las'
    with reading(path, FORMAT), laspy.open(path) as packed:
        promised, read = packed.header.point_count, 0
        # Of a cloud-optimised one (COPC) the points lie in another order, which these records tell, and laspy does not write.
        for record in [record for record in packed.header.vlrs if record.user_id == 'copc']:
            packed.header.vlrs.remove(record)
        Budget(path, options).take(promised * packed.header.point_format.size, f'its {promised} points')
        with laspy.open(out, mode='w', header=packed.header) as unpacked:
            for points in packed.chunk_iterator(PORTION):
                unpacked.write_points(points)
                read += len(points)
        if read != promised:
            raise wrong(path, f'promises {promised} points, but has {read}; it is cut short')
    return out, [], None
