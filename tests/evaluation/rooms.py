# SPDX-License-Identifier: MIT
"""Generated rooms for the judges in this folder that ask MuJoCo."""
import os
import subprocess

import mujoco

KINDS = ('plain varied kitchen bathroom bedroom living office shop storage corridor precarious tabletop library meeting '
         'lounge laundry depot').split()
UNSTABLE = [mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC]


def run(*command):
    subprocess.run(command, check=True, capture_output=True)


def generate(topple, kind, seed, folder):
    """The scan of a room, in a folder of this folder."""
    scan = os.path.join(folder, 'scan')
    run(topple, 'generate', scan, '--seed', str(seed), *(['--furniture', 'varied'] if kind == 'varied' else ['--kind', kind]))
    return scan


def add_options(parser, rooms):
    """Of which rooms; the default is so many of each kind."""
    parser.add_argument('topple')
    parser.add_argument('--rooms', type=int, default=rooms, help=f'of each kind ({rooms})')
    parser.add_argument('--first-seed', type=int, default=501)
    parser.add_argument('--kinds', default=','.join(KINDS), help='comma-separated; empty: none')
    parser.add_argument('--jobs', type=int, default=1, help='rooms at a time (1)')


def chosen(arguments):
    """(kind, seed) of each."""
    return [(kind, seed) for seed in range(arguments.first_seed, arguments.first_seed + arguments.rooms)
            for kind in arguments.kinds.split(',') if kind]
