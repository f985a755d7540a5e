# SPDX-License-Identifier: MIT
"""A result as columns, as a data frame, and as a table in a notebook."""
import html
import math

import numpy as np

from ._arrays import usage
from ._shown import figure

_OVERTURNING = ('tilt_deg', 'tilt_error_deg', 'push_N', 'push_error_N', 'slide_N', 'shake_g', 'hand_push_N', 'hand_push_error_N',
                'hand_height_m', 'gust_m_s', 'gust_error_m_s')
_FRAGILITY = ('pga_g', 'pga_dispersion', 'firm_pga_g', 'pgv_m_s', 'pgv_dispersion', 'falls_per_year', 'return_years')
_FALL = ('falls', 'hits_J', 'lands_on', 'lands_m', 'leans_on', 'takes_along')
_WHY = ('azimuth_deg', 'W_J', 'S_J', 'way_m', 'drop_m', 'lands_on')
_ADVICE = ('kind', 'move_m', 'risk_J', 'hold_N', 'hold_height_m')
_BY_DISTURBANCE = ('risk_J', 'risk_error_J', 'fall_chance')
_ITEMS = {
    'objects': ('id', 'name', 'grounded', 'mass_kg', 'mass_error_kg', 'mass_model', 'center_of_mass_m', 'center_of_mass_error_m',
                'support_height_m', 'center_height_m', 'size_m',
                'box_middle_m', 'piece_of', 'piece_probability', 'joint_probability', 'footprint_error_m', 'barrier_J', 'barrier_error_J', 'release_J', 'mode', 'direction', 'unsafety',
                'unsafety_category', 'unsafety_certain', 'seen_enough', 'stands_on', 'rests_by', 'rest_probability', 'agreement', 'why', 'advice', 'action'),
    'primitives': ('id', 'object', 'model', 'points', 'solid_voxels', 'volume_m3', 'mass_kg', 'center_of_mass_m', 'name'),
    'contacts': ('a', 'b', 'area_m2', 'normal', 'relation', 'probability'),
    'supports': ('supporter', 'supported', 'area_m2', 'probability'),
}
_LISTS = ('stands_on', 'fall_takes_along')  # of ids
_TEXT = ('advice_kind', 'name', 'mass_model', 'rests_by', 'mode', 'unsafety_category', 'why', 'advice', 'action', 'model', 'relation')
_TYPES = {'id': np.int32, 'object': np.int32, 'a': np.int32, 'b': np.int32, 'supporter': np.int32, 'supported': np.int32,
          'piece_of': np.int32, 'fall_lands_on': np.int32, 'why_lands_on': np.int32, 'points': np.uint64, 'solid_voxels': np.uint64, 'grounded': bool, 'unsafety_certain': bool, 'seen_enough': bool,
          'fall_falls': bool, 'fall_leans_on': np.int32, **{name: object for name in _TEXT + _LISTS}}
_VECTORS = ('center_of_mass_m', 'center_of_mass_error_m', 'size_m', 'box_middle_m', 'direction', 'normal', 'fall_lands_m', 'why_edge_start_m', 'why_edge_end_m',
            'advice_move_m')
_PUSHES = 'pushes'


def _column(name, values):
    if _TYPES.get(name) is object:  # sentences and lists of any length, None where there is none
        column = np.empty(len(values), object)
        for row, value in enumerate(values):
            column[row] = list(value) if name in _LISTS else value
        return column
    column = np.array(values, _TYPES.get(name, np.float64))
    return column.reshape(-1, 3) if name in _VECTORS else column


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


def columns(result, what):
    if what == _PUSHES:
        return {name: _column(name, values) for name, values in _pushes(result).items()}
    if what not in _ITEMS:
        raise usage(f'what: expected {", ".join([*_ITEMS, _PUSHES])}, not {what!r}')
    items = getattr(result, what)
    table = {name: [getattr(item, name) for item in items] for name in _ITEMS[what]}
    if what == 'objects':
        for part, names in (('overturning', _OVERTURNING), ('fragility', _FRAGILITY), ('fall', _FALL), ('why_figures', _WHY),
                            ('advice_figures', _ADVICE)):
            parts, stem = [getattr(o, part) for o in items], part.removesuffix('_figures')
            table.update({f'{stem}_{name}': [getattr(p, name) for p in parts] for name in names})
        ends = [np.asarray(o.why_figures.edge_m) if len(o.why_figures.edge_m) else np.full((2, 3), math.nan) for o in items]
        table['why_edge_start_m'], table['why_edge_end_m'] = [e[0] for e in ends], [e[1] for e in ends]
        table['fall_people_share'] = [math.nan if o.fall.people_share is None else o.fall.people_share for o in items]
        for name in _BY_DISTURBANCE:
            for disturbance in sorted({d for o in items for d in getattr(o, name)}):
                stem, unit = (name[:-2], '_J') if name.endswith('_J') else (name, '')
                table[f'{stem}_{disturbance}{unit}'] = [getattr(o, name).get(disturbance, math.nan) for o in items]
    return {name: _column(name, values) for name, values in table.items()}


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
