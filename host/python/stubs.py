#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the stubs of the package: stubs.py FIELDS TEMPLATE OUT MODULE.... The program FIELDS (result_fields) tells what a result's items
have; the template has a line `# kinds` where their classes go, `# fields` in the class Result, and `# tuples` for the named tuples of the
modules."""
import ast
import json
import subprocess
import sys


def properties(kind):
    lines = []
    for field in kind['fields']:
        shape = f'  # {field["shape"]}' if field['shape'] else ''
        lines += ['    @property', f'    def {field["python"]}(self) -> {field["type"]}: ...{shape}']
    return '\n'.join(lines)


def tuples(module):
    """The classes of a module that are named tuples: names and types, which stand there as texts where they are no plain names."""
    with open(module, encoding='utf-8') as file:
        found = [node for node in ast.parse(file.read()).body if isinstance(node, ast.ClassDef) and any(ast.unparse(b) == 'NamedTuple' for b in node.bases)]
    for node in found:
        fields = [field for field in node.body if isinstance(field, ast.AnnAssign)]
        types = [f.annotation.value if isinstance(f.annotation, ast.Constant) else ast.unparse(f.annotation) for f in fields]
        yield '\n'.join([f'class {node.name}(NamedTuple):', *(f'    {f.target.id}: {of}' for f, of in zip(fields, types))])


def main():
    program, template, out, *modules = sys.argv[1:]
    kinds = json.loads(subprocess.run([program], stdout=subprocess.PIPE, check=True).stdout)
    classes = '\n\n'.join(f'class {kind["kind"]}:\n{properties(kind)}' for kind in kinds[:-1])
    with open(template, encoding='utf-8') as file:
        text = file.read().replace('# kinds', classes).replace('    # fields', properties(kinds[-1]))
    text = text.replace('# tuples', '\n\n'.join(one for module in modules for one in tuples(module)))
    with open(out, 'w', encoding='utf-8') as file:
        file.write(text)


if __name__ == '__main__':
    main()
