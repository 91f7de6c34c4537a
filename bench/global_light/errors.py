"""How far a picture is from two independent halves of a reference.

With halves A and B, each the truth plus noise of its own, the mean of (x - A) (x - B) is that of
(x - truth)^2: the noise of either half meets nothing that it correlates with. So an error smaller
than the reference's own can be told, to about the half's variance over the root of the number of
pixels.
"""

from dataclasses import dataclass

import numpy as np


def blocks(picture, side=8):
    h, w = (n // side * side for n in picture.shape[:2])
    cut = picture[:h, :w].astype(np.float64)
    return cut.reshape(h // side, side, w // side, side, -1).mean(axis=(1, 3))


def relative_rmse(picture, a, b):
    """Over the reference's mean; 0 where the noise hides it."""
    square = float(np.mean((picture.astype(np.float64) - a) * (picture.astype(np.float64) - b)))
    return float(np.sqrt(max(square, 0.0)) / (0.5 * (a.mean() + b.mean())))


@dataclass
class Errors:
    pixels: float  # relative RMSE
    blocks: float  # the same of means over 8 x 8 pixels
    mean: float  # of the picture, relative


def errors(picture, a, b):
    truth = 0.5 * (a.mean(dtype=np.float64) + b.mean(dtype=np.float64))
    return Errors(relative_rmse(picture, a, b), relative_rmse(blocks(picture), blocks(a), blocks(b)),
                  float(picture.mean(dtype=np.float64) / truth - 1))


def noise(a, b):
    """Relative RMSE of the mean of the halves."""
    return float(np.sqrt(np.mean((a.astype(np.float64) - b) ** 2)) / 2 / (a.mean() + b.mean()) * 2)
