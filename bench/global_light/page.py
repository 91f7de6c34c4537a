"""Writes the page with the tables, in Markdown."""

import math


def table(header, body):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(c) for c in row) + " |" for row in body]
    return "\n".join(lines)


def path_seconds(rows, error):
    """Returns path tracing's time for `error`: that of its run with the nearest error, times the square
    of the ratio of the errors; and the paths of the cheapest run that reaches the error."""
    runs = [(float(r[5]), float(r[3]), r[2]) for r in rows if r[1] == "path"]
    nearest = min(runs, key=lambda r: abs(math.log(max(r[0], 1e-9) / max(error, 1e-9))))
    existing = [r for r in runs if r[0] <= error]
    cheapest = min(existing, key=lambda r: r[1]) if existing else None
    return nearest[1] * (nearest[0] / max(error, 1e-9)) ** 2, cheapest


def gains(interior, rows):
    mine = [r for r in rows if r[0] == interior.name]
    for r in mine:
        if r[1] != "default":
            continue
        error, seconds = float(r[5]), float(r[3])
        equal, cheapest = path_seconds(mine, error)
        existing = f"{cheapest[1]:g} s ({cheapest[2]})" if cheapest else "none"
        yield [interior.name, r[2], seconds, r[5], r[6], f"{100 * float(r[7]):+.2f} %", r[8],
               f"{equal:.1f}", f"**{equal / seconds:.1f}**", existing]


HEADER = ["scene", "setting", "processor s", "relative RMSE", "8 × 8", "mean", "FLIP",
          "path, s at equal RMSE", "times as fast", "cheapest path run at or under it"]


def summary(interiors, rows):
    body = [g for i in interiors for g in gains(i, rows)]
    widths = [max(len(str(r[k])) for r in [HEADER] + body) for k in range(len(HEADER))]
    return "\n".join("  ".join(str(c).replace("**", "").ljust(w) for c, w in zip(row, widths))
                     for row in [HEADER] + body)


def text(interiors, left_out, rows, noises, is_quick):
    body = [g for i in interiors for g in gains(i, rows)]
    paths = [[r[0], r[2], r[3], r[5], r[6], f"{100 * float(r[7]):+.2f} %", r[8]]
             for r in rows if r[1] == "path"]
    noise = [[i.name, i.size, f"2 × {i.paths}", f"{noises[i.name]:.5f}"] for i in interiors]
    note = "**A quick run: no results.**\n\n" if is_quick else ""
    missing = f"Not in this run: {', '.join(i.name for i in left_out)}.\n\n" if left_out else ""
    return f"""# Whole pictures of interiors: error against time

{note}Made by `bench/global --copy docs/results/global`, this page too; nothing here is typed by hand.
The default method over a sweep of `--error`, beside path tracing, in one run on the same machine:
*processor s* is processor time of the whole command, all threads, reading the scene and all
preparation included. *Relative RMSE*: over the picture's mean, per pixel and for means of 8 × 8
pixels, against path tracing in two independent halves, so that the reference's own noise is taken
out. *Path, s at equal RMSE*: path tracing's error falls with the root of its time; from its run
nearest in error. The scenes: the two of `scenes/`, and those of `bench/interiors`, made by rule.

{missing}{table(HEADER, body)}

![Error against time](global.png)

## Path tracing

{table(["scene", "setting", "processor s", "relative RMSE", "8 × 8", "mean", "FLIP"], paths)}

## References

{table(["scene", "pixels", "paths per pixel", "relative RMSE of their mean"], noise)}
"""
