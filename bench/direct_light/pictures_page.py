"""Writes the tables of bench/direct-pictures, in Markdown."""

from rows import cost_at

HEADER = ["scene", "asked", "made", "made / asked", "told / made", "RMSE", "rays", "s", "fixed: cheapest run at or under it",
          "times as fast", "interpolated", "at or under made", "path: cheapest run at or under it", "times as fast",
          "interpolated"]


def shown(value):
    if value is None:
        return ""
    return value if isinstance(value, str) else f"{value:.4g}"


def runs_of(rows, scene, method):
    return [r for r in rows if (r["scene"], r["method"]) == (scene, method)]


def against(rows, certified, method):
    """Returns the cheapest run of `method` that is as accurate, its relative time, and the relative time
    interpolated between settings."""
    runs = runs_of(rows, certified["scene"], method)
    points = [(max(r["rmse"], 1e-7), r["seconds"]) for r in runs]  # 0: below the noise
    enough = [r for r in runs if r["rmse"] <= certified["rmse"]]
    cost, mark = cost_at(points, certified["rmse"])
    between = f"{cost / certified['seconds']:.2f}{' at most' if mark == '<=' else ''}" if cost else "–"
    if not enough:
        slowest = max(r["seconds"] for r in runs)
        return ["none", f"> {slowest / certified['seconds']:.2f}", between]
    best = min(enough, key=lambda r: r["seconds"])
    return [f"{best['setting']}: {best['seconds']:.3g} s",
            f"**{best['seconds'] / certified['seconds']:.2f}**", between]


def by_made(rows, certified):
    """Returns the relative time of the cheapest `fixed` run by the error that --error limits."""
    runs = runs_of(rows, certified["scene"], "fixed")
    enough = [r["seconds"] for r in runs if r["made"] <= certified["made"]]
    if not enough:
        return f"> {max(r['seconds'] for r in runs) / certified['seconds']:.2f}"
    return f"**{min(enough) / certified['seconds']:.2f}**"


def body(rows, scenes):
    for scene in scenes:
        for r in runs_of(rows, scene, "certified"):
            asked = r["setting"].split()[1]
            yield [scene, asked, f"{r['made']:.4f}", f"{r['made'] / float(asked):.2f}",
                   f"{r['told'] / max(r['made'], 1e-9):.2f}", f"{r['rmse']:.5f}", f"{r['rays']:.1f}", f"{r['seconds']:.3g}",
                   *against(rows, r, "fixed"), by_made(rows, r), *against(rows, r, "path")]


def table(header, lines):
    text = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(text + ["| " + " | ".join(str(c) for c in line) + " |" for line in lines])


def summary(rows, scenes):
    lines = [HEADER, *body(rows, scenes)]
    widths = [max(len(str(line[k]).replace("**", "")) for line in lines) for k in range(len(HEADER))]
    return "\n".join("  ".join(str(c).replace("**", "").ljust(w) for c, w in zip(line, widths))
                     for line in lines)


def all_runs(rows):
    return [[r["scene"], r["method"], r["setting"], f"{r['seconds']:.3g}", f"{r['rays']:.1f}",
             f"{r['rmse']:.5f}", shown(r["made"])] for r in rows]


def text(rows, scenes, shares, is_quick):
    names = [s.name for s in scenes]
    note = "\n**Quick run: small pictures, short references. No results.**\n" if is_quick else ""
    lights = [[s.name, s.lights, f"{100 * shares[s.name]:.0f} %"] for s in scenes]
    return f"""# Direct light, whole pictures
{note}
Made by `bench/direct-pictures`: `troffer render --indirect none` on one thread, `certified` (the
default) at settings of `--error`, `fixed` and `path` at settings of their rays. Nothing but the
command line: trees, masks, viewing rays and all else are in the times (`render_cpu` of `--stats`, the
quickest of three, of one where it took longer than .2 s).

- **asked**: `--error`. **made**: against the reference. **told**: layer `error`. Roots of mean squares
  over all pixels, edges too, of the error over the pixel's own light (or a hundredth of the mean light,
  where that is more): the viewing rays are the reference's own, so that only shadows differ.
- **RMSE**: over the mean light of the picture; what methods are compared by.
- `certified` and `fixed` have the same 4 viewing rays in a pixel, and so have their references (`fixed`
  with 16384 rays to all sources, up to 8192 to one, and with three quarters of them, by other random
  numbers: the product of the differences from both holds no noise of theirs); `path` has others, more of them at every setting, and a reference of its own, in two halves
  of 512 samples. So that this is fair, pixels count only where both references agree: where no edge goes through, and where gloss leaves little noise (one ray of the lobe's own,
  which `certified`, `fixed` and the reference have in common).
- **Cheapest run at or under it**: of the runs that were made, the cheapest that is as exact, and how
  many times the time of `certified` it takes. **Interpolated**: the same between two settings, on
  straight lines in logarithmic scales. "none": not even the slowest run was as exact.
- **At or under made**: the same as "times as fast", for `fixed`, by what was *made* and not by RMSE. `--error`
  asks for an error relative to each pixel's own light, and rays go to dark pixels for it; `fixed` casts
  as many everywhere, which RMSE, that hardly sees what is dark, counts in its favour.

{table(HEADER, body(rows, names))}

## Scenes

{table(["scene", "sources", "pixels that count"], lights)}

## All runs

{table(["scene", "method", "setting", "s", "shadow rays per viewing ray", "RMSE", "made"],
       all_runs(rows))}
"""
