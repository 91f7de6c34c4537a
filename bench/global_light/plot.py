"""Draws error against time, a panel for each scene, with matplotlib."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 110})
STYLES = {"path": ("#c0392b", "o-"), "default": ("#1f3a93", "D-")}


def error_against_time(path, rows, columns=4):
    names = list(dict.fromkeys(r[0] for r in rows))
    lines = (len(names) + columns - 1) // columns
    figure, panels = plt.subplots(lines, columns, squeeze=False,
                                  figsize=(3.2 * columns, 2.9 * lines + 0.4))
    for i, axes in enumerate(panels.flat):
        if i >= len(names):
            axes.set_visible(False)
            continue
        for method, (colour, style) in STYLES.items():
            mine = [r for r in rows if r[0] == names[i] and r[1] == method]
            x = [float(r[3]) for r in mine]
            axes.plot(x, [float(r[5]) for r in mine], style, color=colour, ms=3.5, lw=1.2,
                      label=f"{method}, pixels")
            axes.plot(x, [float(r[6]) for r in mine], style[0] + ":", color=colour, ms=2.5, lw=1,
                      label=f"{method}, 8 × 8 blocks")
        axes.set(xscale="log", yscale="log", title=names[i])
        if i % columns == 0:
            axes.set_ylabel("relative RMSE")
        if i // columns == lines - 1:
            axes.set_xlabel("processor seconds")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncol=4, frameon=False)
    figure.tight_layout(rect=(0, 0, 1, 0.95))
    figure.savefig(path)
    plt.close(figure)
