#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the stubs of the package: stubs.py FIELDS TEMPLATE OUT. The program FIELDS (result_fields) tells what a result's items have; the
template has a line `# kinds` where their classes go, and `# fields` in the class Result."""
import json
import subprocess
import sys


def properties(kind):
    lines = []
    for field in kind['fields']:
        shape = f'  # {field["shape"]}' if field['shape'] else ''
        lines += ['    @property', f'    def {field["python"]}(self) -> {field["type"]}: ...{shape}']
    return '\n'.join(lines)


def main():
    program, template, out = sys.argv[1:]
    kinds = json.loads(subprocess.run([program], stdout=subprocess.PIPE, check=True).stdout)
    classes = '\n\n'.join(f'class {kind["kind"]}:\n{properties(kind)}' for kind in kinds[:-1])
    with open(template, encoding='utf-8') as file:
        text = file.read().replace('# kinds', classes).replace('    # fields', properties(kinds[-1]))
    with open(out, 'w', encoding='utf-8') as file:
        file.write(text)


if __name__ == '__main__':
    main()
