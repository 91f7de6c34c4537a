"""Runs troffer and keeps its results: a command runs again only if its words, the program or the scene
have changed."""

import hashlib
import json
import os
import shlex
import subprocess
import sys
import time
from dataclasses import dataclass, field

import exr

USUAL_BUILD = "build/release"


@dataclass
class Run:
    """Results of a command."""

    command: str  # as typed in the repository's root
    exr: str = ""
    stats: dict = field(default_factory=dict)  # contents of --stats
    wall: float = 0  # seconds of the whole process
    cpu: float = 0  # seconds of processor time, all threads
    csv: str = ""  # of measuring points
    _layers: dict = None

    @property
    def layers(self):
        if self._layers is None:
            self._layers = exr.read(self.exr)
        return self._layers

    @property
    def picture(self):
        return self.layers[""]

    @property
    def rays(self):
        return self.stats["shadow_rays_per_viewing_ray"]


def _digest(*paths):
    h = hashlib.sha256()
    for path in paths:
        with open(path, "rb") as file:
            h.update(file.read())
    return h.hexdigest()


class Program:
    """troffer in `build`, with its files in `out`. Both are relative to the working directory, which is
    the repository's root. usual_out: replaces `out` in printed commands."""

    def __init__(self, build, out, usual_out):
        self.build, self.out, self.usual_out = build, out, usual_out
        self.troffer = f"{build}/troffer"
        self.planned, self.done = 0, 0
        self.version = _digest(self.troffer)
        self.begun = time.time()
        os.makedirs(f"{out}/renders", exist_ok=True)

    def shown(self, words):
        """Returns a command as a reader would type it, with the usual folders."""
        command = shlex.join(words).replace(f"{self.build}/", f"{USUAL_BUILD}/")
        return command.replace(f"{self.out}/", f"{self.usual_out}/")

    def _progress(self, what):
        self.done += 1
        minutes, seconds = divmod(int(time.time() - self.begun), 60)
        print(f"[{self.done:3d}/{self.planned}] {minutes:2d}:{seconds:02d}  {what}", flush=True)

    def _execute(self, name, words, scene, target, is_of_any_version=False):
        """Runs a command unless its result is up to date; returns the record of the run."""
        record_path = f"{self.out}/renders/{name}.run.json"
        key = [self.version, _digest(scene), words]
        if is_of_any_version:
            key = ["any", _digest(scene), words[1:]]
        try:
            with open(record_path) as file:
                record = json.load(file)
            if record["key"] == key and os.path.exists(target):
                self._progress(f"{name} (up to date)")
                return record
        except (OSError, ValueError, KeyError):
            pass
        self._progress(name)
        before, start = os.times(), time.time()
        failed = subprocess.run(words, stdin=subprocess.DEVNULL).returncode
        after = os.times()
        if failed:
            sys.exit(f"error: status {failed} from: {shlex.join(words)}")
        cpu = after.children_user + after.children_system
        cpu -= before.children_user + before.children_system
        record = {"key": key, "wall": time.time() - start, "cpu": cpu}
        with open(record_path, "w") as file:
            json.dump(record, file)
        return record

    def radiosity(self, name, scene, options):
        """Returns the solution file of the preprocessing."""
        target = f"{self.out}/renders/{name}.trad"
        words = [self.troffer, "radiosity", scene, *options.split(), "-o", target]
        record = self._execute(name, words, scene, target)
        return Run(self.shown(words), target, {}, record["wall"], record["cpu"])

    def render(self, name, scene, options, is_of_any_version=False):
        target = f"{self.out}/renders/{name}.exr"
        stats = f"{self.out}/renders/{name}.json"
        words = [self.troffer, "render", scene, *options.split(), "-o", target]
        record = self._execute(name, words + ["--stats", stats, "--quiet"], scene, target,
                               is_of_any_version)
        with open(stats) as file:
            numbers = json.load(file)
        return Run(self.shown(words), target, numbers, record["wall"], record["cpu"])

    def measure(self, name, scene, points, options, is_of_any_version=False):
        """Returns values at the points of a CSV file. A changed file is measured again."""
        name = f"{name}-{_digest(points)[:12]}"
        target = f"{self.out}/renders/{name}.csv"
        words = [self.troffer, "measure", scene, "--points", points, *options.split(), "--quiet",
                 "-o", target]
        record = self._execute(name, words, scene, target, is_of_any_version)
        return Run(self.shown(words), "", {}, record["wall"], record["cpu"], target)

    def timed(self, name, scene, options, repeats=3):
        """Renders `repeats` times on one thread; the stats have the seconds of the fastest run."""
        best = None
        for _ in range(repeats):
            self.forget(name)
            self.planned += 1
            run = self.render(name, scene, options + " --threads 1")
            if best is None or (run.stats["seconds"]["render_cpu"]
                                < best.stats["seconds"]["render_cpu"]):
                best = run
        return best

    def forget(self, name):
        """Discards the result of that name, so that it runs again."""
        record = f"{self.out}/renders/{name}.run.json"
        if os.path.exists(record):
            os.remove(record)

    def compare(self, image, reference):
        words = [self.troffer, "compare", image, reference, "--json"]
        return json.loads(subprocess.run(words, check=True, capture_output=True).stdout)
