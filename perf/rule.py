# SPDX-License-Identifier: MIT
"""The rule by which perf/compare tells a change from noise. docs/performance.md explains it."""
import math
import statistics

# Chance that a comparison calls any case slower or faster although both programs are equal.
FALSE_ALARM = 0.01


def signed_rank_p(values):
    """One-sided p of Wilcoxon's signed-rank test, exact: the chance that values which are as often as far below 0 as
    above have ranks above 0 that sum up to this much or more. Ties share the mean of their ranks."""
    values = [v for v in values if v != 0]
    order = sorted(range(len(values)), key=lambda i: abs(values[i]))
    twice = [0] * len(values)  # ranks doubled, so that those of ties are whole
    at = 0
    while at < len(order):
        end = at
        while end < len(order) and abs(values[order[end]]) == abs(values[order[at]]):
            end += 1
        for i in order[at:end]:
            twice[i] = at + 1 + end
        at = end
    ways = {0: 1}  # sum -> number of the 2^n choices of signs
    for rank in twice:
        more = dict(ways)
        for total, count in ways.items():
            more[total + rank] = more.get(total + rank, 0) + count
        ways = more
    seen = sum(rank for rank, v in zip(twice, values) if v > 0)
    return sum(count for total, count in ways.items() if total >= seen) / 2 ** len(values)


def log_ratios(pairs):
    """Of (base, change) times, a pair of each round."""
    return [math.log(change / base) for base, change in pairs]


def median_ratio(pairs):
    return math.exp(statistics.median(log_ratios(pairs)))


def suspicious(pairs, least):
    """Whether a first series is worth a second one: the median is off by half of what counts."""
    return abs(math.log(median_ratio(pairs))) > 0.5 * math.log1p(least)


def verdict(pairs, least, suspects):
    """'slower', 'faster' or '' from a fresh series of one of so many suspects: whether its ratios are beyond
    1 + least, or below 1 / (1 + least), at FALSE_ALARM shared among the suspects and both directions."""
    level = FALSE_ALARM / (2 * suspects)
    beyond = math.log1p(least)
    ratios = log_ratios(pairs)
    if signed_rank_p([r - beyond for r in ratios]) <= level:
        return 'slower'
    if signed_rank_p([-r - beyond for r in ratios]) <= level:
        return 'faster'
    return ''
