# SPDX-License-Identifier: MIT
"""Packages that some of the library takes, imported when they are needed."""
import importlib

from ._arrays import usage


def needed(module, package, what):
    """The module of an optional package, or an Error of kind "usage" that says how to install it. what: takes it, in words."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        top = module.split('.')[0]
        if isinstance(error, ModuleNotFoundError) and (error.name or '').split('.')[0] == top:
            raise usage(f"{what} takes the Python package {package}: pip install '{package}'") from None
        raise usage(f"{what} takes the Python package {package}, which can't be loaded: {error}") from error
