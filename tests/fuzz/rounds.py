#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fuzzes the readers in turn for a long time and keeps the count.

  rounds.py --fuzzer FUZZ_READERS --corpus DIR --counts FILE --findings DIR --seconds N [READER[=SHARE] ...]
  rounds.py --counts FILE

FUZZ_READERS is built with the preset fuzz (AddressSanitizer and UBSan) or fuzz-fast (neither, a few times as fast).
Each reader gets a minute times its share (1 unless given) a round; all those of tests/fuzz/corpus where none is named.
DIR gets a folder of each, which should lie in memory. FILE gets a line a turn: when, fuzzer, reader, executions,
seconds of the processor, exit code, edges covered, features covered; without a fuzzer their sums are printed, and how
much of its edges each reader had found by the halves of its executions. Exit code 1 where a reader broke.
"""
import argparse
import collections
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time

TURN_S = 60
HERE = pathlib.Path(__file__).resolve().parent
# Memory stays with the process: assimp takes and gives back megabytes for each input.
TUNABLES = 'glibc.malloc.trim_threshold=268435456:glibc.malloc.mmap_threshold=67108864:glibc.malloc.top_pad=16777216'


def turn(a, reader, seconds, seed):
    corpus = a.corpus / reader
    if not corpus.exists():
        shutil.copytree(HERE / 'corpus' / reader, corpus)
    environment = dict(os.environ, TOPPLE_READER=reader, GLIBC_TUNABLES=TUNABLES,
                       ASAN_OPTIONS='allocator_may_return_null=1:detect_leaks=0')
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ran = subprocess.run([a.fuzzer, '-verbosity=1', '-print_final_stats=1', '-seed=%d' % seed, '-max_total_time=%d' % seconds,
                          '-max_len=4096', '-rss_limit_mb=2048', '-timeout=60', '-detect_leaks=0', '-entropic=0',
                          '-reduce_inputs=0', '-artifact_prefix=%s/%s-' % (a.findings, reader), corpus],
                         env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors='replace',
                         check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    executions = re.search(r'number_of_executed_units:\s*(\d+)', ran.stdout)
    covered = (re.findall(r'cov: (\d+) ft: (\d+)', ran.stdout) or [(0, 0)])[-1]
    with open(a.counts, 'a', encoding='utf-8') as counts:
        spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        print(int(time.time()), a.fuzzer.name, reader, executions.group(1) if executions else 0, '%.1f' % spent,
              ran.returncode, *covered, sep='\t', file=counts)
    if ran.returncode:
        (a.findings / ('%s-%d.log' % (reader, time.time()))).write_text(ran.stdout[-20000:])
        print('%s broke: %s' % (reader, a.findings), flush=True)
    return ran.returncode != 0


def sums(counts):
    turns = collections.defaultdict(list)
    for line in counts.read_text().splitlines():
        _, _, reader, count, spent, code, edges, features = line.split('\t')
        turns[reader].append((int(count), float(spent), code != '0', int(edges), int(features)))
    print('reader,executions,seconds,broke,edges_at_eighth,edges_at_quarter,edges_at_half,edges,features')
    for reader, of_it in sorted(turns.items()):
        total = sum(turn[0] for turn in of_it)
        done, most, reached = 0, 0, []
        for count, _, _, edges, _ in of_it:
            done, most = done + count, max(most, edges)
            reached += [most] * (sum(done >= total * part for part in (.125, .25, .5, 1)) - len(reached))
        print(reader, total, round(sum(turn[1] for turn in of_it)), sum(turn[2] for turn in of_it), *reached,
              max(turn[4] for turn in of_it), sep=',')


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--fuzzer', type=pathlib.Path)
    parser.add_argument('--corpus', type=pathlib.Path)
    parser.add_argument('--counts', type=pathlib.Path, required=True)
    parser.add_argument('--findings', type=pathlib.Path)
    parser.add_argument('--seconds', type=float, default=3600)
    parser.add_argument('--seed', type=int, default=1, help='of the first turn; each next one adds one')
    parser.add_argument('readers', nargs='*')
    a = parser.parse_args()
    if not a.fuzzer:
        return sums(a.counts)
    a.fuzzer = a.fuzzer.resolve()
    a.findings.mkdir(parents=True, exist_ok=True)
    a.corpus.mkdir(parents=True, exist_ok=True)
    readers = a.readers or sorted(path.name for path in (HERE / 'corpus').iterdir())
    end, broke, seed = time.time() + a.seconds, False, a.seed
    while time.time() < end:
        for reader in readers:
            name, _, share = reader.partition('=')
            broke |= turn(a, name, max(1, min(TURN_S * float(share or 1), end - time.time())), seed)
            seed += 1
            if time.time() >= end:
                break
    return broke


if __name__ == '__main__':
    sys.exit(main())
