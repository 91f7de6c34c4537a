"""Draws curves and maps with matplotlib."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LinearSegmentedColormap

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 110})
COLOURS = {
    "without coherence": "#c0392b",
    "with coherence": "#1f618d",
    "fixed Owen-Sobol": "#1e8449",
}


def _number(value, _):
    return f"{value:g}"


def _ticks(axis, values):
    axis.set_major_locator(matplotlib.ticker.FixedLocator(values))
    axis.set_minor_locator(matplotlib.ticker.NullLocator())
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(_number))


def two_axes(path, x, left, right, x_label, left_label, right_label, limits):
    """Draws one curve on each of two vertical axes over the allowed variance, as in figure 8.
    limits: (top of the left axis, top of the right axis), to make two plots comparable."""
    figure, axes = plt.subplots(figsize=(4.8, 3.4))
    a = axes.plot(x, left, "o-", ms=3.5, color="#34495e", label=left_label)
    axes.set(xscale="log", xlabel=x_label, ylabel=left_label, ylim=(0, limits[0]))
    _ticks(axes.xaxis, x)
    other = axes.twinx()
    other.grid(False)
    b = other.plot(x, right, "s--", ms=3.5, color="#c0392b", label=right_label)
    other.set(ylabel=right_label, ylim=(0, limits[1]))
    axes.legend(handles=a + b, loc="lower center", bbox_to_anchor=(0.5, 1), fontsize=8, ncol=2)
    plt.setp(axes.get_xticklabels(), rotation=60)
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)


def _few_ticks(axis, values):
    """Sets ticks at 1, 2, 5 of every decade around the values."""
    low, high = np.floor(np.log10(min(values))), np.ceil(np.log10(max(values)))
    ticks = [m * 10.0**e for e in np.arange(low, high + 1) for m in (1, 2, 5)]
    _ticks(axis, [t for t in ticks if min(values) / 2 <= t <= max(values) * 2])


def curves(path, series, x_label, y_label):
    """series: {name: (xs, ys)}, in logarithmic scales."""
    figure, axes = plt.subplots(figsize=(5.6, 3.8))
    for i, (name, (xs, ys)) in enumerate(series.items()):
        axes.plot(xs, ys, "o-", ms=3.5, color=COLOURS.get(name, f"C{i}"), label=name)
    axes.set(xscale="log", yscale="log", xlabel=x_label, ylabel=y_label)
    _few_ticks(axes.xaxis, [x for xs, _ in series.values() for x in xs])
    _few_ticks(axes.yaxis, [y for _, ys in series.values() for y in ys])
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)


def grey(path, values):
    """values (height, width) or (height, width, 3), 0 black … 1 white, one pixel each."""
    image = np.clip(values, 0, 1)
    if image.ndim == 2:
        image = np.repeat(image[..., None], 3, axis=2)
    plt.imsave(path, image)


def ray_map(path, rays):
    """Uses figure 9's greys: black for no rays, dark grey for 8, white from 32 on."""
    dark = 0.25
    shade = np.where(rays < 8, rays / 8 * dark, dark + (rays - 8) / 24 * (1 - dark))
    grey(path, shade)


def signed_map(path, values, limit, label, width=5.6):
    """Draws blue for too dark, red for too bright, white for equal, with a scale."""
    height = width * values.shape[0] / values.shape[1] * 0.84
    figure, axes = plt.subplots(figsize=(width, height))
    colours = LinearSegmentedColormap.from_list("signed", ["#1a3a8a", "#ffffff", "#a01010"])
    shown = axes.imshow(values, cmap=colours, vmin=-limit, vmax=limit, interpolation="nearest")
    axes.axis("off")
    figure.colorbar(shown, ax=axes, label=label, fraction=0.046, pad=0.02)
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)


def count_map(path, values, label, width=5.6):
    height = width * values.shape[0] / values.shape[1] * 0.84
    figure, axes = plt.subplots(figsize=(width, height))
    top = max(float(np.percentile(values, 99.5)), 1e-6)
    shown = axes.imshow(values, cmap="magma", vmin=0, vmax=top, interpolation="nearest")
    axes.axis("off")
    figure.colorbar(shown, ax=axes, label=label, fraction=0.046, pad=0.02)
    figure.tight_layout()
    figure.savefig(path)
    plt.close(figure)
