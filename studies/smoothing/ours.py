# SPDX-License-Identifier: LGPL-3.0-or-later
"""The library's smoothers, through the C functions of driver/driver.cpp."""

import ctypes

import common
import numpy as np

_double = ctypes.POINTER(ctypes.c_double)
_int = ctypes.POINTER(ctypes.c_int)


def build():
    """The driver, built beside the solver."""
    where = "smoothing/driver/libsmoothing_driver.so"
    return ctypes.CDLL(common.built("smoothing_driver", where))


class Ours:
    def __init__(self):
        self.lib = build()
        self.lib.smoothing_names.restype = ctypes.c_char_p
        self.lib.smoothing_run.restype = ctypes.c_double
        self.names = self.lib.smoothing_names().decode().split()

    def load(self, x, cells):
        self.x = np.ascontiguousarray(x, float)
        tags = np.ascontiguousarray(cells, np.int32)
        self.lib.smoothing_load(
            self.x.ctypes.data_as(_double),
            ctypes.c_size_t(len(x)),
            tags.ctypes.data_as(_int),
            ctypes.c_size_t(len(tags)),
        )

    def run(self, name, sweeps, relaxation=1.0):
        """Where the nodes are then, and the processor's seconds."""
        out = self.x.copy()
        outcome = ctypes.c_int()
        seconds = self.lib.smoothing_run(
            name.encode(),
            int(sweeps),
            ctypes.c_double(relaxation),
            out.ctypes.data_as(_double),
            ctypes.byref(outcome),
        )
        if outcome.value:
            raise RuntimeError(f"{name}: outcome {outcome.value}")
        return out, seconds
