# SPDX-License-Identifier: MIT
"""Data-parallel kernels of your own on NumPy arrays, written once, with the same bits on each backend.

    smooth = topple.kernels.load('smooth.kernel')
    smooth(device, height=heights, weight=weights, smoothed=out, params={'count': len(heights)})

docs/dialect.md has the language. A kernel that is loaded here is one that C++ programs can have, too (kernels/README.md). It is built for a
backend when that first runs it: natively by a C++ compiler (g++ or clang++), once, as libraries are kept in ~/.cache/topple-kernels, or in
XDG_CACHE_HOME; for OpenCL by its driver; for Vulkan by glslangValidator (package glslang-tools).

A kernel is code: load none that you would not run. It reads and writes where its indices lead; load() says what is checked.
"""
import collections.abc
import difflib
import glob
import operator
import os
import struct
from typing import NamedTuple

import numpy as np

from . import _kernel_forms
from ._arrays import error, is_masked, usage
from ._device import opened
from ._kernels.tools import build_kernels as _tool

__all__ = ['Buffer', 'Kernel', 'load']

_DTYPES = {'float': np.dtype(np.float32), 'uint': np.dtype(np.uint32), 'int': np.dtype(np.int32)}
_FORMATS = {'float': '=f', 'uint': '=I', 'int': '=i'}  # of struct
_MOST_ITEMS = 2 ** 32 - 1


class Buffer(NamedTuple):
    """What a kernel declares of an array."""
    access: str  # "in", "out" or "inout"
    dtype: np.dtype  # float32, uint32 or int32


class Kernel:
    """A kernel that load() has read. Call it to run it."""

    def __init__(self, kernel, fields, common, sizes):
        self.name = kernel.name  # str
        self.group_size = kernel.group  # int: work-items in a group
        self.buffers = {name: Buffer(access.lower(), _DTYPES[kind]) for access, kind, name in kernel.bindings}  # by name, in their order
        self.parameters = {name: _DTYPES[kind] for kind, name in fields}  # the type of each field, by name
        self._kernel, self._fields, self._common, self._sizes = kernel, fields, common, sizes

    def __repr__(self):
        buffers = [f'{name}: {buffer.access} {buffer.dtype}' for name, buffer in self.buffers.items()]
        return f"<topple.kernels.Kernel {self.name}({', '.join(buffers)}; {', '.join(f'{n}: {t}' for n, t in self.parameters.items())})>"

    def __call__(self, device=None, *, params=None, items=None, **arguments):
        """Runs the kernel once, and waits for it.

        device: a Device of topple.open_device(), or a backend's name, or None for the best. With a name it is opened for this call
        alone, which takes longer than most kernels.
        params: the parameters' fields by name, a dict; a field may be an argument of its own, too.
        items: the number of elements that it works on, by default the field `count`. A kernel with BEGIN_GROUP ... END_GROUP has no
        default: there it is the number of work-items, a multiple of group_size.
        The buffers follow by name: C-contiguous NumPy arrays of any shape, of exactly the declared type, which for "out" and "inout" are
        written in place; what the kernel leaves alone there stays. No array that is written may overlap another one.

        Raises topple.Error of kind "usage" where an argument is wrong, "input" where a compiler refuses the kernel, by its file and
        line, and "device" where the device can't run it, or what builds it is missing."""
        params = self._collected(params, arguments)
        values = self._checked(params)
        block = b''.join(values.values())
        count, items = self._count(items, params)
        arrays = self._arrays(arguments, params, items)
        device = opened(device)
        _kernel_forms.form(self._kernel, self._common, len(block), device.backend).run(device, arrays, block, count)

    def _usage(self, message):
        return usage(f'kernel {self.name}: {message}')

    def _unknown(self, what, name, known):
        near = difflib.get_close_matches(str(name), known, 1, 0.7)
        return self._usage(f'there is no {what} {name!r}' + (f'; did you mean {near[0]!r}?' if near else f", but {', '.join(known) or 'none'}"))

    def _collected(self, params, arguments):
        """The parameters, also of those arguments that are no buffers, which it takes out."""
        if not isinstance(params, (collections.abc.Mapping, type(None))):
            raise self._usage(f'params: expected a dict of {", ".join(self.parameters)}, not {params!r}'[:300])
        collected = dict(params or {})
        for name in [name for name in arguments if name not in self.buffers]:
            if name not in self.parameters:
                raise self._unknown('buffer or parameter', name, [*self.buffers, *self.parameters])
            if name in collected:
                raise self._usage(f'parameter {name} is given twice')
            collected[name] = arguments.pop(name)
        return collected

    def _checked(self, params):
        """The bytes of each parameter, in their order."""
        for name in params:
            if name not in self.parameters:
                raise self._unknown('parameter', name, list(self.parameters))
        values = {}
        for kind, name in self._fields:
            if name not in params:
                raise self._usage(f'parameter {name} is missing')
            expected = 'a float32' if kind == 'float' else f'a whole number, {np.iinfo(_DTYPES[kind]).min} to {np.iinfo(_DTYPES[kind]).max}'
            try:
                if isinstance(params[name], (str, bytes)):
                    raise TypeError
                values[name] = struct.pack(_FORMATS[kind], (float if kind == 'float' else operator.index)(params[name]))
            except (TypeError, ValueError, OverflowError, struct.error):
                raise self._usage(f'parameter {name}: expected {expected}, not {params[name]!r}'[:300]) from None
        return values

    def _count(self, items, params):
        """How much work there is, as the device counts it, and in items."""
        per_group = self._kernel.per_group
        if items is None:
            if per_group or self.parameters.get('count', np.dtype(np.float32)).kind == 'f':
                raise self._usage('items is missing: ' + (f'its number of work-items, a multiple of {self.group_size}' if per_group else
                                                          'the number of elements that it works on; no field count tells it'))
            items = params['count']
        try:
            items = operator.index(items)
        except TypeError:
            raise self._usage(f'items: expected a whole number, not {items!r}'[:300]) from None
        if not 0 <= items <= _MOST_ITEMS:
            raise self._usage(f'items: expected 0 to {_MOST_ITEMS}, not {items}')
        if per_group and items % self.group_size:
            raise self._usage(f'items: expected a multiple of its group of {self.group_size} work-items, not {items}; '
                              f'{-(-items // self.group_size) * self.group_size} is the next one')
        return (items // self.group_size if per_group else items), items

    def _needed(self, name, params, items):
        """How many elements a buffer must have at least, and why."""
        size = self._sizes.get(name, 'items')
        if size is None or size == 'items' and self._kernel.per_group:
            return 0, ''
        if size == 'items':
            count = params['count'] if self.parameters.get('count', np.dtype(np.float32)).kind != 'f' else 0
            return max(items, operator.index(count)), f'one for each item; load() takes sizes={{{name!r}: ...}} where it needs another number'
        return (size, 'as sizes has it') if isinstance(size, int) else (operator.index(params[size]), f'as the parameter {size} has it')

    def _arrays(self, arguments, params, items):
        """One for each binding, in their order."""
        for name, buffer in self.buffers.items():
            if name not in arguments:
                raise self._usage(f'buffer {name} is missing: an array of {buffer.dtype}')
            self._check_array(name, buffer, arguments[name], *self._needed(name, params, items))
        for written in (name for name, buffer in self.buffers.items() if buffer.access != 'in'):
            for other in self.buffers:
                if other != written and np.may_share_memory(arguments[written], arguments[other]):
                    raise self._usage(f'buffers {written} and {other} overlap, and {written} is written; give one of them a .copy()')
        return [arguments[name] for name in self.buffers]

    def _check_array(self, name, buffer, array, needed, why):
        where, expected = f'buffer {name}', f'expected a C-contiguous NumPy array of {buffer.dtype}'
        if not isinstance(array, np.ndarray) or is_masked(array):
            raise self._usage(f'{where}: {expected}, not a {type(array).__name__}')
        given = f'{array.dtype} of shape {array.shape}'
        if array.dtype != buffer.dtype:
            mend = f'; {name}.astype({buffer.dtype.name!r}) converts it' if buffer.access == 'in' and array.dtype.kind in 'iuf' else ''
            raise self._usage(f'{where}: {expected}, not {given}{mend}')
        if not array.flags.c_contiguous:
            mend = f'; np.ascontiguousarray({name}) is a copy that is' if buffer.access == 'in' else ''
            raise self._usage(f'{where}: {expected}, not {given} with strides of {array.strides} bytes, which is not contiguous{mend}')
        if buffer.access != 'in' and not array.flags.writeable:
            raise self._usage(f'{where}: expected an array to write to, not {given} that is read-only')
        if array.size < needed:
            raise self._usage(f'{where}: expected {needed} elements or more, not {given} with {array.size}: {why}')


def _beside(path, name):
    """A file that is named along with the kernel's: as it lies beside that, else where it says."""
    name = os.fspath(name)
    beside = os.path.join(os.path.dirname(path), name)
    return _tool.Source(beside if os.path.exists(beside) else name)


def _header(path, kind):
    """The one header in the kernel's folder that has its parameters."""
    found = []
    for name in sorted(glob.glob(os.path.join(glob.escape(os.path.dirname(path)), '*.h'))):
        with open(name, encoding='utf-8', errors='replace') as file:  # it may be of another program
            if f'STRUCT({kind})' in _tool.without_comments(file.read()):
                found.append(name)
    if len(found) != 1:
        raise error('input', f"{path}: STRUCT({kind}) is in {' and in '.join(found) or 'no header (*.h) beside it'}; "
                             'name the file that it is in by load(..., params=...)')
    return _tool.Source(found[0])


def load(path, *, params=None, functions=None, name=None, sizes=None):
    """The Kernel of a file.

    params: the header with the STRUCT of its parameters, as it lies beside the kernel, or by its path; by default the one header beside
    it that has that STRUCT. functions: a file of what kernels share, FN and #define. name: which kernel, of a file that has several.
    sizes: how many elements buffers must have at least, by name: a number, a parameter's name, or None for any. Where it does not say,
    a buffer must have one for each of the items, and of the parameter `count`; in a kernel with BEGIN_GROUP it may have any. Nothing
    else keeps a kernel from reaching beyond its arrays, which may end the process.

    Raises topple.Error of kind "input" where a file can't be read, or breaks a rule of the dialect, by file and line; of kind "usage"
    where an argument is wrong. Compilers see the kernel when it first runs."""
    path = os.path.abspath(os.fspath(path))
    try:
        kernels = _tool.kernels_in(_tool.Source(path))
        if name is None and len(kernels) > 1:
            raise usage(f"{path} has the kernels {', '.join(kernels)}; choose one by load(..., name={next(iter(kernels))!r})")
        if name is not None and name not in kernels:
            raise usage(f"{path} has no kernel {name!r}, but {', '.join(kernels) or 'none'}")
        name = name or next(iter(kernels), None)
        kernel = _tool.Kernel(kernels[name] if name else _tool.Source(path), name)
        header = _header(path, kernel.params_type) if params is None else _beside(path, params)
        fields = _tool.params_fields(header, kernel.params_type)
        common = _tool.shared_text(header, _tool.shared_functions(kernel, None if functions is None else _beside(path, functions)))
    except _tool.Refused as refused:
        raise error('input', str(refused)) from None
    except (OSError, UnicodeDecodeError) as problem:
        raise error('input', f'{path}: {problem}') from None
    for _, _, buffer in kernel.bindings:
        if buffer in ('self', 'device', 'params', 'items'):
            raise error('input', f'{path}: a buffer called {buffer} has no name of its own in the call; call it otherwise')
    return Kernel(kernel, fields, common, _checked_sizes(kernel, fields, sizes or {}))


def _checked_sizes(kernel, fields, sizes):
    whole = {name for kind, name in fields if kind != 'float'}
    for name, size in sizes.items():
        if name not in [buffer for _, _, buffer in kernel.bindings]:
            raise usage(f'sizes: kernel {kernel.name} has no buffer {name!r}')
        if not (size is None or isinstance(size, str) and size in whole or isinstance(size, int) and size >= 0):
            raise usage(f"sizes: {name}: expected a number from 0, a whole parameter's name ({', '.join(sorted(whole))}) or None, not {size!r}"[:300])
    return dict(sizes)
