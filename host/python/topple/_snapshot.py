# SPDX-License-Identifier: MIT
"""What pickles of a Result hold: every attribute by its name, so that they outlive versions that add some."""
from types import SimpleNamespace

from . import _shown, _topple


class Item(SimpleNamespace):
    """An object, contact or other part of a result, with the attributes that it had."""

    def __repr__(self):
        try:
            return _shown.text(self._kind, self)
        except AttributeError:  # of an earlier version
            return '<topple item {}>'.format(getattr(self, 'id', ', '.join(vars(self))))


_BOUND = tuple(kind for kind in vars(_topple).values() if isinstance(kind, type) and kind is not _topple.Error)


ITEMS = tuple(kind for kind in _BOUND if kind.__name__ not in ('Device', 'Labeller', 'Options', 'Parsed'))


def reduced(item):
    """How pickle and copy take one item of a result."""
    return frozen(item).__reduce__()


def frozen(value):
    if isinstance(value, _BOUND):
        return Item(_kind=type(value).__name__, **{name: frozen(getattr(value, name)) for name in dir(value) if not name.startswith('_')})
    if isinstance(value, list):
        return [frozen(item) for item in value]
    if isinstance(value, dict):
        return {name: frozen(item) for name, item in value.items()}
    return value
