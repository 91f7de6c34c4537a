"""Runs bench_direct for every scene, draws the plots and writes the page."""

import argparse
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass

import page
import plots
import rows

THIN = ["wires", "specks", "combs", "pinholes", "contact", "through source", "through receiver",
        "embedded", "coplanar", "back faces", "open sheets", "duplicates"]


@dataclass
class SceneRun:
    file: str
    size: str  # size of the rendered picture
    rays: int  # rays of each of two independently scrambled references


TILES = 32  # spread over each picture

SCENES = [
    SceneRun("kj92room/kj92room.gltf", "512x512", 16384),
    SceneRun("modern-hall/modern-hall-diffuse.pbrt", "640x480", 16384),
    SceneRun("clutter", "512x512", 16384),
    SceneRun("foliage", "512x512", 32768),
]


def arguments():
    parser = argparse.ArgumentParser(prog="bench/direct")
    parser.add_argument("--out", default="build/bench/direct", metavar="FOLDER",
                        help="where everything is written")
    parser.add_argument("--copy", metavar="FOLDER", help="also write page, plots and tables there")
    parser.add_argument("--quick", action="store_true", help="few hits and settings")
    parser.add_argument("--build", default="build/release", metavar="FOLDER",
                        help="the program built there")
    return parser.parse_args()


def exists(scene):
    return "/" not in scene or any(os.path.exists(f"{f}/{scene}")
                                   for f in ("scenes", "../shared/scenes"))


class Bench:
    def __init__(self, options):
        self.program = f"{options.build}/bench/bench_direct"
        self.out = options.out
        self.is_quick = options.quick
        self.commands = {}  # first command of each experiment

    def run(self, experiment, words):
        command = [self.program, experiment, *words, "--keep", f"{self.out}/references", "--csv",
                   self.out] + (["--quick"] if self.is_quick else [])
        self.commands.setdefault(experiment, " ".join(["bench_direct", experiment, *words]))
        subprocess.run(command, check=True)

    def curves(self):
        for scene in present_scenes():
            for view, size, tiles, spp in [("low resolution", "256x256", TILES, 1),
                                           ("as rendered", scene.size, TILES, 4)]:
                tiles = tiles // 4 if self.is_quick else tiles
                rays = scene.rays // 4 if self.is_quick else scene.rays
                self.run("curves", ["--scene", scene.file, "--view", view, "--size", size,
                                    "--spp", str(spp), "--tiles", str(tiles), "--rays", str(rays)])

    def thin(self):
        for error in ("0.01", "0.002"):
            self.run("thin", ["--size", "256x256", "--tiles", "8" if self.is_quick else "64",
                              "--error", error])

    def bias(self):
        rays, seeds, tiles = ("16384", "100", "4") if self.is_quick else ("65536", "1000", "6")
        for name in [s.file for s in present_scenes()] + (THIN[:2] if self.is_quick else THIN):
            self.run("bias", ["--scene", name, "--size", "256x256", "--tiles", tiles, "--rays", rays,
                              "--replicates", "8", "--seeds", seeds])


def present_scenes():
    return [s for s in SCENES if exists(s.file)]


def main():
    options = arguments()
    os.makedirs(f"{options.out}/references", exist_ok=True)
    for file in os.listdir(options.out):
        if file.endswith((".csv", ".png", ".md")):
            os.remove(f"{options.out}/{file}")
    start = time.monotonic()
    bench = Bench(options)
    missing = [s.file for s in SCENES if not exists(s.file)]
    for file in missing:
        print(f"(left out: there is no scenes/{file})")
    sys.stdout.flush()
    for experiment in (bench.curves, bench.thin, lambda: bench.run("shapes", []), bench.bias):
        experiment()
    table = rows.read(f"{options.out}/curves.csv")
    for file, error, cost in [("visibility.png", "rms_visible", "ns_pair"),
                              ("light.png", "rms_light", "ns_hit")]:
        plots.error_against_time(f"{options.out}/{file}", table, error, cost)
    text = page.write(options.out, TILES, bench.commands, options.quick, missing)
    print(page.summary_text(options.out))
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for file in sorted(os.listdir(options.out)):
            if file.endswith((".csv", ".png")):
                shutil.copy(f"{options.out}/{file}", options.copy)
        with open(f"{options.copy}/README.md", "w") as out:
            out.write(text)
    print(f"{(time.monotonic() - start) / 60:.1f} minutes; written to {options.copy or options.out}")


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as failure:
        sys.exit(failure.returncode)
