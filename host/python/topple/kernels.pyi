# SPDX-License-Identifier: MIT
import os
from typing import Any, Literal, Mapping, NamedTuple, Optional, Union

import numpy as np

from . import Device, _Backend

__all__: list[str]

_Path = Union[str, os.PathLike[str]]

class Buffer(NamedTuple):
    access: Literal["in", "out", "inout"]
    dtype: np.dtype[Any]  # float32, uint32 or int32

class Kernel:
    name: str
    group_size: int  # work-items
    buffers: dict[str, Buffer]
    parameters: dict[str, np.dtype[Any]]
    def __call__(self, device: Union[Device, _Backend, None] = ..., *, params: Optional[Mapping[str, float]] = ..., items: Optional[int] = ..., **arguments: Any) -> None: ...  # arrays, and fields

def load(path: _Path, *, params: Optional[_Path] = ..., functions: Optional[_Path] = ..., name: Optional[str] = ..., sizes: Optional[Mapping[str, Union[int, str, None]]] = ...) -> Kernel: ...
