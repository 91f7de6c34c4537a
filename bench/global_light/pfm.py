"""Writes PFM pictures: linear float RGB, the bottom row first, little endian."""

import numpy as np


def write(path, picture):
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (picture.shape[1], picture.shape[0]))
        file.write(np.ascontiguousarray(picture[::-1], "<f4").tobytes())
