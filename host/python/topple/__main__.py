# SPDX-License-Identifier: MIT
"""`python -m topple`, and the command `topple` of a wheel: the program, in the place of this process."""
import os
import sys

from ._program import program


def main():
    path = program()
    folder = os.path.dirname(path)
    if sys.argv[1:2] == ['verify'] and folder == os.path.dirname(os.path.abspath(__file__)) and not {'-h', '--help'} & set(sys.argv):
        # Said before the export, which takes a while.
        sys.stderr.write('topple: verify takes MuJoCo, which the wheel leaves out; use a build (./dev build), or, with '
                         '`pip install mujoco`, export with --mjcf and run docs/examples/stays.py on it\n')
        sys.exit(3)
    os.execv(path, ['topple', *sys.argv[1:]])


if __name__ == '__main__':
    main()
