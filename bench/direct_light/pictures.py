"""Whole pictures of direct light by the program's own command line: certified over a sweep of
--error, beside fixed and path over sweeps of their rays."""

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
    lights: int = 0  # as `info` counts them


SCENES = [
    Scene("kj92room", "scenes/kj92room/kj92room.gltf"),
    Scene("modern-hall-diffuse", "scenes/modern-hall/modern-hall-diffuse.pbrt"),
    *map(Scene, ("furniture", "staircase", "staircase-metal", "bathroom", "chandelier", "banisters",
                 "blinds", "wires", "bookshelf", "foliage", "gallery", "gloss", "lanterns", "balls",
                 "disks", "lights10", "lights100", "lights1000", "lights3000")),
]
ERRORS = (0.05, 0.02, 0.01, 0.005, 0.002)
FIXED_RAYS = (1, 4, 16, 64, 256, 1024)
MOST_FIXED = 4096  # rays of a viewing ray, to all lights
PATHS = (4, 16, 64, 256, 1024)
VIEWING_RAYS = 4
# Where no edge goes through a pixel, four viewing rays see what all see, within this share.
EVEN = 0.005
HEADER = ["scene", "method", "setting", "seconds", "rays", "rmse", "relative", "told"]


def arguments():
    parser = argparse.ArgumentParser(prog="bench/direct-pictures")
    parser.add_argument("--out", default="build/bench/direct-pictures", metavar="FOLDER")
    parser.add_argument("--copy", metavar="FOLDER")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--scenes", metavar="NAME,...")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    return parser.parse_args()


def luminance(picture):
    return picture.astype(np.float64) @ np.array([0.2126, 0.7152, 0.0722])


class Reference:
    """The light of the picture's own viewing rays, and of all; and the pixels where both agree:
    there, methods with different viewing rays can be compared."""

    def __init__(self, program, scene, file, size, is_quick):
        rays = 2 ** int(np.log2(max(8, (4096 if is_quick else 8192) / scene.lights)))
        paths = 1024 if is_quick else 8192
        common = f"--size {size} --indirect none"
        own = program.render(
            f"{scene.name}-reference", file, f"{common} --method fixed --spp {VIEWING_RAYS} "
            f"--max-spp {VIEWING_RAYS} --shadow-rays {rays}")
        self.own = own.picture.astype(np.float64)
        halves = [program.render(f"{scene.name}-reference{seed}", file,
                                 f"{common} --method path --spp {paths} --max-spp {paths} "
                                 f"--seed {seed}").picture.astype(np.float64) for seed in (101, 102)]
        self.halves = halves
        every = luminance(halves[0] + halves[1]) / 2
        self.light = luminance(self.own)
        self.mean = float(every.mean())
        self.floor = 0.01 * self.mean
        # The halves' own noise must not choose: a pixel is even if both say so.
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
        """Root mean square over the even pixels: over the mean light, and over each pixel's."""
        x, mask = picture.astype(np.float64), self.is_even
        a, b = (self.own, self.own) if has_own_rays else self.halves
        square = ((x - a) * (x - b)).mean(axis=2)[mask]
        rmse = float(np.sqrt(max(square.mean(), 0)) / self.mean)
        y = luminance(x)[mask]
        light = np.maximum(self.light[mask], self.floor)
        square = (y - luminance(a)[mask]) * (y - luminance(b)[mask]) / light**2
        return rmse, float(np.sqrt(max(square.mean(), 0)))

    def told(self, layer):
        light = np.maximum(self.light, self.floor)
        return float(np.sqrt(((layer / light)[self.is_even] ** 2).mean()))


def settings(scene, is_quick):
    own = f"--spp {VIEWING_RAYS} --max-spp {VIEWING_RAYS}"
    for e in ERRORS[1:4] if is_quick else ERRORS:
        yield "certified", f"--error {e:g}", f"{own} --error {e:g} --aov error", True
    for n in FIXED_RAYS[:5] if is_quick else FIXED_RAYS:
        if n == 1 or n * scene.lights <= MOST_FIXED:
            yield "fixed", f"--shadow-rays {n}", f"{own} --method fixed --shadow-rays {n}", True
    for n in PATHS[:4] if is_quick else PATHS:
        yield "path", f"--spp {n}", f"--method path --spp {n} --max-spp {n}", False


def lights_of(program, file):
    info = subprocess.run([program.troffer, "info", file, "--json"], check=True, capture_output=True)
    return json.loads(info.stdout)["emitters"]


def measure(program, scene, is_quick):
    size = "64x48" if is_quick else "128x96"
    file = scene.file
    if not file:
        os.makedirs(f"{program.out}/scenes", exist_ok=True)
        file = f"{program.out}/scenes/{scene.name}.pbrt"
        interiors.write(scene.name, file)
    scene.lights = lights_of(program, file)
    reference = Reference(program, scene, file, size, is_quick)
    rows = []
    for method, setting, options, has_own_rays in settings(scene, is_quick):
        name = f"{scene.name}-{method}-{setting.split()[1]}"
        run = program.timed(name, file, f"--size {size} --indirect none {options}",
                            1 if is_quick else 3)
        rmse, relative = reference.errors(run.picture, has_own_rays)
        told = reference.told(run.layers["error"][..., 0]) if method == "certified" else None
        rows.append({"scene": scene.name, "method": method, "setting": setting,
                     "seconds": run.stats["seconds"]["render_cpu"],
                     "rays": run.stats["shadow_rays"] / run.stats["viewing_rays"],
                     "rmse": rmse, "relative": relative, "told": told})
    return rows, reference.share


def main():
    options = arguments()
    chosen = [s for s in SCENES if not options.scenes or s.name in options.scenes.split(",")]
    os.makedirs(options.out, exist_ok=True)
    program = Program(options.build, options.out, "build/bench/direct-pictures")
    program.planned = 3 * len(chosen)  # timed() counts its own
    start = time.monotonic()
    rows, shares = [], {}
    for scene in chosen:
        more, shares[scene.name] = measure(program, scene, options.quick)
        rows += more
        print(page.summary(rows, [scene.name]), flush=True)
    with open(f"{options.out}/pictures.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows([page.shown(r[k]) for k in HEADER] for r in rows)
    with open(f"{options.out}/pictures.md", "w") as file:
        file.write(page.text(rows, chosen, shares, options.quick))
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for name in ("pictures.csv", "pictures.md"):
            shutil.copyfile(f"{options.out}/{name}", f"{options.copy}/{name}")
    print(f"{(time.monotonic() - start) / 60:.1f} minutes; written to {options.copy or options.out}")


if __name__ == "__main__":
    sys.exit(main())
