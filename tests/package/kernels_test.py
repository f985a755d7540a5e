#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A program with kernels of its own, as a stranger's project.

  kernels_test.py --source DIR --work DIR --cmake FILE --generator NAME --compiler FILE

Configures, builds and installs topple with TOPPLE_ONLY=kernels, moves what was installed elsewhere, and builds
docs/examples/own-kernel against it, in a copy: it runs on each form with the same bits, mistakes are told by the
project's own lines, indices outside at run time, what changes is built anew, its test and benchmark pass and can fail, and names don't clash.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys

from package_test import SKIPPED, check, run

FORMS = ('native', 'opencl', 'vulkan', 'vulkan_as_gpu')
# None of these is looked for, though all of topple takes them.
OF_TOPPLE = re.compile(r'OpenVDB|Eigen|TBB|Qhull|assimp|CLI11|nlohmann|PNG|Boost|cairo', re.I)
WARNINGS = '-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror'


class Project:
    def __init__(self, arguments):
        self.a = arguments
        self.prefix = os.path.join(arguments.work, 'prefix')
        self.source = os.path.join(arguments.work, 'own-kernel')
        self.build = os.path.join(arguments.work, 'own-kernel-build')

    def configure(self, source, build, *options):
        run(self.a.cmake, '-S', source, '-B', build, '-G', self.a.generator, '-DCMAKE_CXX_COMPILER=' + self.a.compiler, *options)
        with open(os.path.join(build, 'CMakeCache.txt'), encoding='utf-8') as file:
            return re.findall(r'^(\w+):\w+=', file.read(), re.M)

    def install(self):
        build, first = os.path.join(self.a.work, 'build'), os.path.join(self.a.work, 'first')
        looked_for = [name for name in self.configure(self.a.source, build, '-DTOPPLE_ONLY=kernels', '-DCMAKE_UNITY_BUILD=ON', '-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG') if OF_TOPPLE.search(name)]
        check(not looked_for, f'TOPPLE_ONLY=kernels looks for {looked_for}')
        run(self.a.cmake, '--build', build)
        run(self.a.cmake, '--install', build, '--prefix', first)
        os.rename(first, self.prefix)
        for folder, _, names in os.walk(self.prefix):
            for name in names:
                with open(os.path.join(folder, name), 'rb') as file:
                    check(self.a.source.encode() not in file.read(), f'{folder}/{name} names {self.a.source}')

    def make(self):
        """Whether the project builds, and what that prints."""
        done = subprocess.run([self.a.cmake, '--build', self.build], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        return done.returncode == 0, done.stdout

    def change(self, name, before, after):
        path = os.path.join(self.source, name)
        with open(path, encoding='utf-8') as file:
            text = file.read()
        check(text.count(before) == 1, f'{name} has {before!r} {text.count(before)} times')
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text.replace(before, after))

    def outputs(self):
        """What my_app prints on each form that there is here."""
        printed = {}
        for form in FORMS:
            done = subprocess.run([os.path.join(self.build, 'my_app'), form], capture_output=True, text=True)
            if done.returncode == 0:
                printed[form] = done.stdout
            elif os.environ.get('TOPPLE_REQUIRE_BACKENDS') == '1' or form == 'native':
                sys.exit(f'my_app {form}: {done.stderr}')
        return printed

    def runs(self):
        """The same bits on each form, which are the heights' means."""
        built, said = self.make()
        check(built, said)
        printed = self.outputs()
        check(len(set(printed.values())) == 1, f'the forms differ: {printed}')
        got = [float.fromhex(line) for line in printed['native'].split()]
        height = [0.1 if i < 50 else 0.7 for i in range(100)]
        weight = [1 + i % 7 for i in range(100)]
        for i, value in enumerate(got):
            near = [max(i - 1, 0), i, min(i + 1, 99)]
            want = sum(weight[k] * height[k] for k in near) / sum(weight[k] for k in near)
            check(abs(value - want) < 1e-6, f'height {i} is {value}, not {want}')
        check(len(got) == 100, f'{len(got)} heights')
        return list(printed)

    def sorts(self):
        """With the primitives, which are installed, too."""
        before = {'#include "topple/kernels/queue.h"\n': '#include "topple/kernels/primitives/sort.h"\n', '    queue.run();\n': """    using Words = Buffer<std::uint32_t>;
    const std::vector<std::uint32_t> numbers{7, 1, 4, 1};
    const Words keys(*device, numbers, "keys"), sorted(*device, numbers.size(), "sorted");
    topple::primitives::Scratch scratch(*device);
    topple::primitives::sort(queue, scratch, {keys, {}, {}}, {sorted, {}, {}});
    queue.run();
    for (const auto key : sorted.download()) std::printf("key %u\\n", key);
"""}
        links = {'COMPONENTS kernels': 'COMPONENTS kernels kernel_primitives', 'my_app PRIVATE my_kernels': 'my_app PRIVATE my_kernels topple::kernel_primitives'}
        for place, then in before.items():
            self.change('main.cpp', place, then)
        for place, then in links.items():
            self.change('CMakeLists.txt', place, then)
        built, said = self.make()
        check(built, said)
        for form, printed in self.outputs().items():
            check(re.findall(r'key (\d+)', printed) == ['1', '1', '4', '7'], f'{form}: {printed}')
        for place, then in before.items():
            self.change('main.cpp', then, place)
        for place, then in links.items():
            self.change('CMakeLists.txt', then, place)

    def tells_mistakes(self):
        last = 'smoothed[i] = sum / '
        for wrong, expected in ((last + '4.0 * ', r'smooth\.kernel:17: 4\.0 is a double in C\+\+ and OpenCL C; write the f behind it'),
                                (last + 'p.cout * ', r"smooth\.kernel:17: 'cout' : no such field in structure")):
            self.change('smooth.kernel', last, wrong)
            built, said = self.make()
            check(not built and re.search('(^|[ \n])' + expected, said), f'{wrong} should be refused by "{expected}":\n{said}')
            self.change('smooth.kernel', wrong, last)
        self.change('my_params.h', 'uint count;', 'double count;')
        built, said = self.make()
        check(not built and 'my_params.h: SmoothParams.count has type double' in said, said)
        self.change('my_params.h', 'double count;', 'uint count;')

    def names_accesses_outside(self):
        """Of the project's own kernel, where it asks for that."""
        right, wrong = 'smoothed[i] = ', 'smoothed[i + 1u] = '
        self.configure(self.source, self.build, '-DTOPPLE_CHECKED_KERNELS=ON')
        self.change('smooth.kernel', right, wrong)
        built, said = self.make()
        check(built, said)
        for form in self.outputs():
            done = subprocess.run([os.path.join(self.build, 'my_app'), form], env=os.environ | {'TOPPLE_CHECK': 'bounds'}, capture_output=True, text=True)
            check(done.stderr == 'kernel smooth: work-item 99 writes smoothed[100], which has 100 elements\n', f'{form}: {done.stderr}')
        self.change('smooth.kernel', wrong, right)
        self.configure(self.source, self.build, '-DTOPPLE_CHECKED_KERNELS=OFF')

    def builds_anew(self):
        """After a change of the kernel, of its parameters or of the tool; and not else."""
        built, said = self.make()
        check(built, said)
        built, said = self.make()
        check('Kernel smooth' not in said, f'the kernel is built though nothing changed:\n{said}')
        tool = os.path.join(self.prefix, 'share/topple/kernels/tools/build_kernels.py')
        for changed in (os.path.join(self.source, 'smooth.kernel'), os.path.join(self.source, 'my_params.h'), tool):
            os.utime(changed)
            built, said = self.make()
            check(built and 'Kernel smooth' in said, f'{changed} changed, and the kernel is not built:\n{said}')

    def checks(self):
        """The project's test and benchmark: they pass, and see where one form differs."""
        test, perf = (os.path.join(self.build, 'checks', name) for name in ('smooth_test', 'my_perf'))
        measure = [perf, 'perf', '--filter', 'smooth', '--runs', '2', '--no-roofline']
        print(run(test))
        table = os.path.join(self.a.work, 'perf.json')
        print(run(*measure, '--json', table))
        with open(table, encoding='utf-8') as file:
            results = json.load(file)['results']
        check({(r['case'], len(r['samples_s'])) for r in results} == {('smooth', 2)}, f'my_perf wrote {results}')
        said = run(perf, 'compare', perf, '--rounds', 1, '--samples', 1, '--least', 9, '--filter', 'smooth')
        check('counts and results: the same' in said and 'slower: nothing' in said, said)
        measured = run(*measure[:2], '--backend', 'native', '--runs', 1, '--filter', 'smooth')
        check(re.search(r'^triad .*\n(.*\n)*smooth .* % (memory|arithmetic|divisions) ', measured, re.M), measured)

        right, wrong = '    }\nEND', '#ifdef TOPPLE_NATIVE\n        smoothed[i] = 1.0f;\n#endif\n    }\nEND'
        self.change('smooth.kernel', right, wrong)
        built, said = self.make()
        check(built, said)
        failed = subprocess.run([test], stdout=subprocess.PIPE, text=True)
        check(failed.returncode == 1 and '[  FAILED  ] Device/Smooth.MatchesTheOracle/native' in failed.stdout, failed.stdout)
        if len({r['backend'] for r in results}) > 1:
            failed = subprocess.run(measure, capture_output=True, text=True)
            check(failed.returncode == 1 and 'perf: smooth: the result on' in failed.stderr, failed.stderr)
        self.change('smooth.kernel', wrong, right)

    def shares_names(self):
        """A kernel called as one of topple's own is another one."""
        shutil.copy(os.path.join(self.a.source, 'kernels/probes/triad.kernel'), self.source)
        self.change('CMakeLists.txt', 'smooth.kernel', 'smooth.kernel triad.kernel')
        self.change('my_params.h', "// Parameters of my_app's kernels.\n",
                    'STRUCT(TriadParams) {\n    uint count;\n    float scale;\n} STRUCT_END(TriadParams)\n')
        self.change('checks/CMakeLists.txt', 'my_perf PRIVATE my_kernels', 'my_perf PRIVATE $<LINK_LIBRARY:WHOLE_ARCHIVE,my_kernels>')
        self.runs()
        symbols = run('nm', '-C', os.path.join(self.build, 'checks', 'my_perf'))
        for name in ('my_app::Triad::source()', 'topple::kernels::Triad::source()'):
            check(f' {name}\n' in symbols, f'my_perf has no {name}')

    def tells_components(self):
        """What is not installed is named."""
        folder = os.path.join(self.a.work, 'library')
        os.makedirs(folder)
        with open(os.path.join(folder, 'CMakeLists.txt'), 'w', encoding='utf-8') as file:
            file.write('cmake_minimum_required(VERSION 3.25)\nproject(none LANGUAGES CXX)\nfind_package(topple REQUIRED)\n')
        done = subprocess.run([self.a.cmake, '-S', folder, '-B', folder + '/build', '-G', self.a.generator, '-DCMAKE_PREFIX_PATH=' + self.prefix],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        check(done.returncode and 'This installation of topple has no component library' in ' '.join(done.stdout.split()), done.stdout)


def main():
    parser = argparse.ArgumentParser()
    for name in ('source', 'work', 'cmake', 'generator', 'compiler'):
        parser.add_argument('--' + name, required=True)
    project = Project(parser.parse_args())
    shutil.rmtree(project.a.work, ignore_errors=True)
    project.install()
    shutil.copytree(os.path.join(project.a.source, 'docs/examples/own-kernel'), project.source)
    project.configure(project.source, project.build, '-DCMAKE_PREFIX_PATH=' + project.prefix, '-DCMAKE_CXX_FLAGS=' + WARNINGS)
    project.runs()
    project.sorts()
    project.tells_mistakes()
    project.names_accesses_outside()
    project.builds_anew()
    project.configure(project.source, project.build, '-DCHECKS=ON')
    forms = project.runs()
    project.checks()
    project.shares_names()
    project.tells_components()
    print('ran on ' + ', '.join(forms))
    sys.exit(0 if len(forms) == len(FORMS) else SKIPPED)


if __name__ == '__main__':
    main()
