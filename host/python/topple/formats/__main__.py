# SPDX-License-Identifier: MIT
"""python3 -m topple.formats convert IN OUT: other programs' scans as `topple parse` reads them; play BAG OUT: for `topple live`."""
import argparse
import os
import sys

from .._arrays import printable
from . import Options, convert, play
from .errors import Error

EXIT_CODES = {'usage': 2}  # as of the program; else 1


def main():
    parser = argparse.ArgumentParser(prog='python3 -m topple.formats', description=__doc__)
    commands = parser.add_subparsers(dest='command', required=True)
    one = commands.add_parser('convert', help='make a cloud or a folder of depth frames of a scan in another format')
    one.add_argument('scan', metavar='IN', help='.laz, .e57, .mcap, .db3, .bag, .r3d, a .zip of Polycam or Record3D, or a folder of COLMAP, '
                                                'of a bag or of one of those exports')
    one.add_argument('out', metavar='OUT', help='.ply or .pcd for a cloud, .las of a .laz, or a folder for depth frames')
    one.add_argument('--unit-m', type=float, default=1.0, metavar='METRES', help='metres of a unit of a COLMAP model or of a cloud far from its origin')
    one.add_argument('--topic', help='of a bag, rather than the one of most messages')
    one.add_argument('--no-isolate', action='store_true', help='read in this process, without limits of memory and time')
    bag = commands.add_parser('play', help='write the depth frames of a bag of ROS at their pace, for topple live; or its clouds, for topple live -')
    bag.add_argument('scan', metavar='BAG', help='.mcap, .db3, .bag, or a folder of a bag')
    bag.add_argument('out', metavar='OUT', help='folder for the frames; -: as messages on standard output, of frames or clouds')
    bag.add_argument('--rate', type=float, default=1.0, help='how many times as fast')
    bag.add_argument('--topic', help='rather than the one of most messages')
    asked = parser.parse_args()
    try:
        if asked.command == 'play':
            to_output = asked.out == '-'
            for note in play(asked.scan, sys.stdout.buffer if to_output else asked.out, asked.rate, asked.topic):
                print(note, file=sys.stderr if to_output else sys.stdout)
            return 0
        converted = convert(asked.scan, asked.out, Options(unit_m=asked.unit_m, topic=asked.topic, isolate=not asked.no_isolate))
    except Error as error:
        print(f'topple.formats: {error}', file=sys.stderr)
        return EXIT_CODES.get(error.kind, 1)
    except BrokenPipeError:  # who reads the messages has ended, and says why
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        return 130
    for note in converted.notes:
        print(note)
    print(printable(str(converted.path)))
    return 0


if __name__ == '__main__':
    sys.exit(main())
