# SPDX-License-Identifier: MIT
"""What repr() says of the items of a result, of those that come back from pickles, too."""
import math

import numpy as np

from . import _topple


def figure(value, digits=3):
    """A number as people write it: so many digits, or all before the point, and no power of ten."""
    if 10**digits <= abs(value) < math.inf:
        return f'{value:.0f}'
    return np.format_float_positional(value, precision=digits, unique=False, fractional=False, trim='-')


def _named(item):
    return f'{item.id}{", " + item.name if item.name else ""}'


def with_names(items, objects):
    """The items, which know what the objects that they are about are called, for their repr()."""
    names = {o.id: o.name for o in objects if o.name}
    for item in items if names else ():
        item._names = names
    return items


def _object(item, id):
    name = getattr(item, '_names', {}).get(id)
    return f'{id} ({name})' if name else f'{id}'


def _corrected(item):
    names = [name for name in map(getattr(item, '_names', {}).get, item.objects) if name]
    return f' of {", ".join(names)}' if names else ''


def _rank(unsafety):
    return 'not ranked' if math.isnan(unsafety) else f'unsafety {unsafety:.1f}'


def _directions(item):
    if len(item.push_J) == 0:
        return 'nothing known'
    lowest = f', a push from {figure(min(item.push_N), 2)} N' if len(item.push_N) else ''
    return f'{len(item.push_J)} directions{lowest}'


def _landing(item):
    if not item.falls:
        return 'nothing upsets it'
    onto = '' if item.lands_on < 0 else f' onto object {item.lands_on}'
    against = '' if item.leans_on < 0 else f' against object {item.leans_on}'
    return f'falls {figure(item.drop_m, 2)} m{onto}{against}'


_TEXTS = {
    'Object': lambda o: f' {_named(o)}, {_rank(o.unsafety)}',
    'Primitive': lambda p: f' {_named(p)}: {p.model}, of object {p.object}, {figure(p.mass_kg)} kg',
    'Contact': lambda c: f': primitives {c.a} and {c.b}, {c.relation}, joint {c.probability:.2f} probable, {figure(c.area_m2, 2)} m2',
    'Support': lambda s: f': object {_object(s, s.supporter)} carries {_object(s, s.supported)}, {figure(s.area_m2, 2)} m2, {s.probability:.2f} probable',
    'AppliedCorrection': lambda c: f' {c.do}{_corrected(c)}: {c.outcome}',
    'Overturning': lambda o: ': does not tip' if math.isnan(o.tilt_deg) else f': tips at {figure(o.tilt_deg)} deg, or {figure(o.hand_push_N)} N at a hand\'s height',
    'Fragility': lambda f: f': half of earthquakes of {figure(f.pga_g, 2)} g upset it' if math.isfinite(f.pga_g) else ': no median',
    'Hold': lambda h: f': {h.by} {h.act} it, {"and it falls" if h.fall_chance > 0 else "it stays"}',
    'Alternative': lambda a: f': {"two things" if a.whole < 0 else f"one thing with object {a.whole}"}, {a.probability:.2f} probable, {figure(a.barrier_J)} J',
    'PossibleThing': lambda t: f': {t.probability:.2f} probable, {figure(t.mass_kg)} kg, {figure(t.barrier_J)} J',
    'DirectedBarrier': lambda b: f': {_directions(b)}',
    'Landscape': lambda item: f': {len(item.energy_J)} poses, in {item.now}',
    'Fall': lambda f: f': {_landing(f)}',
    'Why': lambda w: f': {w.sentence}' if w.sentence else ': nothing to tell',
    'Advice': lambda a: f' {a.kind}: {a.sentence}' if a.kind else ': nothing is needed',
}


def text(kind, item):
    """Raises AttributeError for an item that lacks what its kind has."""
    try:
        return f'<topple.{kind}{_TEXTS[kind](item)}>'
    except KeyError:
        raise AttributeError(kind) from None


def items():
    """Lets the library's classes say so, too."""
    for kind in _TEXTS:
        getattr(_topple, kind).__repr__ = lambda item, kind=kind: text(kind, item)
