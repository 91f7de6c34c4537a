"""Draws pictures side by side, each above a magnified part of it, with captions."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from differences import srgb8

SIDE = 512  # pixels of a panel
GAP = 16
CAPTION = 136
DPI = 100


def _magnified(picture, side):
    """Repeats whole pixels, so that noise is not smoothed."""
    k = side // picture.shape[0]
    return np.repeat(np.repeat(picture, k, axis=0), k, axis=1)


def _rays(n):
    if n == 0:
        return "no"
    return f"{n / 1e6:.2f} M" if n < 1e7 else f"{n / 1e6:.0f} M"


def _caption(row):
    method, _, cpu, viewing, shadow, error = row
    numbers = f"{cpu:.2f} s" if cpu < 10 else f"{cpu:.0f} s"
    if error:
        numbers += f", error {100 * float(error):.2g} %"
    return method, numbers, f"{_rays(viewing)} viewing rays, {_rays(shadow)} shadow rays"


def draw(path, rows, pictures, detail):
    """rows: [method, options, seconds, viewing rays, shadow rays, relative rmse or ""]."""
    exposure = 0.8 / max(float(np.percentile(pictures[-1], 99)), 1e-9)
    n = len(pictures)
    width, height = n * SIDE + (n - 1) * GAP, 2 * SIDE + GAP + CAPTION
    canvas = np.ones((height, width, 3))
    x0, y0, x1, y1 = detail
    for i, picture in enumerate(pictures):
        shown = srgb8(picture * exposure) / 255
        left = i * (SIDE + GAP)
        whole = _magnified(shown, SIDE)
        k = SIDE // picture.shape[0]
        frame = whole
        for t in range(2):
            frame[k * y0 + t, k * x0 : k * x1] = frame[k * y1 - 1 - t, k * x0 : k * x1] = (1, 0.6, 0)
            frame[k * y0 : k * y1, k * x0 + t] = frame[k * y0 : k * y1, k * x1 - 1 - t] = (1, 0.6, 0)
        canvas[:SIDE, left : left + SIDE] = whole
        canvas[SIDE + GAP : 2 * SIDE + GAP, left : left + SIDE] = _magnified(shown[y0:y1, x0:x1],
                                                                            SIDE)
    figure = plt.figure(figsize=(width / DPI, height / DPI), dpi=DPI)
    figure.figimage(canvas, 0, 0, origin="upper")
    for i, row in enumerate(rows):
        x = (i * (SIDE + GAP) + SIDE / 2) / width
        for line, text in enumerate(_caption(row)):
            figure.text(x, (CAPTION - 28 - 42 * line) / height, text, ha="center", va="center",
                        fontsize=17 if line else 24)
    figure.savefig(path, dpi=DPI)
    plt.close(figure)
