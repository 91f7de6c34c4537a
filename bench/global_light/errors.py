"""Errors of a picture with respect to two independent halves of a reference.

With halves A and B, each the truth plus independent noise, the mean of (x - A) (x - B) is that of
(x - truth)^2, because the noise of one half correlates with nothing else in the product. So errors
below the reference's own error can be measured, down to about the half's variance over the root of
the number of pixels.
"""

from dataclasses import dataclass

import numpy as np


def blocks(picture, side=8):
    h, w = (n // side * side for n in picture.shape[:2])
    cut = picture[:h, :w].astype(np.float64)
    return cut.reshape(h // side, side, w // side, side, -1).mean(axis=(1, 3))


def relative_rmse(picture, a, b):
    """Returns the RMSE relative to the reference's mean; 0 if the noise hides it."""
    square = float(np.mean((picture.astype(np.float64) - a) * (picture.astype(np.float64) - b)))
    return float(np.sqrt(max(square, 0.0)) / (0.5 * (a.mean() + b.mean())))


@dataclass
class Errors:
    pixels: float  # relative RMSE
    blocks: float  # relative RMSE of means over 8 x 8 pixels
    mean: float  # relative error of the picture's mean


def errors(picture, a, b):
    truth = 0.5 * (a.mean(dtype=np.float64) + b.mean(dtype=np.float64))
    return Errors(relative_rmse(picture, a, b), relative_rmse(blocks(picture), blocks(a), blocks(b)),
                  float(picture.mean(dtype=np.float64) / truth - 1))


def noise(a, b):
    """Returns the relative RMSE of the mean of the halves."""
    return float(np.sqrt(np.mean((a.astype(np.float64) - b) ** 2)) / 2 / (a.mean() + b.mean()) * 2)
