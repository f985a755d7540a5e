# SPDX-License-Identifier: MIT
"""Whether what parse(), export(), stays() and object_at() are given has their types; the library checks their ranges."""
import difflib
import functools
import inspect
import math
import operator

from ._arrays import usage
from ._topple import Device, Options


def _number(value):
    if isinstance(value, (str, bytes)):
        raise TypeError
    return float(value)


def _whole(bits):
    def check(value):
        value = operator.index(value)
        if not 0 <= value < 1 << bits:
            raise ValueError
        return value
    return check


def _vector(value):
    out = [] if isinstance(value, (str, bytes)) else [_number(x) for x in value]
    if len(out) != 3 or not all(map(math.isfinite, out)):
        raise ValueError
    return out


def _flag(value):
    if value not in (True, False):
        raise ValueError
    return bool(value)


def _callable(value):
    if not callable(value):
        raise TypeError
    return value


def _device(value):
    if not isinstance(value, (str, Device)):
        raise TypeError
    return value


def _text(value):
    if not isinstance(value, str):
        raise TypeError
    return value


def _names(value):
    names = [value] if isinstance(value, str) else list(value)
    if not all(isinstance(name, str) for name in names):
        raise TypeError
    return names


_KINDS = {
    'a number': (_number, ('voxel_m', 'unit_m', 'density_kg_m3', 'friction', 'wind_m_s', 'floor_amplification', 'tolerable_J', 'stability_level', 'tile_m',
                          'force_N', 'impulse_Ns', 'slack_m', 'within_m')),
    'a number, or None': (_number, ('contents_kg_m3', 'wind_from_deg', 'pga_m_s2', 'grouping_time_s', 'motion_unit', 'motion_rate')),
    'a whole number from 0': (_whole(64), ('seed', 'max_memory_bytes', 'max_frame_bytes')),
    'a whole number, 1 or more': (_whole(32), ('walks',)),
    'a whole number, 0 for all cores': (_whole(32), ('threads',)),
    'three finite numbers, as [1, 0, 0], or None': (_vector, ('up', 'viewpoint', 'motion_up', 'way')),
    'three finite numbers, as [0.5, 1, 0.2]': (_vector, ('place_m',)),
    '"g", "m/s2", "cm/s2", or None': (_text, ('accelerogram_unit',)),
    'True or False': (_flag, ('isolate', 'space_fields', 'visuals', 'joints', 'forget_gone')),
    'a name, a list of names, or None': (_names, ('disturbances',)),
    'a name, or a list of names': (_names, ('people',)),
    "a Device of topple.open_device(), a backend's name, or None": (_device, ('device',)),
    'a function, or None': (_callable, ('progress', 'cancelled')),
}
_CHECKS = {name: (check, words) for words, (check, names) in _KINDS.items() for name in names}


def named(call):
    """The function, which says of an argument that it has not which one was meant, perhaps."""
    names = list(inspect.signature(call).parameters)

    @functools.wraps(call)
    def checked(*arguments, **options):
        for name in options:
            if name not in names:
                near = [known for known in names if known.startswith(name)] or difflib.get_close_matches(name, names, 1, 0.7)
                raise TypeError(f'{call.__name__}() has no argument {name!r}' + (f'; did you mean {near[0]!r}?' if near else ''))
        return call(*arguments, **options)
    return checked


def option(name, value):
    """The value as the library takes it, or an Error of kind "usage" that names the option."""
    check, words = _CHECKS[name]
    if value is None and words.endswith('None'):
        return None
    try:
        return check(value)
    except (TypeError, ValueError, OverflowError):
        raise usage(f'{name}: expected {words}, not {value!r}'[:300]) from None


def options(disturbances, given):
    """The library's options of a parse: what is given, by name; disturbances None: all."""
    out = Options()
    if disturbances is not None:
        given = {**given, 'disturbances': disturbances}
    for name, value in given.items():
        setattr(out, name, option(name, value))
    return out
