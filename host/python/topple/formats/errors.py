# SPDX-License-Identifier: MIT
"""What goes wrong with files in other programs' formats, told as topple tells it: one line that names the file."""
import contextlib

from .._arrays import error
from .._optional import needed
from .._topple import Error


def wrong(path, message, kind='input'):
    """The topple.Error to raise: what is wrong with the file, and the mend."""
    return error(kind, f'{path}: {message}')


def needs(module, package, path):
    """The module of an optional package, or an Error of kind "usage" that says how to install it."""
    return needed(module, package, f'{path}: reading it')


@contextlib.contextmanager
def reading(path, what):
    """Whatever a library, or a value that isn't there, raises on a damaged file becomes an Error that names it."""
    try:
        yield
    except (Error, KeyboardInterrupt, BrokenPipeError):  # the pipe is of what is written
        raise
    except MemoryError:
        raise wrong(path, 'does not fit into memory; thin it, or check that it is not damaged') from None
    except OSError as failed:
        raise wrong(path, failed.strerror or str(failed)) from failed
    except Exception as failed:  # each library has its own
        said = ' '.join(str(failed).split())[:200] or type(failed).__name__
        if isinstance(failed, KeyError):
            said = f'it has no {failed}'
        raise wrong(path, f'is no {what}, cut short or damaged: {said}') from failed
