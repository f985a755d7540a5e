#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Kills parses in blocks at random times, and turns bits of what they leave; the next run must give the same bytes.

    resume.py --topple build/release/topple [--kills N] [--flips N] [--rooms N] [--seed S]

A trial of kills ends a run by SIGKILL one to three times, each time going on with what is there, and lets the last one
end. A trial of flips ends one by SIGKILL, turns a bit, or cuts off the end, of one file of the work folder, and lets the
next run end, which must tell of it unless the file was one that is only complete together with another. What comes out
must be what a run that nothing happened to gives, and the work folder must be gone.
"""
import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import inputs  # noqa: E402
from inject import same_files  # noqa: E402

WORK = ".out.topple-work"


class Trials:
    def __init__(self, args, folder):
        self.args, self.folder = args, folder
        self.random = random.Random(args.seed)
        self.cloud = folder / "cloud.ply"
        self.options = ["--backend", "native", "--tile", "5", "--walks", "4"]
        if args.rooms:
            subprocess.run([args.topple, "generate", self.cloud, "--building", "--spacing", "0.03", "--seed", "3", "--points",
                            str(150000 * args.rooms)], check=True, stdout=subprocess.DEVNULL)
            self.options += ["--voxel", "0.06"]
        else:
            inputs.write_ply(self.cloud)
            self.options += ["--voxel", "0.08"]
        self.work = folder / "work"
        self.sound = folder / "sound"
        self.sound.mkdir()
        begin = time.monotonic()
        code, err = self.finish(self.sound)
        self.normal_s = time.monotonic() - begin
        if code != 0:
            raise SystemExit("resume.py: fails without a fault: " + err)

    def start(self, where):
        return subprocess.Popen([self.args.topple, "parse", self.cloud, *self.options, "-o", where / "out"],
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def finish(self, where):
        process = self.start(where)
        _, err = process.communicate(timeout=600)
        return process.returncode, err

    def kill(self):
        """Whether the run was still going on."""
        process = self.start(self.work)
        try:
            process.communicate(timeout=self.random.uniform(0.02, 1.0) * self.normal_s)
            return False
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return True

    def wrong(self, code, err):
        """What is wrong with the last run; empty where nothing is."""
        if code != 0:
            return "code %s: %s" % (code, err.splitlines()[-1:])
        if not same_files(self.work / "out", self.sound / "out"):
            return "another result"
        # A run that was killed while it wrote OUT leaves that folder, as is documented.
        left = [n for n in os.listdir(self.work) if n != "out" and not n.startswith(".topple-")]
        return "left over: %s" % left if left else ""

    def fresh(self):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()

    def try_kills(self):
        self.fresh()
        killed = sum(self.kill() for _ in range(self.random.randint(1, 3)))
        return killed, self.wrong(*self.finish(self.work))

    def damage(self):
        """The name of the file that was damaged; None where there is none yet."""
        work = self.work / WORK
        names = sorted(n for n in os.listdir(work) if n != "topple-lock") if work.is_dir() else []
        sizes = {n: (work / n).stat().st_size for n in names}
        names = [n for n in names if sizes[n] > 0 and not n.endswith(".part")]
        if not names:
            return None
        name = self.random.choice(names)
        file, size = work / name, sizes[name]
        if self.random.random() < 0.2:
            os.truncate(file, self.random.randrange(size))
        else:
            with open(file, "r+b") as stream:
                at = self.random.randrange(size)
                stream.seek(at)
                byte = stream.read(1)[0] ^ (1 << self.random.randrange(8))
                stream.seek(at)
                stream.write(bytes((byte,)))
        return name

    def try_flip(self):
        """(the damaged file, whether it was told, what is wrong); the first is None where none could be damaged."""
        for _ in range(20):
            self.fresh()
            if self.kill():
                before = set(os.listdir(self.work / WORK)) if (self.work / WORK).is_dir() else set()
                name = self.damage()
                if name:
                    break
        else:
            return None, False, ""
        code, err = self.finish(self.work)
        wrong = self.wrong(code, err)
        told = "is damaged and is made anew" in err
        # Without its last file a group is not finished, and none of it is looked at; without its manifest nothing is.
        group = "cells-" + name.split("-", 1)[1] if name.startswith("numbers-") else name
        group = "bins.bin" if name in ("points.bin", "colours.bin") else group
        if not wrong and not told and name != "topple-work" and group in before:
            wrong = "not told of " + name
        return name, told, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--topple", required=True, type=os.path.abspath)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--flips", type=int, default=20)
    parser.add_argument("--rooms", type=int, default=0, help="of a building (default: a floor and a box, which takes less)")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="topple-resume-") as temporary:
        trials = Trials(args, Path(temporary))
        bad = kills = 0
        for n in range(args.kills):
            killed, wrong = trials.try_kills()
            kills += killed
            if wrong:
                bad += 1
                print("kills %d: %s" % (n, wrong), flush=True)
        print("%d trials, %d runs killed, %d wrong" % (args.kills, kills, bad), flush=True)
        names, told, bad_flips = {}, 0, 0
        for n in range(args.flips):
            name, was_told, wrong = trials.try_flip()
            kind = (name or "none").split("-")[0]
            names[kind] = names.get(kind, 0) + 1
            told += was_told
            if wrong:
                bad_flips += 1
                print("flips %d: %s" % (n, wrong), flush=True)
        print("%d files damaged (%s), %d told, %d wrong" %
              (args.flips, ", ".join("%s %d" % kind for kind in sorted(names.items())), told, bad_flips))
    sys.exit(1 if bad + bad_flips else 0)


if __name__ == "__main__":
    main()
