# SPDX-License-Identifier: MIT
"""Images in scans, by pillow: PNG and JPEG alone, as others of its formats start programs, or are seldom looked at."""
import io

import numpy as np

from .errors import needs, reading, wrong


def _opened(data, path, what, budget):
    image = needs('PIL.Image', 'pillow', path)
    found = image.open(io.BytesIO(data), formats=('PNG', 'JPEG'))
    width, height = found.size
    budget.take(width * height * 4, f'{what}, of {width} x {height} pixels,')
    return found


def grey(data, path, what, budget):
    """(height, width) integers of an image's bytes. what: the image is, for messages."""
    with reading(path, f'scan with a sound {what}'):
        values = np.array(_opened(data, path, what, budget))
        if values.ndim != 2 or values.dtype.kind not in 'ui':
            raise wrong(path, f'{what} is no grey image')
        return values.astype(np.int64)


def coloured(data, path, what, budget):
    """(height, width, 3) uint8."""
    with reading(path, f'scan with a sound {what}'):
        return np.array(_opened(data, path, what, budget).convert('RGB'))
