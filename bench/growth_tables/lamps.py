"""Compares many, finely divided or very unequal lamps with a single one, at equal error: run(...)."""

import csv
import json
import os
import subprocess
import sys
from dataclasses import dataclass

import numpy as np

import rooms

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "../../experiments/lib"))
import differences  # noqa: E402
import exr  # noqa: E402

ERRORS = (0.2, 0.1, 0.05, 0.025)
SIZE = "128x128"
REFERENCE_SPP = 512
BRIGHT = 6  # pixels this many times brighter than the mean are lamps and are left out

AT_LAMPS = "LookAt 0.4 0.4 1.7  5 4 0.8  0 0 1\n"
DOWNWARDS = "LookAt 0.4 0.4 2.3  5 4 -0.9  0 0 1\n"


def emitter(text, radiance=10.0):
    return (f'AttributeBegin\nAreaLightSource "diffuse" "rgb L" [ {radiance:g} {radiance:g} {radiance:g} ]\n'
            f"{text}AttributeEnd\n")


def mesh(folder, name, points, faces):
    rooms.write_ply(f"{folder}/{name}.ply", points, faces)
    return f'Shape "plymesh" "string filename" "{os.path.basename(folder)}/{name}.ply"\n'


def ball_of(triangles):
    """A bumpy ball of .8 m below the ceiling."""
    return rooms.body(triangles, np.array([4, 3, 2.5]), 0.4, np.random.default_rng(5))


def ball(folder, triangles):
    return mesh(folder, f"ball-{triangles}", *ball_of(triangles))


def divided_ball(folder, triangles, along):
    """The same shape with each triangle divided into along² ones. These are not exactly coplanar, since
    importers would merge them."""
    points, faces = ball_of(triangles)
    corners = points[faces].astype(float)
    corners = corners[np.linalg.norm(np.cross(*(corners[:, k, :3] - corners[:, 0, :3] for k in (1, 2))),
                                     axis=1) > 0]
    i, j = np.meshgrid(np.arange(along + 1), np.arange(along + 1), indexing="ij")
    inside = (i + j <= along).ravel()
    number = np.cumsum(inside) - 1
    u, v = i.ravel()[inside] / along, j.ravel()[inside] / along
    at = (corners[:, None, 0] * (1 - u - v)[:, None] + corners[:, None, 1] * u[:, None]
          + corners[:, None, 2] * v[:, None])
    at[..., :3] += np.random.default_rng(6).uniform(-2e-5, 2e-5, at[..., :3].shape)

    def vertex(a, b):
        return number[a * (along + 1) + b]
    small = [(vertex(a, b), vertex(a + 1, b), vertex(a, b + 1))
             for a in range(along) for b in range(along - a)]
    small += [(vertex(a + 1, b), vertex(a + 1, b + 1), vertex(a, b + 1))
              for a in range(along - 1) for b in range(along - 1 - a)]
    every = np.arange(len(corners))[:, None, None] * len(u) + np.array(small)[None]
    return mesh(folder, f"ball-{triangles}-{along}", at.reshape(-1, at.shape[-1]).astype("<f4"),
                every.reshape(-1, 3).astype("<i4"))


def panel(folder, along):
    """The square of one lamp, with 2 (along - 1)² triangles."""
    (x0, y0, z), _, (x1, y1, _), _ = next(rooms.lights(1))
    x, y = np.meshgrid(np.linspace(x0, x1, along), np.linspace(y0, y1, along))
    points = np.stack([x, y, z + 0 * x, x, y], -1).reshape(-1, 5).astype("<f4")
    a = (np.arange(along - 1)[:, None] * along + np.arange(along - 1)[None]).ravel()
    faces = np.concatenate([np.stack([a, a + along, a + 1], 1),
                            np.stack([a + 1, a + along, a + along + 1], 1)]).astype("<i4")
    return mesh(folder, f"panel-{along}", points, faces)


def write(out):
    """Writes the rooms with these lamps and returns the names of the files."""
    folder = f"{out}/scenes/lamps"
    os.makedirs(folder, exist_ok=True)
    whole = f"{folder}.pbrt"
    rooms.write(whole, 10_000, 1)
    with open(whole) as file:
        text = file.read()
    bare = text[:text.index("AttributeBegin")]
    of_lamps = {n: "".join(emitter(rooms.quad(*c)) for c in rooms.lights(n)) for n in (1, 1000)}
    nine = list(rooms.lights(9))
    lamps = {
        "one": of_lamps[1],
        "thousand": of_lamps[1000],
        "panel": emitter(panel(folder, 225)),
        "coarse ball": emitter(ball(folder, 400)),
        "divided ball": emitter(divided_ball(folder, 400, 16)),
        "fine ball": emitter(ball(folder, 100_000)),
        "strongest": emitter(rooms.quad(*nine[0])),
        "eight decades": "".join(emitter(rooms.quad(*c), 10.0**(1 - k)) for k, c in enumerate(nine)),
    }
    names = {}
    for name, shapes in lamps.items():
        names[name] = f"{out}/scenes/lamps-{name.replace(' ', '-')}.pbrt"
        # The room's meshes are in the folder named after its original file.
        with open(names[name], "w") as file:
            file.write(bare + shapes)
        with open(names[name].replace(".pbrt", "-down.pbrt"), "w") as file:
            assert AT_LAMPS in bare
            file.write((bare + shapes).replace(AT_LAMPS, DOWNWARDS))
    return names


@dataclass
class Pair:
    what: str
    single: str
    many: str
    is_down: bool = False


PAIRS = [
    Pair("1,000 lamps, which are seen", "one", "thousand"),
    Pair("1,000 lamps, looking down", "one", "thousand", True),
    Pair("one panel in 100,352 triangles", "one", "panel"),
    Pair("a bumpy ball of 400 triangles, each in 256", "coarse ball", "divided ball"),
    Pair("one with finer bumps, of 100,000 triangles, beside that of 400", "coarse ball", "fine ball"),
    Pair("nine lamps over eight decades, beside the strongest", "strongest", "eight decades"),
]


def render(troffer, scene, options, target):
    stats = target.replace(".exr", ".json")
    words = [troffer, "render", scene, *options.split(), "--size", SIZE, "--quiet", "-o", target, "--stats",
             stats]
    failed = subprocess.run(words, stdin=subprocess.DEVNULL).returncode
    if failed:
        sys.exit(f"error: status {failed} from: {' '.join(words)}")
    with open(stats) as file:
        seconds = json.load(file)["seconds"]["total_cpu"]
    return exr.read(target)[""][..., :3].astype(float), seconds


def curve(troffer, scene, out, name):
    """Returns processor seconds and errors of the default, then of path, for each of ERRORS."""
    halves = [render(troffer, scene, f"--method path --spp {REFERENCE_SPP} --seed {901 + k}",
                     f"{out}/{name}-half{k}.exr") for k in (0, 1)]
    a, b = halves[0][0], halves[1][0]
    mean = (a.mean() + b.mean()) / 2
    is_dark = (a + b).mean(2) / 2 < BRIGHT * mean

    def error(x):
        # The halves' noise is independent, so it averages out.
        return float(np.sqrt(max(((x - a) * (x - b)).mean(2)[is_dark].mean(), 1e-12)) / mean)

    points = []
    for asked in ERRORS:
        x, seconds = render(troffer, scene, f"--error {asked}", f"{out}/{name}.exr")
        points.append((seconds, error(x)))
    x, seconds = render(troffer, scene, "--method path --spp 64", f"{out}/{name}.exr")
    return points, (seconds, error(x))


def run(troffer, out):
    """Returns the rows of the table, and all measurements."""
    os.makedirs(f"{out}/scenes", exist_ok=True)
    names = write(out)
    curves, rows, all_rows = {}, [], []
    for pair in PAIRS:
        two = []
        for which in (pair.single, pair.many):
            key = which + (" down" if pair.is_down else "")
            if key not in curves:
                scene = names[which].replace(".pbrt", "-down.pbrt" if pair.is_down else ".pbrt")
                curves[key] = curve(troffer, scene, out, key.replace(" ", "-"))
                for asked, (seconds, error) in zip(ERRORS, curves[key][0]):
                    all_rows.append([key, f"--error {asked}", f"{seconds:.3g}", f"{error:.3g}"])
                all_rows.append([key, "--method path --spp 64", *(f"{v:.3g}" for v in curves[key][1])])
                print("\n".join(" ".join(r) for r in all_rows[-len(ERRORS) - 1:]), flush=True)
            two.append(curves[key])
        (single, path_single), (many, path_many) = two
        seconds, error = many[ERRORS.index(0.05)]
        alone = differences.at_equal(error, [e for _, e in single], [s for s, _ in single])
        path_ratio = path_many[0] * path_many[1]**2 / (path_single[0] * path_single[1]**2)
        path_seconds = path_many[0] * (path_many[1] / error)**2
        rows.append([pair.what, f"{error:.4f}", f"{seconds:.3g}", f"{alone:.3g}",
                     f"{seconds / alone:.2f}", f"{path_ratio:.2f}", f"{path_seconds / seconds:.1f}"])
    return rows, all_rows


HEADER = ["what", "error", "it takes s", "one takes s", "times", "path: times", "path takes … times as long"]


def page(rows, minutes):
    lines = ["# Many lamps beside one", "",
             "Made by `bench/growth --lamps --copy docs/results/growth`. The room of "
             "[the growth tables](README.md), 10,000 triangles, "
             f"{SIZE.replace('x', ' × ')} pixels, whole pictures. *Error*: root mean square over the mean, of "
             f"what is not a lamp (less than {BRIGHT} times the mean), that the default made by "
             "`--error .05`, against two independent halves of "
             f"{REFERENCE_SPP} paths. *It takes*, *one takes*: processor seconds of all threads, of the many "
             "lamps and of the single one at the same error, which lies on a curve through `--error` "
             + ", ".join(str(e) for e in ERRORS) + ". *Path: times*: the same ratio for `--method path`; "
             "and how much longer that one takes than the default for the many, at equal error.", "",
             "A thousand lamps in sight are a thousand outlines; what they cover of pixels is exact "
             "([cells](../cells.md), 8). The second row has them where they light, but are not looked at. "
             "A light in many triangles is drawn by groups of them. Finer bumps hide more of a lamp from each "
             "place: that is another lamp, for paths too.", "",
             "| " + " | ".join(HEADER) + " |", "|---" * len(HEADER) + "|"]
    lines += ["| " + " | ".join(r) + " |" for r in rows]
    return "\n".join([*lines, "", f"{minutes:.1f} minutes in all."]) + "\n"


def write_results(rows, all_rows, minutes, out):
    with open(f"{out}/lamps.csv", "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(
            [["lamps", "options", "processor s", "error"], *all_rows])
    with open(f"{out}/lamps.md", "w") as file:
        file.write(page(rows, minutes))
