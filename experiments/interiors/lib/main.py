"""Compares the default with path tracing at equal processor time, with estimated and actual errors."""

import argparse
import os
import shutil
import sys
from dataclasses import dataclass

import numpy as np
from PIL import Image
from program import Program

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# from coarse to fine
SETTINGS = ["--error .4 --spp 1 --max-spp 4", "--error .2 --spp 2 --max-spp 8", "--error .1", "--error .05",
            "--error .02"]
USUAL = 2
CROPS, CROP_SIDE, CROP_PATHS = 24, 32, 256  # of the reference; paths per pixel of each half
MOST_BYTES = 390_000


@dataclass
class Room:
    name: str
    file: str
    options: str = ""
    where: str = ""


OURS = [
    Room("modern-hall", "scenes/modern-hall/modern-hall.pbrt", "",
         "\"Modern Hall\" by NewSee2l035, CC-BY 3.0"),
    Room("office", "scenes/office/office.pbrt", "--luminaires scenes/office/luminaires.csv"),
    Room("kj92room", "scenes/kj92room/kj92room.gltf"),
    Room("daylight-room", "scenes/daylight-room/daylight-room.gltf",
         "--eye .35,1.55,3.6 --target 4,1,1.2 --fov 62 --sky clear --sun 95,28"),
]
PUBLIC = [
    Room("kitchen", "kitchen-panels.glb", "", "morse, © LAAS-CNRS, ONERA, BSD"),
    Room("offices", "offices-panels.glb", "", "morse, © LAAS-CNRS, ONERA, BSD"),
    Room("apartment", "apartment-panels.glb", "", "morse, © LAAS-CNRS, ONERA, BSD"),
]


def arguments():
    parser = argparse.ArgumentParser(prog="experiments/interiors/run")
    parser.add_argument("--out", default="build/experiments/interiors", metavar="FOLDER")
    parser.add_argument("--build", default="build/release", metavar="FOLDER")
    parser.add_argument("--rooms", metavar="FOLDER")
    parser.add_argument("--limit", type=float, default=20, metavar="S")
    parser.add_argument("--size", default="1280x720", metavar="WxH")
    parser.add_argument("--only", metavar="NAME,...")
    parser.add_argument("--copy", metavar="FOLDER")
    return parser.parse_args()


def rooms(folder):
    if not folder:
        return OURS
    found = [Room(r.name, f"{folder}/{r.file}", r.options, r.where) for r in PUBLIC]
    return (OURS[:1] + [r for r in found if os.path.exists(r.file)] + OURS[1:])[:4]


def timed(program, room, name, options, size):
    program.forget(name)
    program.planned += 1
    return program.render(name, room.file, f"{room.options} --size {size} {options}")


def finest_in_time(program, room, size, limit):
    """Renders with the finest setting that keeps the limit, or with the coarsest of all."""
    def run(k):
        return timed(program, room, f"{room.name}-{k}", f"{SETTINGS[k]} --aov error", size)

    k, best = USUAL, run(USUAL)
    step = 1 if best.wall <= limit else -1
    while 0 <= k + step < len(SETTINGS):
        if step < 0 and best.wall <= limit:
            break
        more = run(k + step)
        if step > 0 and more.wall > limit:
            break
        k, best = k + step, more
    return k, best


def paths_in_time(program, room, size, seconds):
    """Renders with as many paths a pixel as take the processor time of the other picture."""
    trial = timed(program, room, f"{room.name}-trial", "--method path --spp 1 --max-spp 1", size)
    render = trial.stats["seconds"]["render_cpu"]
    spp = max(1, round((seconds - (trial.cpu - render)) / render))
    options = f"--method path --spp {spp} --max-spp {spp} --aov error"
    return spp, timed(program, room, f"{room.name}-path", options, size)


def crops(size):
    """Yields windows spread over the picture: a Halton sequence of corners."""
    width, height = (int(n) for n in size.split("x"))

    def radical_inverse(i, base):
        value, share = 0.0, 1.0 / base
        while i:
            value, i, share = value + i % base * share, i // base, share / base
        return value

    side = min(CROP_SIDE, width, height)
    for i in range(1, CROPS + 1):
        x = int(radical_inverse(i, 2) * (width - side + 1))
        y = int(radical_inverse(i, 3) * (height - side + 1))
        yield x, y, x + side, y + side


def reference(program, room, size):
    """Returns two halves: luminances of the crops side by side."""
    halves = []
    for seed in (101, 102):
        parts = []
        for i, crop in enumerate(crops(size)):
            window = ",".join(str(n) for n in crop)
            program.planned += 1
            run = program.render(f"{room.name}-half{seed}-{i}", room.file,
                                 f"{room.options} --size {size} --crop {window} --method path --spp "
                                 f"{CROP_PATHS} --max-spp {CROP_PATHS} --seed {seed}",
                                 is_of_any_version=True)
            parts.append(run.picture @ LUMINANCE)
        halves.append(np.concatenate(parts, axis=1))
    return halves


def errors(run, size, a, b):
    """Returns actual and estimated errors, root mean squares over the mean. Far brighter pixels (lights)
    are left out of both. The noise of the two halves is independent, so it averages out."""
    cut = [np.s_[y0:y1, x0:x1] for x0, y0, x1, y1 in crops(size)]
    picture = np.concatenate([run.picture[c] @ LUMINANCE for c in cut], axis=1)
    error = np.concatenate([run.layers["error"][..., 0][c] for c in cut], axis=1)
    mean = (a + b) / 2
    kept = mean < 6 * mean.mean()
    made = np.sqrt(max(0.0, float(np.mean(((picture - a) * (picture - b))[kept]))))
    return made / mean[kept].mean(), np.sqrt(np.mean(error[kept] ** 2)) / mean[kept].mean()


def save(run, path, exposure):
    """Writes a JPEG of at most MOST_BYTES."""
    linear = np.maximum(np.nan_to_num(run.picture.astype(np.float64)), 0) * exposure
    # A curve that keeps mid-grey and compresses highlights.
    shown = linear * (1 + linear / 16) / (1 + linear * (1 - 1 / 16) * 0.25)
    c = np.clip(shown, 0, 1)
    srgb = np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.power(c, 1 / 2.4) - 0.055)
    image = Image.fromarray(np.floor(srgb * 255 + 0.5).astype(np.uint8))
    for quality in range(90, 20, -5):
        image.save(path, quality=quality, optimize=True)
        if os.path.getsize(path) <= MOST_BYTES:
            return


def page(rows, limit, size):
    lines = ["# Interiors by the default and by path tracing in the same time", "",
             f"Made by `experiments/interiors/run`, this page too: {size.replace('x', ' × ')} pixels, by the "
             f"finest of a few settings that takes {limit:g} s or less by the clock, and by path tracing with as "
             "many paths a pixel as take the same processor time. Made and told: root mean square error of "
             f"pixels over the mean, against {2 * CROP_PATHS} paths a pixel in {CROPS} windows of {CROP_SIDE} × "
             f"{CROP_SIDE} pixels, whose own noise is taken out; lights are left out.", "",
             "| room | setting | s | processor s | made | told | told / made | path: paths a pixel | processor s | "
             "made | made / default's |", "|---" * 11 + "|"]
    for room, setting, mine, path, spp, (made, told), (path_made, _) in rows:
        over = "" if mine.wall <= limit else " (over the limit)"
        lines.append(f"| {room.name} | `{setting}` | {mine.wall:.1f}{over} | {mine.cpu:.1f} | {made:.4f} | "
                     f"{told:.4f} | {told / max(made, 1e-9):.2f} | {spp} | {path.cpu:.1f} | {path_made:.4f} | "
                     f"{path_made / max(made, 1e-9):.1f} |")
    lines += ["", "| by default | path tracing in the same time |", "|---|---|"]
    for room, *_ in rows:
        lines.append(f"| ![{room.name}](interior-{room.name}.jpg) | ![{room.name}, by paths]"
                     f"(interior-{room.name}-path.jpg) |")
    notes = [f"{r[0].name}: {r[0].where}" for r in rows if r[0].where]
    lines += ["", "Geometry: " + "; ".join(notes) + "." if notes else ""]
    return "\n".join(lines) + "\n"


def main():
    options = arguments()
    program = Program(options.build, options.out, "build/experiments/interiors")
    rows, files = [], ["interiors.md"]
    chosen = [r for r in rooms(options.rooms) if not options.only or r.name in options.only.split(",")]
    for room in chosen:
        k, mine = finest_in_time(program, room, options.size, options.limit)
        spp, path = paths_in_time(program, room, options.size, mine.cpu)
        a, b = reference(program, room, options.size)
        rows.append((room, SETTINGS[k], mine, path, spp, errors(mine, options.size, a, b),
                     errors(path, options.size, a, b)))
        # Makes the median pixel mid-grey.
        middle = np.median(mine.picture @ LUMINANCE)
        exposure = 0.18 / max(float(middle), 1e-30)
        for run, name in ((mine, room.name), (path, f"{room.name}-path")):
            files.append(f"interior-{name}.jpg")
            save(run, f"{options.out}/{files[-1]}", exposure)
    text = page(rows, options.limit, options.size)
    with open(f"{options.out}/interiors.md", "w") as file:
        file.write(text)
    print(text)
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for name in files:
            shutil.copyfile(f"{options.out}/{name}", f"{options.copy}/{name}")


if __name__ == "__main__":
    sys.exit(main())
