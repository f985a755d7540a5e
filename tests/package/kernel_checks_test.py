#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Each kernel says what it computes, and has an oracle, a test and a case of the benchmark, which name it. Those of a
folder are called through host/<folder>, whose headers the tests and cases include, and share an oracle.

  kernel_checks_test.py SOURCE
"""
import pathlib
import re
import sys

PROBES = {'barrier_probe', 'dialect_probe'}  # of the dialect and its backends: nobody waits for them
HEAD = {'what its work-items do (Mapping: ...)': r'\bMapping:', 'whether it is Exact or Bounded': r'\b([Ee]xact|[Bb]ounded)\b'}
PLACES = {'an oracle in tests/oracle': ['tests/oracle/*.h'], 'a test': ['tests/kernels/*.cpp', 'tests/vdb/*.cpp', 'tests/host/*/*.cpp'],
          'a case in perf/cases': ['perf/cases/*.cpp', 'perf/kernels/*.cpp']}


def faults(source):
    texts = {what: ' '.join(file.stem + ' ' + file.read_text(encoding='utf-8') for glob in globs for file in sorted(source.glob(glob)))
             for what, globs in PLACES.items()}
    kernels = sorted(source.glob('kernels/**/*.kernel'))
    if not kernels:
        yield f'{source}/kernels: no kernel'
    for file in kernels:
        name = file.stem
        head = re.match(r'(//[^\n]*\n)*', file.read_text(encoding='utf-8')).group()
        for what, pattern in HEAD.items():
            if not re.search(pattern, head):
                yield f'{file.relative_to(source)}: its head comment does not say {what}'
        if name in PROBES:
            continue
        typed = ''.join(word.capitalize() for word in name.split('_'))
        named = [name, name + '_oracle', 'kernels::' + typed]
        faces = [face for face in sorted(source.glob(f'host/{file.parent.name}/*.cpp')) if f'kernels::{typed}' in face.read_text(encoding='utf-8')]
        named += [f'{file.parent.name}/{face.stem}.h' for face in faces]
        if faces:
            named.append(file.parent.name + '_oracle')
        for what, text in texts.items():
            if not re.search(rf'\b({"|".join(map(re.escape, named))})\b', text):
                yield f'{file.relative_to(source)}: {what} that names it is missing'


if __name__ == '__main__':
    found = list(faults(pathlib.Path(sys.argv[1])))
    print('\n'.join(found))
    sys.exit(bool(found))
