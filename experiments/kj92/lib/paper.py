"""Makes figures 4, 5, 7 and table 1 of the paper."""

import csv

import plots
from crop import Crop
from differences import srgb8
from page import Picture, Section, Table
from settings import FIGURE_VARIANCE, sweep_name


def _drawn(context, figure, captions):
    with open(context.path(f"{figure}.csv")) as file:
        rows = list(csv.DictReader(file))
    pictures = [Picture(f"{figure}-{r['panel']}.png", captions(r)) for r in rows]
    table = Table(f"{figure}.csv", list(rows[0]), [list(r.values()) for r in rows], True)
    program = context.program
    command = program.shown([f"{program.build}/bench/kj92_bintree_figures", f"{program.out}/"])
    return rows, pictures, table, command


def figure4(context):
    def caption(row):
        forced = int(row["level_difference_rays"])
        why = f", {forced} of them for the level difference" if forced else ""
        what = "initial rays" if row["step"] == "initial rays" else f"{row['new_rays']} new{why}"
        return f"({row['panel']}) {row['rays']} rays: {what}; visible {float(row['mean']):.2f}"

    rows, pictures, table, command = _drawn(context, "figure4", caption)
    forced = [r["panel"] for r in rows if int(r["level_difference_rays"])]
    last = rows[-1]
    text = [
        "The square is the source; the grey part is hidden behind a straight edge. Open dots: the "
        "ray sees light; filled: it meets the occluder; ringed: new in this picture; orange: cells "
        "that exist only because of the level difference.",
        "As in the paper the rays gather along the shadow's boundary, and cells on both sides of "
        f"it are split because of the level difference (here in {', '.join(forced)}; the paper "
        "shows it twice in nine steps, as a larger difference than our 1 would give it). With "
        f"{last['rays']} rays the visible share is {float(last['mean']):.3f}; exactly it is "
        f"{float(last['exact']):.3f}, and the tree believes in a standard error of "
        f"{float(last['standard_error']):.3f}, which is far too cautious (see figure 8).",
        "One choice shows how flags mislead: in (b) and (c) rays go into the lower right quarter, "
        "which is nearly all shadow, because it differs from its neighbours, while the lower left "
        "quarter, which the edge does cross, looks like light for want of a second ray.",
    ]
    return Section(text, pictures, [table], [command])


def figure5(context):
    rows, pictures, table, command = _drawn(
        context, "figure5", lambda r: f"({r['panel']}) {r['step']}: {r['rays']} rays")
    a, b, c = rows
    text = [
        f"(a) The pattern at a point, {a['rays']} rays. (b) The shadow's edge has moved, much "
        "further than from one pixel to the next so that it can be seen: all leaves are cast again "
        f"with new positions in their cells, and refined, {b['rays']} rays. (c) Shrunk: where a "
        "node and both its children are all light or all shadow, two rays stay of their subtrees, "
        f"{c['rays']} in all; none above the initial level of 8 cells, and none that the level "
        "difference would ask for again at once.",
        "This is the paper's rule and its figure. What its text leaves open is whether rays keep "
        "their positions; ours do not, because an unlucky ray would spoil a whole scanline "
        "(docs/log/bintree.md has both measured).",
    ]
    return Section(text, pictures, [table], [command])


def figure7(context):
    crop = Crop.of(context)
    s = context.settings
    pictures, errors, rows = [], [], []
    shown = [
        ("a", "crop-1-64", "1 viewing ray, 64 shadow rays: a jittered one in each of 8 × 8 cells"),
        ("b", "crop-64-1", "64 viewing rays, 1 shadow ray each, not stratified"),
        ("c", "crop-norm", "4 viewing rays, 64 shadow rays: the norm picture"),
        ("d", sweep_name(FIGURE_VARIANCE, True),
         f"4 viewing rays, adaptive, allowed {FIGURE_VARIANCE}, with coherence"),
    ]
    for letter, name, caption in shown:
        run = context.runs[name]
        _show(context, f"figure7{letter}.png", run.picture)
        pictures.append(Picture(f"figure7{letter}.png", f"({letter}) {caption}", 320))
        error = (run.picture - crop.reference.picture).mean(axis=-1)
        file = f"figure7{letter}-error.png"
        # 0.05 of the mean spans the range from grey to black or white
        plots.grey(context.path(file), 0.5 + error / crop.reference.picture.mean() * 10)
        errors.append(Picture(file, f"({letter}) minus converged: white +5 %, black −5 %", 320))
        p = crop.point(run, letter)
        spp = run.stats["spp"]
        rows.append([f"7{letter}", spp, p.rays, spp * p.rays, p.norm.average, p.norm.rmse,
                     p.reference.average, p.reference.rmse, p.shadow_error, p.seconds, p.cpu])
    _show(context, "figure7-converged.png", crop.reference.picture)
    pictures.append(Picture("figure7-converged.png",
                            f"converged: {s.reference_spp} viewing rays, 64 shadow rays", 320))
    header = ["figure", "viewing rays per pixel", "shadow rays per viewing ray",
              "shadow rays per pixel", "average difference, norm", "rmse, norm",
              "average difference, converged", "rmse, converged", "error of D on the floor",
              "render s", "processor s"]
    return Section(_text7(*rows), pictures + errors, [Table("figure7.csv", header, rows)])


def _show(context, file, picture):
    plots.grey(context.path(file), srgb8(picture) / 255)


def _text7(a, b, c, d):
    worse = b[8] > a[8]
    return [
        "All four sources emit; D alone is sampled, and what the others give and what is "
        "reflected comes from the preprocessing, interpolated. So only D makes shadows, as in the "
        "paper. The lower row shows what is wrong with each.",
        "Against the converged picture 7a is off by "
        f"{a[6]:.2f}, 7b by {b[6]:.2f}, 7c by {c[6]:.2f} and 7d by {d[6]:.2f} (8-bit values); 7d "
        f"casts {d[3]:.0f} shadow rays per pixel, 7c {c[3]:.0f}, 7a {a[3]:.0f}, 7b {b[3]:.0f}. "
        + ("As in the paper, 64 rays that are not stratified over the source give the poorer "
           "shadow though edges are smooth, and 64 stratified ones rough edges." if worse else
           "In the paper 7b's shadow is poorer than 7a's; here it is not.")
        + (" The adaptive picture differs from the converged one little more than the norm does, "
           "for less than half of its shadow rays." if d[6] < 1.6 * c[6] and d[3] < c[3] / 2 else
           ""),
    ]


def table1(context):
    crop = Crop.of(context)
    header = ["method", "viewing rays per pixel", "allowed variance", "shadow rays per viewing ray",
              "average difference, norm", "rmse, norm", "average difference, reference",
              "rmse, reference", "shadow rays on the floor", "error of D on the floor",
              "bias of D on the floor", "render s", "processor s"]
    norm = crop.point(crop.norm, "norm picture (7c)")
    points = [norm, *crop.sweep[False], *crop.sweep[True], *crop.fixed]
    rows = [[p.method, 4, p.variance, p.rays, p.norm.average, p.norm.rmse, p.reference.average,
             p.reference.rmse, p.rays_floor, p.shadow_error, p.shadow_bias, p.seconds, p.cpu]
            for p in points]
    own = norm.reference
    at = {p.variance: (a, p) for a, p in zip(crop.sweep[False], crop.sweep[True])}
    single, coherent = at[FIGURE_VARIANCE]
    text = [
        "*Norm*: figure 7c. *Reference*: the converged picture of figure 7. *Error of D on the "
        "floor*: rmse of D's direct light where all viewing rays of a pixel meet the floor, "
        f"against the same viewing rays with {context.settings.reference_rays} fixed rays each, "
        "relative to D's mean unoccluded light there: the error of shadows alone, without that of "
        "edges. *Fixed Owen-Sobol* is the norm picture with D's light on the floor from "
        "`--method fixed`.",
        "The paper's values are lost in our copy; its text says that a larger allowance costs "
        "fewer rays and brings more error, and that the error remains small. So it is here: at "
        f"{FIGURE_VARIANCE}, {single.rays:.1f} rays and a difference of {single.norm.average:.2f} "
        f"from the norm without coherence, {coherent.rays:.1f} and {coherent.norm.average:.2f} "
        f"with it, of 255. The norm itself is off by {own.average:.2f} from the reference "
        f"(rmse {own.rmse:.4f}), so differences from it of about that size say little.",
    ]
    return Section(text, [], [Table("table1.csv", header, rows)])
