# SPDX-License-Identifier: MIT
"""E57 of laser scanners (pye57): all scans of the file in its frame, with colours, and the scanners' places where it tells them."""
import numpy as np

from .cloud import Cloud, kept
from .errors import needs, reading, wrong
from .limits import Budget

FORMAT = 'E57 file'
COLOURS = ('colorRed', 'colorGreen', 'colorBlue')


def recognises(path):
    return path.is_file() and path.suffix.lower() == '.e57'


def _scan(file, index, notes, budget):
    """Points (N, 3), colours (N, 3) or None, and the scanner's place or None, in the file's frame."""
    header = file.get_header(index)
    # Each is read as a double, and put together with the others.
    budget.take(8 * header.point_count * len(header.point_fields), f'scan {index}, of {header.point_count} points,')
    coloured = all(name in header.point_fields for name in COLOURS)
    try:
        data = file.read_scan(index, colors=coloured, ignore_missing_fields=True)
    except Exception:
        if not coloured:
            raise
        data, coloured = file.read_scan(index, ignore_missing_fields=True), False
        notes.append(f'The colours of scan {index} are of more than 8 bits, or damaged, and were left out.')
    points = np.stack([data['cartesianX'], data['cartesianY'], data['cartesianZ']], axis=1)
    colours = np.stack([data[name] for name in COLOURS], axis=1).astype(np.uint8) if coloured else None
    # Spherical readings are of the scanner; Cartesian ones of it where their frame is its own, which a pose tells.
    own = header.has_pose() or 'sphericalRange' in header.point_fields
    return points, colours, np.array(header.translation, float) if own else None


def read(path, options):
    """The Cloud of all scans."""
    pye57 = needs('pye57', 'pye57', path)
    notes, budget = [], Budget(path, options)
    with reading(path, FORMAT):
        file = pye57.E57(str(path))
        try:
            scans = [_scan(file, index, notes, budget) for index in range(file.scan_count)]
        finally:
            file.close()
    scans = [scan for scan in scans if len(scan[0])]
    if not scans:
        raise wrong(path, 'has no scan with points')
    places = [place for _, _, place in scans]
    colours = None
    if any(c is not None for _, c, _ in scans):
        colours = np.concatenate([np.zeros((len(p), 3), np.uint8) if c is None else c for p, c, _ in scans])
    unplaced = sum(place is None for place in places)
    if len(scans) > 1:
        notes.append(f'The file has {len(scans)} scans, which were put together by their poses.')
    if unplaced:
        notes.append(f'The file does not say where the scanner stood{f" of {unplaced} of them" if len(scans) > 1 else ""}.')
    viewpoint = places[0]
    if len(scans) > 1:
        viewpoint = np.concatenate([np.tile(np.full(3, np.nan) if place is None else place, (len(p), 1))
                                    for (p, _, _), place in zip(scans, places)])
    return Cloud(np.concatenate([p for p, _, _ in scans]), colours, None if unplaced == len(scans) else viewpoint,
                 notes=notes).moved_near(options.unit_m)


def convert(path, folder, options):
    return kept(read(path, options), path, folder, options)
