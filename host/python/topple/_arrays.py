# SPDX-License-Identifier: MIT
"""What is given as arrays, as the library takes it: where it lies, if it is that already."""
import sys
import warnings

import numpy as np

from . import _topple
from ._topple import Error


MOST_ROWS = 2 ** 32 - 1


def printable(text, most=8192):
    """As core/printable.h has it: what a file says may steer a terminal."""
    try:
        raw = text.encode('utf-8', 'surrogateescape')
    except UnicodeEncodeError:
        raw = text.encode('utf-8', 'surrogatepass')
    return _topple.printable(raw, most)


def error(kind, message):
    made = Error(printable(message))
    made.kind = kind
    return made


def usage(message):
    return error('usage', message)


def warn(message):
    """A RuntimeWarning that names the line which called the package, however deep in it this is."""
    frame, level = sys._getframe(1), 2
    while frame is not None and frame.f_globals.get('__name__', '').split('.')[0] == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, RuntimeWarning, stacklevel=level)


def is_masked(source):
    """Without importing what NumPy keeps for later: where nobody has, there is no such array."""
    return isinstance(source, getattr(sys.modules.get('numpy.ma'), 'MaskedArray', ()))


def as_array(source, name):
    """A NumPy array of the same memory, of whatever has __dlpack__ too. What is masked is NaN."""
    if is_masked(source):
        return _unmasked(source, name)
    if hasattr(source, '__dlpack__') and not isinstance(source, np.ndarray):
        try:
            return np.from_dlpack(source)
        except (AttributeError, BufferError, RuntimeError, TypeError) as error:
            mend = 'give .detach()' if 'grad' in str(error) else 'copy it to the CPU first, as .cpu() or .get() do'
            raise usage(f'{name}: its memory is not NumPy\'s to read ({error}); {mend}') from error
    try:
        return np.asarray(source)
    except ValueError as error:
        raise usage(f'{name}: no array can be made of it: {error}') from error


def _unmasked(source, name):
    if not np.ma.is_masked(source):
        return source.data
    if source.dtype.kind != 'f':
        raise usage(f'{name}: a masked array of {source.dtype}, which has no value for what is masked; {name}.filled(0) makes it 0')
    return source.filled(np.nan)


def _by_name(source, names, what):
    """The columns of these names of a table, such as a pandas.DataFrame or a dict; None where it is none, or has no names."""
    if isinstance(source, (dict, np.ndarray)):
        there = list(source) if isinstance(source, dict) else []
    else:
        there = [name for name in getattr(source, 'columns', ()) if isinstance(name, str)]
    if not there:
        return None
    missing = [name for name in names if name not in there]
    if missing:
        raise usage(f"{what}: there is no column {missing[0]!r}, but {', '.join(map(repr, there))}"[:300])
    return [source[name] for name in names]


def fields(records, names, what):
    """The columns of these names of an array of records; None where it is none."""
    if not records.dtype.names:
        return None
    missing = [name for name in names if name not in records.dtype.names]
    if missing:
        raise usage(f'{what}: the records have no field {missing[0]}')
    return [records[name] for name in names]


def wrong_array(values, name, shape, variable, columns='', source=None):
    """The Error that says what an array is and what it should be, with the mend; of what it was made of, too."""
    mend = ''
    if hasattr(source, 'to_numpy'):  # of pandas or polars
        variable += '.to_numpy()'
    if values.dtype.kind == 'O' and hasattr(source, 'points'):
        mend = f'; of a point cloud of Open3D give np.asarray({variable}.points)'
    elif values.dtype.kind == 'O' and hasattr(source, 'point'):
        mend = f'; of a point cloud of Open3D give {variable}.point.positions.numpy()'
    elif isinstance(source, (list, tuple)) and values.dtype.kind in 'iub':
        mend = f"; np.array({variable}, 'float32') converts integers, and they must be metres"
    elif values.ndim == 2 and 3 <= values.shape[0] <= 9 and values.shape[1] > values.shape[0]:
        mend = f"; {variable}{'' if values.shape[0] == 3 else '[:3]'}.T has a row for each point"
    elif not columns and values.ndim > 2 and values.shape[-1] == 3:
        mend = f'; {variable}.reshape(-1, 3) has a row for each point'
    elif values.dtype.kind in 'iub':
        mend = f"; {variable}{columns}.astype('float32') converts integers, and they must be metres"
    elif values.dtype.kind == 'O' and values.ndim == 2 and values.shape[1] == 3:
        mend = f"; {variable}.astype('float32') converts them"
    elif not columns and values.ndim == 1 and shape == '(N, 3)' and values.size % 3 == 0 < values.size and values.dtype.kind == 'f':
        mend = f'; {variable}.reshape(-1, 3) has a row for each point'
    elif columns:
        mend = f'; {variable}{columns} takes the first three columns'
    return usage(f'{name}: expected floats of shape {shape}, not {values.dtype} of shape {values.shape}{mend}')


def column(values, name, variable):
    """One coordinate of each point as float32: where it lies, if it is that already."""
    values = as_array(values, name)
    if values.ndim != 1 or values.dtype.kind != 'f':
        raise wrong_array(values, name, '(N,)', variable)
    return _as_float32(values, name)


def _as_float32(values, name):
    """Where it lies, if it is that already, and lies as C++ takes it."""
    if len(values) > MOST_ROWS:  # of one row that stands for all, say, which takes no memory
        raise usage(f'{name}: {len(values)} rows; {MOST_ROWS} are the most')
    return values if values.dtype == np.float32 and values.flags.aligned else values.astype(np.float32)


def columns(source, names, what):
    """The three coordinates of an array, of records with fields of these names, or of three arrays."""
    if isinstance(source, tuple) and len(source) == 3:
        return [column(c, f'{what} {name}', name) for c, name in zip(source, names)]
    by_name, given = _by_name(source, names, what), source
    if by_name is None:
        source = as_array(source, what)
        by_name = fields(source, names, what)
    if by_name is not None:
        return [column(c, f'{what} {name}', f"{what}['{name}']") for c, name in zip(by_name, names)]
    if source.ndim != 2 or source.shape[1] != 3 or source.dtype.kind != 'f':
        raise wrong_array(source, what, '(N, 3)', what,
                          '[:, :3]' if source.ndim == 2 and source.shape[1] > 3 and source.shape[0] != 3 else '', given)
    source = _as_float32(source, what)
    return [source[:, axis] for axis in range(3)]


def has_rows(given):
    """Whether it is something for each point, as columns() takes it, and no single place."""
    if isinstance(given, dict) or hasattr(given, 'columns'):
        return True
    if hasattr(given, '__dlpack__') and not isinstance(given, np.ndarray):
        given = as_array(given, 'it')
    if isinstance(given, (list, tuple)):
        return any(isinstance(part, (list, tuple, np.ndarray)) or hasattr(part, '__dlpack__') for part in given)
    return isinstance(given, np.ndarray) and (given.ndim > 1 or given.dtype.names is not None)


def channels(source):
    """Red, green and blue of an array, of records with fields of these names, or of three arrays; no copies."""
    names = ('red', 'green', 'blue')
    given = source if isinstance(source, tuple) and len(source) == 3 else _by_name(source, names, 'colours')
    if given is None:
        source = as_array(source, 'colours')
        given = fields(source, names, 'colours')
    if given is None:
        if source.ndim != 2 or source.shape[1] != 3:
            raise usage(f'colours: an array of shape {source.shape}; expected (N, 3)')
        given = [source[:, c] for c in range(3)]
    channels = [as_array(c, 'colours') for c in given]
    for channel in channels:
        if channel.dtype != np.uint8:
            raise usage(f'colours: {channel.dtype}; expected uint8, 0 to 255: '
                        'of 0 to 1 give (255 * colours).astype(np.uint8)')
    return channels


def exactly(source, name, shape, dtype):
    """An array without gaps of that type and shape, where None, or a name, stands for any length: a copy only where it is
    none. Floats must be finite, and integers fit."""
    values, wanted = as_array(source, name), np.dtype(dtype)
    expected = f"({', '.join('N' if n is None else str(n) for n in shape)}{',' if len(shape) == 1 else ''})"
    same_kind = values.dtype.kind == 'f' if wanted.kind == 'f' else values.dtype.kind in 'iu' or values.size == 0
    fits = values.ndim == len(shape) and all(n is None or isinstance(n, str) or n == m for n, m in zip(shape, values.shape))
    if not same_kind or not fits:
        mend = f"; {name}.astype('{wanted}') converts them" if fits and values.dtype.kind in 'iuf' else ''
        raise usage(f"{name}: expected {'floats' if wanted.kind == 'f' else 'integers'} of shape {expected}, not "
                    f'{values.dtype} of shape {values.shape}{mend}')
    if wanted.kind == 'f':
        if not np.isfinite(values).all():
            at = np.argwhere(~np.isfinite(values))[0]
            raise usage(f'{name}: {values[tuple(at)]} at {tuple(int(n) for n in at)}; every value must be finite, leave '
                        'out what is not')
    elif values.size and values.dtype != wanted:
        for value in (int(values.min()), int(values.max())):
            if not np.iinfo(wanted).min <= value <= np.iinfo(wanted).max:
                raise usage(f'{name}: {value} is beyond what {wanted} holds')
    return np.require(values, wanted, ['C', 'A'])


def number(value, name):
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise usage(f'{name}: expected a number, not {value!r}') from error
