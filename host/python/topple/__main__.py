# SPDX-License-Identifier: MIT
"""`python -m topple`, and the command `topple` of a wheel: the program, in the place of this process."""
import os
import sys

from ._program import program


def main():
    path = program()
    os.execv(path, ['topple', *sys.argv[1:]])


if __name__ == '__main__':
    main()
