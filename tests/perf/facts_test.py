#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""perf/facts on tables that were altered: facts_test.py PROGRAM"""
import os
import subprocess
import sys
import tempfile
import unittest

PERF = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'perf')
PROGRAM = sys.argv.pop(1)
CASE = 'support_function'


class Facts(unittest.TestCase):
    def told(self, alter):
        """What is said of a table whose row of CASE was altered, a list of words."""
        with open(os.path.join(PERF, 'facts.csv'), encoding='utf-8') as file:
            rows = [line.rstrip('\n').split(',') for line in file]
        [row] = [row for row in rows if row[:2] == ['native', CASE]]
        rows = [rows[0], *alter(rows[0], row)]
        with tempfile.TemporaryDirectory() as folder:
            table = os.path.join(folder, 'facts.csv')
            with open(table, 'w', encoding='utf-8') as file:
                file.writelines(','.join(row) + '\n' for row in rows)
            done = subprocess.run([os.path.join(PERF, 'facts'), PROGRAM, '--backend', 'native', '--filter', CASE,
                                   '--table', table], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1 if done.stdout else 0, done.stdout + done.stderr)
        return done.stdout

    def test_the_table_is_right(self):
        self.assertEqual(self.told(lambda names, row: [row]), '')

    def test_another_hash_or_count_is_told(self):
        def other(name):
            def alter(names, row):
                at = names.index(name)
                return [row[:at] + [row[at][:-1] + ('1' if row[at][-1] != '1' else '2')] + row[at + 1:]]
            return alter

        self.assertIn(f'native {CASE}: the result changed', self.told(other('hash')))
        for count in ('dispatches', 'bytes_bound', 'bytes'):
            self.assertIn(f'native {CASE}: {count} ', self.told(other(count)))

    def test_cases_too_many_or_too_few_are_told(self):
        self.assertIn(f'native {CASE}: not in the table', self.told(lambda names, row: []))
        more = self.told(lambda names, row: [row, [row[0], CASE + '_2', *row[2:]]])
        self.assertIn(f'native {CASE}_2: did not run', more)


if __name__ == '__main__':
    unittest.main()
