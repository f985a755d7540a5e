# SPDX-License-Identifier: MIT
"""Attacks by names: what stands where topple reads or writes leads elsewhere, or is another's.

Each is a name and a function that makes it in a folder, beside which lies the canary (attacks_test.py), and returns
topple's arguments.
"""
import os
import pathlib
import shutil
import socket
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / 'malformed'))
import inputs  # noqa: E402

CLOUD = dict(inputs.room_files())['xyz']
OUTPUTS = ('parse.cache', 'solids.bin', 'points.ply', 'solid.ply', 'volume.vdb', 'report.html', 'objects.glb', 'map.bt', 'view-photo.png',
           'view-parts.png', 'view-completed.png', 'view-objects.png', 'view-risk.png', 'view-walks.png', 'view-human.png', 'view-wind.png', 'view-earthquake.png', 'landscapes.json',
           'verify.json', 'scene.json')
NAMES = ('a\nb', 'a\x1b[2Jb', 'a\x1b]0;owned\x07b', 'a\u202egnp.b', 'a\u2066b\u2069', 'a\u200fb', b'a\xff\xfeb', b'\x9b31m', 'a\x7fb', '-rf', '--help',
         '%s%n%x', '%2e%2e', 'a;b', '$(touch ran)', '`touch ran`', "a'b\"c", ' a ', 'a\\b', 'a\tb', '\ufeffa', 'e\u0301', '\u5bb6', 'a' * 240, '~', '*',
         '\r', 'a\rb', '\u2028', '\u0085', '...', '<img src=x onerror=alert(1)>', '&amp;')


def link(target):
    return lambda place, canary: place.symlink_to(canary / target if target else 'nowhere/at/all')


def put_socket(place, canary):
    here = os.getcwd()
    os.chdir(place.parent)  # its address has 108 bytes
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(place.name)
    os.chdir(here)


def put_folder(place, canary):
    place.mkdir()
    (place / 'thesis.tex').write_text('years of work')


OBSTACLES = {'link to a file': link('secret.txt'), 'link to a folder': link('inner'), 'link to nothing': link(''),
             'link to what is new there': link('new'), 'link to a device': lambda place, canary: place.symlink_to('/dev/zero'),
             'link in a circle': lambda place, canary: place.symlink_to(place.name), 'pipe': lambda place, canary: os.mkfifo(place),
             'socket': put_socket, 'folder': put_folder, 'own file': lambda place, canary: place.write_text('a letter to my sister')}
TEXTS = {'link to a file', 'link to a folder', 'link to what is new there', 'pipe', 'folder'}  # for places of less weight


def clear(place):
    place.parent.mkdir(parents=True, exist_ok=True)
    if place.is_dir() and not place.is_symlink():
        shutil.rmtree(place)
    elif place.is_symlink() or place.exists():
        place.unlink()


def output_attacks(good):
    """Where results are written."""
    parse = ('parse', 'in.xyz', '-o', 'OUT')
    places = [('OUT/' + name, parse, OBSTACLES if name in ('scene.json', 'view-risk.png', 'parse.cache') else TEXTS) for name in OUTPUTS]
    places += [('OUT', parse, OBSTACLES), ('.OUT.topple-work', ('parse', 'in.xyz', '-o', 'OUT', '--tile', '5'), OBSTACLES),
               ('kept', parse + ('--cache', 'kept'), OBSTACLES), ('kept.part', parse + ('--cache', 'kept'), OBSTACLES),
               ('OUT/parse.cache.part', ('parse', 'in.xyz', '-o', 'OUT-2', '--cache', 'OUT/parse.cache'), OBSTACLES),
               ('p.png', ('landscape', 'good', '-o', 'p.png'), OBSTACLES), ('p.svg', ('landscape', 'good', '-o', 'p.svg'), OBSTACLES),
               ('s.usda', ('export', 'good', '--usd', 's.usda'), OBSTACLES), ('s.bodies.json', ('export', 'good', '--usd', 's.usda'), OBSTACLES),
               ('room.ply', ('generate', 'room.ply', '--building', '--points', '20000', '--spacing', '0.2'), OBSTACLES),
               ('room.truth.json', ('generate', 'room.ply', '--building', '--points', '20000', '--spacing', '0.2'), TEXTS),
               ('scan', ('generate', 'scan', '--single'), OBSTACLES), ('scan/depth', ('generate', 'scan', '--single'), OBSTACLES),
               ('scan/truth.json', ('generate', 'scan', '--single'), OBSTACLES),
               ('r.json', ('perf', '--json', 'r.json', '--filter', 'no such case'), OBSTACLES), ('r.csv', ('perf', '--csv', 'r.csv', '--filter', 'none'), TEXTS)]
    for option, name, folder in (('--mjcf', 'scene.xml', 'scene_mjcf'), ('--urdf', 'scene.urdf', 'scene_urdf'), ('--sdf', 'scene.sdf', 'scene_sdf')):
        for place in (name, folder, 'bodies.json', '.' + folder + '.topple-tmp'):
            places.append(('sim/' + place, ('export', 'good', option, 'sim'), OBSTACLES if option == '--urdf' else TEXTS))
    for place, words, obstacles in places:
        for what in obstacles if isinstance(obstacles, set) else list(obstacles):
            def make(folder, canary, place=place, what=what, words=words):
                (folder / 'in.xyz').write_bytes(CLOUD)
                shutil.copytree(good, folder / 'good')
                if place.startswith('OUT/'):
                    shutil.copytree(good, folder / 'OUT')
                clear(folder / place)
                OBSTACLES[what](folder / place, canary)
                return words
            yield '%s at %s of %s' % (what, place, words[0]), make


def input_attacks(good):
    """What a scan names, or lies beside it."""
    sequence = ('depth', 'depth/0.png', 'depth/1.png', 'color', 'color/0.png', 'color/intrinsics.json', 'intrinsics.json', 'trajectory.txt',
                'trajectory.log', 'poses.txt', 'topple-notes.txt')
    for command in ('parse', 'estimate'):
        for place in sequence:
            for what in OBSTACLES:
                def make(folder, canary, command=command, place=place, what=what):
                    inputs.frames(folder / 'in')
                    (folder / 'in/color').mkdir()
                    (folder / 'in/color/0.png').write_bytes(inputs.png(48, 36, 8, 2, b''.join(b'\0' + b'\1\2\3' * 48 for _ in range(36))))
                    clear(folder / 'in' / place)
                    OBSTACLES[what](folder / 'in' / place, canary)
                    return (command, 'in') + (('-o', 'OUT') if command == 'parse' else ())
                yield '%s at %s of %s' % (what, place, command), make
    for what in OBSTACLES:
        def beside(folder, canary, what=what):
            (folder / 'in.xyz').write_bytes(CLOUD)
            OBSTACLES[what](folder / 'in.xyz.topple-notes.txt', canary)
            return 'parse', 'in.xyz', '-o', 'OUT'
        yield '%s beside a cloud' % what, beside
        for uri in ('a.bin', 'b/a.bin'):
            def buffer(folder, canary, what=what, uri=uri):
                root, data = inputs.glb_parts()
                (folder / 'b').mkdir()
                OBSTACLES[what](folder / uri, canary)
                import json
                (folder / 'in.gltf').write_text(json.dumps(dict(root, buffers=[{'byteLength': len(data), 'uri': uri}])))
                return 'parse', 'in.gltf', '-o', 'OUT'
            yield '%s as the buffer %s' % (what, uri), buffer
        for place in ('scene.json', 'solids.bin', 'points.ply', 'landscapes.json'):
            def output(folder, canary, what=what, place=place):
                shutil.copytree(good, folder / 'good')
                clear(folder / 'good' / place)
                OBSTACLES[what](folder / 'good' / place, canary)
                return ('landscape', 'good') if place == 'landscapes.json' else ('export', 'good', '--usd', 's.usda')
            yield '%s at %s that is exported' % (what, place), output
        for option in ('--corrections', '--hazard', '--motion', '--accelerogram'):
            def side(folder, canary, what=what, option=option):
                (folder / 'in.xyz').write_bytes(CLOUD)
                OBSTACLES[what](folder / 'side.json', canary)
                return 'parse', 'in.xyz', '-o', 'OUT', option, 'side.json'
            if what in ('pipe', 'socket', 'folder', 'link to a device', 'link in a circle', 'own file'):
                yield '%s as %s' % (what, option), side


def name_attacks(good):
    """Names that steer a terminal, a shell, a page or a parser of options."""
    for n, name in enumerate(NAMES):
        name = name if isinstance(name, bytes) else os.fsencode(name)
        for role in ('input', 'output', 'title', 'missing', 'corrections', 'picture'):
            def make(folder, canary, name=name, role=role):
                place = os.fsdecode(name)
                (folder / 'in.xyz').write_bytes(CLOUD)
                if role == 'input':
                    file = b'./' + name[:200] + b'.xyz'
                    (folder / os.fsdecode(file)).write_bytes(CLOUD)
                    return 'parse', os.fsdecode(file), '-o', 'OUT'
                if role == 'output':
                    return 'parse', 'in.xyz', '-o', './' + place
                if role == 'title':
                    return 'parse', 'in.xyz', '-o', 'OUT', '--title=' + place
                if role == 'picture':
                    shutil.copytree(good, folder / 'good')
                    return 'landscape', 'good', '-o', './' + os.fsdecode(name[:200]) + '.png'
                return ('parse', place, '-o', 'OUT') if role == 'missing' else ('parse', 'in.xyz', '-o', 'OUT', '--corrections', './' + place)
            yield 'name %d as %s' % (n, role), make


def relation_attacks(good):
    """The output among what is read, and places where nothing can be written."""
    def pair(name, source, out, *more, prepare=None):
        def make(folder, canary):
            (folder / 'in.xyz').write_bytes(CLOUD)
            inputs.frames(folder / 'in')
            shutil.copytree(good, folder / 'OUT')
            (folder / 'OUT-link').symlink_to('OUT')
            if prepare:
                prepare(folder, canary)
            return ('parse', source.format(folder), '-o', out.format(folder)) + more
        return 'relation ' + name, make

    for n, (source, out) in enumerate((('in', 'in'), ('in', 'in/OUT'), ('in', 'in/depth'), ('in/', 'in/./'), ('in', '{0}/in'), ('in.xyz', 'in.xyz'),
                                       ('in.xyz', '.'), ('in.xyz', '..'), ('in.xyz', '/'), ('in.xyz', ''), ('in.xyz', 'in.xyz/OUT'),
                                       ('OUT/points.ply', 'OUT'), ('OUT/points.ply', 'OUT-link'), ('OUT-link/points.ply', '{0}/OUT'), ('OUT', 'OUT'),
                                       ('in.xyz', '/proc/topple'), ('in.xyz', '/dev/null'), ('in.xyz', '/dev/full/OUT'), ('/dev/stdin', 'OUT-2'),
                                       ('/dev/zero', 'OUT-2'), ('/proc/self/mem', 'OUT-2'), ('/proc/self/fd/0', 'OUT-2'), ('.', 'OUT-2'), ('/', 'OUT-2'),
                                       ('in.xyz', 'x/' * 2100 + 'y'), ('x/' * 2100 + 'y', 'OUT-2'), ('in.xyz', 'y' * 300), ('in.xyz', 'OUT-link'))):
        yield pair(str(n), source, out)
    yield pair('cache is the scan', 'in.xyz', 'OUT-2', '--cache', 'in.xyz')
    yield pair('cache is a link to the scan', 'in.xyz', 'OUT-2', '--cache', 'c', prepare=lambda f, c: (f / 'c').symlink_to('in.xyz'))
    yield pair('cache is a result', 'in.xyz', 'OUT-2', '--cache', 'OUT/scene.json')
    yield pair('locked parent', 'in.xyz', 'locked/OUT', prepare=lambda f, c: (f / 'locked').mkdir(mode=0o555))
    yield pair('staging of another', 'in.xyz', 'OUT', prepare=lambda f, c: put_folder(f / '.topple-aaaaaaaaaa', c))
    yield pair('staging is a link', 'in.xyz', 'OUT', prepare=lambda f, c: (f / '.topple-aaaaaaaaaa').symlink_to(c / 'inner'))
    yield pair('staging within', 'in.xyz', 'OUT', prepare=lambda f, c: put_folder(f / 'OUT/.topple-aaaaaaaaaa', c))


def all_attacks(good):
    for attacks in (output_attacks, input_attacks, name_attacks, relation_attacks):
        yield from attacks(good)
