#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Installs what was built, and uses it as a stranger's project would.

  package_test.py install|example|headers|exports|adopt_opencl|examples|pkg_config|python|python_formats|python_example|notebooks
      --source DIR --build DIR --work DIR ...

`install` comes first: it installs into WORK, moves the whole elsewhere, so that nothing can depend on where
it was first, and parses a small generated scan with the program there. Each of the others configures, builds
and runs a project against it. Exits with 77 where a test is skipped.
"""
import argparse
import collections
import glob
import json
import os
import re
import shutil
import subprocess
import sys

SKIPPED = 77


def run(*command, **options):
    """What the command prints; it must succeed."""
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    if done.returncode == SKIPPED and os.environ.get('TOPPLE_REQUIRE_BACKENDS') != '1':
        print(done.stdout)
        sys.exit(SKIPPED)
    if done.returncode:
        sys.exit(f'{" ".join(map(str, command))}: exit code {done.returncode}\n{done.stdout}')
    return done.stdout


def check(holds, message):
    if not holds:
        sys.exit(message)


class Package:
    def __init__(self, arguments):
        self.a = arguments
        self.prefix = os.path.join(arguments.work, 'prefix')
        self.scan = os.path.join(arguments.work, 'scan')

    def install(self):
        shutil.rmtree(self.a.work, ignore_errors=True)
        first = os.path.join(self.a.work, 'first')
        run(self.a.cmake, '--install', self.a.build, '--prefix', first)
        os.rename(first, self.prefix)
        self.check_paths()
        topple = os.path.join(self.prefix, 'bin', 'topple')
        run(topple, 'generate', self.scan, '--seed', 1, '--frames', 8)
        check(self.parsed('native') > 1, 'the scan holds too few objects to tell anything')

    def check_paths(self):
        """Nothing installed names this source tree, but for what a debugger reads."""
        places = [os.path.abspath(place).encode() for place in (self.a.source, self.a.build)]
        for folder, _, names in os.walk(self.prefix):
            for name in names:
                path = os.path.join(folder, name)
                if self.a.build_type != 'Release' and not path.endswith(('.h', '.cmake')):
                    continue
                with open(path, 'rb') as file:
                    data = file.read()
                for place in places:
                    check(place not in data, f'{path} names {place.decode()}')

    def parsed(self, backend):
        """The number of objects in the scene.json of the installed program."""
        out = os.path.join(self.a.work, 'parsed-' + backend)
        if not os.path.exists(out):
            run(os.path.join(self.prefix, 'bin', 'topple'), 'parse', self.scan, '-o', out, '--backend', backend, '--quiet')
        with open(os.path.join(out, 'scene.json'), encoding='utf-8') as file:
            return len(json.load(file)['objects'])

    def build(self, source, name, target):
        """Configures and builds a project's target; its folder."""
        folder = os.path.join(self.a.work, name)
        shutil.rmtree(folder, ignore_errors=True)
        run(self.a.cmake, '-S', source, '-B', folder, '-G', self.a.generator, '-DCMAKE_PREFIX_PATH=' + self.prefix,
            '-DCMAKE_CXX_COMPILER=' + self.a.compiler, '-DCMAKE_BUILD_TYPE=' + self.a.build_type,
            '-DEXAMPLES=' + os.path.join(self.a.source, 'docs/examples'))
        with open(os.path.join(folder, 'CMakeCache.txt'), encoding='utf-8') as file:
            found = re.search(r'^topple_DIR:PATH=(.*)$', file.read(), re.M).group(1)
        check(found.startswith(self.prefix), f'found topple in {found}, not below {self.prefix}')
        run(self.a.cmake, '--build', folder, '--target', target)
        return folder

    def example(self):
        """The files of docs/library.md, as they stand there."""
        source = os.path.join(self.a.work, 'example')
        shutil.rmtree(source, ignore_errors=True)
        os.makedirs(source)
        with open(os.path.join(self.a.source, 'docs/library.md'), encoding='utf-8') as file:
            blocks = dict(re.findall(r'^<!-- example: (\S+) -->\n```\w+\n(.*?)^```$', file.read(), re.M | re.S))
        check(sorted(blocks) == ['CMakeLists.txt', 'main.cpp'], f'docs/library.md has the example blocks {sorted(blocks)}')
        for name, text in blocks.items():
            with open(os.path.join(source, name), 'w', encoding='utf-8') as file:
                file.write(text)
        built = self.build(source, 'example-build', 'all')
        program = os.path.join(built, 'myapp')
        out = os.path.join(self.a.work, 'example-parsed')
        self.compare(run(program, self.scan, out), 'auto')
        check(os.path.exists(os.path.join(out, 'report.html')), 'the example wrote no report')

    def headers(self):
        self.build(os.path.join(self.a.source, 'tests/package/consumer'), 'headers-build', 'headers')

    def exports(self):
        """What a shared library shows is what the public headers declare, whichever linker makes it."""
        declared = collections.Counter()
        for path in glob.glob(os.path.join(self.prefix, 'include/topple/*.h')):
            with open(path, encoding='utf-8') as file:
                text = re.sub(r'//[^\n]*|/\*.*?\*/', '', file.read(), flags=re.S)
            # Functions outside of classes begin at the margin; those with a body are no symbols of the library.
            declared.update(re.findall(r'^(?!inline|typedef|using)[\w:][\w:<>,&* ]*?[ &*](\w+)\((?:[^;{}()]|\([^()]*\)|\{\})*\);', text, re.M))
            self.members = getattr(self, 'members', '') + text
        check(declared['parse'] == 3 and declared['topple_parse_cloud'] == 1, f'the headers declare {dict(declared)}')
        libraries = [os.path.join(folder, name) for folder, _, names in os.walk(self.prefix) for name in names
                     if name in ('libtopple.a', 'libtopple.so')]
        check(len(libraries) == 1, f'libtopple lies in {libraries}')
        if libraries[0].endswith('.so'):
            return self.check_exports('its linker', libraries[0], declared)
        linkers = [linker for linker in ('bfd', 'gold', 'lld', 'mold') if shutil.which('ld.' + linker)]
        check(linkers, 'no linker was found')
        os.environ['PKG_CONFIG_PATH'] = os.path.join(os.path.dirname(libraries[0]), 'pkgconfig')
        needed = [flag for flag in run('pkg-config', '--libs', 'topple').split() if flag != '-ltopple']
        for linker in linkers:
            shared = os.path.join(self.a.work, f'libtopple-{linker}.so')
            run(self.a.compiler, '-shared', '-fuse-ld=' + linker, '-Wl,--no-undefined',
                '-Wl,--version-script=' + os.path.join(self.a.source, 'host/package/exports.map'),
                '-Wl,--whole-archive', libraries[0], '-Wl,--no-whole-archive', *needed, '-o', shared)
            self.check_exports(linker, shared, declared)
            os.remove(shared)

    def check_exports(self, linker, library, declared):
        symbols = set(run('nm', '-DC', '--defined-only', '--format=posix', library).splitlines())
        # "topple::parse(...) T 12 34", "topple_parse T 12 34"; of gold's standard library nothing is ours to hide.
        shown = sorted({re.sub(r' [A-Za-z] [0-9a-f ]*$', '', symbol) for symbol in symbols if symbol.startswith('topple')})
        found = collections.Counter()
        for symbol in shown:
            scopes = re.sub(r'\[abi:\w+\]', '', symbol).split('(')[0].split('::')
            if scopes[0].startswith('topple_') or all(scope.islower() for scope in scopes[:-1]):
                found[scopes[-1]] += 1
            else:
                name = scopes[-1].removeprefix('~')
                check(name == scopes[-2] or re.search(rf'(?<!\w){re.escape(name)}\(', self.members), f'{linker}: {symbol} is shown, and no public header has it')
        check(found == declared, f'{linker}: shown more often than declared: {dict(found - declared)}; less often: {dict(declared - found)}')
        print(f'{linker}: {len(shown)} symbols')

    def adopt_opencl(self):
        source = os.path.join(self.a.source, 'tests/package/consumer')
        program = os.path.join(self.build(source, 'adopt-build', 'adopt_opencl'), 'adopt_opencl')
        self.compare(run(program, self.scan), 'native')

    def examples(self):
        """docs/examples in C++."""
        source = os.path.join(self.a.source, 'tests/package/consumer')
        built = self.build(source, 'examples-build', 'examples')
        check(re.search(r'^[1-9]\d* objects of [1-9]\d* points$', run(os.path.join(built, 'labels_in_place'), self.scan), re.M), 'no objects were found')
        out = os.path.join(self.a.work, 'example-map')
        shutil.rmtree(out + '-mujoco', ignore_errors=True)
        printed = run(os.path.join(built, 'robot'), out)
        print(printed)
        for expected in (r'^3 objects$', r'^mass of object [12]: held$', r'^object [12]: .* 3\.0 kg', r'^  stands on object [12]$',
                         r'^  an arm may touch it', r'^3 bodies in'):
            check(re.search(expected, printed, re.M), f'the map\'s example did not print {expected}')
        check(os.path.exists(out + '-mujoco/scene.xml') and os.path.exists(out + '/report.html'), 'the map\'s example wrote too little')

    def pkg_config(self):
        """docs/examples in C, without CMake."""
        folders = [folder for folder, _, names in os.walk(self.prefix) if 'topple.pc' in names]
        check(len(folders) == 1, f'topple.pc lies in {folders}')
        os.environ['PKG_CONFIG_PATH'] = folders[0]
        flags = run('pkg-config', '--cflags', '--libs', 'topple').split()
        with open(os.path.join(self.a.source, 'CMakeLists.txt'), encoding='utf-8') as file:
            version = re.search(r'VERSION (\d+\.\d+\.\d+) LANGUAGES', file.read()).group(1)
        check(run('pkg-config', '--modversion', 'topple').strip() == version, 'topple.pc names another version')
        program = os.path.join(self.a.work, 'risky_objects')
        run(self.a.c_compiler, '-std=c99', '-Wall', '-Wextra', '-Wpedantic', '-Werror',
            os.path.join(self.a.source, 'docs/examples/risky_objects.c'), *flags, '-Wl,-rpath,' + folders[0] + '/..',
            '-o', program)
        printed = run(program, self.scan)
        self.compare(printed, 'auto')
        check(re.search(r"floor's normal is \(-0.60, -?0.00, 0.80\)", printed), 'the normal is wrong')

    def use_python_package(self):
        folders = [folder for folder, _, names in os.walk(self.prefix) if 'py.typed' in names]
        check(len(folders) == 1, f'the Python package lies in {folders}')
        os.environ['PYTHONPATH'] = os.path.dirname(folders[0])
        os.chdir(self.a.work)
        at = run(sys.executable, '-c', 'import topple; print(topple.__file__)').strip()
        check(at.startswith(folders[0]), f'Python imports {at}')

    # Those of tests/python that take packages of others.
    OTHERS = ('test_formats.py', 'test_odd_callers.py', 'test_ros_bags.py', 'test_strangers.py', 'test_viewers.py')

    def python(self):
        """tests/python, by pytest, but for those that python_formats runs."""
        self.use_python_package()
        tests = os.path.join(self.a.source, 'tests/python')
        left = [f'--ignore={os.path.join(tests, name)}' for name in self.OTHERS]
        print(run(sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', *left, tests))

    def python_formats(self):
        """By the Python that has these packages, which ./dev setup installs."""
        self.use_python_package()
        wanted = ['lazrs', 'laspy', 'pye57', 'rosbags', 'mcap_ros2', 'mcap_protobuf', 'foxglove_schemas_protobuf', 'liblzfse', 'OpenEXR', 'PIL',
                  'pytest']
        if not os.path.exists(self.a.venv_python):
            print(f'{self.a.venv_python} is missing: ./dev setup')
            sys.exit(SKIPPED)
        found = 'import importlib.util as u, sys; print(*[p for p in sys.argv[1:] if u.find_spec(p) is None])'
        missing = run(self.a.venv_python, '-c', found, *wanted).split()
        if missing:
            print(f'{self.a.venv_python} has no {", ".join(missing)}: ./dev setup')
            sys.exit(SKIPPED)
        tests = [os.path.join(self.a.source, 'tests/python', name) for name in self.OTHERS]
        print(run(self.a.venv_python, '-m', 'pytest', '-q', '-rs', '-p', 'no:cacheprovider', *tests))

    def python_example(self):
        """docs/examples in Python."""
        self.use_python_package()
        if subprocess.run([sys.executable, '-c', 'import matplotlib'], capture_output=True).returncode:
            print('matplotlib is missing: apt-get install python3-matplotlib')
            sys.exit(SKIPPED)
        picture = os.path.join(self.a.work, 'room.png')
        printed = run(sys.executable, os.path.join(self.a.source, 'docs/examples/room.py'), self.scan, picture)
        self.compare(printed, 'auto')
        check(os.path.getsize(picture) > 50000, 'the picture is as good as empty')

    def notebooks(self):
        """docs/notebooks, from their first cell to their last."""
        self.use_python_package()
        if subprocess.run([sys.executable, '-c', 'import matplotlib'], capture_output=True).returncode:
            print('matplotlib is missing: apt-get install python3-matplotlib')
            sys.exit(SKIPPED)
        os.environ['MPLBACKEND'] = 'Agg'
        folder = os.path.join(self.a.source, 'docs/notebooks')
        scripts = sorted(name for name in os.listdir(folder) if name.endswith('.py'))
        check(len(scripts) >= 3, f'docs/notebooks has {scripts}')
        for script in scripts:
            work = os.path.join(self.a.work, script[:-3])
            shutil.rmtree(work, ignore_errors=True)
            os.makedirs(work)
            os.chdir(work)
            print(run(sys.executable, os.path.join(folder, script)))
            pictures = [name for name in os.listdir(work) if name.endswith('.png')]
            check(len(pictures) == 1 and os.path.getsize(pictures[0]) > 20000, f'{script} made the pictures {pictures}')
        check(os.path.exists(os.path.join(self.a.work, 'first_report/first-report/report.html')), 'no report was written')

    def compare(self, printed, backend):
        """The number of objects that was printed is that of `topple parse` on that backend."""
        print(printed)
        found = re.search(r'^(\d+) objects', printed, re.M)
        check(found, 'no number of objects was printed')
        check(int(found.group(1)) == self.parsed(backend), f'topple parse finds {self.parsed(backend)} objects')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('test', choices=['install', 'example', 'headers', 'exports', 'adopt_opencl', 'examples', 'pkg_config', 'python',
                                         'python_formats', 'python_example', 'notebooks'])
    for name in ('source', 'build', 'work', 'cmake', 'generator', 'c-compiler', 'compiler', 'build-type', 'venv-python'):
        parser.add_argument('--' + name, required=True)
    arguments = parser.parse_args()
    getattr(Package(arguments), arguments.test)()


if __name__ == '__main__':
    main()
