#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The rule of perf/compare on times that are made up, and the page of perf/history."""
import itertools
import math
import os
import random
import subprocess
import sys
import tempfile
import unittest

PERF = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'perf')
sys.path.insert(0, PERF)
import rule  # noqa: E402


def rounds(lot, ratio, noise, count=15):
    return [(math.exp(noise * lot.gauss(0, 1)), ratio * math.exp(noise * lot.gauss(0, 1))) for _ in range(count)]


class SignedRank(unittest.TestCase):
    def test_is_the_share_of_all_signs(self):
        lot = random.Random(1)
        for _ in range(20):
            values = [lot.gauss(0.3, 1) for _ in range(8)]
            ranks = [1 + sum(abs(o) < abs(v) for o in values) for v in values]
            seen = sum(r for r, v in zip(ranks, values) if v > 0)
            at_least = sum(sum(itertools.compress(ranks, signs)) >= seen
                           for signs in itertools.product((0, 1), repeat=8))
            self.assertEqual(rule.signed_rank_p(values), at_least / 256)

    def test_of_ties_and_of_nothing(self):
        self.assertEqual(rule.signed_rank_p([1, 1, 1]), 1 / 8)
        self.assertEqual(rule.signed_rank_p([1, -1]), 3 / 4)
        self.assertEqual(rule.signed_rank_p([0, 0]), 1)


class Verdict(unittest.TestCase):
    def test_blames_equal_programs_once_in_a_hundred(self):
        # 2000 series at 1 %: 20 expected, and more than 40 by chance in 1 of 10^5.
        lot = random.Random(2)
        blamed = sum(rule.verdict(rounds(lot, 1, 0.2), 0, 1) != '' for _ in range(2000))
        self.assertLessEqual(blamed, 40)
        self.assertGreaterEqual(blamed, 4)  # it is no rule that never says anything

    def test_blames_hardly_ever_beyond_what_counts(self):
        lot = random.Random(3)
        self.assertEqual(sum(rule.verdict(rounds(lot, 1, 0.05), 0.05, 1) != '' for _ in range(500)), 0)

    def test_tells_a_fifth_in_either_direction(self):
        lot = random.Random(4)
        for ratio, call in ((1.2, 'slower'), (1 / 1.2, 'faster')):
            told = sum(rule.verdict(rounds(lot, ratio, 0.05), 0.05, 4) == call for _ in range(200))
            self.assertGreaterEqual(told, 190)

    def test_outliers_of_a_busy_machine_change_nothing(self):
        lot = random.Random(5)
        pairs = rounds(lot, 1.2, 0.02)
        pairs[3] = (50, 1)
        self.assertEqual(rule.verdict(pairs, 0.05, 1), 'slower')


class History(unittest.TestCase):
    HEAD = 'backend,device,driver,case,best_ms,share,hash\n'

    def page_of(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                with open(os.path.join(folder, name), 'w', encoding='utf-8') as file:
                    file.write(text)
            out = os.path.join(folder, 'page.html')
            done = subprocess.run([sys.executable, os.path.join(PERF, 'history'), folder, '-o', out],
                                  capture_output=True, text=True)
            if done.returncode:
                return done.returncode, done.stderr
            with open(out, encoding='utf-8') as file:
                return 0, file.read()

    def test_marks_changed_results(self):
        row = 'native,"CPU, fast","4 threads",triad,{},0.5,{}\n'
        code, page = self.page_of({f'{n}.csv': self.HEAD + row.format(ms, h)
                                   for n, (ms, h) in enumerate(((1, 'a'), (2, 'a'), (3, 'b')))})
        self.assertEqual(code, 0)
        self.assertEqual(page.count('r="3"'), 3)
        self.assertEqual(page.count('r="6"'), 1)
        self.assertNotIn('http', page)

    def test_names_what_is_no_table(self):
        for text in ('', self.HEAD + 'native,a,b,triad,nan,0.5,a\n', 'x,y\n1,2\n'):
            code, message = self.page_of({'ok.csv': self.HEAD, 'z.csv': text})
            self.assertEqual(code, 1)
            self.assertIn('z.csv', message)
        self.assertEqual(self.page_of({})[0], 1)


if __name__ == '__main__':
    unittest.main()
