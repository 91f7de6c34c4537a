#!/usr/bin/env python3
"""Renders twenty random rooms of bench/random_rooms, 24 x 18 pixels each, and checks what holds in any
room: random_rooms.py PROGRAM

In each room: no pixel is negative; a crop, computed by two threads, has the bytes of the whole picture
by one thread; the mean is that of path tracing within noise. Pixels that show a lamp or the sky
themselves do not count for means and errors: their part of it is a matter of chance. Over all rooms: the means are right on
average, and most estimated errors are near the actual ones. Bounds are loose, because these pictures
and their references have few samples; bench/random-rooms measures.
"""

import array
import json
import math
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                "../../bench/random_rooms"))
import generate  # noqa: E402  pylint: disable=wrong-import-position

rooms, width, height = 20, 24, 18
crop = (5, 4, 17, 13)
clamp = 4  # times the mean, for errors: a few bright pixels do not decide
alike = 9  # pixels whose errors count as one: neighbours share gathers and fits


def render(program, scene, out, *options):
    """Returns the pixels, three floats each, the lowest row first, and the statistics."""
    subprocess.run([program, "render", *scene, "--size", f"{width}x{height}", "--quiet", "-o",
                    out + ".pfm", "--stats", out + ".json", *options], check=True)
    with open(out + ".pfm", "rb") as file:
        for _ in range(3):
            file.readline()
        values = array.array("f", file.read())
    with open(out + ".json", encoding="utf-8") as file:
        return values, json.load(file)


def window(values):
    """The part of a whole picture that the crop shows."""
    x0, y0, x1, y1 = crop
    part = array.array("f")
    for row in range(height - y1, height - y0):
        part.extend(values[3 * (row * width + x0):3 * (row * width + x1)])
    return part


def luminances(values):
    return [0.2126 * values[i] + 0.7152 * values[i + 1] + 0.0722 * values[i + 2]
            for i in range(0, len(values), 3)]


def mean(values):
    return math.fsum(values) / len(values)


def shows_no_light(emission):
    """Whether each pixel and its neighbours show no light source."""
    def is_dark(x, y):
        return all(emission[q * width + p] == 0 for q in range(max(y - 1, 0), min(y + 2, height))
                   for p in range(max(x - 1, 0), min(x + 2, width)))
    return [is_dark(k % width, k // width) for k in range(width * height)]


class Found:
    """A picture beside two independent ones by path tracing, where `counts` is true."""

    def __init__(self, x, a, b, counts, estimated):
        x, a, b = ([v for v, c in zip(p, counts) if c] for p in (x, a, b))
        n = len(x)
        right = mean(a) / 2 + mean(b) / 2
        noise = math.sqrt(math.fsum((p - q) ** 2 for p, q in zip(a, b))) / 2 / n
        own = estimated * mean(x) / math.sqrt(n / alike)
        self.off = mean(x) / right - 1
        self.sigma = math.hypot(noise, own) / right
        a, b, x = ([min(v, clamp * right) for v in p] for p in (a, b, x))
        # The product of both differences does not contain the noise of the references.
        squares = [(p - q) * (p - r) / right ** 2 for p, q, r in zip(x, a, b)]
        square = mean(squares)
        spread = math.sqrt(mean([(s - square) ** 2 for s in squares]) / n)
        self.is_measured = square > 4 * spread
        self.actual = math.sqrt(max(square, 0))
        self.ratio = estimated / self.actual if self.is_measured else math.nan


def look_at(program, seed, folder):
    """Renders a room. Returns what was found and a list of faults."""
    file, options, tags = generate.write(seed, folder)
    scene, out = [file, *options], os.path.join(folder, "picture")
    quality = ("--error", ".3", "--max-spp", "128")
    whole, statistics = render(program, scene, out, *quality, "--threads", "1")
    part, _ = render(program, scene, out, *quality, "--threads", "2", "--crop",
                     ",".join(map(str, crop)))
    halves = [render(program, scene, out, "--method", "path", "--spp", "128", "--seed", str(k))[0]
              for k in (1, 2)]
    emission = render(program, scene, out, "--method", "path", "--depth", "0", "--spp", "256")[0]
    faults = []
    if min(whole) < 0:
        faults.append(f"a pixel is negative: {min(whole)}")
    if part.tobytes() != window(whole).tobytes():
        faults.append("the crop by two threads differs from the whole by one")
    found = Found(luminances(whole), *map(luminances, halves), shows_no_light(luminances(emission)),
                  statistics["estimated_error"])
    if abs(found.off) > 4 * found.sigma + 0.01:
        faults.append("the mean is not that of path tracing")
    print(f"room {seed}: mean {100 * found.off:+.1f} % (sigma {100 * found.sigma:.1f} %), error "
          f"{found.actual:.3f}, estimated over actual {found.ratio:.2f}, "
          f"{statistics['seconds']['total_cpu']:.1f} s; {', '.join(tags)}", flush=True)
    return found, [f"room {seed}: {f}" for f in faults]


def main():
    all_found, faults = [], []
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(rooms):
            found, of_room = look_at(sys.argv[1], seed, folder)
            all_found.append(found)
            faults += of_room
    # Means of all rooms, the more certain ones with more weight.
    weights = [1 / (f.sigma ** 2 + 0.01 ** 2) for f in all_found]
    bias = sum(w * f.off for w, f in zip(weights, all_found)) / sum(weights)
    sigma = 1 / math.sqrt(sum(weights))
    ratios = [f.ratio for f in all_found if f.is_measured]
    near = sum(0.5 < r < 3 for r in ratios)
    print(f"means: {100 * bias:+.2f} % (sigma {100 * sigma:.2f} %); estimated over actual in 0.5 to 3 "
          f"in {near} of {len(ratios)} rooms")
    if abs(bias) > 3 * sigma:
        faults.append("the means are off on average")
    if len(ratios) < rooms / 2 or near < 0.75 * len(ratios):
        faults.append("too few estimated errors are near the actual ones")
    for fault in faults:
        print("error:", fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
