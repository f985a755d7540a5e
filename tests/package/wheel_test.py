#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""wheel_test.py --source DIR --build DIR --work DIR --python FILE: makes the wheel, and uses it where nothing else is.

Everything in it must find its libraries in it, but for those of the C and C++ runtimes; then a new virtual environment
that has NumPy and the wheel generates a scan, parses it and files that other programs read, and tells which devices
there are without drivers. PATH has that environment alone. FILE: the Python with what makes wheels, which runs all this. Exits with 77 where what makes wheels is missing.
"""
import argparse
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

from package_test import SKIPPED, check, run

LARGEST_MB = 40
RUNTIME = re.compile(r'(linux-vdso|/.*/ld-linux-.*|ld-linux-.*|lib(c|m|mvec|dl|rt|pthread|util|resolv|gcc_s|stdc\+\+))\.so(\.\d+)?')
SCRIPT = '''
import sys, time
start = time.perf_counter()
import topple
print(f'import topple: {time.perf_counter() - start:.2f} s')
scan, out = sys.argv[1:]
result = topple.parse(scan, device='native', disturbances='wind')
result.write(out)
assert len(result.objects) > 5, result.objects
import os
assert os.path.getsize(os.path.join(out, 'report.html')) > 1e5
with open('floor.obj', 'w') as file:  # by topple-reader, and the volume by topple-volume-reader
    file.write('v 0 0 0\\nv 3 0 0\\nv 3 3 0\\nv 0 3 0\\nv 1 1 1\\nv 2 1 1\\nv 2 2 1\\nv 1 2 1\\nf 1 2 3 4\\nf 5 6 7 8\\n')
for path in ('floor.obj', os.path.join(out, 'volume.vdb')):
    assert topple.parse(path, device='native', disturbances=[]).objects, path
'''


def environment(folder, wheel):
    """A new virtual environment with the wheel and this Python's NumPy; its site-packages."""
    run(sys.executable, '-m', 'venv', '--without-pip', folder)
    python = folder / 'bin' / 'python'
    run(sys.executable, '-m', 'pip', '--python', python, 'install', '--quiet', '--disable-pip-version-check', '--no-index', '--no-deps', wheel)
    site = pathlib.Path(run(python, '-c', 'import sysconfig; print(sysconfig.get_path("platlib"))').strip())
    numpy = pathlib.Path(importlib.util.find_spec('numpy').origin).parent
    for own in (numpy, numpy.with_name('numpy.libs')):
        if own.exists():
            (site / own.name).symlink_to(own)
    return site


def check_libraries(site):
    """What each program and library in the wheel is linked with lies in it."""
    files = [f for folder in ('topple', 'topple.libs') for f in sorted((site / folder).iterdir())
             if f.is_file() and f.read_bytes()[:4] == b'\x7fELF']
    check(len(files) > 20, f'{len(files)} programs and libraries only')
    for file in files:
        for line in run('ldd', file).splitlines():
            name, path = (re.match(r'\s*(\S+)(?: => (\S+))?', line)).groups()
            inside = path and pathlib.Path(path).resolve().is_relative_to(site)
            check(inside or RUNTIME.fullmatch(name), f'{file.name} takes {name} from {path}')


def check_licences(wheel):
    with zipfile.ZipFile(wheel) as packed:
        names = packed.namelist()
    licences = {name.split('/licenses/')[1].split('/')[0] for name in names if '/licenses/' in name}
    for expected in ('LICENSE', 'libopenvdb', 'libtbb', 'libboost-iostreams', 'libblosc', 'libqhull', 'libassimp', 'libeigen3', 'pybind11', 'libjs-three'):
        check(any(licence.startswith(expected) for licence in licences), f'the wheel has no licence of {expected}: {sorted(licences)}')


def main():
    parser = argparse.ArgumentParser()
    for name in ('source', 'build', 'work', 'python'):
        parser.add_argument('--' + name, type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    if arguments.python.exists() and pathlib.Path(sys.executable) != arguments.python:
        os.execv(arguments.python, [arguments.python, *sys.argv])
    missing = [p for p in ('auditwheel', 'numpy', 'pip', 'scikit_build_core') if importlib.util.find_spec(p) is None]
    if missing and os.environ.get('TOPPLE_REQUIRE_BACKENDS') != '1':
        print(f'{sys.executable} has no {", ".join(missing)}: ./dev setup installs them')
        sys.exit(SKIPPED)
    work = arguments.work.resolve()
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    tools = dict(os.environ, PATH=os.path.dirname(sys.executable) + ':' + os.environ['PATH'])
    print(run(sys.executable, arguments.source / 'host/python/wheel/make_wheel.py', '--build', arguments.build, '--out', work, env=tools).splitlines()[-1])
    wheel = next(work.glob('*.whl'))
    check('manylinux' in wheel.name, f'{wheel.name} is of this system only')
    check(wheel.stat().st_size < LARGEST_MB * 1e6, f'{wheel.name} has more than {LARGEST_MB} MB')
    check_licences(wheel)
    site = environment(work / 'venv', wheel)
    check_libraries(site)
    alone = {'PATH': str(work / 'venv' / 'bin'), 'HOME': str(work), 'PYTHONNOUSERSITE': '1'}
    topple = work / 'venv' / 'bin' / 'topple'
    run(topple, 'generate', 'scan', '--seed', '1', '--frames', '8', cwd=work, env=alone)
    print(run(work / 'venv' / 'bin' / 'python', '-c', SCRIPT, 'scan', 'out', cwd=work, env=alone))
    refused = subprocess.run([topple, 'verify', 'out'], cwd=work, env=alone, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    check(refused.returncode == 3 and 'the wheel leaves out' in refused.stdout, f'topple verify: exit code {refused.returncode}\n{refused.stdout}')
    listed = run(topple, 'devices', cwd=work, env=dict(alone, VK_ICD_FILENAMES='/nowhere', VK_DRIVER_FILES='/nowhere', OCL_ICD_VENDORS='/nowhere'))
    for words in ('native  ', 'OpenCL finds no driver', 'Vulkan finds no driver'):
        check(words in listed, f'topple devices without drivers does not say "{words}":\n{listed}')


if __name__ == '__main__':
    main()
