"""Compares whole pictures: the default over a sweep of --error with path tracing, error against time."""

import argparse
import csv
import os
import shutil
import sys
import time
from dataclasses import dataclass

import interiors
import page
import plot
from errors import errors, noise
from pfm import write
from program import Program


@dataclass
class Interior:
    name: str
    file: str  # empty: made by bench/interiors
    size: str
    paths: int  # paths per pixel of each half of the reference
    target: float  # intended speed-up over path tracing


INTERIORS = [
    Interior("kj92room", "scenes/kj92room/kj92room.gltf", "256x256", 1024, 50),
    Interior("modern-hall-diffuse", "scenes/modern-hall/modern-hall-diffuse.pbrt", "256x192", 512,
             30),
    Interior("modern-hall", "scenes/modern-hall/modern-hall.pbrt", "256x192", 512, 10),
    Interior("staircase", "", "256x192", 512, 10),
    Interior("bathroom", "", "256x192", 512, 10),
    Interior("ajar", "", "256x192", 512, 20),
    Interior("gallery", "", "256x192", 512, 20),
    Interior("furniture", "", "256x192", 512, 10),
    Interior("staircase-metal", "", "256x192", 512, 10),
    Interior("gloss", "", "256x192", 512, 10),
]
ERRORS = (0.05, 0.02, 0.01, 0.005)
PATHS = (16, 64, 256)
HEADER = ["scene", "method", "setting", "processor s", "viewing rays", "relative rmse",
          "8x8 rmse", "mean", "flip"]


def arguments():
    parser = argparse.ArgumentParser(prog="bench/global")
    parser.add_argument("--out", default="build/bench/global", metavar="FOLDER")
    parser.add_argument("--copy", metavar="FOLDER")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--references", action="store_true")
    parser.add_argument("--scenes", metavar="NAME,...")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    return parser.parse_args()


def scene_file(interior, out):
    if interior.file:
        return interior.file
    path = f"{out}/scenes/{interior.name}.pbrt"
    os.makedirs(f"{out}/scenes", exist_ok=True)
    interiors.write(interior.name, path)
    return path


def settings():
    for e in ERRORS:
        yield "default", f"--error {e:g}", f"--error {e:g}"
    for n in PATHS:
        yield "path", f"--spp {n}", f"--method path --spp {n} --max-spp {n}"


def halves(program, interior, is_quick):
    """Returns the reference's halves. They are unbiased, so any version of troffer may render them."""
    size = "80x60" if is_quick else interior.size
    paths = 256 if is_quick else interior.paths
    file = scene_file(interior, program.out)
    return [program.render(f"{interior.name}-half{seed}", file,
                           f"--size {size} --method path --spp {paths} --max-spp {paths} "
                           f"--seed {seed}", is_of_any_version=True) for seed in (101, 102)]


def measure(program, interior, is_quick):
    """Returns the rows of the table for one scene, and the noise of its reference."""
    size = "80x60" if is_quick else interior.size
    file = scene_file(interior, program.out)
    a, b = (h.picture for h in halves(program, interior, is_quick))
    reference = f"{program.out}/renders/{interior.name}-reference.pfm"
    write(reference, 0.5 * (a + b))
    rows = []
    for method, setting, options in settings():
        name = f"{interior.name}-{method}-{setting.split()[1]}"
        run = program.render(name, file, f"--size {size} {options}")
        e = errors(run.picture, a, b)
        flip = program.compare(run.exr, reference)["flip"]
        rows.append([interior.name, method, setting, round(run.cpu, 2), run.stats["viewing_rays"],
                     f"{e.pixels:.5f}", f"{e.blocks:.5f}", f"{e.mean:+.5f}", f"{flip:.5f}"])
    return rows, noise(a, b)


def main():
    options = arguments()
    chosen = [i for i in INTERIORS if not options.scenes or i.name in options.scenes.split(",")]
    os.makedirs(options.out, exist_ok=True)
    program = Program(options.build, options.out, "build/bench/global")
    runs = 0 if options.references else len(list(settings()))
    program.planned = len(chosen) * (2 + runs)
    start = time.monotonic()
    if options.references:
        for interior in chosen:
            halves(program, interior, options.quick)
        return
    rows, noises = [], {}
    for interior in chosen:
        more, noises[interior.name] = measure(program, interior, options.quick)
        rows += more
    with open(f"{options.out}/global.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADER, *rows])
    plot.error_against_time(f"{options.out}/global.png", rows)
    left_out = [i for i in INTERIORS if i not in chosen]
    text = page.text(chosen, left_out, rows, noises, options.quick)
    with open(f"{options.out}/README.md", "w") as file:
        file.write(text)
    print(page.summary(chosen, rows))
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for name in ("global.csv", "global.png", "README.md"):
            shutil.copyfile(f"{options.out}/{name}", f"{options.copy}/{name}")
    print(f"{(time.monotonic() - start) / 60:.1f} minutes; written to {options.copy or options.out}")


if __name__ == "__main__":
    sys.exit(main())
