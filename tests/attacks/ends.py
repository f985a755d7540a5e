# SPDX-License-Identifier: MIT
"""Attacks by how a run ends: signals at random times, limits of the system, descriptors that are closed or full.

Each is a name and an Ending: arguments, a signal after so many seconds, limits, and what stands for stdin, stdout and
stderr.
"""
import dataclasses
import resource
import signal

SIGNALS = ('HUP', 'INT', 'QUIT', 'TERM', 'PIPE', 'XCPU', 'KILL')
PARSE = ('parse', 'in.xyz', '-o', 'a/OUT', '--walks', '200')
COMMANDS = {'parse': (PARSE, 2.0), 'tiles': (PARSE + ('--tile', '5', '--no-cache'), 2.0), 'pictures': (PARSE + ('--png', '--glb'), 2.5),
            'exporting': (PARSE + ('--urdf', 'sim'), 2.0), 'estimate': (('estimate', 'in.xyz'), 0.4),
            'export': (('export', 'good', '--mjcf', 'sim'), 0.4), 'landscape': (('landscape', 'good', '-o', 'p.png'), 0.2),
            'verify': (('verify', 'good', '--seconds', '30'), 1.0), 'generate': (('generate', 'scan', '--frames', '12'), 1.5),
            'building': (('generate', 'b.ply', '--building', '--points', '300000', '--spacing', '0.05'), 1.0),
            'evaluate': (('evaluate', '--seeds', '1', '--measures', '--thing', 'box', '-o', 'ev'), 2.0),
            'view': (('view', 'good', '--no-browser'), 0.5), 'devices': (('devices',), 0.3)}


@dataclasses.dataclass
class Ending:
    words: tuple
    sent: str = ''
    after_s: float = 0
    limits: dict = dataclasses.field(default_factory=dict)
    files: dict = dataclasses.field(default_factory=dict)  # descriptor -> path, or None: closed
    environment: dict = dataclasses.field(default_factory=dict)
    ended: str = ''  # how it must end: 'signal', 'full' (not 0 where anything is printed), '' (no crash)


def signal_attacks(rng, each):
    for name, (words, seconds) in COMMANDS.items():
        for sent in SIGNALS:
            for _ in range(each):
                yield '%s gets %s' % (name, sent), Ending(words, sent, rng.uniform(0.0, seconds), ended='signal')
    for name in ('parse', 'verify', 'export'):
        yield '%s gets INT twice' % name, Ending(COMMANDS[name][0], 'INT INT', rng.uniform(0.1, 0.6), ended='signal')


def limit_attacks():
    for name, (words, _) in COMMANDS.items():
        if name in ('view', 'evaluate'):
            continue
        for size in (0, 100, 10_000, 300_000):
            yield '%s with files of %d bytes' % (name, size), Ending(words, limits={resource.RLIMIT_FSIZE: size})
        for count in (3, 4, 5, 6, 8, 11, 16, 24):
            yield '%s with %d descriptors' % (name, count), Ending(words, limits={resource.RLIMIT_NOFILE: count})
        for mb in (40, 120, 250, 500):
            yield '%s with %d MB' % (name, mb), Ending(words, limits={resource.RLIMIT_AS: mb << 20})
        yield '%s with 1 s' % name, Ending(words, limits={resource.RLIMIT_CPU: 1})
        for missing in ((0,), (1,), (2,), (0, 1), (1, 2), (0, 1, 2)):
            yield '%s without %s' % (name, missing), Ending(words, files=dict.fromkeys(missing))
        yield '%s to a full disk' % name, Ending(words, files={1: '/dev/full'}, ended='full')
        yield '%s with errors to a full disk' % name, Ending(words, files={2: '/dev/full'})
        for place in ('/nowhere', '/dev/null', ''):
            yield '%s with TMPDIR=%s' % (name, place), Ending(words, environment={'TMPDIR': place})
    for words in (('--help',), ('--version',), ('perf', '--list'), ('export', '--help'), ('devices',), ('estimate', 'in.xyz', '--json')):
        yield '%s to a full disk' % ' '.join(words), Ending(words, files={1: '/dev/full'}, ended='full')


def all_attacks(rng, each):
    yield from signal_attacks(rng, each)
    yield from limit_attacks()


NUMBER = {name: int(getattr(signal, 'SIG' + name)) for name in SIGNALS}
