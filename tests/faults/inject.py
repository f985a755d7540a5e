#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fails allocations, writes, renames and syncs of topple one at a time, and looks at what it does then.

    inject.py --topple build/release/topple --shim build/release/tests/faults/libfaults.so [options]

For each kind of run (a cloud, frames, a mesh, blocks ...) and each kind of fault it runs topple once for every call that
could fail (or --runs of them, evenly spread). Each run must end by itself, with exit code 1, one line on stderr, no OUT
and nothing left over; or with 0 and the same OUT as without a fault, where topple could do without. What an interrupted
parse in blocks leaves must lead the next run to the same OUT.

The fault "fork" fails every --every-th allocation of a run's stages before the output, each in a child forked there, so
that all of them can be tried in one run; "memory" fails one allocation a run, with two threads and with all stages.
"""
import argparse
import filecmp
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import inputs  # noqa: E402

PARSE = ["--backend", "native", "--voxel", "0.08", "--walks", "4", "--quiet"]
# Kind of run: arguments, {in} and {ref} being the folders of inputs and of results that stand beforehand.
KINDS = {
    "cloud": ["parse", "{in}/cloud.ply"],
    "text": ["parse", "{in}/cloud.xyz", "--up", "0,0,1"],
    "las": ["parse", "{in}/cloud.las"],
    "mesh": ["parse", "{in}/mesh.obj", "--glb", "--octomap"],
    "frames": ["parse", "{in}/frames"],
    "single": ["parse", "{in}/single", "--up", "0,-1,0"],
    "octomap": ["parse", "{in}/map.bt"],
    "volume": ["parse", "{in}/volume.vdb"],
    "blocks": ["parse", "{in}/cloud.ply", "--tile", "5"],
    "again": ["parse", "{in}/cloud.ply"],  # over an earlier output
    "pictures": ["parse", "{in}/cloud.ply", "--png"],
    "landscape": ["landscape", "{ref}"],
    "estimate": ["estimate", "{in}/cloud.ply"],
}
# Of these no allocation fails: cairo chooses fonts by fontconfig, and estimate looks for drivers, which crash where they
# get no memory, or print that.
FOREIGN = {"pictures", "landscape", "estimate"}
DISK_FAULTS = ["ENOSPC", "EIO", "short"]
# They hold the times of their run.
UNEQUAL = {"scene.json", "report.html"}
GRACE_S = 10


class Failure(Exception):
    pass


def same_files(a, b):
    # Where no cache can be written the parse does without.
    names, others = (sorted(set(os.listdir(folder)) - {"parse.cache"}) for folder in (a, b))
    if names != others:
        return False
    return all(n in UNEQUAL or filecmp.cmp(a / n, b / n, shallow=False) for n in names)


class Kind:
    """One kind of run, and what it gives without a fault."""

    def __init__(self, name, args, folder):
        self.name, self.args, self.folder = name, args, folder
        self.sound = folder / ("sound-" + name)
        self.normal_s = 0

    def command(self, out, threads, fault):
        words = [w.format(**{"in": self.folder / "inputs", "ref": self.folder / "sound-cloud/out"}) for w in KINDS[self.name]]
        if words[0] == "parse":
            # The cache is written amid the stages, and no child is forked once a file is.
            no_cache = ["--no-cache"] if fault and fault.startswith("fork") else []
            return [self.args.topple, *words, *PARSE, *no_cache, "--threads", str(threads), "-o", str(out)]
        if words[0] == "landscape":
            return [self.args.topple, *words, "-o", str(out / "picture.png")]
        return [self.args.topple, *words, "--voxel", "0.08", "--quiet"]

    def prepare(self, work):
        """The folder that a run works in, as it stands before."""
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        if self.name == "again":
            shutil.copytree(self.folder / "sound-cloud/out", work / "out")
        if self.name == "landscape":
            (work / "out").mkdir()

    def run(self, work, fault=None, threads=2, limit_s=60, core=None):
        """(code, lines on stderr, what the shim told, seconds); code None: it had to be killed."""
        environment = dict(os.environ)
        read_end, write_end = os.pipe()
        if fault:
            environment.update({"LD_PRELOAD": self.args.shim, "TOPPLE_FAULT": fault, "TOPPLE_FAULT_TELL": str(write_end)})
        begin = time.monotonic()
        process = subprocess.Popen(
            self.command(work / "out", threads, fault), cwd=work, env=environment, pass_fds=(write_end,), stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
            preexec_fn=(lambda: os.sched_setaffinity(0, {core})) if core is not None else None)
        os.close(write_end)
        with os.fdopen(read_end, errors="replace") as told:
            if fault and fault.startswith("fork"):
                report = told.read()  # as it comes: it may be longer than a pipe holds
            try:
                _, err = process.communicate(timeout=limit_s)
                code = process.returncode
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                _, err = process.communicate()
                code = None
            if not (fault and fault.startswith("fork")):
                report = told.read()
        return code, err.splitlines(), report, time.monotonic() - begin

    def make_sound(self):
        self.prepare(self.sound)
        code, err, _, self.normal_s = self.run(self.sound)
        if code != 0:
            raise SystemExit("inject.py: %s fails without a fault: %s" % (self.name, err))

    def calls(self, fault, threads=2):
        work = self.folder / ("count-" + self.name)
        self.prepare(work)
        _, _, report, _ = self.run(work, fault + ":0", threads)
        shutil.rmtree(work)
        return int(re.search(r"calls (\d+)", report).group(1))

    def try_fault(self, fault, work):
        """Raises Failure where the run does not end as it should; else whether it was refused."""
        self.prepare(work)
        code, err, _, seconds = self.run(work, fault, limit_s=self.normal_s + GRACE_S)
        if code is None:
            raise Failure("no end after %.0f s" % seconds)
        if code not in (0, 1):
            raise Failure("code %d: %s" % (code, err[:3]))
        if len(err) != code or (err and not err[0].startswith("topple: ")):
            raise Failure("code %d and %d lines on stderr: %s" % (code, len(err), err[:3]))
        left = set(os.listdir(work)) - {"out"}
        if self.name == "blocks" and code == 1:
            left -= {".out.topple-work"}
        if left:
            raise Failure("code %d and left over: %s" % (code, sorted(left)))
        has_out = (work / "out").exists()
        if code == 0 and has_out and not same_files(work / "out", self.sound / "out"):
            raise Failure("code 0, but OUT is another one")
        if code == 1 and self.name == "again" and not same_files(work / "out", self.folder / "sound-cloud/out"):
            raise Failure("the earlier OUT has changed")
        if code == 1 and self.name == "landscape" and os.listdir(work / "out"):
            raise Failure("left a part of a picture")
        if code == 1 and self.name not in ("again", "landscape") and has_out:
            raise Failure("left an OUT: %s" % sorted(os.listdir(work / "out")))
        if self.name == "blocks" and code == 1:
            code2, err2, _, _ = self.run(work)
            if code2 != 0 or not same_files(work / "out", self.sound / "out") or os.listdir(work) != ["out"]:
                raise Failure("the next run: code %s, %s, %s" % (code2, err2[:2], os.listdir(work)))
        return code == 1


def spread(first, calls, runs):
    """Numbers from first to calls, all or `runs` of them evenly."""
    span = max(calls - first + 1, 0)
    if not runs or runs >= span:
        return range(first, calls + 1)
    return sorted({first + (2 * n + 1) * span // (2 * runs) for n in range(runs)})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--topple", required=True, type=os.path.abspath)
    parser.add_argument("--shim", required=True, type=os.path.abspath)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=list(KINDS))
    parser.add_argument("--faults", nargs="+", choices=["fork", "memory", *DISK_FAULTS], default=["fork", "memory", *DISK_FAULTS])
    parser.add_argument("--runs", type=int, default=0, help="of each kind and fault (default: all)")
    parser.add_argument("--first", type=int, default=1, help="of the calls that may fail")
    parser.add_argument("--every", type=int, default=1, help="of the fault fork: every so manyth allocation")
    parser.add_argument("--lasting", action="store_true", help="all allocations after the one that fails do so, too")
    args = parser.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory(prefix="topple-faults-") as temporary:
        folder = Path(temporary)
        inputs.write_all(folder / "inputs")
        kinds = {name: Kind(name, args, folder) for name in KINDS}
        # What other kinds start from.
        for name in ("cloud", "mesh"):
            kinds[name].make_sound()
        shutil.copy(kinds["mesh"].sound / "out/map.bt", folder / "inputs/map.bt")
        shutil.copy(kinds["cloud"].sound / "out/volume.vdb", folder / "inputs/volume.vdb")
        for name in args.kinds:
            kind = kinds[name]
            kind.make_sound()
            for fault in args.faults:
                if name in FOREIGN and fault in ("fork", "memory"):
                    continue
                begin = time.monotonic()
                if fault == "fork":
                    work = folder / "work"
                    kind.prepare(work)
                    core = min(os.sched_getaffinity(0))
                    code, err, report, _ = kind.run(work, "fork:%d%s" % (args.every, "+" if args.lasting else ""), threads=1, limit_s=36000, core=core)
                    total = re.search(r"calls (\d+) children (\d+) refused (\d+) unaware (\d+) wrong (\d+)", report)
                    if code != 0 or not total:
                        print("%s %s: the run itself failed: %s %s" % (name, fault, err[:2], report[-300:]))
                        wrong += 1
                        continue
                    calls, runs, refused, unaware, bad = map(int, total.groups())
                    lines = report.splitlines()
                    if "TOPPLE_FAULT_TRACE" not in os.environ:
                        lines = [l for l in lines if l.startswith("wrong")][:20]
                    for line in lines:
                        print("  %s %s: %s" % (name, fault, line))
                else:
                    calls = kind.calls(fault)
                    runs = refused = bad = 0
                    if calls == 0:
                        bad = 1
                        print("  %s %s: no such call: this tries nothing" % (name, fault))
                    for n in spread(args.first, calls, args.runs):
                        runs += 1
                        try:
                            refused += kind.try_fault("%s:%d%s" % (fault, n, "+" if args.lasting and fault == "memory" else ""), folder / "work")
                        except Failure as failure:
                            bad += 1
                            print("  %s %s:%d: %s" % (name, fault, n, failure))
                wrong += bad
                print("%-10s %-7s %8d calls, %8d failed: %8d refused, %d as they should not (%.0f s)" %
                      (name, fault, calls, runs, refused, bad, time.monotonic() - begin), flush=True)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
