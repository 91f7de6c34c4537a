"""Differences between pictures, which are linear float arrays (height, width, 3)."""

from dataclasses import dataclass

import numpy as np


def srgb8(linear):
    """Returns 8-bit sRGB values, as `troffer compare` and `--tone-map none` make them."""
    c = np.clip(np.nan_to_num(linear.astype(np.float64)), 0, 1)
    encoded = np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.power(c, 1 / 2.4) - 0.055)
    return np.floor(encoded * 255 + 0.5)


@dataclass
class Difference:
    average: float  # mean absolute difference of 8-bit rgb values, 0 ... 255
    rmse: float  # linear
    relative_rmse: float  # RMSE over the reference's mean


def difference(picture, reference, mask=None):
    """Compares all pixels, or those where mask (height, width) is set."""
    if mask is not None:
        picture, reference = picture[mask], reference[mask]
    rmse = float(np.sqrt(np.mean((picture.astype(np.float64) - reference) ** 2)))
    average = float(np.mean(np.abs(srgb8(picture) - srgb8(reference))))
    return Difference(average, rmse, rmse / max(float(reference.mean()), 1e-30))


def smooth(picture, mask, radius):
    """Returns the mean over squares of 2 radius + 1 pixels, of pixels in the mask; 0 outside of it."""
    weights = np.repeat(mask[..., None].astype(np.float64), picture.shape[-1], axis=-1)
    sums = []
    for plane in (picture * weights, weights):
        for axis in (0, 1):
            pad = [(radius + 1, radius) if a == axis else (0, 0) for a in range(3)]
            total = np.cumsum(np.pad(plane, pad), axis=axis)
            n = total.shape[axis]
            ahead = np.take(total, range(2 * radius + 1, n), axis=axis)
            plane = ahead - np.take(total, range(0, n - 2 * radius - 1), axis=axis)
        sums.append(plane)
    return np.where(mask[..., None], sums[0] / np.maximum(sums[1], 1), 0)


def at_equal(x, xs, ys):
    """Returns y at x on the curve through (xs, ys), linear in logarithms; NaN outside of the curve."""
    order = np.argsort(xs)
    xs, ys = np.asarray(xs, float)[order], np.asarray(ys, float)[order]
    if len(xs) == 0 or not xs[0] <= x <= xs[-1]:
        return float("nan")
    return float(np.exp(np.interp(np.log(x), np.log(xs), np.log(ys))))


def irradiance_of_rectangle(points, normals, corner, u, v, cells=48):
    """Returns the unoccluded irradiance per radiance, and the solid angle, of the parallelogram corner +
    [0,1] u + [0,1] v that emits toward u × v, by the midpoint rule. points, normals: (n, 3)."""
    corner, u, v = (np.asarray(a, float) for a in (corner, u, v))
    normal = np.cross(u, v)
    area = np.linalg.norm(normal)
    normal /= area
    irradiance, angle = np.zeros(len(points)), np.zeros(len(points))
    for i in range(cells):
        for j in range(cells):
            to = corner + u * (i + 0.5) / cells + v * (j + 0.5) / cells - points
            squared = np.maximum(np.einsum("ij,ij->i", to, to), 1e-12)
            cos_source = np.maximum(-(to @ normal) / np.sqrt(squared), 0)
            cos_point = np.maximum(np.einsum("ij,ij->i", to, normals) / np.sqrt(squared), 0)
            angle += cos_source / squared
            irradiance += cos_source * cos_point / squared
    return irradiance * area / cells**2, angle * area / cells**2
