"""Makes figures of whole rooms: figure 6, the reference, selection, refinement, the halls."""

import math

import numpy as np

import exr
import plots
from differences import at_equal, difference, srgb8
from page import Picture, Section, Table
from settings import (DIFFUSE_HALL_REFERENCE, ROOM_DIRECT_REFERENCE, ROOM_REFERENCE,
                      SELECTION_SCENES, refinement_name, selection_name)

RAYS = "shadow rays per viewing ray"
DIFFERENCE = "average difference (8-bit)"
OTHER_SIZE = Section(["Left out in a quick try, whose pictures have another size than the "
                      "reference."])


def figure6(context):
    run = context.runs["room"]
    plots.grey(context.path("figure6.png"), srgb8(run.picture) / 255)
    sources = run.layers["sources"][..., 0]
    plots.count_map(context.path("figure6-sources.png"), sources,
                    "sources sampled per viewing ray", 5)
    text = [
        "The room with table and cabinet by `kj92` at default settings. A and B are the small "
        "sources on the right wall, C the large one on the left wall, D that on the ceiling; none "
        "is in view. The room is built after the paper's sketch; its sizes, reflectances and "
        "radiances are ours.",
        "The second picture counts the sources that are sampled at each point (bright patches "
        "count too): none on the table top and the walls that see all lights freely, most under "
        f"the table and beside the cabinet, {sources.mean():.2f} in the mean. In the paper the "
        "floor samples D alone; by our thresholds it samples more sources, and the crop below is "
        "therefore told to sample D alone.",
    ]
    return Section(text, [Picture("figure6.png", "6b: the whole room", 512),
                          Picture("figure6-sources.png", "sources sampled")])


def _row(name, run, reference):
    d = difference(run.picture, reference)
    off = 100 * (float(run.picture.mean()) / float(reference.mean()) - 1)
    s = run.stats
    return [name, s["spp"], s["shadow_rays_per_viewing_ray"], off, d.relative_rmse, d.average,
            s["seconds"]["preprocess"], s["seconds"]["render"], run.cpu, s["peak_memory_mb"]]


ROOM_DIFFERENCE_TEXT = (
    "Where the approximation lives: reflected light, and sources that are not sampled, come from "
    "a mesh. The feet of the table's legs are too bright, for elements blur what is smaller than "
    "themselves; the wall above the cabinet has dark spots and its foot a dark line, most likely "
    "because sample points in the narrow gap behind it speak for the visible parts of their "
    "elements as well. "
    "The outline of the table is the noise of four viewing rays on its edges.")
HEADER = ["picture", "viewing rays per pixel", RAYS, "mean, % off the reference",
          "relative rmse", DIFFERENCE, "preprocessing s", "rendering s", "processor s",
          "peak memory MB"]


def whole_room(context):
    if context.settings.is_quick:
        return OTHER_SIZE
    reference = exr.read(ROOM_REFERENCE)[""]
    run = context.runs["room-default"]
    error = (run.picture - reference).mean(axis=-1) / float(reference.mean())
    plots.signed_map(context.path("room-difference.png"), error, 0.1,
                     "difference / mean of the reference")
    row = _row("kj92room", run, reference)
    within = "within" if abs(row[3]) <= 1.5 else "outside"
    text = [
        f"At default settings the mean is {row[3]:+.2f} % off the path-traced one, {within} the "
        f"1.5 % that we ask for. Half of all pixels are off by less than "
        f"{100 * float(np.median(np.abs(error))):.1f} %, 99 % by less than "
        f"{100 * float(np.percentile(np.abs(error), 99)):.1f} % of the mean; the reference's own "
        "noise of 0.8 % and the four viewing rays on edges are part of that.",
        ROOM_DIFFERENCE_TEXT,
    ]
    return Section(text, [Picture("room-difference.png", "kj92 minus reference")],
                   [Table("room.csv", HEADER, [row])])


def selection(context):
    header = ["scene", "selection", "allowed variance", RAYS, "sources sampled", "sources probed",
              DIFFERENCE, "relative rmse, of light clipped at 1", "mean, % off", "render s",
              "processor s"]
    rows, pictures, text = [], [], [
        "Direct light only (`--indirect none`), so that rays to bright patches do not count "
        f"and the truth is known: {context.settings.selection_reference_rays} fixed rays to every "
        "source from the very same viewing rays. Without selection every source is sampled at "
        "every point."]
    for scene, _, _ in SELECTION_SCENES:
        exact = context.runs[f"{scene}-direct"].picture
        own = []
        for on in ("off", "on"):
            for v in context.settings.selection_variances:
                run = context.runs[selection_name(scene, on, v)]
                shown = difference(np.minimum(run.picture, 1), np.minimum(exact, 1))
                off = 100 * (float(run.picture.mean()) / float(exact.mean()) - 1)
                sampled, *probed = run.layers["sources"].mean(axis=(0, 1))
                own.append([scene, on, v, run.rays, float(sampled), float(sum(probed)),
                            shown.average, shown.relative_rmse, off,
                            run.stats["seconds"]["render"], run.cpu])
        series = {f"selection {on}": ([r[3] for r in own if r[1] == on],
                                      [r[6] for r in own if r[1] == on]) for on in ("off", "on")}
        file = f"selection-{scene}.png"
        plots.curves(context.path(file), series, RAYS, DIFFERENCE)
        pictures.append(Picture(file, f"{scene}: difference against rays"))
        text.append(_saved(scene, series) + " " + _treated(own))
        rows += own
    text.append(
        "Selection helps twice: rays are saved, and a source that is plainly seen is added "
        "exactly, without noise, where without selection its rays still differ in value. It saves "
        "least where the allowance is small, for then most rays go to sources in penumbra, which "
        "no selection may leave out.")
    return Section(text, pictures, [Table("selection.csv", header, rows)])


def _treated(rows):
    """Summarizes the selection of one scene."""
    off, on = ([r for r in rows if r[1] == which] for which in ("off", "on"))
    widest = max(r[2] for r in rows)
    bias = {r[1]: r[8] for r in rows if r[2] == widest}
    return (f"Sampled at a viewing ray are {on[0][4]:.1f} sources, and {on[0][5]:.1f} probed "
            f"(without selection {off[0][4]:.1f}, bounces of mirrors not counted). At {widest:g} "
            f"the mean is {bias['on']:+.1f} % off with selection, {bias['off']:+.1f} % without.")


def _saved(scene, series):
    """Returns rays with and without selection at equal difference."""
    off, on = series["selection off"], series["selection on"]
    ratios = [(r, at_equal(e, off[1], off[0])) for r, e in zip(*on)]
    found = [(r, o) for r, o in ratios if not math.isnan(o)]
    if not found:
        return f"{scene}: the two curves have no difference in common."
    best, worst = max(o / r for r, o in found), min(o / r for r, o in found)
    pairs = ", ".join(f"{r:.1f} instead of {o:.1f}" for r, o in found)
    return (f"{scene}: at equal difference {pairs} shadow rays per viewing ray, "
            f"{worst:.2f} to {best:.2f} times fewer.")


def refinement(context):
    if context.settings.is_quick:
        return OTHER_SIZE
    reference = exr.read(ROOM_DIRECT_REFERENCE)[""]
    header = ["viewing rays, first", "viewing rays, most", "viewing rays per pixel",
              "shadow rays per pixel", "relative rmse", DIFFERENCE, "render s", "processor s"]
    rows = []
    for low, high in context.settings.refinement:
        run = context.runs[refinement_name(low, high)]
        d = difference(run.picture, reference)
        pixels = run.stats["width"] * run.stats["height"]
        rows.append([low, high, run.stats["viewing_rays"] / pixels,
                     run.stats["shadow_rays"] / pixels, d.relative_rmse, d.average,
                     run.stats["seconds"]["render"], run.cpu])
    series = {}
    for name, keep in (("the same everywhere", lambda r: r[0] == r[1]),
                       ("refined", lambda r: r[0] != r[1])):
        kept = [r for r in rows if keep(r)]
        series[name] = ([r[7] for r in kept], [r[4] for r in kept])
    plots.curves(context.path("refinement.png"), series, "processor time of the process, s",
                 "relative rmse")
    even, refined = series["the same everywhere"], series["refined"]
    gains = [at_equal(e, even[1], even[0]) / t for t, e in zip(*refined)]
    known = [f"{g:.1f}" for g in gains if g == g]
    text = [
        "The whole room, direct light, allowed 0.05, against pbrt-v4's 2048 paths per pixel, whose "
        "own noise is 0.4 %. *Refined*: after 1, 2 or 4 viewing rays in every pixel, up to 8 times "
        "as many where colour, object or shadow pattern differ from a neighbour's. "
        + (f"At equal error refinement takes {' and '.join(known)} times less processor time."
           if known else "The refined pictures' errors lie below those of all even ones."),
    ]
    return Section(text, [Picture("refinement.png", "error against time")],
                   [Table("refinement.csv", header, rows)])


def halls(context):
    plain, diffuse = context.runs["hall-default"], context.runs["hall-diffuse-default"]
    path = context.runs["hall-path"]
    pictures = []
    for file, run, caption in (
        ("hall.png", plain, "modern-hall by kj92, default settings"),
        ("hall-path.png", path, f"modern-hall by path tracing, {path.stats['spp']} paths a pixel"),
        ("hall-diffuse.png", diffuse, "modern-hall-diffuse by kj92, default settings"),
    ):
        plots.grey(context.path(file), srgb8(run.picture * 2**-0.7) / 255)
        pictures.append(Picture(file, caption))
    rows = [_row("modern-hall", plain, path.picture)]
    text = []
    if not context.settings.is_quick:
        reference = exr.read(DIFFUSE_HALL_REFERENCE)[""]
        error = (diffuse.picture - reference).mean(axis=-1) / float(reference.mean())
        plots.signed_map(context.path("hall-diffuse-difference.png"), error, 0.3,
                         "difference / mean of the reference")
        pictures.append(Picture("hall-diffuse-difference.png",
                                "modern-hall-diffuse: kj92 minus path-traced reference"))
        rows.append(_row("modern-hall-diffuse", diffuse, reference))
        text.append(_halls_text(rows))
    return Section(text, pictures, [Table("halls.csv", HEADER, rows)])


def _halls_text(rows):
    plain, diffuse = rows
    return (
        f"Both halls go through whole, without special settings, in {plain[8]:.0f} s and "
        f"{diffuse[8]:.0f} s of processor time and {plain[9]:.0f} and {diffuse[9]:.0f} MB, at {plain[2]:.0f} and "
        f"{diffuse[2]:.0f} shadow rays per viewing ray: 13 sources and many bright patches, at an "
        "allowance of 0.01, where the second stop or the cap ends most trees. The diffuse "
        f"hall's mean is {diffuse[3]:+.2f} % off the reference (ours is rgb, the reference spectral: path "
        f"tracing itself is 0.4 % off). modern-hall is {plain[3]:+.1f} % off: the preprocessing "
        "follows no light by way of the glossy floor, chrome and glass to the place where it "
        "arrives.")
