#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fuzzes the readers in turn for a long time and keeps the count.

  rounds.py --fuzzer FUZZ_READERS --corpus DIR --counts FILE --findings DIR --seconds N [READER[=SHARE] ...]
  rounds.py --counts FILE

FUZZ_READERS is built with the preset fuzz (AddressSanitizer and UBSan) or fuzz-fast (neither, a few times as fast).
Each reader gets a minute times its share (1 unless given) a round; all those of tests/fuzz/corpus where none is named.
DIR gets a folder of each, which should lie in memory. FILE gets a line a turn: when, fuzzer, reader, executions,
seconds of the processor, exit code; without a fuzzer their sums are printed. Exit code 1 where a reader broke.
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


def turn(a, reader, seconds):
    corpus = a.corpus / reader
    if not corpus.exists():
        shutil.copytree(HERE / 'corpus' / reader, corpus)
    environment = dict(os.environ, TOPPLE_READER=reader, GLIBC_TUNABLES=TUNABLES,
                       ASAN_OPTIONS='allocator_may_return_null=1:detect_leaks=0')
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ran = subprocess.run([a.fuzzer, '-verbosity=0', '-print_final_stats=1', '-max_total_time=%d' % seconds,
                          '-max_len=4096', '-rss_limit_mb=2048', '-timeout=60', '-detect_leaks=0', '-entropic=0',
                          '-reduce_inputs=0', '-artifact_prefix=%s/%s-' % (a.findings, reader), corpus],
                         env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors='replace',
                         check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    executions = re.search(r'number_of_executed_units:\s*(\d+)', ran.stdout)
    with open(a.counts, 'a', encoding='utf-8') as counts:
        spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        print(int(time.time()), a.fuzzer.name, reader, executions.group(1) if executions else 0, '%.1f' % spent,
              ran.returncode, sep='\t', file=counts)
    if ran.returncode:
        (a.findings / ('%s-%d.log' % (reader, time.time()))).write_text(ran.stdout[-20000:])
        print('%s broke: %s' % (reader, a.findings), flush=True)
    return ran.returncode != 0


def sums(counts):
    executions, seconds, broke = collections.Counter(), collections.Counter(), collections.Counter()
    for line in counts.read_text().splitlines():
        _, fuzzer, reader, count, spent, code = line.split('\t')
        for key in (reader, fuzzer, 'all'):
            executions[key] += int(count)
            seconds[key] += float(spent)
            broke[key] += code != '0'
    for key, count in executions.most_common():
        print('%-40s %12d executions %10.0f s  %d broke' % (key, count, seconds[key], broke[key]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--fuzzer', type=pathlib.Path)
    parser.add_argument('--corpus', type=pathlib.Path)
    parser.add_argument('--counts', type=pathlib.Path, required=True)
    parser.add_argument('--findings', type=pathlib.Path)
    parser.add_argument('--seconds', type=float, default=3600)
    parser.add_argument('readers', nargs='*')
    a = parser.parse_args()
    if not a.fuzzer:
        return sums(a.counts)
    a.fuzzer = a.fuzzer.resolve()
    a.findings.mkdir(parents=True, exist_ok=True)
    a.corpus.mkdir(parents=True, exist_ok=True)
    readers = a.readers or sorted(path.name for path in (HERE / 'corpus').iterdir())
    end, broke = time.time() + a.seconds, False
    while time.time() < end:
        for reader in readers:
            name, _, share = reader.partition('=')
            broke |= turn(a, name, max(1, min(TURN_S * float(share or 1), end - time.time())))
            if time.time() >= end:
                break
    return broke


if __name__ == '__main__':
    sys.exit(main())
