# SPDX-License-Identifier: MIT
"""How the scripts of this folder take times and tell them: a line WHAT|LIBRARY|SECONDS for each library there is."""
import sys
import time


def best(run, count=3):
    """The best seconds of some runs, and what the last one returned."""
    seconds = float('inf')
    for _ in range(count):
        start = time.perf_counter()
        result = run()
        seconds = min(seconds, time.perf_counter() - start)
    return seconds, result


def tell(what, library, seconds):
    print(f'{what}|{library}|{seconds}', flush=True)


def tell_all(peers):
    """Calls each; one whose library is not there is left out, and the error output says so."""
    for peer in peers:
        try:
            peer()
        except ImportError as error:
            print(f'{peer.__name__} is left out: {error}', file=sys.stderr, flush=True)
