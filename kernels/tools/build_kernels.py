#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Builds one kernel source into the forms that the three backends run.

  build_kernels.py OUT_DIR --params FILE --namespace NAME --root DIR [--kernel FILE [--functions FILE] --glslang PATH
                   [--checked COMPILER]]

Writes into OUT_DIR, for <name>.kernel:
  <name>.hpp         the kernel's typed description: Args (one member per binding), Params, source()
  <name>.source.cpp  its KernelSource: SPIR-V words, OpenCL text, native entries
  <name>.native.cpp  the C++ form, compiled once per instruction set
and with --checked, whose preprocessor it takes, in the KernelSource also the forms that check indices (check_bounds.py):
  <name>.checked.cpp the C++ form of those
and without --kernel:
  params.hpp         the parameters of all kernels, as the host sees them

FILEs are named in errors and by compilers as they lie below DIR. What is C++ stands in the namespace NAME.
The declarations in the source (KERNEL, BUFFER_*, PARAMS, SHARED, ITEMS_PER_LANE) are the only
binding list there is: all forms and the host's types come from it.

The Python package topple.kernels takes it as a module, for kernels that are loaded at run time.
"""
import copy
import os
import re
import struct
import subprocess
import sys

SIZES = {'float': 4, 'uint': 4, 'int': 4}
HOST_TYPES = {'float': 'float', 'uint': 'std::uint32_t', 'int': 'std::int32_t'}
ACCESS = {'IN': 'read', 'OUT': 'write', 'INOUT': 'read_write'}


# What compiles somewhere but breaks the promise that all backends give the same bits (docs/dialect.md).
REFUSED = [
    (r'(?<![\w.])(?:\d+\.\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])|(?<![\w.])\d+[eE][-+]?\d+(?![\w.])',
     'is a double in C++ and OpenCL C; write the f behind it'),
    (r'\b(?:sin|cos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|exp|exp2|exp10|log|log2|log10|pow|rsqrt|inversesqrt|'
     r'cbrt|hypot|erf)\s*\(', 'differs between backends; use a polynomial'),
    (r'\b(?:dot|length|distance|normalize|cross|mix|smoothstep|fma|mad|fmod|mod|fract|round|rint|roundEven)\s*\(',
     'rounds differently between backends; spell it out with + - * /'),
    (r'\b(?:double|half|long|short|char|size_t|u?int64_t|float[234]|u?int[234]|[iu]?vec[234])\b',
     'is not a type of the dialect; it has float, uint, int and bool'),
    (r'\b(?:float|uint|int)\s*\*\s*\w+\s*[;,=)]', 'is a pointer, which GLSL has not'),
]


class Refused(Exception):
    """A kernel, or what belongs to it, is not as it must be: file, line where known, and why."""


def fail(name, message):
    raise Refused(f'{name}: {message}')


def prelude(*path):
    """What a dialect's words mean in one of the languages."""
    with open(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'dialect', *path), encoding='utf-8') as f:
        return f.read()


class Source:
    """A file that is part of what compilers get: its text, and the name that they know it by, as it lies below root;
    its whole path where it does not, or without one."""

    def __init__(self, path, root=None):
        with open(path, encoding='utf-8') as f:
            self.text = f.read()
        whole = os.path.abspath(path)
        below = os.path.relpath(whole, root) if root else os.pardir + os.sep
        self.name = whole if below.startswith(os.pardir + os.sep) else below
        if re.search('["\\\\\n\r\udc80-\udcff]', self.name):
            fail(ascii(self.name), 'compilers can tell no name with quotes, backslashes, line breaks or what is not UTF-8')

    def quoted(self):
        return f'#line 1 "{self.name}"\n{self.text}'


def without_comments(text):
    """The same lines."""
    return re.sub(r'//[^\n]*', '', text)


GRID_ARRAYS = ('leaf_low', 'leaf_high', 'first', 'mask')


def spell_out_grids(text):
    """Each GRID_IN(number, name) as the four buffers that a sparse grid is, in the same line."""
    def buffers(grid):
        return ' '.join(f'BUFFER_IN({int(grid[1]) + n}, uint, {grid[2]}_{array})' for n, array in enumerate(GRID_ARRAYS))

    return re.sub(r'\bGRID_IN\(\s*(\d+)\s*,\s*(\w+)\s*\)', buffers, text)


def kernels_in(source):
    """The kernels of a file that has several, by name: for each the file with the lines of all others empty, so that numbers of
    lines, and what they share, stay."""
    code = without_comments(source.text)
    blocks = list(re.finditer(r'(?:\bITEMS_PER_LANE\([^)]*\)\s*)?\bKERNEL\(\s*(\w+).*?\b(?:END|END_GROUP)\b', code, re.S))
    found = {}
    for kept in blocks:
        alone = copy.copy(source)
        if len(blocks) > 1:
            alone.text = code
            for other in blocks:
                if other is not kept:
                    alone.text = alone.text[:other.start()] + re.sub(r'[^\n]', ' ', other[0]) + alone.text[other.end():]
        if kept[1] in found:
            fail(source.name, f'there are two kernels {kept[1]}')
        found[kept[1]] = alone
    return found


def check_dialect(name, text):
    """Refuses, by file and line, what the compilers let pass. Comments don't count."""
    code = without_comments(text)
    per_group = 'BEGIN_GROUP' in code
    for number, line in enumerate(code.split('\n'), 1):
        if line.lstrip().startswith('#'):
            continue
        for pattern, why in REFUSED:
            found = re.search(pattern, line)
            if found:
                fail(f'{name}:{number}', f'{found.group(0).strip()} {why}')
        if per_group and re.search(r'\breturn\b', line) and not re.search(r'\bFN\b', code):
            fail(f'{name}:{number}', 'return in a kernel with barriers leaves the other lanes waiting')


class Kernel:
    """The declarations of one kernel file."""

    def __init__(self, source, name=None):
        """name: of the kernel, where the file is not called after it."""
        self.source = copy.copy(source)
        path = source.name
        code = without_comments(source.text)
        self.grids = re.findall(r'\bGRID_IN\(\s*\d+\s*,\s*(\w+)\s*\)', code)
        self.source.text = spell_out_grids(source.text)
        code = spell_out_grids(code)
        self.name = name or os.path.basename(path).rsplit('.', 1)[0]
        if self.name == 'params':
            fail(path, 'params.hpp is the header of the parameters; call the kernel otherwise')
        check_dialect(path, source.text)
        head = re.findall(r'\bKERNEL\(\s*(\w+)\s*,\s*(\d+)\s*\)', code)
        if len(head) != 1:
            fail(path, f'expected one KERNEL(name, group_size), found {len(head)}')
        if head[0][0] != self.name:
            fail(path, f'KERNEL is called {head[0][0]}, but its file {self.name}')
        if not re.search(r'\bBEGIN\b.*\bEND\b|\bBEGIN_GROUP\b.*\bEND_GROUP\b', code, re.S):
            fail(path, f'kernel {self.name} has no BEGIN ... END, or BEGIN_GROUP ... END_GROUP')
        self.group = int(head[0][1])
        if not 1 <= self.group <= 1024:
            fail(path, f'KERNEL({self.name}, {self.group}): a group has 1 to 1024 work-items')
        self.bindings = []
        for access, index, kind, name in re.findall(
                r'\bBUFFER_(IN|OUT|INOUT)\(\s*(\d+)\s*,\s*(\w+)\s*,\s*(\w+)\s*\)', code):
            if kind not in SIZES:
                fail(path, f'buffer {name} has type {kind}; a buffer holds {", ".join(SIZES)}')
            if int(index) != len(self.bindings):
                fail(path, f'buffer {name} has index {index}, expected {len(self.bindings)}')
            self.bindings.append((access, kind, name))
        params = re.findall(r'\bPARAMS\(\s*(\w+)\s*,\s*(\w+)\s*\)', code)
        if len(params) != 1:
            fail(path, f'expected one PARAMS(Type, name), found {len(params)}')
        self.params_type, self.params_name = params[0]
        self.shared = re.findall(r'\bSHARED\(\s*(\w+)\s*,\s*(\w+)\s*,\s*(\w+)\s*\)', code)
        columns = ('native', 'opencl', 'vulkan', 'gpu')
        items = re.findall(r'\bITEMS_PER_LANE\(([^)]*)\)', code)
        numbers = items[0].split(',') if items else ['1'] * len(columns)
        if len(numbers) != len(columns):
            fail(path, f'ITEMS_PER_LANE has {len(numbers)} numbers, expected {len(columns)}: {", ".join(columns)}')
        if not all(re.fullmatch(r'\s*[1-9]\d{0,3}\s*', n) for n in numbers):
            fail(path, f'ITEMS_PER_LANE({items[0]}): expected whole numbers, 1 or more')
        self.items = dict(zip(columns, map(int, numbers)))
        self.per_group = 'BEGIN_GROUP' in code
        if not self.per_group and ('BARRIER' in code or 'LANES' in code.replace('ITEMS_PER_LANE', '')):
            fail(path, 'LANES needs BEGIN_GROUP ... END_GROUP')

    def body(self, items):
        """The source as a backend's compiler gets it, behind what gives it ITEMS."""
        return items + '#define ITEMS_PER_LANE(native, opencl, vulkan, gpu)\n' + self.source.quoted()


def params_fields(params, kind):
    """Fields of one parameter struct, as (type, name)."""
    code = without_comments(params.text)
    found = re.search(r'STRUCT\(%s\)\s*\{(.*?)\}' % kind, code, re.S)
    if not found:
        fail(params.name, f'no STRUCT({kind})')
    fields = re.findall(r'(\w+)\s+(\w+)\s*;', found.group(1))
    for t, n in fields:
        if t not in SIZES:
            fail(params.name, f'{kind}.{n} has type {t}; parameters are {", ".join(SIZES)}')
    if 4 * len(fields) > 128:
        fail(params.name, f'{kind} has {4 * len(fields)} bytes, more than the 128 of a push constant')
    return fields


# Opcodes of SPIR-V float arithmetic, from the specification's section 3.42.13.
ARITHMETIC = {127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 148}
OP_DECORATE, OP_MEMBER_DECORATE, NO_CONTRACTION = 71, 72, 42


def add_no_contraction(words):
    """Decorates every arithmetic result, so that drivers neither fuse nor re-associate."""
    at, insert, results = 5, None, []
    while at < len(words):
        opcode, length = words[at] & 0xffff, words[at] >> 16
        if opcode in ARITHMETIC:
            results.append(words[at + 2])
        if opcode in (OP_DECORATE, OP_MEMBER_DECORATE):
            insert = at + length
        at += length
    extra = []
    for result in results:
        extra += [(3 << 16) | OP_DECORATE, result, NO_CONTRACTION]
    return words[:insert] + extra + words[insert:]


OP_NAME, OP_FUNCTION, OP_FUNCTION_END, OP_FUNCTION_CALL, OP_FDIV = 5, 54, 56, 57, 136


def call_divide(words):
    """Lets topple_divide of the prelude do every division but its own, which may be of less than IEEE's precision."""
    divide, inside, out, at = None, False, words[:5], 5
    while at < len(words):
        opcode, length = words[at] & 0xffff, words[at] >> 16
        instruction = words[at:at + length]
        if opcode == OP_NAME and struct.pack('<%dI' % (length - 2), *instruction[2:]).startswith(b'topple_divide('):
            divide = instruction[1]
        if opcode == OP_FUNCTION:
            inside = instruction[2] == divide
        if opcode == OP_FDIV and not inside:
            kind, result, a, b = instruction[1:]
            instruction = [(6 << 16) | OP_FUNCTION_CALL, kind, result, divide, a, b]
        out += instruction
        at += length
    if divide is None:
        fail('dialect/glsl/prelude.glsl', 'no topple_divide')
    return out


def shared_functions(kernel, functions=None):
    """What a kernel may call: words of grids and of halves where it or they use them, and functions where there are some."""
    code = without_comments(kernel.source.text + (functions.text if functions else ''))
    text = prelude('grid.h') if 'GRID_' in code or kernel.grids else ''
    text += prelude('half.h') if re.search(r'\b(?:half_bits|bits_half)\b', code) else ''
    if functions:
        check_dialect(functions.name, functions.text)
        text += functions.quoted() + '\n'
    return text


def shared_text(params, functions=''):
    """What stands before the kernel in each form: parameters, and what it may call."""
    return params.quoted() + '\n' + functions


def opencl(kernel, common, checks=''):
    """OpenCL C text; the driver is given ITEMS as an option."""
    return prelude('opencl', 'prelude.cl') + checks + common + kernel.body('')


def spirv(kernel, common, glslang, stem, checks=''):
    """The words of a kernel's SPIR-V. stem: of the names of files to work in."""
    glsl = ('#version 450\n#extension GL_GOOGLE_cpp_style_line_directive : require\n' + prelude('glsl', 'prelude.glsl') + checks
            + common + kernel.body(f"layout(constant_id = 0) const int ITEMS = {kernel.items['vulkan']};\n"))
    source = stem + '.comp'
    binary = stem + '.spv'
    with open(source, 'w', encoding='utf-8') as f:
        f.write(glsl)
    run = subprocess.run([glslang, '-V', '--keep-uncalled', '--target-env', 'vulkan1.1', '-S', 'comp', '-o', binary,
                          source],
                         capture_output=True, text=True)
    if run.returncode:
        raise Refused(f'glslang refuses {kernel.source.name}:\n{run.stdout}{run.stderr}')
    with open(binary, 'rb') as f:
        data = f.read()
    words = add_no_contraction(call_divide(list(struct.unpack('<%dI' % (len(data) // 4), data))))
    with open(binary, 'wb') as f:
        f.write(struct.pack('<%dI' % len(words), *words))
    return words


def params_header(params, namespace):
    return f'''// Generated from {params.name}.
#pragma once

#include <cstdint>

namespace {namespace} {{

using uint = std::uint32_t;

#define STRUCT(T) struct T
#define STRUCT_END(T) ;
{params.quoted()}
#undef STRUCT
#undef STRUCT_END

}}  // namespace {namespace}
'''


def header(kernel, fields, namespace):
    camel = ''.join(w.capitalize() for w in kernel.name.split('_'))
    of_grid = {f'{grid}_{array}': (grid, array) for grid in kernel.grids for array in GRID_ARRAYS}
    args, binds = [], []
    for _, kind, name in kernel.bindings:
        grid, array = of_grid.get(name, (None, None))
        if grid is None:
            args.append(f'        ::topple::device::Argument<{HOST_TYPES[kind]}> {name};')
        elif array == GRID_ARRAYS[0]:
            args.append(f'        ::topple::device::GridArgument {grid};')
        binds.append(f'        ranges.push_back(args.{f"{grid}.{array}" if grid else name}.range);')
    args, binds = '\n'.join(args), '\n'.join(binds)
    asserts = '\n'.join(f'static_assert(offsetof({kernel.params_type}, {n}) == {4 * i});'
                        for i, (_, n) in enumerate(fields))
    return f'''// Generated from {kernel.source.name}.
#pragma once

#include <cstddef>
#include <vector>

#include "params.hpp"
#include "topple/kernels/buffer.h"

namespace {namespace} {{

{asserts}
static_assert(sizeof({kernel.params_type}) == {4 * len(fields)});

struct {camel} {{
    using Params = {kernel.params_type};
    struct Args {{
{args}
    }};
    static void bind(const Args& args, std::vector<::topple::device::BoundRange>& ranges) {{
{binds}
    }}
    static const ::topple::device::KernelSource& source();
}};

}}  // namespace {namespace}
'''


def native(kernel, common, namespace, prelude='prelude.h'):
    """The C++ form, with the bindings spelled out for the prelude's macros."""
    const = {'IN': 'const ', 'OUT': '', 'INOUT': ''}
    load = ' '.join(f'auto* __restrict {n} = static_cast<{const[a]}{t}*>(args_.buffers[{i}]); (void){n};'
                    for i, (a, t, n) in enumerate(kernel.bindings))
    load += (f' {kernel.params_type} {kernel.params_name}; std::memcpy(&{kernel.params_name}, args_.params, '
             f'sizeof({kernel.params_name}));')
    parameters = ''.join(f'{const[a]}{t}* __restrict {n}, ' for a, t, n in kernel.bindings)
    parameters += f'const {kernel.params_type} {kernel.params_name},'
    arguments = ''.join(f'{n}, ' for _, _, n in kernel.bindings) + f'{kernel.params_name},'
    shared = ' '.join(f'alignas(64) {t} {n}[{c}];' for t, n, c in kernel.shared)
    return f'''// Generated from {kernel.source.name}.
#define DIALECT_NAMESPACE {namespace}
#include "dialect/native/{prelude}"
#define RUN_NAME TOPPLE_RUN_NAME
#define LOAD_BINDINGS {load}
#define BINDING_PARAMETERS {parameters}
#define BINDING_ARGUMENTS {arguments}
#define SHARED_ARRAYS {shared}
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-variable"
#pragma GCC diagnostic ignored "-Wunknown-pragmas"
#pragma GCC diagnostic ignored "-Wmissing-declarations"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
namespace {namespace} {{
{common}
{kernel.body(f"#define ITEMS {kernel.items['native']}" + chr(10))}
}}  // namespace {namespace}
'''


def source_constants(kernel, words, opencl_text, prefix=''):
    bindings = ',\n    '.join(f'{{"{n}", ::topple::device::Access::{ACCESS[a]}, {SIZES[t]}}}'
                              for a, t, n in kernel.bindings)
    spv = ',\n    '.join(', '.join(f'0x{w:08x}' for w in words[i:i + 8]) for i in range(0, len(words), 8))
    # Long literals in pieces: compilers only promise 65,536 characters for one.
    pieces = '\n    '.join('R"CL(' + opencl_text[i:i + 8000] + ')CL"' for i in range(0, len(opencl_text), 8000))
    return f'''constexpr ::topple::device::Binding {prefix}bindings[] = {{
    {bindings}}};
constexpr std::uint32_t {prefix}spirv[] = {{
    {spv}}};
constexpr const char* {prefix}opencl =
    {pieces};
'''


def source_cpp(form, namespace, checked=None):
    """form, checked: the kernel, its SPIR-V and its OpenCL C, without checks and with them."""
    kernel = form[0]
    camel = ''.join(w.capitalize() for w in kernel.name.split('_'))
    scope = f'{kernel.name}_scope'
    common = f'''"{kernel.name}", {kernel.group},
        {kernel.items['native']}, {kernel.items['opencl']}, {kernel.items['vulkan']}, {kernel.items['gpu']},
        {str(kernel.per_group).lower()}, sizeof(Params),'''
    constants = source_constants(*form)
    entry = last = source = ''
    if checked:
        constants += source_constants(*checked, 'checked_')
        entry = 'void run_checked(const ::topple::device::NativeArgs&, std::uint32_t, std::uint32_t);\n'
        last = '        , &checked\n'
        source = f'''    static const ::topple::device::KernelSource checked{{
        {common} {scope}::checked_bindings, {scope}::checked_spirv, {scope}::checked_opencl,
        {{{scope}::run_checked, nullptr, nullptr}}
    }};
'''
    return f'''// Generated from {kernel.source.name}.
#include "{kernel.name}.hpp"

namespace {namespace} {{
namespace {scope} {{
void run_baseline(const ::topple::device::NativeArgs&, std::uint32_t, std::uint32_t);
#ifdef TOPPLE_NATIVE_ISAS
void run_avx2(const ::topple::device::NativeArgs&, std::uint32_t, std::uint32_t);
void run_avx512(const ::topple::device::NativeArgs&, std::uint32_t, std::uint32_t);
#endif
{entry}
{constants}
}}  // namespace {scope}

const ::topple::device::KernelSource& {camel}::source() {{
{source}    static const ::topple::device::KernelSource source{{
        {common} {scope}::bindings, {scope}::spirv, {scope}::opencl,
#ifdef TOPPLE_NATIVE_ISAS
        {{{scope}::run_baseline, {scope}::run_avx2, {scope}::run_avx512}}
#else
        {{{scope}::run_baseline, nullptr, nullptr}}
#endif
{last}    }};
    return source;
}}

}}  // namespace {namespace}
'''


def write(path, text):
    with open(path, 'w', encoding='utf-8') as f:
        f.write(text)


def main():
    import argparse  # here alone: who takes this as a module has no use for it

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out')
    for name in ('params', 'namespace', 'root'):
        parser.add_argument('--' + name, required=True)
    for name in ('kernel', 'functions', 'glslang', 'checked'):
        parser.add_argument('--' + name)
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    params = Source(options.params, options.root)
    if not options.kernel:
        write(os.path.join(options.out, 'params.hpp'), params_header(params, options.namespace))
        return
    functions = options.functions and Source(options.functions, options.root)
    kernel = Kernel(Source(options.kernel, options.root))
    shared = shared_functions(kernel, functions)
    common = shared_text(params, shared)
    fields = params_fields(params, kernel.params_type)
    at = os.path.join(options.out, kernel.name)
    form, checked = (kernel, spirv(kernel, common, options.glslang, at), opencl(kernel, common)), None
    if options.checked:
        import check_bounds  # which lies beside this file

        own = shared_text(params)
        cpp, cl, comp = (check_bounds.checked(kernel, shared, backend, options.checked) for backend in ('native', 'opencl', 'vulkan'))
        checked = (cl, spirv(comp, own, options.glslang, at + '.checked', prelude('glsl', 'checks.glsl')),
                   opencl(cl, own, prelude('opencl', 'checks.cl')))
        write(at + '.checked.cpp', native(cpp, own, options.namespace, 'checks.h'))
    write(at + '.hpp', header(kernel, fields, options.namespace))
    write(at + '.native.cpp', native(kernel, common, options.namespace))
    write(at + '.source.cpp', source_cpp(form, options.namespace, checked))


if __name__ == '__main__':
    try:
        main()
    except Refused as refused:
        sys.exit(str(refused))
