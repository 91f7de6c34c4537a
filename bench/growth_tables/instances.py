"""Measures the cost of instances and of copies: halls with increasing numbers of plants."""

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import time

import plants

# plants, triangles of each, also as copies, methods
CASES = [(10, 100_000, True, 2), (100, 100_000, True, 2), (1000, 100_000, False, 2),
         (2000, 1000, True, 1), (10_000, 250, True, 1), (100_000, 70, True, 1)]
METHODS = [("path", "--method path --spp 8 --size 256x256"), ("certified", "--error .1 --size 48x48")]
HEADER = ["plants", "triangles each", "stored as", "method", "import s", "structures s", "rest s",
          "processor s", "memory MB", "mean"]


def shorter(cases, is_quick):
    return [(max(2, n // 10), t, c, m) for n, t, c, m in cases] if is_quick else cases


def run(troffer, scene, options, out):
    words = [troffer, "render", scene, *options.split(), "--quiet", "-o",
             f"{out}/picture.pfm", "--stats", f"{out}/stats.json"]
    subprocess.run(words, stdin=subprocess.DEVNULL, check=True)
    with open(f"{out}/stats.json") as file:
        s = json.load(file)
    seconds = s["seconds"]
    rest = seconds["preprocess"] + seconds["render"]
    return [*(f"{x:.3g}" for x in (seconds["import"], seconds["build"], rest, seconds["total_cpu"])),
            f"{s['peak_memory_mb']:.0f}", f"{mean_of(f'{out}/picture.pfm'):.5g}"]


def mean_of(path):
    import numpy as np
    with open(path, "rb") as file:
        file.readline()
        width, height = map(int, file.readline().split())
        file.readline()
        return float(np.fromfile(file, "<f4", 3 * width * height).mean())


def page(rows, minutes):
    lines = ["# What instances cost", "",
             "Made by `bench/instances --copy docs/results/growth`; nothing here is typed by hand. A hall "
             "of 20 × 15 × 4 m under 12 lamps, full of plants (`bench/growth_tables/plants.py`), each the "
             "same bush of curved leaves, turned, of another size, every fifth mirrored; "
             f"{os.cpu_count()} threads, " + ", ".join(f"`{words}`" for _, words in METHODS) + ". *Instances*: "
             "`ObjectInstance`s, of which the first are copied ([formats.md](../formats.md#instances)); *copies*: "
             "as many shapes, each read from the same file. Seconds by the clock: *import* reads files, "
             "*structures* builds what rays need, *rest* is all else; *processor*: of all threads, all "
             "phases, which other work on the machine changes less. *Memory*: the most at any time. *Mean*: of the picture.", "",
             "| " + " | ".join(HEADER) + " |", "|---" * len(HEADER) + "|"]
    lines += ["| " + " | ".join(str(x) for x in row) + " |" for row in rows]
    lines += ["", f"{minutes:.1f} minutes in all."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(prog="bench/instances")
    parser.add_argument("--out", default="build/bench/instances", metavar="FOLDER")
    parser.add_argument("--copy", metavar="FOLDER")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    options = parser.parse_args()
    os.makedirs(f"{options.out}/scenes", exist_ok=True)
    start = time.monotonic()
    rows = []
    for count, triangles, has_copies, methods in shorter(CASES, options.quick):
        for is_copied in (False, True) if has_copies else (False,):
            kind = "copies" if is_copied else "instances"
            scene = f"{options.out}/scenes/{count}x{triangles}-{kind}.pbrt"
            plants.write(scene, count, triangles, is_copied)
            for method, words in METHODS[:methods]:
                rows.append([f"{count:,}", f"{triangles:,}", kind, method,
                             *run(f"{options.build}/troffer", scene, words, options.out)])
                print(" ".join(f"{x!s:>10}" for x in rows[-1]), flush=True)
    minutes = (time.monotonic() - start) / 60
    with open(f"{options.out}/instances.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADER, *rows])
    with open(f"{options.out}/instances.md", "w") as file:
        file.write(page(rows, minutes))
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for name in ("instances.csv", "instances.md"):
            shutil.copyfile(f"{options.out}/{name}", f"{options.copy}/{name}")


if __name__ == "__main__":
    sys.exit(main())
