# SPDX-License-Identifier: MIT
"""A result as columns, as a data frame, and as a table in a notebook."""
import html
import math

import numpy as np

from . import _topple
from ._arrays import usage
from ._shown import figure

_ITEMS = {'objects': 'Object', 'primitives': 'Primitive', 'contacts': 'Contact', 'supports': 'Support'}
# What an object's parts have that stands beside them, too, and what is no figure of it.
_LEFT_OUT = ('drop_m', 'why_stands_on', 'why_sentence', 'advice_sentence', 'advice_action', 'landscape_now')


def _column(values, of):
    if of in ('object', 'ids'):  # sentences and lists of any length, None where there is none
        column = np.empty(len(values), object)
        for row, value in enumerate(values):
            column[row] = list(value) if of == 'ids' else value
        return column
    if of == 'vector':
        return np.array(values, np.float64).reshape(-1, 3)
    return np.array([math.nan if value is None else value for value in values], of)


def _of_items(kind, items, stem=''):
    """What the items have, and their parts with a name before theirs."""
    columns, later = {}, {}
    for name, of in _topple.COLUMNS[kind].items():
        values = [getattr(item, name) for item in items]
        if of in _topple.COLUMNS:
            later.update(_of_items(of, values, stem + name.removesuffix('_figures') + '_'))
        elif of == 'by_disturbance':
            for disturbance in sorted(set().union(*values)):
                named, unit = (name[:-2], '_J') if name.endswith('_J') else (name, '')
                later[f'{stem}{named}_{disturbance}{unit}'] = _column([value.get(disturbance, math.nan) for value in values], 'float64')
        elif stem + name not in _LEFT_OUT:
            columns[stem + name] = _column(values, of)
    return {**columns, **later}


def _pushes(result):
    """A row for each direction of each object that may be pushed over."""
    rows = [(o, n) for o in result.objects for n in range(len(o.barrier_by_direction.push_N))]
    of = [o.barrier_by_direction for o, _ in rows]
    ways = [n for _, n in rows]
    table = {'object': [o.id for o, _ in rows], 'azimuth_deg': [360 * n / len(b.push_N) for b, n in zip(of, ways)]}
    for name in ('direction', 'push_N', 'push_error_N', 'push_J'):
        table[name] = [getattr(b, name)[n] for b, n in zip(of, ways)]
    for name in ('slide_N', 'hand_height_m'):
        table[name] = [getattr(o.overturning, name) for o, _ in rows]
    return table


def _blows(result):
    """A row for each height of each direction of each object that blows may upset."""
    rows = [(o.id, o.barrier_by_direction, n, at) for o in result.objects for n in range(len(o.barrier_by_direction.blow_Ns))
            for at in range(len(o.barrier_by_direction.height_m))]
    return {'object': [o for o, *_ in rows], 'azimuth_deg': [360 * n / len(b.blow_Ns) for _, b, n, _ in rows],
            'direction': [b.direction[n] for _, b, n, _ in rows], 'height_m': [b.height_m[at] for _, b, _, at in rows],
            **{name: [getattr(b, name)[n, at] for _, b, n, at in rows] for name in ('blow_Ns', 'blow_J')}}


_BY_DIRECTION = {'pushes': _pushes, 'blows': _blows}


def columns(result, what):
    if not isinstance(what, str) or what not in {**_ITEMS, **_BY_DIRECTION}:
        raise usage(f'what: expected {", ".join([*_ITEMS, *_BY_DIRECTION])}, not {what!r}')
    if what in _BY_DIRECTION:
        types = {'object': 'int32', 'direction': 'vector'}
        return {name: _column(values, types.get(name, 'float64')) for name, values in _BY_DIRECTION[what](result).items()}
    items = getattr(result, what)
    table = _of_items(_ITEMS[what], items)
    if what == 'objects':
        ends = [np.asarray(o.why_figures.edge_m) if len(o.why_figures.edge_m) else np.full((2, 3), math.nan) for o in items]
        for n, end in enumerate(('start', 'end')):
            table[f'why_edge_{end}_m'] = _column([e[n] for e in ends], 'vector')
    return table


def dataframe(result, what):
    try:
        import pandas
    except ImportError as error:
        raise ImportError('Result.to_dataframe() takes pandas, which is not installed: pip install pandas; Result.columns() gives '
                          'the same as NumPy arrays') from error
    flat = {}
    for name, column in columns(result, what).items():
        if column.ndim == 1:
            flat[name] = column
            continue
        stem, unit = (name[:-2], '_m') if name.endswith('_m') else (name, '')
        flat.update({f'{stem}_{axis}{unit}': column[:, n] for n, axis in enumerate('xyz')})
    return pandas.DataFrame(flat)


_SHOWN = 12


def _row(o):
    rank = f'{o.unsafety:.1f}' if not math.isnan(o.unsafety) else 'not ranked' if o.seen_enough else 'not seen enough'
    hue = 'transparent' if math.isnan(o.unsafety) else f'hsl({120 - 120 * (o.unsafety - 1) / 9:.0f} 70% 60%)'
    barrier = f'{figure(o.barrier_J, 2)} ± {figure(o.barrier_error_J, 1)}' if o.barrier_J > o.barrier_error_J \
        else f'below {figure(o.barrier_J + o.barrier_error_J, 2)}'
    category = (o.unsafety_category or '') + ('' if o.unsafety_certain or not o.unsafety_category else '?')
    cells = [f'{o.id} {o.name}'.strip(), rank, category, f'{figure(o.mass_kg)} ± {figure(o.mass_error_kg, 1)}', barrier, o.why]
    cells = [f'<td>{html.escape(cell)}</td>' for cell in cells]
    cells[1] = cells[1].replace('<td>', f'<td style="border-left: 0.6em solid {hue}">')
    return f'<tr>{"".join(cells)}</tr>'


def riskiest_first(o):
    category = ('none', 'low', 'medium', 'high').index(o.unsafety_category or 'none')
    return math.isnan(o.unsafety), -category, category > 0 and not o.unsafety_certain, -o.unsafety, o.id


def page(result):
    """The riskiest first: by category, within one what is certain first, and then by risk; last what was not seen enough."""
    loose = sorted((o for o in result.objects if not o.grounded), key=riskiest_first)
    head = ''.join(f'<th>{name}</th>' for name in ('id', 'unsafety, 1 to 10', 'category', 'mass, kg', 'barrier, J', 'why'))
    more = f'<p>{len(loose) - _SHOWN} more objects in <code>Result.objects</code></p>' if len(loose) > _SHOWN else ''
    return (f'<div><p>topple: {html.escape(result.source)}, {len(result.objects)} objects, of which {len(loose)} may move; '
            f'{len(result.point_object)} points, on {html.escape(result.backend)}</p><table><thead><tr>{head}</tr></thead><tbody>'
            f'{"".join(_row(o) for o in loose[:_SHOWN])}</tbody></table>{more}</div>')
