#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs topple where names, links and signals are against it (paths.py, ends.py).

  attacks_test.py --program TOPPLE --work DIR [--every N] [--each N] [--jobs N] [--only TEXT]

Whatever comes, topple must not crash, nor be still after 10 s without a word, nor touch or tell what lies beside its
folder (the canary), nor leave anything unfinished; what it prints must be plain UTF-8, and where it fails by an
attack's file, one line, and nothing made. Exit code 1 where anything else is seen. --every N: each N-th attack.
"""
import argparse
import concurrent.futures
import hashlib
import os
import pathlib
import random
import resource
import shutil
import signal
import stat
import subprocess
import sys
import threading
import time

import ends
import paths

PATIENCE = 60
SECRET = b'the canary sings of 4711'


def tree(folder):
    """All that is below a folder: kinds, modes and contents."""
    out = {}
    for path in sorted(folder.rglob('*')):
        status = path.lstat()
        data = path.read_bytes() if stat.S_ISREG(status.st_mode) else os.readlink(path).encode() if path.is_symlink() else b''
        out[str(path.relative_to(folder))] = (status.st_mode, hashlib.sha256(data).hexdigest())
    return out


def make_canary(folder):
    (folder / 'inner').mkdir(parents=True)
    (folder / 'secret.txt').write_bytes(SECRET + b'\n')
    (folder / 'inner/0.png').write_bytes(SECRET)
    return folder


def leftovers(*folders):
    return [str(p) for f in folders for p in f.rglob('*')
            if not any(part.endswith('.topple-work') for part in p.parts)  # stays, for the next run to go on from
            and (p.name.startswith('.topple-') and p.name != '.topple-aaaaaaaaaa' or p.name.endswith('.part') and p.name not in ('kept.part', 'parse.cache.part'))]


def plain(data):
    text = data.decode('utf-8')
    return all(c.isprintable() or c in '\n ' for c in text)


class Run:
    """One attack in a folder of its own: `work` with `canary` and `tmp` beside it."""

    def __init__(self, place, program, good):
        self.place, self.program, self.good = place, program, good
        self.work, self.tmp = place / 'work', place / 'tmp'
        self.work.mkdir(parents=True)
        self.tmp.mkdir()
        self.canary = make_canary(place / 'canary')
        self.faults = []

    def expect(self, holds, fault):
        if not holds:
            self.faults.append(fault)

    def start(self, words, ending=None):
        ending = ending or ends.Ending(())
        words = list(words)
        if words and words[0] in ('parse', 'estimate'):
            words += ['--backend', 'native'] + ([] if ending.words else ['--quiet'])

        def prepare():
            for what, value in ending.limits.items():
                resource.setrlimit(what, (value, value if what != resource.RLIMIT_CPU else value + 2))
            for number, path in ending.files.items():
                os.close(number)
                if path and os.open(path, os.O_RDWR) != number:
                    os._exit(99)

        files = [open(self.place / name, 'wb') for name in ('stdout', 'stderr')]
        environment = dict(os.environ, TMPDIR=str(self.tmp), **{})
        environment.update(ending.environment)
        child = subprocess.Popen([str(self.program), *words], cwd=self.work, stdin=subprocess.DEVNULL, stdout=files[0], stderr=files[1],
                                 preexec_fn=prepare, env=environment, start_new_session=True)
        for file in files:
            file.close()
        return child

    def wait(self, child):
        try:
            code = child.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            code = child.wait()
            self.faults.append('no end within %d s' % PATIENCE)
        self.out, self.err = ((self.place / name).read_bytes() for name in ('stdout', 'stderr'))
        return code

    def check(self, code, canary):
        self.expect(tree(self.canary) == canary, 'the canary was touched')
        for name, data in (('stdout', self.out), ('stderr', self.err)):
            self.expect(SECRET not in data, 'the canary is on ' + name)
            try:
                self.expect(plain(data), 'control characters on ' + name)
            except UnicodeDecodeError:
                self.faults.append('no UTF-8 on ' + name)
        for path in self.work.rglob('*'):
            if path.is_file() and not path.is_symlink():
                data = path.read_bytes()
                self.expect(SECRET not in data, 'the canary is in ' + path.name)
                if path.name in ('report.html', 'scene.json') and 'good' not in path.parts:
                    try:
                        text = data.decode('utf-8')
                        self.expect(path.name != 'report.html' or not set('\u202e\u2066\u200f\x1b\x9b') & set(text), 'bidi controls in ' + path.name)
                    except UnicodeDecodeError:
                        self.faults.append('no UTF-8 in ' + path.name)
        self.expect(not (self.work / 'ran').exists(), 'a name was run')
        left = leftovers(self.work, self.tmp)
        self.expect(code == -signal.SIGKILL or not left, 'left behind: ' + ', '.join(left[:3]))


def attack_by_path(run, make):
    words = make(run.work, run.canary)
    canary, before = tree(run.canary), tree(run.work)
    code = run.wait(run.start(words))
    run.expect(code in (0, 1, 2), 'exit code %s' % code)
    if code != 0:
        run.expect(run.err.startswith(b'topple: ') and run.err.count(b'\n') == 1, 'no single line: %r' % run.err[:200])
        run.expect(tree(run.work) == before, 'something was made or changed')
    else:  # what stood there of others is still there
        after = tree(run.work)
        for name, what in before.items():
            if not stat.S_ISREG(what[0]) or what[1] == hashlib.sha256(b'a letter to my sister').hexdigest() and not name.startswith('OUT/') or name.endswith('thesis.tex'):
                run.expect(stat.S_ISDIR(what[0]) or after.get(name) == what, '%s is gone or changed' % name)
    run.check(code, canary)
    return code


def handles(process, number):
    """Whether a process has a handler of a signal: the loader has none yet, on a busy machine for seconds."""
    try:
        caught = next(line for line in pathlib.Path(f'/proc/{process}/status').read_text(encoding='ascii').splitlines() if line.startswith('SigCgt:'))
    except (OSError, StopIteration):
        return False
    return int(caught.split()[1], 16) >> (number - 1) & 1 == 1


def attack_by_end(run, ending):
    (run.work / 'in.xyz').write_bytes(paths.CLOUD)
    if 'good' in ending.words:
        shutil.copytree(run.good, run.work / 'good')
    canary = tree(run.canary)
    child = run.start(ending.words, ending)
    sent, in_main = ending.sent.split(), True
    for name in sent:
        time.sleep(ending.after_s)
        if child.poll() is None:
            in_main = in_main and handles(child.pid, ends.NUMBER[name])
            os.kill(child.pid, ends.NUMBER[name])
    begun = time.monotonic()
    code = run.wait(child)
    if ending.ended == 'signal':
        run.expect(time.monotonic() - begun < 10, 'went on for %.0f s' % (time.monotonic() - begun))
        number = ends.NUMBER[sent[0]]
        run.expect(code in (0, -number if sent[0] == 'KILL' else 128 + number) or code == -number and not in_main,
                   'exit code %s' % code)
    elif ending.ended == 'full':
        run.expect(code == 1 and run.err.count(b"standard output can't be written") == 1, 'exit code %s: %r' % (code, run.err[-200:]))
    else:  # the loader's own failures, where there is hardly any memory or descriptor, are 127
        run.expect(code in (0, 1, 2, 3, 127, 128 + signal.SIGXCPU, -signal.SIGKILL), 'exit code %s: %r' % (code, run.err[-200:]))
    out = run.work / 'a/OUT'
    run.expect(not out.exists() or (out / 'scene.json').exists(), 'half an output')
    run.expect(out.exists() or not out.parent.exists() or code == -signal.SIGKILL or list(out.parent.iterdir()), 'an empty parent is left')
    run.check(code, canary)
    if code == -signal.SIGKILL and 'a/OUT' in ending.words:  # the next run takes away what it left
        again = run.wait(run.start(ending.words))
        run.expect(again == 0, 'the next run ends with %s: %r' % (again, run.err[-200:]))
        run.check(again, canary)
    return code


def race(run, place, words, seconds):
    """While topple runs again and again, what stands at a place is now a file and now a link out."""
    (run.work / 'in.xyz').write_bytes(paths.CLOUD)
    paths.inputs.frames(run.work / 'in')
    shutil.copytree(run.good, run.work / 'OUT')
    canary, place, over = tree(run.canary), run.work / place, threading.Event()
    good = place.read_bytes() if place.is_file() else b'note'

    def swap():
        spare = place.with_name('spare')
        while not over.is_set():
            for make in (lambda: spare.symlink_to(run.canary / 'secret.txt'), lambda: spare.write_bytes(good)):
                spare.unlink(missing_ok=True)
                make()
                try:
                    os.replace(spare, place)
                except OSError:
                    pass

    # What the race itself puts in the output is another's: no run need succeed.
    thread = threading.Thread(target=swap)
    thread.start()
    end, code = time.monotonic() + seconds, 0
    while time.monotonic() < end:
        code = run.wait(run.start(words))
        run.expect(code in (0, 1, 2), 'exit code %s' % code)
        run.expect(SECRET not in run.out + run.err, 'the canary is told')
    over.set()
    thread.join()
    run.check(code, canary)
    return code


RACES = (('in/depth/0.png', ('parse', 'in', '-o', 'OUT-2')), ('in/intrinsics.json', ('parse', 'in', '-o', 'OUT-2')),
         ('in/trajectory.txt', ('estimate', 'in')), ('in/topple-notes.txt', ('parse', 'in', '-o', 'OUT-2')),
         ('in.xyz.topple-notes.txt', ('parse', 'in.xyz', '-o', 'OUT-2', '--walks', '2')), ('kept', ('parse', 'in.xyz', '-o', 'OUT-2', '--cache', 'kept')),
         ('OUT/points.ply', ('export', 'OUT', '--usd', 's.usda')), ('p.png', ('landscape', 'OUT', '-o', 'p.png')),
         ('OUT/scene.json', ('parse', 'in.xyz', '-o', 'OUT', '--walks', '2')))


def good_result(program, work):
    cloud = work / 'box.xyz'
    cloud.write_bytes(paths.CLOUD)
    subprocess.run([str(program), 'parse', str(cloud), '-o', str(work / 'good'), '--backend', 'native', '--quiet', '--walks', '5'], check=True)
    return work / 'good'


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--program', required=True, type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument('--work', required=True, type=lambda p: pathlib.Path(p).resolve())
    parser.add_argument('--every', type=int, default=1)
    parser.add_argument('--each', type=int, default=2)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--only', default='')
    a = parser.parse_args()
    shutil.rmtree(a.work, ignore_errors=True)
    a.work.mkdir(parents=True)
    good = good_result(a.program, a.work)
    attacks = [(name, attack_by_path, make) for name, make in paths.all_attacks(good)]
    attacks += [(name, attack_by_end, ending) for name, ending in ends.all_attacks(random.Random(5), a.each)]
    attacks += [('race at ' + place, lambda run, words, place=place: race(run, place, words, 4), words) for place, words in RACES]
    chosen = [(n, *attack) for n, attack in enumerate(attacks) if n % a.every == 0 and a.only in attack[0]]

    def run_one(one):
        number, name, kind, what = one
        run = Run(a.work / str(number), a.program, good)
        try:
            code = kind(run, what)
        except Exception as error:  # an attack that can't be made
            code = None
            run.faults.append('%s: %s' % (type(error).__name__, error))
        if run.faults:
            print('%d, %s (%s): %s' % (number, name, code, '; '.join(run.faults[:4])), flush=True)
        else:
            shutil.rmtree(run.place, ignore_errors=True)
        return not run.faults

    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        held = list(pool.map(run_one, chosen))
    print('%d attacks, %d held' % (len(held), sum(held)))
    return 0 if held and all(held) else 1


if __name__ == '__main__':
    sys.exit(main())
