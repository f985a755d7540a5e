#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a C++ file with the fitted models as constants; a model that is damaged ends the build with what is wrong.

usage: embed_models.py OUT.cpp NAME=FILE ...
"""
import json
import math
import struct
import sys

ARRAYS = ('feature', 'threshold', 'missing_left', 'left', 'right')
SCALING = ('low', 'high', 'mean', 'deviation')
OUTPUTS = ('joint_out', 'shell_out')


class Damaged(Exception):
    pass


def check(model):
    """Raises Damaged where a model (schema topple.trees/1) is not one whose every way down ends in a leaf."""
    for key in ('features', 'trees', 'baseline', 'scale', 'offset'):
        if key not in model:
            raise Damaged(f'no {key}')
    if not all(isinstance(name, str) for name in model['features']):
        raise Damaged('features: expected names')
    for key in ('baseline', 'scale', 'offset'):
        if not isinstance(model[key], (int, float)) or not math.isfinite(model[key]):
            raise Damaged(f'{key}: expected a number')
    for number, tree in enumerate(model['trees']):
        count = len(tree.get('feature', ()))
        if count == 0 or any(len(tree.get(key, ())) != count for key in ARRAYS):
            raise Damaged(f'tree {number} is damaged: its arrays ' + ', '.join(ARRAYS) + ' must be of one length, not 0')
        for n in range(count):
            feature, left, right = tree['feature'][n], tree['left'][n], tree['right'][n]
            # Children come after their parents, so that every way down ends.
            if feature >= len(model['features']) or (feature >= 0 and not (n < left < count and n < right < count)):
                raise Damaged(f'tree {number} is damaged at node {n}')


def check_context(model):
    """Raises Damaged where a network (schema topple.context/1) lacks or has more than its layers take."""
    width, rounds = model.get('width'), model.get('rounds')
    if not isinstance(width, int) or not isinstance(rounds, int) or not 0 < width <= 1024 or width % 32 or not 0 < rounds <= 16:
        raise Damaged('width: expected a multiple of 32; rounds: 1 to 16')
    inputs = []
    for kind in ('nodes', 'joints'):
        part = model[kind]
        count = len(part['names'])
        if any(len(part[key]) != count for key in SCALING) or not all(0 <= m < count for m in part['missing']):
            raise Damaged(f'{kind}: ' + ', '.join(SCALING) + ' must be as many as its names')
        if not all(deviation > 0 for deviation in part['deviation']):
            raise Damaged(f'{kind}: a deviation is not above 0')
        inputs.append(count + len(part['missing']))
    lines = sum(1 + n + 1 + width for n in inputs) + rounds * sum(1 + n * width + 1 + width for n in (2, 2, 3, 3))
    if len(model['weights']) != lines * width:
        raise Damaged(f'weights: {lines * width} expected, not {len(model["weights"])}')
    if any(len(model[key]) != 2 + width for key in OUTPUTS):
        raise Damaged(', '.join(OUTPUTS) + f': {2 + width} numbers expected')
    numbers = [*model['weights'], *(v for key in OUTPUTS for v in model[key]),
               *(v for kind in ('nodes', 'joints') for key in SCALING for v in model[kind][key])]
    if not all(isinstance(v, (int, float)) and math.isfinite(v) for v in numbers):
        raise Damaged('a weight is no number')


def single(value):
    """The nearest number in single precision, as C++ reads it back."""
    text = f'{struct.unpack("f", struct.pack("f", value))[0]:.9g}'
    return text + ('f' if '.' in text or 'e' in text else '.0f')


def code_of(name, model):
    nodes, roots = [], []
    for tree in model['trees']:
        first = len(nodes)
        roots.append(first)
        for feature, threshold, missing_left, left, right in zip(*(tree[key] for key in ARRAYS)):
            leaf = feature < 0
            nodes.append(f'    {{{-1 if leaf else feature}, {single(threshold)}, {"true" if missing_left else "false"}, '
                         f'{0 if leaf else first + left}, {0 if leaf else first + right}}},')
    features = [f'    {json.dumps(feature)},' for feature in model['features']]
    numbers = ', '.join(repr(float(model[key])) for key in ('baseline', 'scale', 'offset'))
    return [f'constexpr std::string_view {name}_features[] = {{', *features, '};',
            f'constexpr TreeNode {name}_nodes[] = {{', *nodes, '};',
            f'constexpr std::uint32_t {name}_roots[] = {{', '    ' + ', '.join(map(str, roots)) + ',', '};',
            f'constinit const TreeTable {name}_table{{{name}_features, {name}_nodes, {name}_roots, {numbers}}};', '']


def code_of_context(name, model):
    def array(kind, of, values):
        return [f'constexpr {kind} {name}_{of}[] = {{', *(f'    {value},' for value in values), '};']

    code, scalings = [], []
    for kind in ('nodes', 'joints'):
        part = model[kind]
        code += array('std::string_view', f'{kind}_names', map(json.dumps, part['names']))
        for key in SCALING:
            code += array('float', f'{kind}_{key}', map(single, part[key]))
        missing = f'{name}_{kind}_missing' if part['missing'] else ''  # an array of nothing is none
        code += array('std::uint32_t', f'{kind}_missing', part['missing']) if missing else []
        scalings.append('{' + ', '.join(f'{name}_{kind}_{key}' for key in ('names', *SCALING)) + f', {missing or "{}"}}}')
    for key in ('weights', *OUTPUTS):
        code += array('float', key, map(single, model[key]))
    return [*code, f'constinit const ContextTable {name}_table{{{scalings[0]}, {scalings[1]}, {model["width"]}, {model["rounds"]},',
            f'    {name}_weights, {name}_joint_out, {name}_shell_out}};', '']


# By schema: the check of a model, and its code.
SCHEMAS = {'topple.trees/1': (check, code_of), 'topple.context/1': (check_context, code_of_context)}


def main():
    code = ['// Generated by host/fitted/embed_models.py.', '#include "fitted/model_tables.h"',
            '#include "fitted/network.h"', '', 'namespace topple::fitted {', '']
    for part in sys.argv[2:]:
        name, path = part.split('=', 1)
        with open(path, encoding='ascii') as file:
            try:
                model = json.load(file)
                schema = model.get('schema') if isinstance(model, dict) else None
                if schema not in SCHEMAS:
                    raise Damaged('expected schema ' + ' or '.join(SCHEMAS))
                check_model, code_of_model = SCHEMAS[schema]
                check_model(model)
            except (ValueError, TypeError, KeyError, Damaged) as problem:
                sys.exit(f'{path}: {problem}')
        code += code_of_model(name, model)
    code += ['}  // namespace topple::fitted', '']
    with open(sys.argv[1], 'w', encoding='ascii') as file:
        file.write('\n'.join(code))


if __name__ == '__main__':
    main()
