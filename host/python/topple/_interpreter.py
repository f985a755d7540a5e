# SPDX-License-Identifier: MIT
"""Raises ImportError in a sub-interpreter: what NumPy and pybind11 keep belongs to one interpreter, and another would read its memory."""
import importlib

for _name in ('_interpreters', '_xxsubinterpreters'):  # since CPython 3.13, and before
    try:
        _known = importlib.import_module(_name)
    except ImportError:
        continue
    if _known.get_current() != _known.get_main():
        raise ImportError('topple runs in the main interpreter of a process alone, not in a sub-interpreter: use threads, or processes')
    break
