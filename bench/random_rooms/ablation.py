"""Measures what each rule gains; see ../ablation."""

import argparse
import os
import re
import signal
import subprocess
import sys

import numpy as np

import main as rooms

here = os.path.dirname(os.path.abspath(__file__))
root = os.path.join(here, "../..")


def rules_in_source():
    found = set()
    for folder, _, names in os.walk(os.path.join(root, "src")):
        for name in names:
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                found |= set(re.findall(r'is_left_out<"([^"]+)">', file.read()))
    return sorted(found)


def costs():
    """Costs of counted work by their names in costs.h."""
    with open(os.path.join(root, "src/transport/costs.h"), encoding="utf-8") as file:
        found = re.findall(r"(cost_of_\w+) = ([0-9./ ]+)", file.read())
    return {name: eval(value) for name, value in found}  # pylint: disable=eval-used


def counted_cost(stats):
    """Cost of the counted work of a picture, in rays: the same beside any load, other than time."""
    c, parts = costs(), [stats["work"] | {"viewing_rays": stats["viewing_rays"]}]
    parts[0]["pairs"] = stats["lit_certified"] + stats["masked"] + stats["mixed"]
    parts.append(stats.get("preparation", {}))
    return c["cost_of_surrogate"] * stats["surrogate_samples"] + sum(
        p.get("viewing_rays", 0) + p.get("extension_rays", 0)
        + c["cost_of_shadow_ray"] * p.get("shadow_rays", 0) + c["cost_of_mask"] * p.get("masks", 0)
        + c["cost_of_mask_facet"] * p.get("mask_facets", 0)
        + c["cost_of_point"] * p.get("points", 0) + c["cost_of_cluster"] * p.get("clusters", 0)
        + c["cost_of_pair"] * p.get("pairs", 0) for p in parts)


class PublicScene(rooms.Room):
    """A scene by others, from a line of bench/public.txt."""

    def __init__(self, file, options, a):
        self.a, self.file, self.options, self.tags = a, file, options, []
        parts = os.path.relpath(file, a.public).split(os.sep)
        self.seed = "-" + "-".join(p for p in parts if p not in ("scenes", "scene.xml"))
        os.makedirs(os.path.join(a.out, f"room{self.seed}"), exist_ok=True)


def public_scenes(a):
    if not a.public:
        return []
    files = [os.path.join(folder, name) for folder, _, names in sorted(os.walk(a.public))
             for name in names]
    with open(os.path.join(here, "../public.txt"), encoding="utf-8") as file:
        lines = [l.split("|") for l in file if l.strip() and not l.startswith("#")]
    scenes = []
    for kind, end, options in lines:
        found = next((f for f in files if f.endswith("/" + end.strip())), None)
        if found and kind.strip() == a.set:
            whole = os.path.join(os.path.dirname(found), "without-missing-shapes.xml")
            scenes.append(PublicScene(whole if os.path.exists(whole) else found, options.split(), a))
    return scenes


class Measured:
    """Pictures of one scene, with and without rules, at each error and seed."""

    def __init__(self, room, a):
        self.room, self.a = room, a
        halves = [room.path(f"half{k}-{a.reference}", a.reference, 900 + k) for k in range(2)]
        self.reference = rooms.Reference(*(h.luminance for h in halves))
        # Every rule is compared with these pictures, so their times are medians.
        self.whole = {c: self.render_thrice(*c) for c in self.cases()}
        self.reference.refine(room, [p for p in self.whole.values() if p])

    def cases(self):
        return [(e, s) for e in self.a.errors for s in range(self.a.seeds)]

    def render(self, error, seed):
        return self.room.try_render("ablation", ["--error", error, "--seed", str(seed)])

    def render_thrice(self, error, seed):
        pictures = [self.render(error, seed) for _ in range(3)]
        return None if None in pictures else sorted(pictures, key=lambda p: p.seconds)[1]

    def without(self, rule):
        """Returns per picture (work, time, error, mean, its standard error, counted work) over those
        with the rule; None for a picture that is the same; a picture over the limit counts as at the limit."""
        os.environ["TROFFER_WITHOUT"] = rule
        rows = []
        for case in self.cases():
            whole = self.whole[case]
            if whole is None:
                continue
            part = self.render(*case)
            e0 = self.reference.error(whole.luminance)
            if part is None:
                work = self.a.limit / whole.seconds
                rows.append((work, work, 1, 0, 1, work))
                continue
            if np.array_equal(part.luminance, whole.luminance):
                rows.append(None)
                continue
            e1 = self.reference.error(part.luminance)
            time = part.seconds / whole.seconds
            x, y = (self.reference.limited(p.luminance) for p in (part, whole))
            noise = np.hypot(part.estimated, whole.estimated) / (x.size / rooms.alike) ** 0.5
            counted = counted_cost(part.stats) / counted_cost(whole.stats)
            rows.append((time * (e1 / e0) ** 2, time, e1 / e0, x.mean() / y.mean() - 1, noise,
                         counted * (e1 / e0) ** 2))
        del os.environ["TROFFER_WITHOUT"]
        return rows


def row_of(rule, rows):
    changed = np.array([r for r in rows if r is not None])
    if not len(changed):
        return f"| {rule} | | | | | | | | | 0 of {len(rows)} |"
    logs = np.log(changed[:, [0, 1, 2, 5]])
    mean = np.exp(logs.mean(axis=0))
    error = logs[:, 0].std(ddof=1) / len(logs) ** 0.5 if len(logs) > 1 else float("nan")
    weights = 1 / (changed[:, 4] ** 2 + 1e-8)
    off, sigma = (weights * changed[:, 3]).sum() / weights.sum(), weights.sum() ** -0.5
    return (f"| {rule} | {mean[0]:.3f} | {error:.3f} | {np.exp(logs[:, 0].min()):.2f} | "
            f"{np.exp(logs[:, 0].max()):.2f} | {mean[1]:.3f} | {mean[2]:.3f} | {mean[3]:.3f} | {100 * off:+.2f} % "
            f"({off / sigma:+.1f}) | {len(changed)} of {len(rows)} |")


def main():
    parser = argparse.ArgumentParser(description="Measures what each rule of the default method gains.")
    parser.add_argument("--rules", help="names, separated by commas; without: all")
    parser.add_argument("--rooms", type=int, default=20, help="number of random rooms")
    parser.add_argument("--first", type=int, default=100, help="seed of the first room")
    parser.add_argument("--list", help="seeds of the rooms, separated by commas, in place of these two")
    parser.add_argument("--size", default="80x60")
    parser.add_argument("--errors", default=".05")
    parser.add_argument("--seeds", type=int, default=1, help="pictures of each scene and error")
    parser.add_argument("--public", default="", help="folder with repositories of bench/public.txt")
    parser.add_argument("--set", default="look", help="of bench/public.txt")
    parser.add_argument("--reference", type=int, default=1024, help="samples of each half")
    parser.add_argument("--limit", type=int, default=120, help="processor seconds of a picture; "
                        "scenes that take longer are left out")
    parser.add_argument("--program", default=os.path.join(root, "build/ablation/troffer"))
    parser.add_argument("--out", default=os.path.join(root, "build/bench/random-rooms"))
    a = parser.parse_args()
    a.errors, a.out, a.keep = a.errors.split(","), os.path.abspath(a.out), False
    rules = a.rules.split(",") if a.rules else rules_in_source()
    unknown = set(rules) - set(rules_in_source())
    if unknown:
        sys.exit(f"error: no such rule: {', '.join(sorted(unknown))}. There are: "
                 f"{', '.join(rules_in_source())}")
    os.makedirs(a.out, exist_ok=True)
    rows = {rule: [] for rule in rules}
    # A shell that starts it in the background ignores this signal.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    seeds = ([int(s) for s in a.list.split(",") if s] if a.list is not None
             else range(a.first, a.first + a.rooms))
    scenes = [rooms.Room(seed, a) for seed in seeds] + public_scenes(a)
    try:
        for k, scene in enumerate(scenes):
            print(f"{k + 1} of {len(scenes)}: {scene.seed}", file=sys.stderr, flush=True)
            try:
                measured = Measured(scene, a)
                for rule in rules:
                    rows[rule] += measured.without(rule)
            except (RuntimeError, rooms.Stopped, subprocess.SubprocessError) as error:
                print(f"{scene.seed} failed: {error}", file=sys.stderr)
    except KeyboardInterrupt:
        print("stopped: the table holds what was finished", file=sys.stderr)
    print("| without | work | ± | least | most | time | error | counted | mean | n |\n" + "|---" * 10 + "|")
    for rule in rules:
        print(row_of(rule, rows[rule]))


if __name__ == "__main__":
    main()
