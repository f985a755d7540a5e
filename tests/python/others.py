# SPDX-License-Identifier: MIT
import contextlib

import pytest

import topple


@contextlib.contextmanager
def raises(kind, words=None):
    """What is done within raises a topple.Error of this kind, whose message has the words, a regular expression."""
    with pytest.raises(topple.Error, match=words) as raised:
        yield
    assert raised.value.kind == kind


class Exported:
    """An array of another library's, which has __dlpack__ alone."""

    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()
