"""Measures how time and memory of whole pictures grow, with one variable changed at a time."""

import argparse
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass

import lamps
import rooms

OPTIONS = "--error .05"
HEADER = ["varied", "value", "threads", "import s", "structures s", "cells s", "picture s", "in all s",
          "processor s", "memory MB", "cells", "pixels"]


@dataclass
class Case:
    varied: str
    value: str
    size: str  # the varied quantity, for the exponent
    triangles: int = 10_000
    lights: int = 10
    width: int = 256
    height: int = 256
    threads: int = 0  # 0: all cores
    texels: int = 0  # texels along an edge of each body's image; 0: no images


def cases(is_quick):
    shrink = 10 if is_quick else 1
    texels = [128, 512, 2048]
    pixels = [(256, 256), (512, 512), (1024, 1024), (3840, 2160)]
    for n in (10_000, 30_000, 100_000, 300_000, 1_000_000):
        yield Case("triangles", f"{n:,}", n, triangles=n // shrink)
    for n in (1, 10, 100, 1000):
        yield Case("lights", f"{n:,}", n, lights=max(1, n // shrink))
    for n in texels[:2] if is_quick else texels:
        yield Case("textures", f"{rooms.BODIES} × {n}²", rooms.BODIES * n * n, texels=n)
    for w, h in pixels[:2] if is_quick else pixels:
        yield Case("pixels", f"{w} × {h}", w * h, width=w, height=h)
    threads, cores = 1, os.cpu_count() or 1
    while threads <= cores:
        yield Case("threads", str(threads), threads, width=512, height=512, threads=threads)
        threads = threads * 2 if threads == cores else min(2 * threads, cores)


def scene_of(case, out):
    path = f"{out}/scenes/room-{case.triangles}-{case.lights}-{case.texels}.pbrt"
    if not os.path.exists(path):
        os.makedirs(os.path.dirname(path), exist_ok=True)
        rooms.write(path, case.triangles, case.lights, case.texels)
    return path


def run(case, troffer, out):
    threads = case.threads or os.cpu_count() or 1
    stats = f"{out}/stats.json"
    words = [troffer, "render", scene_of(case, out), *OPTIONS.split(), "--size",
             f"{case.width}x{case.height}", "--threads", str(threads), "--quiet", "-o",
             f"{out}/picture.exr", "--stats", stats]
    failed = subprocess.run(words, stdin=subprocess.DEVNULL).returncode
    if failed:
        sys.exit(f"error: status {failed} from: {' '.join(words)}")
    with open(stats) as file:
        s = json.load(file)
    seconds, cells = s["seconds"], s["cells"]
    picture = seconds["preprocess"] + seconds["render"] - cells["seconds"]
    return [case.varied, case.value, threads, *(f"{x:.3g}" for x in (
        seconds["import"], seconds["build"], cells["seconds"], picture, seconds["total"],
        seconds["total_cpu"])), f"{s['peak_memory_mb']:.0f}", cells["count"],
        s["width"] * s["height"]]


def exponent(sizes, values):
    """Returns p of value ~ size^p between the last two sizes, which predict larger ones best."""
    if min(values[-2:]) <= 0:
        return float("nan")
    return math.log(values[-1] / values[-2]) / math.log(sizes[-1] / sizes[-2])


EXPLANATION = {
    "triangles": "The hierarchy of triangles takes n log n, reading and memory n; what rays cost grows "
                 "with the logarithm. Cells follow surfaces as they turn: the finer "
                 "the bumps, the more of them, up to what voxels hold. Proofs look at "
                 "the triangles between a patch of the picture and a light; where they are too many, "
                 "rays take over.",
    "lights": "The lights share one area and one power. Of many weak ones some are drawn; few are "
              "certified one by one. What those in sight cover of a pixel is exact "
              "([cells](../cells.md), 8); [lamps.md](lamps.md) has them, finely divided ones and "
              "very unequal ones at equal error.",
    "textures": "Each body wears an image of its own, 8-bit PNG of as many texels. Reading decodes "
                "them, on all cores, structures are their levels ([textures](../materials.md#textures)); they stay as "
                "they are, three bytes a texel and a third more. What rays look up are levels as "
                "fine as their footprints, so that the picture takes hardly longer.",
    "pixels": "Cells are made for what is seen, and do not know of pixels; gathers and viewing rays go "
              "by pixels. More pixels on one surface share gathers over more neighbours, and clusters "
              "of viewing rays come closer together, which proofs like: time grows more slowly than "
              "pixels. Memory is that of layers and of what each pixel gathered.",
    "threads": "Pictures have the same bytes for any number. Small files are read by one, and hits are "
               "added to cells one after the other.",
}


def page(rows, sizes, minutes):
    lines = ["# How time and memory grow", "",
             "Made by `bench/growth --copy docs/results/growth`, this page too; nothing here is typed by "
             "hand. A room of 8 × 6 × 3 m with 24 bumpy bodies and a grid of lights in its ceiling "
             "(`bench/growth_tables/rooms.py`), whole pictures, `" + OPTIONS + "`; 10,000 triangles, 10 "
             f"lights, 256 × 256 pixels and {os.cpu_count()} threads where nothing else is said. Seconds by "
             "the clock, by phase: *import* reads files, *structures* builds hierarchies, *cells* "
             "prepares reflected light ([cells](../cells.md)), *picture* is gathers and viewing rays. "
             "*Processor*: of all threads, all phases. *Memory*: the most at any time. "
             "*Growth*: the exponent between the last two rows.", ""]
    for varied in EXPLANATION:
        mine = [r for r in rows if r[0] == varied]
        at = [s for r, s in zip(rows, sizes) if r[0] == varied]
        lines += [f"## {varied.capitalize()}", "", EXPLANATION[varied], "",
                  f"| {varied} | " + " | ".join(HEADER[3:11]) + " |", "|---" * 9 + "|"]
        for r in mine:
            lines.append("| " + " | ".join(str(x) for x in [r[1], *r[3:11]]) + " |")
        if len(mine) > 1:
            growth = [exponent(at, [float(r[c]) for r in mine]) for c in range(3, 11)]
            lines.append("| *growth* | " + " | ".join("" if math.isnan(g) else f"*{g:.2f}*" for g in growth)
                         + " |")
        lines.append("")
    lines.append(f"{minutes:.1f} minutes in all.")
    return "\n".join(lines) + "\n"


def finish(options, names, minutes):
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for name in names:
            shutil.copyfile(f"{options.out}/{name}", f"{options.copy}/{name}")
    print(f"{minutes:.1f} minutes; written to {options.copy or options.out}")


def main():
    parser = argparse.ArgumentParser(prog="bench/growth")
    parser.add_argument("--out", default="build/bench/growth", metavar="FOLDER")
    parser.add_argument("--copy", metavar="FOLDER")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--lamps", action="store_true")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    start = time.monotonic()
    troffer = f"{options.build}/troffer"
    if options.lamps:
        rows, measured = lamps.run(troffer, options.out)
        minutes = (time.monotonic() - start) / 60
        lamps.write_results(rows, measured, minutes, options.out)
        finish(options, ("lamps.csv", "lamps.md"), minutes)
        return
    rows, sizes = [], []
    for case in cases(options.quick):
        rows.append(run(case, troffer, options.out))
        sizes.append(float(case.size))
        print(" ".join(f"{x!s:>10}" for x in rows[-1]), flush=True)
    minutes = (time.monotonic() - start) / 60
    with open(f"{options.out}/growth.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADER, *rows])
    with open(f"{options.out}/README.md", "w") as file:
        file.write(page(rows, sizes, minutes))
    finish(options, ("growth.csv", "README.md"), minutes)


if __name__ == "__main__":
    sys.exit(main())
