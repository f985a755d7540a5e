#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs topple on inputs, and on files of its own (own_files.py), that are damaged or made to harm, each with limits.

  malformed_test.py --program TOPPLE --work DIR [--every N] [--each N] [--seed N] [--jobs N] [--only TEXT] [--table FILE]
                    [--python PYTHON]

--every N runs each N-th of the cases; --each N makes as many of each change to each good file, as a measure of
how many cases there are. --python names one that has the package: without, topple.load is left out. A case passes where topple ends with 0, 1 or 2, in 10 s of processor time, with at most
400 MB + 20 times the input's size of memory, and, unless with 0, one line on stderr and no output. Exit code 1
where any case does not, 0 otherwise.
"""
import argparse
import concurrent.futures
import multiprocessing
import os
import pathlib
import random
import shutil
import signal
import stat
import subprocess
import sys
import tempfile
import time

import inputs
import own_files

# Like the program: one line where it fails.
LOAD = """
import sys, topple
try:
    topple.load(sys.argv[1])
except topple.Error as error:
    sys.exit(str(error))
"""
SECONDS, PATIENCE = 10, 120  # of processor time; by the clock, on a busy machine
FIXED_KB, OF_SIZE = 400_000, 20  # the points on a mesh's faces take as much, however few faces it has


def input_bytes(folder):
    total = 0
    for path in folder.rglob('*'):
        status = path.lstat()
        total += status.st_size if stat.S_ISREG(status.st_mode) else 0
    return total


class Case:
    def __init__(self, number, name, folder, python):
        self.number, self.name, self.folder, self.python = number, name, folder, python
        self.faults, self.code, self.seconds, self.peak_kb, self.error = [], None, 0.0, 0, ''

    def expect(self, holds, fault):
        if not holds:
            self.faults.append(fault)

    def run(self, program, words):
        out = self.folder / 'OUT'
        size = input_bytes(self.folder)
        before = set(os.listdir(self.folder))
        words = [str(word) for word in words]
        if words[0] == 'parse':
            words += ['-o', str(out), '--backend', 'native', '--quiet', '--walks', '5']
        elif words[0] == 'landscape':
            words += ['-o', str(self.folder / 'OUT.svg')]
        elif words[0] == 'estimate':
            words += ['--backend', 'native', '--quiet']
        with open(self.folder / 'stderr', 'wb') as error:
            start = [str(program), *words] if words[0] != 'load' else [self.python, '-c', LOAD, *words[1:]]
            child = subprocess.Popen(start, cwd=self.folder, stdin=subprocess.DEVNULL,
                                     stdout=subprocess.DEVNULL, stderr=error, start_new_session=True)
            self.wait(child)
        self.error = (self.folder / 'stderr').read_bytes().decode('utf-8', 'replace')
        lines = self.error.splitlines()
        self.expect(self.code in (0, 1, 2), 'exit code %s' % self.code)
        if self.code != 0:
            self.expect(len(lines) == 1, '%d lines on stderr' % len(lines))
            left = set(os.listdir(self.folder)) - before - {'stderr'}
            self.expect(not left, 'left behind: %s' % ', '.join(sorted(left)))
        self.expect('_M_' not in self.error, 'an exception of the standard library')
        self.expect(all(c.isprintable() for line in lines for c in line), 'control characters on stderr')
        self.expect(self.seconds <= SECONDS, '%.1f s of processor time' % self.seconds)
        limit = FIXED_KB + OF_SIZE * size // 1000
        self.expect(self.peak_kb <= limit or self.code == 0, '%d kB of memory, more than %d' % (self.peak_kb, limit))
        return self

    def wait(self, child):
        end = time.monotonic() + PATIENCE
        while True:
            pid, status, used = os.wait4(child.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > end:
                os.killpg(child.pid, signal.SIGKILL)
                pid, status, used = os.wait4(child.pid, 0)
                self.faults.append('no end within %d s' % PATIENCE)
                break
            time.sleep(0.005)
        child.returncode = os.waitstatus_to_exitcode(status)
        self.code = child.returncode
        self.seconds, self.peak_kb = used.ru_utime + used.ru_stime, used.ru_maxrss


def good_results(program, work):
    """A parse of a box on a floor."""
    work.mkdir(parents=True)
    cloud = work / 'box.xyz'
    cloud.write_bytes(dict(inputs.room_files())['xyz'])
    subprocess.run([str(program), 'parse', str(cloud), '-o', str(work / 'good'), '--octomap', '--glb', '--backend',
                    'native', '--quiet'], check=True)
    return work / 'good'


def run_case(number, name, folder, program, python, words):
    return Case(number, name, folder, python).run(program, words)


def run_all(a, small, chosen):
    def run(case):
        number, name, make = case
        folder = a.work / str(number) / 'in'
        folder.mkdir(parents=True)
        result = small.submit(run_case, number, name, folder, a.program, a.python, make(folder)).result()
        if not result.faults:
            shutil.rmtree(folder.parent)
        return result

    table = open(a.table, 'w', encoding='utf-8') if a.table else None
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        results = []
        for result in pool.map(run, chosen):
            results.append(result)
            if table:
                print(result.number, result.name, result.code, '%.2f' % result.seconds, result.peak_kb,
                      result.error.strip()[:300], sep='\t', file=table, flush=True)
            if result.faults:
                print('case %d, %s: %s\n    %s\n    in %s' % (result.number, result.name, '; '.join(result.faults),
                                                           result.error.strip()[:300], result.folder), flush=True)
    return results


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--program', required=True, type=pathlib.Path)
    parser.add_argument('--work', required=True, type=pathlib.Path)
    parser.add_argument('--every', type=int, default=1)
    parser.add_argument('--each', type=int, default=12)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--python')
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--only', default='')
    parser.add_argument('--table', type=pathlib.Path)
    a = parser.parse_args()
    a.program = a.program.resolve()
    shutil.rmtree(a.work, ignore_errors=True)
    good = good_results(a.program, a.work)
    every = list(inputs.cases(good, random.Random(a.seed), a.each))
    every += own_files.cases(a.program, good, random.Random(a.seed), a.each)
    chosen = [(number, name, make) for number, (name, make) in enumerate(every)
              if number % a.every == 0 and a.only in name and (a.python or not name.startswith('own load'))]

    # A process's peak of memory begins with that of the one that started it: not this one's.
    small = concurrent.futures.ProcessPoolExecutor(a.jobs, multiprocessing.get_context('spawn'))
    with small:
        results = run_all(a, small, chosen)

    codes = {code: sum(r.code == code for r in results) for code in sorted({r.code for r in results})}
    bad = sum(bool(r.faults) for r in results)
    print('%d cases, %d of them with faults; exit codes %s; most processor time %.1f s, most memory %d MB' % (
        len(results), bad, codes, max(r.seconds for r in results), max(r.peak_kb for r in results) // 1000))
    return 1 if bad or not results else 0


if __name__ == '__main__':
    sys.exit(main())
