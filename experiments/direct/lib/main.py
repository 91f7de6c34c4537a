"""Renders the crop under the table by fixed, kj92 and certified at equal time, and converged."""

import argparse
import csv
import os
import shutil
import sys

import panels
from differences import difference
from program import Program

ROOM = "scenes/kj92room/kj92room.gltf"
# The floor at the left back leg of the table, as in the experiments of 1992; only source D is
# sampled.
VIEW = ("--eye 0.7,1.9,0.66 --target 1.38,2.95,0.05 --up 0,0,1 --fov 45 --size 256x256 "
        "--light emitter0 --indirect none")
LIGHT = "--light emitter0"
DETAIL = (80, 96, 144, 160)  # magnified part of the picture, shown in the second row: x0, y0, x1,
                             # y1

FILE = "equal-time"
HEADER = ["method", "options", "processor s", "viewing rays", "shadow rays", "relative rmse"]


def candidates(solution):
    """Returns {method: options}; the best of each that takes no longer than certified is shown."""
    fixed = [f"--spp {spp} --shadow-rays {n}" for spp in (1, 2, 4) for n in (1, 2, 4, 8, 16, 32)]
    kj92 = [f"--spp {spp} --variance {v:g} --shadow-rays {n} --solution {solution}"
            for spp in (1, 2, 4) for v in (0.05, 0.1, 0.2, 0.5) for n in (4, 8, 16)]
    return {"fixed": fixed, "kj92": kj92}


def seconds(run):
    return run.stats["seconds"]["render_cpu"]


def best_of(runs, allowed, reference):
    """Returns the run with the least error within the allowed time; the fastest if all take longer."""
    inside = [r for r in runs if seconds(r) <= allowed]
    if not inside:
        return min(runs, key=seconds)
    return min(inside, key=lambda r: difference(r.picture, reference).relative_rmse)


def arguments():
    parser = argparse.ArgumentParser(prog="experiments/direct/run")
    parser.add_argument("--out", default="build/experiments/direct", metavar="FOLDER")
    parser.add_argument("--copy", metavar="FOLDER")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    return parser.parse_args()


def render_all(program):
    """Returns {caption: (run, options)} in the order of the panels, and the reference."""
    program.planned = 2
    converged = program.render("converged", ROOM,
                               f"{VIEW} --method fixed --spp 256 --shadow-rays 64 --seed 1")
    reference = converged.picture
    solution = program.radiosity("crop", ROOM, LIGHT).exr
    certified = program.timed("certified", ROOM, f"{VIEW} --method certified")
    shown = {}
    for method, all_options in candidates(solution).items():
        runs = []
        for i, options in enumerate(all_options):
            run = program.timed(f"{method}-{i}", ROOM, f"{VIEW} --method {method} {options}")
            run.options = options.split(" --solution")[0]
            runs.append(run)
        shown[method] = best_of(runs, 1.1 * seconds(certified), reference)
    certified.options = "default"
    converged.options = "--spp 256 --shadow-rays 64"
    return {**shown, "certified": certified, "converged": converged}


def main():
    options = arguments()
    os.makedirs(options.out, exist_ok=True)
    program = Program(options.build, options.out, "build/experiments/direct")
    runs = render_all(program)
    reference = runs["converged"].picture
    rows = []
    for method, run in runs.items():
        error = difference(run.picture, reference).relative_rmse
        # The converged picture was rendered on all cores, and its error is unknown.
        is_known = method != "converged"
        rows.append([method, run.options, round(seconds(run), 3), run.stats["viewing_rays"],
                     run.stats["shadow_rays"], f"{error:.5f}" if is_known else ""])
    with open(f"{options.out}/{FILE}.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADER, *rows])
    panels.draw(f"{options.out}/{FILE}.png", rows, [r.picture for r in runs.values()], DETAIL)
    for row in [HEADER, *rows]:
        print("  ".join(f"{v!s:>28}" for v in row))
    if options.copy:
        for ending in ("png", "csv"):
            shutil.copyfile(f"{options.out}/{FILE}.{ending}", f"{options.copy}/{FILE}.{ending}")


if __name__ == "__main__":
    sys.exit(main())
