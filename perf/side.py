# SPDX-License-Identifier: MIT
"""One side of a comparison: a revision that is built here, or a program that exists."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

# Of a case, beside what was counted: its own work as it tells it.
WORK = ('items', 'bytes', 'operations', 'divisions', 'gathers')
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def fail(message):
    print('compare: ' + message, file=sys.stderr)
    sys.exit(2)


def git(*arguments):
    done = subprocess.run(['git', '-C', ROOT, *arguments], capture_output=True, text=True)
    if done.returncode:
        fail(f'git {" ".join(arguments)}: {done.stderr.strip()}')
    return done.stdout.strip()


class Side:
    """`name` is a revision, or the path of a topple that is built. `edit(tree)` may change its sources first."""

    def __init__(self, label, name, folder, edit=None):
        self.label, self.name, self.edit = label, name, edit
        self.folder = os.path.join(folder, label)
        self.tree, self.build = os.path.join(self.folder, 'tree'), os.path.join(self.folder, 'build')
        self.built_here = not (os.path.isfile(name) and os.access(name, os.X_OK))
        self.program = os.path.join(self.build, 'topple') if self.built_here else os.path.abspath(name)
        self.facts = {}  # case -> (hash, counts) of every run

    def prepare(self, jobs):
        if not self.built_here:
            return
        commit = git('rev-parse', '--verify', self.name + '^{commit}')
        if os.path.isdir(self.tree):
            git('worktree', 'remove', '--force', self.tree)
        git('worktree', 'prune')
        git('worktree', 'add', '--force', '--detach', self.tree, commit)
        if self.edit:
            self.edit(self.tree)
        steps = [['cmake', '-S', self.tree, '-B', self.build, '-G', 'Ninja', '-DCMAKE_BUILD_TYPE=Release',
                  '-DTOPPLE_TESTS=OFF', '-DTOPPLE_PEERS=OFF'],
                 ['cmake', '--build', self.build, '--target', 'topple', '-j', str(jobs)]]
        # Both sides see the same relative paths, so that ccache compiles equal files once, and equal
        # revisions give equal programs.
        environment = dict(os.environ, CCACHE_BASEDIR=self.folder, CCACHE_NOHASHDIR='1')
        print(f'compare: building {self.label} {commit[:12]} ({self.name})', flush=True)
        os.makedirs(self.build, exist_ok=True)
        for step in steps:
            done = subprocess.run(step, capture_output=True, text=True, cwd=self.build, env=environment)
            if done.returncode:
                fail(f'{self.label} {self.name} does not build:\n{(done.stdout + done.stderr)[-3000:]}')

    def remove(self):
        if os.path.isdir(self.tree):
            subprocess.run(['git', '-C', ROOT, 'worktree', 'remove', '--force', self.tree], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, arguments):
        """One run of `topple perf`; (backend, case) -> seconds: the least processor time of all threads of its
        samples, or the least wall time where none was taken, or a GPU did the work."""
        with tempfile.TemporaryDirectory() as folder:
            out = os.path.join(folder, 'run.json')
            done = subprocess.run([self.program, 'perf', '--json', out, *arguments], capture_output=True, text=True)
            if done.returncode:
                fail(f'{self.label} {self.name}: topple perf failed:\n{(done.stdout + done.stderr)[-2000:]}')
            with open(out, encoding='utf-8') as file:
                results = json.load(file)['results']
        for r in results:
            counts = r['counts'] | {key: r[key] for key in WORK}
            self.facts.setdefault((r['backend'], r['case']), []).append((r['hash'], counts))
        return {(r['backend'], r['case']): r['best_s'] if r['gpu'] or not r['samples_cpu_s'] else r['best_cpu_s']
                for r in results}


def changed_facts(base, change):
    """Lines on what is exact and differs: results, and counts that each side has the same in all of its runs.
    Returns (worse, other): results that changed and counts that grew, and counts that shrank."""
    worse, other = [], []
    for case in sorted(set(base.facts) & set(change.facts)):
        name = ' '.join(case)
        hashes = [{hash_ for hash_, _ in side.facts[case]} for side in (base, change)]
        if hashes[0] != hashes[1]:
            worse.append(f'{name}: the result changed, {"/".join(sorted(hashes[0]))} to {"/".join(sorted(hashes[1]))}')
        for key in base.facts[case][0][1]:
            values = [{counts.get(key) for _, counts in side.facts[case]} for side in (base, change)]
            if values[0] == values[1] or len(values[0]) > 1 or len(values[1]) > 1:
                continue
            before, after = values[0].pop(), values[1].pop()
            (worse if after is None or after > before else other).append(f'{name}: {key} {before} to {after}')
    return worse, other
