#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The pages for readers hold together: docs_test.py SOURCE [TOPPLE FIELDS].

Every relative link and picture in README.md, CHANGELOG.md, SECURITY.md, docs and kernels/README.md leads to a file, and to a heading
of it where it names one; every page of docs is linked from README.md. With the program TOPPLE, every option that a page gives to a command
of topple is one that the command's --help-all lists, and the files that docs/disturbances.md and docs/corrections.md show are read.
docs/parameters.md has the constants of the stages as they stand in the code, and all of them. Measured figures in the pages are those of the
newest row of perf/results. docs/output.md has the fields that FIELDS, the program result_fields, tells of. Folders include those above
them in the table of docs/architecture.md.
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

# Options of topple stand alone in code in these pages; elsewhere such code may be another program's.
OPTIONS_ALONE = {'README.md', 'docs/output.md', 'docs/formats.md', 'docs/corrections.md', 'docs/scale.md', 'docs/how-it-works.md', 'docs/disturbances.md',
                 'docs/limits.md'}
# What those pages say of other programs: topple.formats, mpirun.
OTHERS = {'--topic', '--unit-m', '--bind-to'}


def pages(source):
    found = [os.path.join(source, name) for name in ('README.md', 'CHANGELOG.md', 'SECURITY.md', 'kernels/README.md')]
    return found + sorted(glob.glob(os.path.join(source, 'docs', '**', '*.md'), recursive=True))


def without_blocks(text):
    return re.sub(r'^```.*?^```$', '', text, flags=re.MULTILINE | re.DOTALL)


def anchors(text):
    """The names that headings can be linked by, as Git hosts make them."""
    names = set()
    for heading in re.findall(r'^#+ +(.+?) *$', without_blocks(text), re.MULTILINE):
        plain = re.sub(r'\[([^]]*)\]\([^)]*\)', r'\1', heading).lower()
        names.add(re.sub(r'[^\w\- ]', '', plain).replace(' ', '-'))
    return names


def links(text):
    prose = re.sub(r'`[^`\n]*`', '', without_blocks(text))
    return re.findall(r'\]\(([^)\s]+)\)', prose)


def check_links(source):
    problems, linked = [], set()
    for page in pages(source):
        with open(page, encoding='utf-8') as file:
            text = file.read()
        name = os.path.relpath(page, source)
        for link in links(text):
            if re.match(r'[a-z]+:', link):
                continue
            path, _, anchor = link.partition('#')
            target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
            if name == 'README.md':
                linked.add(os.path.relpath(target, source))
            if not os.path.exists(target):
                problems.append(f'{name}: {link}: there is no such file')
            elif anchor and target.endswith('.md'):
                with open(target, encoding='utf-8') as file:
                    if anchor not in anchors(file.read()):
                        problems.append(f'{name}: {link}: there is no such heading')
        # Files that are named without a link. kernels/README.md has those of a kernel that is yet to be written.
        for path in re.findall(r'`((?:docs|kernels|tests|perf|host)/[\w./-]+\.\w+)`', text):
            if name not in ('CHANGELOG.md', 'kernels/README.md') and not os.path.exists(os.path.join(source, path)):
                problems.append(f'{name}: {path}: there is no such file')
    for page in glob.glob(os.path.join(source, 'docs', '*.md')):
        if os.path.relpath(page, source) not in linked:
            problems.append(f'README.md does not link {os.path.relpath(page, source)}')
    return problems


def options_of(program):
    """By command, what its --help-all lists; under '' those of all."""
    def listed(*command):
        done = subprocess.run([program, *command, '--help-all'], stdout=subprocess.PIPE, text=True, check=True, timeout=60)
        return done.stdout

    commands = re.findall(r'^([a-z]+)$', listed(), re.MULTILINE)
    if len(commands) < 5:
        sys.exit(f'{program} --help-all lists the commands {commands}')
    found = {command: set(re.findall(r'--[a-z][\w-]*', listed(command))) for command in commands}
    found[''] = set.union(*found.values(), {'--version'})
    return found


def check_options(source, program):
    problems, known, counted = [], options_of(program), 0
    for page in pages(source):
        name = os.path.relpath(page, source)
        if name == 'CHANGELOG.md' or name.startswith('docs/decisions'):
            continue
        with open(page, encoding='utf-8') as file:
            text = file.read()
        blocks = re.findall(r'^```(?:sh|bash)?\n(.*?)^```$', text, re.MULTILINE | re.DOTALL)
        lines = [line for block in blocks for line in block.replace('\\\n', ' ').splitlines()]
        code = lines + re.findall(r'`([^`\n]+)`', without_blocks(text))
        for line in code:
            line = line.split('  #')[0]
            call = re.search(r'(?:^|/|\s)topple(?:-mpi)? ([a-z]+)(.*)', line)
            if call and call[1] in known:
                given, allowed, who = call[2], known[call[1]], 'topple ' + call[1]
            elif name in OPTIONS_ALONE and line.startswith('--'):
                given, allowed, who = line, known[''] | OTHERS, 'topple'
            else:
                continue
            for option in re.findall(r'(?<![\w-])--[a-z][\w-]*', given):
                counted += 1
                if option not in allowed:
                    problems.append(f'{name}: `{line.strip()}`: {who} has no {option}')
    if counted < 50:
        problems.append(f'only {counted} options were found in the pages: the search for them is broken')
    return problems


def check_examples(source, program):
    """Files that pages show, which `topple parse` reads before it looks for the scan."""
    problems = []
    for name, shown, option in (('docs/disturbances.md', 'hazard.txt', '--hazard'), ('docs/disturbances.md', 'materials.json', '--materials'),
                                ('docs/corrections.md', 'corrections.json', '--corrections')):
        with open(os.path.join(source, name), encoding='utf-8') as file:
            blocks = re.findall(rf'^<!-- example: {shown} -->\n```\w*\n(.*?)^```$', file.read(), re.MULTILINE | re.DOTALL)
        if len(blocks) != 1:
            problems.append(f'{name}: {len(blocks)} example blocks of {shown}')
            continue
        with tempfile.NamedTemporaryFile('w', encoding='utf-8') as example:
            example.write(blocks[0])
            example.flush()
            done = subprocess.run([program, 'parse', 'no scan', option, example.name], stderr=subprocess.PIPE, text=True, timeout=60)
        if not done.stderr.startswith('topple: no scan: '):
            problems.append(f'{name}: its example is refused: {done.stderr}')
    return problems


def constants_of(source):
    """By file, the constants with a fraction of the stages and their values, as they are written."""
    found = {}
    for folder in ('core', 'geometry', 'points', 'solids', 'physics', 'graph', 'objects', 'safety', 'result', 'scale', 'pipeline', '../vdb'):
        for path in sorted(glob.glob(os.path.normpath(os.path.join(source, 'host', folder, '**', '*.[ch]*')), recursive=True)):
            if re.search(r'/points/formats/|host/.*/(read_\w+|at2|acceleration_units)\.', path):
                continue  # limits of what files may say
            with open(path, encoding='utf-8') as file:
                text = re.sub('//.*', '', file.read())
            for listed in re.findall(r'^(?:inline )?constexpr (?:double|float) ([^;]*);', text, re.MULTILINE):
                for name, _, value in (one.partition('=') for one in listed.split(',')):
                    if 'numeric_limits' not in value:
                        found.setdefault(os.path.relpath(path, source), {})[name.strip()] = ' '.join(value.split()).rstrip('fF')
    return found


def check_parameters(source):
    page, problems, told = 'docs/parameters.md', [], 0
    left = constants_of(source)
    with open(os.path.join(source, page), encoding='utf-8') as file:
        rows = re.findall(r'^`((?:host|vdb)/[^`]+)` \| ([^|\n]*)', file.read(), re.MULTILINE)
    for path, listed in rows:
        for name, value in re.findall(r'`(\w+)=([^`]*)`', listed):
            told += 1
            known = left.get(path, {}).pop(name, None)
            if known != value:
                problems.append(f'{page}: {path}: {name} is {value}, but {known or "not there, or told twice"} in the code')
    problems += [f'{page}: {path}: {name} {value} is missing' for path, names in left.items() for name, value in names.items()]
    if told < 100:
        problems.append(f'only {told} constants were found in {page}: the search for them is broken')
    return problems


def check_folders(source):
    """Each folder includes those alone that stand above it in the table of docs/architecture.md."""
    with open(os.path.join(source, 'docs', 'architecture.md'), encoding='utf-8') as file:
        rows = re.findall(r'^((?:`[a-z/]+/`(?:, )?)+) \|', file.read(), re.MULTILINE)
    place = {name: n for n, row in enumerate(rows) for name in re.findall(r'`(?:host/)?(\w+)/`', row)}
    place = {name: n for name, n in place.items() if name == 'vdb' or os.path.isdir(os.path.join(source, 'host', name))}
    problems = []
    for path in glob.glob(os.path.join(source, 'host', '**', '*'), recursive=True) + glob.glob(os.path.join(source, 'vdb', '*')):
        folder = os.path.relpath(path, source).removeprefix('host/').split('/')[0]
        if not path.endswith(('.cpp', '.h')) or folder not in place:
            continue
        with open(path, encoding='utf-8') as file:
            included = re.findall(r'^#include "(\w+)/', file.read(), re.MULTILINE)
        problems += [f'{os.path.relpath(path, source)} includes {other}, which stands below it in docs/architecture.md'
                     for other in included if place.get(other, -1) > place[folder]]
    return problems


def check_made(source, script, *arguments):
    """What a script writes into pages is there."""
    done = subprocess.run([sys.executable, os.path.join(source, *script), '--check', *arguments, source], stderr=subprocess.PIPE, text=True,
                          timeout=60)
    return done.stderr.splitlines()


def main():
    source = sys.argv[1]
    problems = check_links(source) + check_parameters(source) + check_folders(source) + check_made(source, ('perf', 'quote'))
    if len(sys.argv) > 2:
        problems += check_options(source, sys.argv[2]) + check_examples(source, sys.argv[2])
        problems += check_made(source, ('docs', 'fields'), sys.argv[3])
    sys.exit('\n'.join(problems) if problems else 0)


if __name__ == '__main__':
    main()
