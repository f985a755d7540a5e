# SPDX-License-Identifier: MIT
"""What goes wrong with files in other programs' formats, told as topple tells it: one line that names the file."""
import contextlib
import importlib

from .._topple import Error


def wrong(path, message, kind='input'):
    """The topple.Error to raise: what is wrong with the file, and the mend."""
    error = Error(f'{path}: {message}')
    error.kind = kind
    return error


def needs(module, package, path):
    """The module of an optional package, or an Error of kind "usage" that says how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        top = module.split('.')[0]
        if isinstance(error, ModuleNotFoundError) and (error.name or '').split('.')[0] == top:
            raise wrong(path, f"reading it takes the Python package {package}: pip install '{package}'", 'usage') from None
        raise wrong(path, f'the Python package {package} can\'t be loaded: {error}', 'usage') from error


@contextlib.contextmanager
def reading(path, what):
    """Whatever a library, or a value that isn't there, raises on a damaged file becomes an Error that names it."""
    try:
        yield
    except (Error, KeyboardInterrupt):
        raise
    except MemoryError:
        raise wrong(path, 'does not fit into memory; thin it, or check that it is not damaged') from None
    except OSError as error:
        raise wrong(path, error.strerror or str(error)) from error
    except Exception as error:  # each library has its own
        said = ' '.join(str(error).split())[:200] or type(error).__name__
        if isinstance(error, KeyError):
            said = f'it has no {error}'
        raise wrong(path, f'is no {what}, cut short or damaged: {said}') from error
