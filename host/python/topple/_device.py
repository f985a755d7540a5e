# SPDX-License-Identifier: MIT
"""Opening a device."""
from . import _topple
from ._arrays import usage
from ._options import option


def open_device(backend='auto', threads=0):
    """The best Device of a backend: "native", "opencl" or "vulkan", a GPU before a CPU; or, with "auto", a GPU if there is one, else
    native. threads: of the native backend, 0 for all cores. Raises Error of kind "usage" or "device", and TypeError where the
    backend is no name."""
    if not isinstance(backend, str):
        raise TypeError(f'open_device: backend: expected "auto", "native", "opencl" or "vulkan", not {backend!r}'[:300])
    return _topple.open_device(backend, option('threads', threads))


def opened(device):
    """What a call is given as its device, open: a Device, or a backend's name, or None for the best."""
    if device is None or isinstance(device, str):
        return _topple.open_device('auto' if device is None else device)
    if not isinstance(device, _topple.Device):
        raise usage(f"device: expected one of topple.open_device() or a backend's name, not {device!r}")
    return device
