"""Draws error against time with matplotlib."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import rows

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 110})
STYLES = {
    "fixed single": ("#82c99a", "o--", "fixed, single rays"),
    "fixed packets": ("#1e8449", "o-", "fixed, packets of 16"),
    "kj92 alone": ("#e59866", "s--", "kj92 without coherence"),
    "kj92 coherence": ("#c0392b", "s-", "kj92 with coherence"),
    "certified": ("#1f3a93", "D-", "certified"),
}
LABELS = {
    "rms_visible": "RMSE of the visible share",
    "rms_light": "RMSE of direct light / mean unoccluded",
    "ns_pair": "ns per hit and source, one thread",
    "ns_hit": "ns per hit, one thread",
}


def _number(value, _):
    if value >= 1e6:
        return f"{value / 1e6:g}M"
    return f"{value / 1e3:g}k" if value >= 1e4 else f"{value:g}"


def _ticks(axis, values):
    low, high = np.floor(np.log10(min(values))), np.ceil(np.log10(max(values)))
    decades = [10.0**e for e in np.arange(low, high + 1)]
    steps = (1,) if high - low > 3 else (1, 3)
    ticks = [m * t for t in decades for m in steps if min(values) / 2 <= m * t <= max(values) * 2]
    axis.set_major_locator(matplotlib.ticker.FixedLocator(ticks))
    axis.set_minor_locator(matplotlib.ticker.NullLocator())
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(_number))


def error_against_time(path, table, error, cost):
    """Draws a row of panels for each view, and a column for each scene."""
    names = list(dict.fromkeys(r["scene"] for r in table))
    views = list(dict.fromkeys(r["view"] for r in table))
    figure, panels = plt.subplots(len(views), len(names), squeeze=False,
                                  figsize=(3.3 * len(names), 3.1 * len(views) + 0.5))
    for i, view in enumerate(views):
        for k, name in enumerate(names):
            _panel(panels[i][k], table, name, view, error, cost)
            if k == 0:
                panels[i][k].set_ylabel(LABELS[error])
            if i == len(views) - 1:
                panels[i][k].set_xlabel(LABELS[cost])
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=len(STYLES), frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.95))
    figure.savefig(path)
    plt.close(figure)


def _panel(axes, table, name, view, error, cost):
    all_x, all_y = [], []
    for method, (colour, style, label) in STYLES.items():
        points = rows.curve(table, name, view, method, error, cost)
        if not points:
            continue
        y, x = zip(*points)
        axes.plot(x, y, style, color=colour, ms=3.5, lw=1.2, label=label)
        all_x += x
        all_y += y
    axes.set(xscale="log", yscale="log", title=f"{name}, {view}")
    axes.title.set_fontsize(9)
    _ticks(axes.xaxis, all_x)
    _ticks(axes.yaxis, all_y)
    if error == "rms_visible":
        for level in (0.005, 0.001):
            axes.axhline(level, color="#999", lw=0.8, ls=":")
