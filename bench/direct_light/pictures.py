"""Measures whole pictures of direct light on the command line: certified over a sweep of --error,
next to fixed and path over sweeps of their rays."""

import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass

import numpy as np

import interiors
import pictures_page as page
from program import Program


@dataclass
class Scene:
    name: str
    file: str = ""  # empty: made by bench/interiors
    lights: int = 0  # number of lights by `info`


SCENES = [
    Scene("kj92room", "scenes/kj92room/kj92room.gltf"),
    Scene("modern-hall-diffuse", "scenes/modern-hall/modern-hall-diffuse.pbrt"),
    *map(Scene, ("furniture", "staircase", "staircase-metal", "bathroom", "chandelier", "banisters",
                 "blinds", "wires", "bookshelf", "foliage", "gallery", "gloss", "lanterns", "balls",
                 "disks", "lights10", "lights100", "lights1000", "lights3000")),
]
ERRORS = (0.05, 0.02, 0.01, 0.005)
FIXED_RAYS = (1, 4, 16, 64, 256, 1024, 4096)
MOST_FIXED = 4096  # rays per viewing ray, to all lights
PATHS = (4, 16, 64, 256)
REFERENCE_RAYS = 16384  # rays per viewing ray, to all lights; limited by MOST_TO_ONE per light
MOST_TO_ONE = 8192
REFERENCE_PATHS = 512  # in each of two halves
# Runs shorter than this (s) are repeated three times.
SHORT = 0.2
VIEWING_RAYS = 4
# A pixel without edges has the same value for four viewing rays as for all, within this share.
EVEN = 0.005
HEADER = ["scene", "method", "setting", "seconds", "rays", "rmse", "made", "told"]


def arguments():
    parser = argparse.ArgumentParser(prog="bench/direct-pictures")
    parser.add_argument("--out", default="build/bench/direct-pictures", metavar="FOLDER")
    parser.add_argument("--copy", metavar="FOLDER")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--scenes", metavar="NAME,...")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    parser.add_argument("--reference-build", metavar="FOLDER")
    parser.add_argument("--references-only", action="store_true")
    return parser.parse_args()


def luminance(picture):
    return picture.astype(np.float64) @ np.array([0.2126, 0.7152, 0.0722])


def reference_rays(lights):
    """Returns rays per viewing ray to each light, for both halves. Different numbers have different
    sequences, so halves and settings have independent errors."""
    rays = 2 ** int(np.log2(min(max(8, REFERENCE_RAYS / lights), MOST_TO_ONE)))
    return rays, rays * 3 // 4


class Reference:
    """The light by the picture's own viewing rays, and by all; and the pixels where both agree. There,
    methods with different viewing rays can be compared."""

    def __init__(self, program, scene, file, size):
        paths = REFERENCE_PATHS
        common = f"--size {size} --indirect none"
        self.own = [program.render(
            f"{scene.name}-reference-{rays}", file, f"{common} --method fixed --spp {VIEWING_RAYS} "
            f"--max-spp {VIEWING_RAYS} --shadow-rays {rays}").picture.astype(np.float64)
            for rays in reference_rays(scene.lights)]
        halves = [program.render(f"{scene.name}-reference{seed}", file,
                                 f"{common} --method path --spp {paths} --max-spp {paths} "
                                 f"--seed {seed}").picture.astype(np.float64) for seed in (101, 102)]
        self.halves = halves
        every = luminance(halves[0] + halves[1]) / 2
        self.light = luminance(self.own[0] + self.own[1]) / 2
        self.mean = float(every.mean())
        self.floor = 0.01 * self.mean
        # A pixel is even only if both halves say so, since their noise must not decide.
        self.is_even = (self.light > 0)
        for half in halves:
            off = np.abs(luminance(half) - self.light) / np.maximum(self.light, self.floor)
            self.is_even &= off < EVEN + 3 * self.half_noise()
        self.share = float(self.is_even.mean())

    def half_noise(self):
        a, b = (luminance(h) for h in self.halves)
        light = np.maximum(self.light, self.floor)
        return float(np.median(np.abs(a - b) / light))

    def errors(self, picture, has_own_rays):
        """Returns two root mean squares: over the even pixels, relative to the mean light; and, if the
        viewing rays are the reference's, over all pixels, relative to each pixel's light."""
        x, mask = picture.astype(np.float64), self.is_even
        a, b = self.own if has_own_rays else self.halves
        square = ((x - a) * (x - b)).mean(axis=2)[mask]
        rmse = float(np.sqrt(max(square.mean(), 0)) / self.mean)
        if not has_own_rays:
            return rmse, None
        return rmse, self.relative(luminance(x - a) * luminance(x - b))

    def relative(self, squares):
        """Returns the root of the mean of squares, relative to each pixel's light squared."""
        is_seen = self.light > 0
        light = np.maximum(self.light, self.floor)
        return float(np.sqrt(max((squares / light ** 2)[is_seen].mean(), 0)))


def settings(scene, is_quick):
    own = f"--spp {VIEWING_RAYS} --max-spp {VIEWING_RAYS}"
    for e in ERRORS[1:4] if is_quick else ERRORS:
        yield "certified", f"--error {e:g}", f"{own} --error {e:g} --aov error", True
    for n in FIXED_RAYS:
        # the reference's own setting must not be compared with itself
        is_apart = 4 * n <= 3 * reference_rays(scene.lights)[0]
        if n == 1 or (n * scene.lights <= MOST_FIXED and is_apart):
            yield "fixed", f"--shadow-rays {n}", f"{own} --method fixed --shadow-rays {n}", True
    for n in PATHS:
        yield "path", f"--spp {n}", f"--method path --spp {n} --max-spp {n}", False


def lights_of(program, file):
    info = subprocess.run([program.troffer, "info", file, "--json"], check=True, capture_output=True)
    return json.loads(info.stdout)["emitters"]


def measure(program, references, scene, options):
    is_quick = options.quick
    size = "64x48" if is_quick else "96x72"
    file = scene.file
    if not file:
        os.makedirs(f"{program.out}/scenes", exist_ok=True)
        file = f"{program.out}/scenes/{scene.name}.pbrt"
        interiors.write(scene.name, file)
    scene.lights = lights_of(program, file)
    reference = Reference(references, scene, file, size)
    rows = []
    if options.references_only:
        return rows, reference.share
    for method, setting, more, has_own_rays in settings(scene, is_quick):
        name = f"{scene.name}-{method}-{setting.split()[1]}"
        words = f"--size {size} --indirect none {more}"
        run = program.timed(name, file, words, 1)
        if not is_quick and run.stats["seconds"]["render_cpu"] < SHORT:
            again = program.timed(name, file, words, 2)
            run = min(run, again, key=lambda r: r.stats["seconds"]["render_cpu"])
        rmse, made = reference.errors(run.picture, has_own_rays)
        is_certified = method == "certified"
        told = reference.relative(run.layers["error"][..., 0] ** 2) if is_certified else None
        rows.append({"scene": scene.name, "method": method, "setting": setting,
                     "seconds": run.stats["seconds"]["render_cpu"],
                     "rays": run.stats["shadow_rays"] / run.stats["viewing_rays"],
                     "rmse": rmse, "made": made, "told": told})
    return rows, reference.share


def write(rows, scenes, shares, options):
    """Writes the results so far."""
    with open(f"{options.out}/pictures.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows([page.shown(r[k]) for k in HEADER] for r in rows)
    with open(f"{options.out}/pictures.md", "w") as file:
        file.write(page.text(rows, scenes, shares, options.quick))


def main():
    options = arguments()
    names = options.scenes.split(",") if options.scenes else [s.name for s in SCENES]
    chosen = [s for name in names for s in SCENES if s.name == name]
    os.makedirs(options.out, exist_ok=True)
    program = Program(options.build, options.out, "build/bench/direct-pictures")
    program.planned = 4 * len(chosen)  # timed() counts its own runs
    references = program
    if options.reference_build:
        references = Program(options.reference_build, options.out, "build/bench/direct-pictures")
        references.planned = 4 * len(chosen)
    start = time.monotonic()
    rows, shares = [], {}
    for scene in chosen:
        more, shares[scene.name] = measure(program, references, scene, options)
        rows += more
        if options.references_only:
            continue
        print(page.summary(rows, [scene.name]), flush=True)
        write(rows, [s for s in chosen if s.name in shares], shares, options)
    if options.copy and not options.references_only:
        os.makedirs(options.copy, exist_ok=True)
        for name in ("pictures.csv", "pictures.md"):
            shutil.copyfile(f"{options.out}/{name}", f"{options.copy}/{name}")
    print(f"{(time.monotonic() - start) / 60:.1f} minutes; written to {options.copy or options.out}")


if __name__ == "__main__":
    sys.exit(main())
