"""Compares `troffer measure` with path tracing on lists of points, at equal standard error."""

import argparse
import csv
import os
import shutil
import sys
import time
from dataclasses import dataclass

import numpy as np

import interiors
import page
from program import Program

# file: empty if bench/interiors makes the scene.
INTERIORS = {
    "kj92room": "scenes/kj92room/kj92room.gltf",
    "modern-hall-diffuse": "scenes/modern-hall/modern-hall-diffuse.pbrt",
    "modern-hall": "scenes/modern-hall/modern-hall.pbrt",
    "staircase": "",
    "bathroom": "",
    "ajar": "",
    "gallery": "",
    "furniture": "",
}
# Points are visible at the middles of pixels; the short list has every OF_SHORT-th of them.
PIXELS, OF_SHORT = "20x15", 24
PATHS, PATHS_OF_REFERENCE = 8192, {"short": 131072, "long": 32768}


@dataclass
class Measured:
    lux: np.ndarray
    error: np.ndarray  # estimated standard errors
    cpu: float  # seconds

    @property
    def told(self):
        """Returns the root mean square of the estimated errors, over the list's mean."""
        return float(np.sqrt(np.mean(self.error**2)) / self.lux.mean())

    @property
    def estimated_relative(self):
        """Returns the root mean square over lit points of each error relative to the point's light."""
        lit = self.lux > 0
        return float(np.sqrt(np.mean((self.error[lit] / self.lux[lit])**2)))


def arguments():
    parser = argparse.ArgumentParser(prog="bench/measuring")
    parser.add_argument("--out", default="build/bench/measuring", metavar="FOLDER")
    parser.add_argument("--copy", metavar="FOLDER")
    parser.add_argument("--scenes", metavar="NAME,...")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    return parser.parse_args()


def scene_file(name, out):
    if INTERIORS[name]:
        return INTERIORS[name]
    os.makedirs(f"{out}/scenes", exist_ok=True)
    interiors.write(name, f"{out}/scenes/{name}.pbrt")
    return f"{out}/scenes/{name}.pbrt"


def write_points(program, name, file):
    """Writes the files of the two lists."""
    run = program.render(f"{name}-seen", file, f"--size {PIXELS} --method path --spp 1 --max-spp 1 "
                         "--aov position,normal", is_of_any_version=True)
    layers = run.layers
    points = np.concatenate([layers["position"], layers["normal"]], axis=2).reshape(-1, 6)
    points = points[np.linalg.norm(points[:, 3:], axis=1) > 0.5].astype(np.float64)
    lists = {}
    for kind, step in ("short", max(len(points) // OF_SHORT, 1)), ("long", 1):
        path = f"{program.out}/{name}-{kind}.csv"
        np.savetxt(path, points[::step], "%.9g", ",", header="x,y,z,nx,ny,nz", comments="")
        lists[kind] = path
    return lists


def measured(program, name, file, points, options, is_of_any_version=False):
    run = program.measure(name, file, points, options, is_of_any_version)
    table = np.genfromtxt(run.csv, delimiter=",", names=True)
    return Measured(table["illuminance_lx"], table["standard_error"], run.cpu)


def row(name, kind, ours, paths, truth):
    both = np.sqrt(ours.error**2 + truth.error**2)
    z = (ours.lux - truth.lux) / np.where(both > 0, both, 1)
    by_paths = paths.cpu * (paths.told / ours.told) ** 2
    each_by_paths = paths.cpu * (paths.estimated_relative / ours.estimated_relative) ** 2
    return {"scene": name, "list": kind, "points": len(z), "processor s": f"{ours.cpu:.2f}",
            "standard error": f"{ours.told:.5f}", "inside": f"{np.mean(np.abs(z) < 1.96):.3f}",
            "z": f"{np.sqrt(np.mean(z**2)):.2f}",
            "in all": f"{ours.lux.mean() / truth.lux.mean() - 1:+.5f}",
            "of the reference": f"{truth.told:.5f}", "path processor s": f"{paths.cpu:.2f}",
            "path standard error": f"{paths.told:.5f}",
            "path s at equal error": f"{by_paths:.1f}", "times as fast": f"{by_paths / ours.cpu:.1f}",
            "relative error": f"{ours.estimated_relative:.5f}",
            "path relative error": f"{paths.estimated_relative:.5f}",
            "path s at equal relative error": f"{each_by_paths:.1f}",
            "times as fast by relative error": f"{each_by_paths / ours.cpu:.1f}"}


def rows_of(program, name):
    file = scene_file(name, program.out)
    lists = write_points(program, name, file)
    truths = {kind: measured(program, f"{name}-{kind}-reference", file, points,
                             f"--method path --spp {PATHS_OF_REFERENCE[kind]} --seed 101",
                             True)
              for kind, points in lists.items()}
    for kind, points in lists.items():
        ours = measured(program, f"{name}-{kind}-default", file, points, "")
        paths = measured(program, f"{name}-{kind}-path", file, points,
                         f"--method path --spp {PATHS}")
        yield row(name, kind, ours, paths, truths[kind])


def main():
    options = arguments()
    chosen = [n for n in INTERIORS if not options.scenes or n in options.scenes.split(",")]
    os.makedirs(options.out, exist_ok=True)
    program = Program(options.build, options.out, "build/bench/measuring")
    program.planned = 7 * len(chosen)
    start = time.monotonic()
    rows = [r for name in chosen for r in rows_of(program, name)]
    with open(f"{options.out}/measuring.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    with open(f"{options.out}/README.md", "w") as file:
        file.write(page.text(rows, [n for n in INTERIORS if n not in chosen]))
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for name in ("measuring.csv", "README.md"):
            shutil.copyfile(f"{options.out}/{name}", f"{options.copy}/{name}")
    print(page.table(rows))
    print(f"{(time.monotonic() - start) / 60:.1f} minutes; written to {options.copy or options.out}")


if __name__ == "__main__":
    sys.exit(main())
