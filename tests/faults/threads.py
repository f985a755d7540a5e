#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs topple where the system gives it few threads (ulimit -u): threads.py --topple TOPPLE

Each run must end by itself: with its output, or with exit code 1, one line and none. Takes root, which has no such
limit and so runs it as a user who has no processes; else exit code 77.
"""
import argparse
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

import inputs

NOBODY = 65533


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--topple', required=True, type=pathlib.Path)
    a = parser.parse_args()
    program = a.topple.resolve()
    if os.geteuid() != 0:
        print('skipped: not root')
        return 77
    wrong = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        inputs.write_xyz(folder / 'cloud.xyz')
        inputs.write_obj(folder / 'mesh.obj')
        os.chmod(folder, 0o777)

        def limited(threads):
            resource.setrlimit(resource.RLIMIT_NPROC, (threads, threads))
            os.setgid(NOBODY)
            os.setuid(NOBODY)

        for threads in list(range(1, 12)) + [16, 24]:
            for file in ('cloud.xyz', 'mesh.obj'):
                out = folder / ('out-%d-%s' % (threads, file))
                try:
                    done = subprocess.run([program, 'parse', folder / file, '-o', out, '--quiet', '--backend', 'native',
                                           '--walks', '5'], preexec_fn=lambda: limited(threads), timeout=300,
                                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
                except PermissionError:
                    print('skipped: another user may not run %s' % program)
                    return 77
                right = (done.returncode == 0 and out.exists() and not done.stderr or
                         done.returncode == 1 and len(done.stderr.splitlines()) == 1 and not out.exists())
                wrong += not right
                print('%2d threads, %s: %s %s %s' % (threads, file, 'right' if right else 'WRONG', done.returncode,
                                                   done.stderr.strip()), flush=True)
                shutil.rmtree(out, ignore_errors=True)
    return wrong > 0


if __name__ == '__main__':
    sys.exit(main())
