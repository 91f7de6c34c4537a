"""Measures random rooms; see ../random-rooms."""

import argparse
import json
import os
import resource
import signal
import subprocess
import sys

import numpy as np

import generate

clamp = 4  # times the mean without the brightest twentieth
alike = 9  # pixels whose errors count as one in a mean: neighbours share gathers and fits
worst_pixels = 4  # that get a reference of their own
worst_samples = 16384  # of each half of it

doubts = {
    "negative": "a pixel is negative",
    "slow": "more than 1.21 times the work of `path`: errs 1.1 times as much in the same time",
    "under-estimated": "estimated error below 0.6 of the actual one",
    "rising": "a smaller --error errs more than 1.1 times as much, beyond noise",
    "mean": "mean off by more than 0.3 % and four standard errors",
    "missed": "actual error more than twice the one asked for",
    "outlier": "a pixel is off by more than its value and a tenth of the mean",
}


def luminance_of(path):
    with open(path, "rb") as file:
        file.readline()
        width, height = map(int, file.readline().split())
        file.readline()
        values = np.frombuffer(file.read(), "<f4").reshape(height, width, 3)
    return values[::-1].astype(float) @ [0.2126, 0.7152, 0.0722], float(values.min())


class Picture:
    def __init__(self, luminance, least, stats):
        self.luminance, self.least = luminance, least
        self.seconds = stats["seconds"]["total_cpu"]
        self.estimated = stats.get("estimated_error") or 0.0
        self.stats = stats


class Stopped(Exception):
    """A picture took longer than --limit."""


class Room:
    """One room's files and pictures. Pictures by `path` are kept and used again."""

    def __init__(self, seed, a):
        self.a, self.seed = a, seed
        self.file, self.options, self.tags = generate.write(seed, a.out)

    def command(self, options):
        return [self.a.program, "render", self.file, *self.options, "--size", self.a.size,
                "--threads", "1", *options]

    def render(self, name, options, is_kept=False):
        out = os.path.join(self.a.out, f"room{self.seed}", f"{self.a.size}-{name}")
        is_kept = is_kept or self.a.keep
        if not (is_kept and os.path.exists(out + ".json") and os.path.exists(out + ".pfm")):
            limit = 10 * self.a.limit if "path" in options else self.a.limit
            done = subprocess.run(
                self.command(options) + ["--quiet", "-o", out + ".pfm", "--stats", out + ".json"],
                capture_output=True, text=True, check=False,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)))
            if done.returncode == -signal.SIGXCPU:
                raise Stopped
            if done.returncode != 0:
                raise RuntimeError(f"room {self.seed}: {done.stderr.strip()}")
        with open(out + ".json", encoding="utf-8") as file:
            return Picture(*luminance_of(out + ".pfm"), json.load(file))

    def try_render(self, name, options):
        try:
            return self.render(name, options)
        except Stopped:
            return None

    def path(self, name, samples, seed=0, more=()):
        return self.render(name, ["--method", "path", "--spp", str(samples), "--max-spp",
                                  str(samples), "--seed", str(seed), *more], True)


class Reference:
    def __init__(self, a, b):
        self.a, self.b = a.copy(), b.copy()

    def refine(self, room, pictures):
        """Computes the pixels that differ most by many more samples: a small lamp that thousands of
        paths miss is the reference's fault."""
        chosen = set()
        for p in pictures:
            off = np.abs(self.limited(p.luminance) - self.limited((self.a + self.b) / 2))
            chosen |= set(np.argsort(-off.ravel())[:worst_pixels].tolist())
        width = self.a.shape[1]
        for y, x in (divmod(k, width) for k in sorted(chosen)):
            for half, seed in ((self.a, 700), (self.b, 701)):
                crop = ("--crop", f"{x},{y},{x + 1},{y + 1}")
                more = room.path(f"pixel-{x}-{y}-{seed}", worst_samples, seed, crop)
                half[y, x] = more.luminance[0, 0]

    @property
    def white(self):
        """Luminance from which on a display shows white, as the program's estimated error has it."""
        values = np.sort((self.a + self.b).ravel() / 2)
        return clamp * values[:values.size - values.size // 20].mean() or values[-1]

    @property
    def mean(self):
        """Mean luminance as a display shows it."""
        return self.limited((self.a + self.b) / 2).mean()

    def limited(self, x):
        return np.minimum(x, self.white)

    def own_error(self):
        return ((self.limited(self.a) - self.limited(self.b)) ** 2).mean() ** 0.5 / 2 / self.mean

    def squares(self, x):
        """Squared relative error of each pixel; its mean does not contain the reference's noise."""
        return ((self.limited(x) - self.limited(self.a)) * (self.limited(x) - self.limited(self.b)) /
                self.mean ** 2)

    def square(self, x):
        """Mean squared relative error, and its standard error by the reference's noise."""
        d = self.squares(x)
        variance = (self.limited(self.a) - self.limited(self.b)) ** 2 / 2 / self.mean ** 2
        spread = (2 * np.maximum(d, 0) * variance + variance ** 2).sum() ** 0.5 / d.size
        return d.mean(), spread

    def spread(self, x):
        """Standard error of the mean squared error, as another seed would show it."""
        d = self.squares(x)
        return d.std() / (d.size / alike) ** 0.5

    def error(self, x):
        """Relative error; if the reference's noise hides it, an upper bound of it."""
        square, spread = self.square(x)
        return max(square, 2 * spread, 1e-10) ** 0.5

    def off(self, picture):
        """Relative difference of the clamped means, and that in standard errors of both."""
        x, both = self.limited(picture.luminance), self.limited((self.a + self.b) / 2)
        noise = self.own_error() * self.mean / x.size ** 0.5
        ours = picture.estimated * self.mean / (x.size / alike) ** 0.5
        difference = x.mean() - both.mean()
        return difference / both.mean(), difference / max(np.hypot(noise, ours), 1e-30)

    def worst(self, x, by_path):
        """The pixel that is farthest off: x, y, its value, the reference's, whether it counts. Noise
        that `path` shows there as well, such as that of caustics, does not count."""
        both = (self.a + self.b) / 2
        off = np.abs(self.limited(x) - self.limited(both))
        y, col = divmod(int(np.argmax(off)), x.shape[1])
        right, spread = both[y, col], abs(self.a[y, col] - self.b[y, col])
        noise = max(spread, abs(by_path[y, col] - right) / 2)
        counts = off[y, col] > right + 0.1 * self.mean and off[y, col] > 4 * noise
        return col, y, x[y, col], right, counts


def time_at(error, paths):
    """Seconds of `path` for an error: by a power law between its pictures (error, seconds), beyond
    them as samples, whose squared error falls as 1/n."""
    for (e0, t0), (e1, t1) in zip(paths, paths[1:]):
        if e0 >= error >= e1 and e0 > e1:
            return t0 * (t1 / t0) ** (np.log(e0 / error) / np.log(e0 / e1))
    (e0, t0), (e1, t1) = paths[0], paths[-1]
    return t1 * (e1 / error) ** 2 if error < e1 else t0 * (e0 / error) ** 2


def doubts_of(asked, error, times, picture, reference, by_path, before):
    """Names of the invariants that a picture violates. by_path: the best picture by
    `path`. before: picture at a larger
    --error, or None."""
    found = []
    off, z = reference.off(picture)
    square, spread = reference.square(picture.luminance)
    if picture.least < 0:
        found.append("negative")
    if times < 1 / 1.21:
        found.append("slow")
    is_measured = error > reference.own_error() and square > 3 * spread
    if is_measured and picture.estimated < 0.6 * error:
        found.append("under-estimated")
    if abs(off) > 0.003 and abs(z) > 4:
        found.append("mean")
    if is_measured and error > 2 * asked:
        found.append("missed")
    if before:
        larger = reference.square(before.luminance)[0]
        noise = np.hypot(reference.spread(picture.luminance), reference.spread(before.luminance))
        if square > 1.21 * larger and square - larger > 3 * noise:
            found.append("rising")
    if reference.worst(picture.luminance, by_path)[4]:
        found.append("outlier")
    return found


def measure(room, a):
    """Prints the rows of a room. Returns for each: asked, times, estimated / actual, doubts."""
    halves = [room.path(f"half{k}-{a.reference}", a.reference, 900 + k) for k in range(2)]
    reference = Reference(halves[0].luminance, halves[1].luminance)
    made = [(e, room.try_render(f"error{e}", ["--error", e])) for e in a.errors]
    paths = [room.path(f"path{n}", n) for n in a.samples]
    reference.refine(room, [p for _, p in made if p])
    by_path = [(reference.error(p.luminance), p.seconds) for p in paths]
    rows, before = [], None
    for asked, picture in made:
        if picture is None:
            times = time_at(float(asked), by_path) / a.limit
            found = ["slow"] if times < 1 / 1.21 else []
            print(f"| {room.seed} | {asked} | | | | over {a.limit} | "
                  f"{' '.join(f'{e:.3f}/{t:.1f}' for e, t in by_path)} | under {times:.2f} | | "
                  f"{' '.join(found)} |", flush=True)
            rows.append((asked, times, float("nan"), found, ""))
            continue
        error = reference.error(picture.luminance)
        times = time_at(error, by_path) / picture.seconds
        found = doubts_of(float(asked), error, times, picture, reference, paths[-1].luminance,
                          before)
        before = picture
        off, z = reference.off(picture)
        x, y, value, right, _ = reference.worst(picture.luminance, paths[-1].luminance)
        mark = "?" if reference.own_error() > error / 3 else ""
        print(f"| {room.seed} | {asked} | {error:.4f}{mark} | {picture.estimated / error:.2f} | "
              f"{100 * off:+.2f} % ({z:+.1f}) | {picture.seconds:.2f} | "
              f"{' '.join(f'{e:.3f}/{t:.1f}' for e, t in by_path)} | {times:.2f} | "
              f"({x}, {y}) {value:.3g} for {right:.3g} | {' '.join(found)} |", flush=True)
        rows.append((asked, times, picture.estimated / error, found, mark))
    return rows


def summary(rows, errors):
    print("\n| asked | rooms | times as fast: geometric mean, median, least | est. in 1 to 1.6, under "
          "0.6, of rooms without ? | " + " | ".join(doubts) + " |\n" + "|---" * (4 + len(doubts)) + "|")
    for e in errors:
        of = [r for r in rows if r[0] == e]
        if not of:
            continue
        times = np.array([r[1] for r in of])
        estimates = np.array([r[2] for r in of if np.isfinite(r[2]) and not r[4]])
        within = np.sum((estimates >= 1) & (estimates <= 1.6))
        print(f"| {e} | {len(of)} | {np.exp(np.log(times).mean()):.2f}, {np.median(times):.2f}, "
              f"{times.min():.2f} | {within}, {np.sum(estimates < 0.6)} of {len(estimates)} | " +
              " | ".join(str(sum(d in r[3] for r in of)) for d in doubts) + " |")
    print("\nA ? marks an error below three times the reference's own. Doubts:")
    for name, text in doubts.items():
        print(f"- {name}: {text}")


def main():
    parser = argparse.ArgumentParser(description="Compares the default method with path tracing in "
                                     "random rooms, at equal error.")
    parser.add_argument("--rooms", type=int, default=100, help="number of rooms")
    parser.add_argument("--first", type=int, default=0, help="seed of the first room")
    parser.add_argument("--size", default="96x72")
    parser.add_argument("--errors", default=".1,.05,.02")
    parser.add_argument("--samples", default="16,64,256", help="of `path`, ascending")
    parser.add_argument("--reference", type=int, default=2048, help="samples of each half")
    parser.add_argument("--limit", type=int, default=600, help="processor seconds of a picture, of "
                        "`path` ten times as many; what takes longer counts as meeting its --error")
    parser.add_argument("--keep", action="store_true", help="use the default's old pictures, too")
    here = os.path.dirname(os.path.abspath(__file__))
    parser.add_argument("--program", default=os.path.join(here, "../../build/release/troffer"))
    parser.add_argument("--out", default=os.path.join(here, "../../build/bench/random-rooms"))
    a = parser.parse_args()
    a.errors, a.samples = a.errors.split(","), [int(n) for n in a.samples.split(",")]
    a.out = os.path.abspath(a.out)
    print("| room | asked | error | est. | mean (z) | s | path: error/s | times | worst pixel | "
          "doubts |\n" + "|---" * 10 + "|", flush=True)
    rows, failed = [], 0
    for seed in range(a.first, a.first + a.rooms):
        try:
            rows += measure(Room(seed, a), a)
        except (RuntimeError, Stopped) as error:
            failed += 1
            print(f"| {seed} | failed: {error} |", flush=True)
    summary(rows, a.errors)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
