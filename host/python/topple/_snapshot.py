# SPDX-License-Identifier: MIT
"""What pickles of a Result hold: every attribute by its name, so that they outlive versions that add some."""
from types import SimpleNamespace

from . import _topple


class Item(SimpleNamespace):
    """An object, contact or other part of a result, with the attributes that it had."""

    def __repr__(self):
        return '<topple item {}>'.format(getattr(self, 'id', ', '.join(vars(self))))


_BOUND = tuple(kind for kind in vars(_topple).values() if isinstance(kind, type) and kind is not _topple.Error)


ITEMS = tuple(kind for kind in _BOUND if kind.__name__ not in ('Device', 'Options', 'Parsed'))


def reduced(item):
    """How pickle and copy take one item of a result."""
    return frozen(item).__reduce__()


def frozen(value):
    if isinstance(value, _BOUND):
        return Item(**{name: frozen(getattr(value, name)) for name in dir(value) if not name.startswith('_')})
    if isinstance(value, list):
        return [frozen(item) for item in value]
    if isinstance(value, dict):
        return {name: frozen(item) for name, item in value.items()}
    return value
