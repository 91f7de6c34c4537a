"""Writes the page with all tables, in Markdown."""

import os

import rows

ASKED = {"kj92room": 20, "modern-hall-diffuse": 6, "clutter": 3, "foliage": 0.9}
TARGETS = (0.005, 0.001)


def table(header, body):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(c) for c in row) + " |" for row in body]
    return "\n".join(lines)


def share(value, digits=1):
    return f"{100 * value:.{digits}f} %"


def digits(value, count=3):
    return f"{float(f'{value:.{count}g}'):,.10g}"


def speed_up(curves, scene, view, error):
    """Returns the speed-up of certified visibility over the best fixed sampling at `error`."""
    fixed, method = rows.best_fixed(curves, scene, view, error)
    certified, mark = rows.cost_at(rows.curve(curves, scene, view, "certified"), error)
    if certified is None:
        return fixed, method, None, "beyond"
    if fixed is None:  # fixed sampling is slower than its slowest run, which is less accurate
        slowest = min(rows.curve(curves, scene, view, m)[-1] for m in rows.FIXED[1:])[1]
        return None, method, certified, f"> {slowest / certified:.1f}"
    return fixed, method, certified, f"{'≥ ' if mark else ''}{fixed / certified:.1f}"


def summary_rows(out):
    curves = rows.read(f"{out}/curves.csv")
    body = []
    for scene, view in rows.scenes(curves):
        row = [scene, view]
        for error in TARGETS:
            fixed, _, certified, factor = speed_up(curves, scene, view, error)
            row += [digits(fixed) if fixed else "beyond",
                    digits(certified) if certified else "beyond", f"**{factor}**"]
        body.append(row + [f"≥ {ASKED.get(scene, '–')}"])
    header = ["scene", "hits"]
    for error in TARGETS:
        header += [f"fixed, ns, at {error:g}", "certified, ns", "times as fast"]
    return header + ["asked at 0.005"], body


def summary_text(out):
    header, body = summary_rows(out)
    widths = [max(len(str(r[i])) for r in [header] + body) for i in range(len(header))]
    lines = ["  ".join(str(c).replace("**", "").ljust(w) for c, w in zip(row, widths))
             for row in [header] + body]
    return "\n".join(lines)


def default_rows(out):
    """Returns rows by --error: cost of certified visibility, and of fixed sampling for the same error."""
    curves = rows.read(f"{out}/curves.csv")
    body = []
    for r in curves:
        if r["method"] != "certified":
            continue
        fixed, method = rows.best_fixed(curves, r["scene"], r["view"], r["rms_visible"])
        body.append([r["scene"], r["view"], f"{r['setting']:g}", f"{r['rms_visible']:.5f}",
                     f"{r['predicted_visible']:.5f}",
                     f"{r['predicted_visible'] / max(r['rms_visible'], 1e-9):.1f}",
                     f"{r['rms_light']:.5f}", digits(r["ns_pair"]), digits(r["ns_hit"]),
                     f"{r['rays_hit']:.2f}", f"{fixed / r['ns_pair']:.1f}" if fixed else method])
    return body


def rays_rows(out):
    curves = rows.read(f"{out}/curves.csv")
    return [[r["scene"], r["view"], r["method"], f"{r['setting']:g}", f"{r['rms_visible']:.5f}",
             f"{r['rms_light']:.5f}", digits(r["ns_pair"]), digits(r["ns_hit"]),
             f"{r['rays_hit']:.1f}"] for r in curves if r["method"] != "certified"]


def pair_rows(out):
    return [[r["scene"], r["view"], f"{r['width']:.0f} × {r['height']:.0f}", f"{r['spp']:.0f}",
             digits(r["triangles"], 9), f"{r['sources']:.0f}", digits(r["hits"], 9),
             digits(r["counted"], 9), share(r["open"]), share(r["hidden"]),
             digits(r["reference_rays"], 9), f"{r['reference_rms_error']:.5f}"]
            for r in rows.read(f"{out}/pairs.csv") if r["view"] != "view"]


def answer_rows(out):
    return [[r["scene"], r["view"], f"{r['error']:g}", share(r["lit"]), share(r["dark"]),
             share(r["masked"]), f"{r['masked_predicted']:.4f} / {r['masked_rms']:.4f}",
             share(r["mixed"]), f"{r['mixed_predicted']:.4f} / {r['mixed_rms']:.4f}",
             f"{100 * r['worst_where_open']:.5f} %", f"{r['contradictions']:.0f}"]
            for r in rows.read(f"{out}/answers.csv")]


def shape_rows(out):
    return [[r["shape"], f"{r['points']:.0f}", f"{100 * r['mean_difference']:.6f} %",
             f"{100 * r['largest_difference']:.4f} %", f"{r['rays']:.1f}"]
            for r in rows.read(f"{out}/shapes.csv")]


def thin_rows(out):
    return [[r["scene"], r["what"], f"{r['error']:g}", f"{r['pairs']:.0f}", share(r["hidden"], 3),
             share(r["hidden_found"], 3), share(r["mean_size_of_error"], 3),
             share(r["largest_error"], 2), f"{r['contradictions']:.0f}"]
            for r in sorted(rows.read(f"{out}/thin.csv"), key=lambda r: -r["error"])]


def _in_standard_errors(row):
    if row["mean_error"] == 0 and row["standard_error"] == 0:
        return "exact: nothing there hides a source from these hits"
    return f"**{row['in_standard_errors']:+.2f}**"


def bias_rows(out):
    return [[r["scene"], f"{r['error']:g}", f"{r['pairs']:.0f}", f"{r['seeds']:.0f}",
             f"{r['mean_error']:+.7f}", f"{r['standard_error']:.7f}",
             f"{r['reference_standard_error']:.7f}", _in_standard_errors(r)]
            for r in rows.read(f"{out}/bias.csv")]


def write(out, tiles, commands, is_quick, missing):
    header, body = summary_rows(out)
    command = f"`bench/direct{' --quick' if is_quick else ''} --copy docs/results/direct`"
    first = ("**A quick try: few hits and settings, no results.** " if is_quick else "")
    absent = f" Left out, as it was not there: {', '.join(missing)}." if missing else ""
    text = f"""# Direct light: error against time

{first}Made by {command}, all of it, this page too; nothing here is typed by hand.{absent} What
is measured, by `bench/direct_light` (program `bench_direct`): the hits of {tiles} tiles of 8 × 8 pixels
spread over the picture, at low resolution with one viewing ray per pixel, and as they are rendered
with four; each paired with every flat source of the scene. A pair counts if its source, unhidden,
would give at least a thousandth of its mean irradiance. *Visible share*: how much of the source's
unoccluded irradiance arrives; *rms*: root mean square error over pairs. *ns*: processor time of one
thread, over all pairs that light could reach, the fastest of three runs (two of kj92, one of fixed
with more than 128 rays); all methods of a scene and view in one run of the program.

- **fixed**: N Owen-Sobol rays to every source, uniform in area, close to a source nearly uniform in
  solid angle; the ratio of open to all weights. *Packets*: 16 rays at a time, for N ≥ 32 such that
  a packet goes to a compact part of the source, which makes it up to twice as fast.
- **kj92**: a bintree for each source as `--method kj92` grows it (`src/kj92/bintree.h`), over a
  sweep of the allowed variance; the allowed error is that of all sources together; ratio estimate.
- **certified**: `--method certified` over a sweep of `--error`.

## Times as fast as fixed, at equal error

The faster of single rays and packets against certified visibility, in ns for a pair of hit and
source, at the same rms error of the visible share; between settings straight lines in logarithmic
scales, nothing beyond them. "≥": the coarsest setting is more exact than asked already; ">": fixed
sampling with 4096 rays is not so exact yet, and is counted with what these take; "beyond": no
setting of certified visibility is so exact.

{table(header, body)}

![rms error of the visible share against time](visibility.png)

The same of all light that a hit gets, against the time for all its sources:

![rms error of direct light against time](light.png)

## Certified visibility, setting by setting

*predicted*: root of the mean variance that the method tells; *light*: rms error of a hit's direct
irradiance, all sources, over the mean of what would arrive unhidden; the last column: at the error
it made, against the faster way of fixed sampling.

{table(["scene", "hits", "--error", "rms", "predicted", "predicted / rms", "light", "ns a pair",
        "ns a hit", "rays a hit", "times as fast as fixed"], default_rows(out))}

How pairs were answered; predicted / made error of masked and mixed ones; the largest relative
difference of the light from the closed form in double precision where the reference found nothing
hidden; pairs certified lit where a ray was hidden, or dark where one was not.

{table(["scene", "hits", "--error", "lit", "dark", "masked", "error", "mixed", "error",
        "off where nothing hides", "contradictions"], answer_rows(out))}

## Unoccluded light

`{commands.get("shapes", "")}`: one source of each shape alone, 20 000 points about it with any
normal, `--method certified` at default settings against closed forms in double precision; points
that get less than a thousandth of the mean are left out.

{table(["source", "points", "mean difference", "largest", "rays a point"], shape_rows(out))}

## Thin occluders

`{commands.get("thin", "")}`: a floor, lights of 1 m × 1 m and 1.5 m × 0.1 m, reference
2 × 16384 rays. *hidden*: mean hidden share by the reference and as found; *error*: of the
visible share, mean of its size over pairs, and largest.

{table(["scene", "occluders", "--error", "pairs", "hidden", "found", "mean error", "largest",
        "contradictions"], thin_rows(out))}

## Bias

`{commands.get("bias", "")}`
and so on: mean error over all pairs and seeds. The reference is 8 × 65536 rays, exact at the rim of
sources: what is closer to the source than a ray in single precision can tell is looked at in double
precision (`bench/direct_light/reference.h`). Its own standard error counts in the last column.

{table(["scene", "--error", "pairs", "seeds", "mean error", "standard error", "of the reference",
        "in standard errors"], bias_rows(out))}

## The scenes and their references

{table(["scene", "hits", "pixels", "rays per pixel", "triangles", "sources", "hits", "pairs", "open",
        "hidden", "reference rays", "its rms error"], pair_rows(out))}

## All runs of fixed and kj92

{table(["scene", "hits", "method", "rays or allowed variance", "rms", "light", "ns a pair",
        "ns a hit", "rays a hit"], rays_rows(out))}

CSV files: [curves](curves.csv), [answers](answers.csv), [pairs](pairs.csv), [thin](thin.csv),
[shapes](shapes.csv), [bias](bias.csv).
"""
    with open(os.path.join(out, "README.md"), "w") as file:
        file.write(text)
    return text
