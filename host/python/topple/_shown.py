# SPDX-License-Identifier: MIT
"""What repr() says of the items of a result, of those that come back from pickles, too."""
import math

from . import _topple


def _named(item):
    return f'{item.id}{", " + item.name if item.name else ""}'


def _rank(unsafety):
    return 'not ranked' if math.isnan(unsafety) else f'unsafety {unsafety:.1f}'


def _directions(item):
    if len(item.push_J) == 0:
        return 'nothing known'
    lowest = f', a push from {min(item.push_N):.2g} N' if len(item.push_N) else ''
    return f'{len(item.push_J)} directions{lowest}'


def _landing(item):
    if not item.falls:
        return 'nothing upsets it'
    onto = '' if item.lands_on < 0 else f' onto object {item.lands_on}'
    against = '' if item.leans_on < 0 else f' against object {item.leans_on}'
    return f'falls {item.drop_m:.2g} m{onto}{against}'


_TEXTS = {
    'Object': lambda o: f' {_named(o)}, {_rank(o.unsafety)}',
    'Primitive': lambda p: f' {_named(p)}: {p.model}, of object {p.object}, {p.mass_kg:.3g} kg',
    'Contact': lambda c: f': primitives {c.a} and {c.b}, {c.relation}, joint {c.probability:.2f} probable, {c.area_m2:.2g} m2',
    'Support': lambda s: f': object {s.supporter} carries {s.supported}, {s.area_m2:.2g} m2, {s.probability:.2f} probable',
    'AppliedCorrection': lambda c: f' {c.do}: {c.outcome}',
    'Overturning': lambda o: ': does not tip' if math.isnan(o.tilt_deg) else f': tips at {o.tilt_deg:.3g} deg, or {o.hand_push_N:.3g} N at a hand\'s height',
    'Fragility': lambda f: f': half of earthquakes of {f.pga_g:.2g} g upset it' if math.isfinite(f.pga_g) else ': no median',
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
