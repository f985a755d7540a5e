# SPDX-License-Identifier: MIT
"""The forms of kernels that backends run, made by build_kernels.py and by compilers when they are first asked for."""
import ctypes
import hashlib
import os
import re
import shutil
import stat
import struct
import subprocess
import tempfile
import threading

from ._arrays import error
from ._kernels.tools import build_kernels as _tool
from ._topple import kernels as _made_by

_HOME = os.path.join(os.path.dirname(os.path.abspath(__file__)), '_kernels')
_ISAS = ('baseline', 'avx2', 'avx512')

_made, _making = {}, threading.Lock()


def form(kernel, common, params_bytes, backend):
    """What that backend's devices run. One of the same text is made once in a process, as devices keep what they build of it."""
    key = backend, kernel.name, kernel.source.quoted(), common
    with _making:
        if key not in _made:
            words, text, entries = b'', '', [0, 0, 0]
            if backend == 'native':
                entries = _native(kernel, common)
            elif backend == 'opencl':
                text = _tool.opencl(kernel, common)
            else:
                words = _spirv(kernel, common)
            items = [kernel.items[of] for of in ('native', 'opencl', 'vulkan', 'gpu')]
            bindings = [(name, access.lower()) for access, _, name in kernel.bindings]
            _made[key] = _made_by.Kernel(kernel.name, kernel.group, items, kernel.per_group, params_bytes, bindings, words, text, entries)
        return _made[key]


def _refused(kernel, compiler, said):
    """The Error that has what a compiler says is wrong, in a line."""
    lines = [' '.join(line.split()) for line in said.splitlines() if re.search(r'\berror\b', line, re.IGNORECASE)]
    lines = [line for line in lines if not re.search('compilation (terminated|errors)', line)]
    return error('input', f'kernel {kernel.name}: {os.path.basename(compiler)} refuses it: ' + ('; '.join(lines[:5]) or ' '.join(said[-500:].split())))


def _spirv(kernel, common):
    glslang = shutil.which('glslangValidator') or shutil.which('glslang')
    if not glslang:
        raise error('device', f'kernel {kernel.name}: Vulkan takes glslangValidator, which is not in PATH: apt-get install glslang-tools, or '
                              'run it on "native" or "opencl"')
    with tempfile.TemporaryDirectory(prefix='topple-kernel-') as folder:
        try:
            words = _tool.spirv(kernel, common, glslang, os.path.join(folder, kernel.name))
        except _tool.Refused as refused:
            raise _refused(kernel, glslang, str(refused)) from None
    return struct.pack(f'={len(words)}I', *words)


def _read(*path):
    with open(os.path.join(_HOME, *path), encoding='utf-8') as file:
        return file.read()


def _folder():
    """Where libraries are kept. Code is run from it, so nobody else may write there."""
    base = os.environ.get('XDG_CACHE_HOME', '')
    folder = os.path.join(base if os.path.isabs(base) else os.path.expanduser('~/.cache'), 'topple-kernels')
    try:
        os.makedirs(folder, 0o700, exist_ok=True)
        found = os.lstat(folder)
    except OSError as problem:
        raise error('device', f'{folder}, where native kernels are kept: {problem.strerror}; XDG_CACHE_HOME names another place') from None
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.geteuid() or found.st_mode & 0o777 != 0o700:
        raise error('device', f'{folder}, where native kernels are kept, must be a folder of yours that is open to nobody else '
                              f'(mode 700, not {found.st_mode & 0o777:o}): remove it, or set XDG_CACHE_HOME')
    return folder


def _flags():
    """By whom they are for, or the instruction set, what the C++ form is compiled with: the same as in CMake's builds."""
    return {of: flags for of, *flags in (line.split() for line in _read('tools', 'native_flags.txt').splitlines() if line[:1].isalpha())}


def _compiler(kernel):
    """A compiler's path, and what it says that it is."""
    found = next(filter(None, map(shutil.which, filter(None, (os.environ.get('CXX'), 'c++', 'g++', 'clang++')))), None)
    if not found:
        raise error('device', f'kernel {kernel.name}: native kernels take a C++ compiler (c++, g++ or clang++), and there is none in PATH: '
                              'apt-get install g++, or run it on "opencl" or "vulkan"')
    return found, _run(kernel, found, '--version')


def _run(kernel, compiler, *arguments):
    """What it prints."""
    done = subprocess.run([compiler, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors='backslashreplace', env=dict(os.environ, LC_ALL='C'))
    if done.returncode:
        raise _refused(kernel, compiler, done.stdout)
    return done.stdout


def _native(kernel, common):
    """The addresses of the kernel's machine code for each instruction set, 0 but for that of the processor here: of a library that is
    compiled unless it is there."""
    compiler, version = _compiler(kernel)
    isa, of = _made_by.native_isa(), _flags()
    flags = ['-std=c++20', '-O3', '-fPIC', '-shared', *of['all'], *([] if 'clang' in version else of['gcc']), *of.get(_ISAS[isa], [])]
    text = '#define TOPPLE_RUN_NAME run_here\n' + _tool.native(kernel, common, 'made') + f'''
extern "C" void topple_entry_(const ::topple::device::NativeArgs& args_, std::uint32_t first_, std::uint32_t last_) {{
    made::{kernel.name}_scope::run_here(args_, first_, last_);
}}
'''
    included = _read('dialect', 'native', 'prelude.h'), _read('topple', 'kernels', 'kernel.h')
    key = hashlib.sha256('\0'.join([text, *included, compiler, version, *flags]).encode())
    library = os.path.join(_folder(), f'{kernel.name}-{key.hexdigest()[:32]}.so')
    try:
        if not os.path.exists(library):
            _compile(kernel, compiler, flags, text, library)
        loaded = ctypes.CDLL(library)
    except OSError as problem:
        raise error('device', f'kernel {kernel.name}: {problem}; remove {library} if it is there, or have XDG_CACHE_HOME name another place') from None
    return [ctypes.cast(loaded.topple_entry_, ctypes.c_void_p).value if n == isa else 0 for n in range(len(_ISAS))]


def _compile(kernel, compiler, flags, text, library):
    """Made under another name first: whoever looks meanwhile sees all of it, or nothing."""
    with tempfile.TemporaryDirectory(prefix='.', dir=os.path.dirname(library)) as folder:
        source, made = os.path.join(folder, kernel.name + '.cpp'), os.path.join(folder, 'made.so')
        with open(source, 'w', encoding='utf-8') as file:
            file.write(text)
        _run(kernel, compiler, *flags, '-isystem', _HOME, source, '-o', made)
        os.replace(made, library)
