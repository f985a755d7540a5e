#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the commands of docs/tutorials.md as they stand there, one after the other, in an empty folder.

usage: tutorials_test.py PAGE WORK FOLDER-OF-PROGRAMS
"""
import os
import re
import shutil
import subprocess
import sys


def main():
    page, work, programs = sys.argv[1:]
    with open(page, encoding='utf-8') as file:
        text = file.read()
    blocks = re.findall(r'^<!-- (run|file): ?(\S*) ?-->\n```\n(.*?)^```$', text.replace('<!-- run -->', '<!-- run: -->'), re.MULTILINE | re.DOTALL)
    commands = [line for what, _, block in blocks if what == 'run' for line in block.splitlines()]
    if len(commands) < 10:
        sys.exit(f'{page}: only {len(commands)} commands were found: the search for them is broken')
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    environment = {**os.environ, 'PATH': programs + os.pathsep + os.environ['PATH']}
    for what, name, block in blocks:
        if what == 'file':
            with open(os.path.join(work, name), 'w', encoding='utf-8') as file:
                file.write(block)
            continue
        for line in block.splitlines():
            done = subprocess.run(line, shell=True, cwd=work, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            print(f'$ {line}\n{done.stdout}')
            if done.returncode != 0:
                sys.exit(f'{page}: `{line}` ended with {done.returncode}')
    for made in ('second/report.html', 'ratings.csv', 'sim/scene.xml', 'live-out/scene.json'):
        if not os.path.isfile(os.path.join(work, made)):
            sys.exit(f'{page}: its commands made no {made}')


if __name__ == '__main__':
    main()
