# SPDX-License-Identifier: MIT
"""The checked form of a kernel, for TOPPLE_CHECK=bounds: each access of a buffer goes through CHECKED of
kernels/dialect/*/checks.*, which compares its index with the number of elements that are bound.

Macros are expanded first, as what they access is seen only then."""
import copy
import re
import subprocess

CHECKS = 'checks_'  # the hidden binding, behind the kernel's own
WRITES, OF_GROUP, BINDING_SHIFT = 1, 2, 2  # host/device/bounds_check.cpp
ASSIGNED = re.compile(r'\s*(?:(?:[-+*/%|&^]|<<|>>)?=(?!=)|\+\+|--)')
UPDATED = re.compile(r'(?:\b(?:ATOMIC|SHARED)_\w+\s*\(|\+\+|--)\s*$')
# Word by word, so that each of them is looked at.
LOAD_NEAR = '#define LOAD_NEAR(to, from, base, place) EACH_ITEM(i) { to[i] = from[(base) + place[i]]; }\n'
STORE_LINE = '#define STORE_LINE(to, at, from, base) for (uint k_ = 0u; k_ < 16u; k_++) { to[(at) + k_] = from[(base) + k_]; }\n'


def expanded(kernel, functions, backend, compiler):
    """What kernels share and the kernel without macros of their own, as one backend's compiler sees them."""
    source = f'#define TOPPLE_{backend.upper()} 1\n' + LOAD_NEAR + STORE_LINE + functions + kernel.source.quoted()
    run = subprocess.run([compiler, '-E', '-undef', '-nostdinc', '-x', 'c', '-'], input=source, capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(f'{compiler} does not expand {kernel.source.name}:\n{run.stderr}')
    text = re.sub(r'(?m)^# \d+ "<.*\n', '', run.stdout)
    return re.sub(r'(?m)^# (\d+ "[^"]*").*$', r'#line \1', text)


def closing(code, at):
    """The place of the bracket that closes the one before `at`."""
    depth = 1
    while depth:
        depth += {'[': 1, ']': -1}.get(code[at], 0)
        at += 1
    return at - 1


def checked_accesses(kernel, code, uniform):
    """code with its accesses checked; uniform(place): whether it belongs to the group and no work-item there."""
    access = re.compile(r'(?<![\w.])(%s)\s*\[' % '|'.join(name for _, _, name in kernel.bindings))

    def rewritten(first, last):
        out = ''
        while found := access.search(code, first, last):
            end = closing(code, found.end())
            of_group = uniform(found.start())
            writes = bool(ASSIGNED.match(code, end + 1) or UPDATED.search(code, 0, found.start()))
            binding = [name for _, _, name in kernel.bindings].index(found.group(1))
            word = binding << BINDING_SHIFT | OF_GROUP * of_group | WRITES * writes
            out += (code[first:found.end()] + f'CHECKED({word}u, {"GROUP_ID" if of_group else "GLOBAL_ID"}, '
                    + rewritten(found.end(), end) + ')]')
            first = end + 1
        return out + code[first:last]

    return rewritten(0, len(code))


def checked(kernel, functions, backend, compiler):
    """The kernel with its hidden binding and this backend's checked text, what kernels share in it."""
    code = expanded(kernel, functions, backend, compiler)
    begin = re.search(r'\bBEGIN(?:_GROUP)?\b', code).end()
    body = code[begin:]

    def uniform(place):
        lanes = re.findall(r'\b(?:END_)?LANES\b', body[:place])
        return kernel.per_group and (not lanes or lanes[-1] == 'END_LANES')

    form = copy.copy(kernel)
    form.bindings = kernel.bindings + [('INOUT', 'uint', CHECKS)]
    form.source = copy.copy(kernel.source)
    form.source.text = (re.sub(r'\bPARAMS\(', f'CHECKS({len(kernel.bindings)}) PARAMS(', code[:begin])
                        + checked_accesses(kernel, body, uniform))
    return form
