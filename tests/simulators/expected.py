# SPDX-License-Identifier: MIT
"""What an export must hold, as the test that made it wrote it down. For the checks in this folder."""
import importlib
import json
import os
import sys

# A round shape may lie so far beside the hull that it stands for.
WITHIN_M = 0.00051


def needed(module):
    """The module, or the end of this check: 77 tells the test that the library is missing."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        print(error)
        sys.exit(77)


class Expected:
    def __init__(self, folder):
        self.folder = folder
        with open(self.path('expected.json')) as file:
            self.__dict__.update(json.load(file))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def fronts(self):
        """Each with the name of its body."""
        return {name: (of, front) for of, body in self.bodies.items() for name, front in body['fronts'].items()}

    def free(self):
        return {name: body for name, body in self.bodies.items() if not body['fixed']}


def near(what, found, wanted, within):
    import numpy as np
    found, wanted = np.ravel(np.array(found, float)), np.ravel(np.array(wanted, float))
    assert found.shape == wanted.shape and np.abs(found - wanted).max() <= within, f'{what}: {found}, not {wanted}'


def matrix(w, x, y, z):
    """Of a unit quaternion."""
    import numpy as np
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def near_inertia(what, moments, axes, body):
    import numpy as np
    wanted = np.reshape(body['inertia'], (3, 3))
    near(what, axes @ np.diag(moments) @ axes.T, wanted, 1e-4 * np.trace(wanted))
