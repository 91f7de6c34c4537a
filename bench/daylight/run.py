#!/usr/bin/env python3
"""Error against processor time of the sky's direct light:
run.py TROFFER [--output TABLES.md] [--lights "ARGS" ...] [--scenes NAME ...] [--seeds N]
image.pfm in ARGS is an environment image that is written next to the rooms. SIZE=WxH in the
environment sets the size of the pictures, for a quick look.

Renders the rooms of rooms.py by the default method, by `fixed` and by `path` (direct light alone),
each with several seeds. Writes two tables: processor seconds and errors of a picture, and how many
times longer `fixed` and `path` take for the error of the default. With --output the tables go to
that file after each row (with headings, ready for docs/reference/daylight.md), and the runs to a .csv of the
same name. Errors come from the differences of pictures: the relative RMSE of all pixels, which is
mostly due to edges against the visible sky, and the median pixel's relative error (as a standard
deviation).

Times of `fixed` for the median pixel: by the power law between its two runs of 4 viewing rays a
pixel, or by the best run of all if that is faster. Times of `fixed` for all pixels: by the best run
of 16 viewing rays with 16 shadow rays, 64 with 4, and 1024 with 4, since 4 viewing rays leave an
error at edges that shadow rays cannot reduce. Times of `path`: by the best of its three runs.
Errors fall with the root of the time, as noise does. `fixed` 1024 x 4 and the last run of `path`
take about as long as the default, so the results depend little on that law.
"""
import argparse
import array
import csv
import json
import math
import os
import pathlib
import subprocess
import tempfile

import rooms


SIZE = ['--size', os.environ['SIZE']] if 'SIZE' in os.environ else []
LIGHTS = ['--sky overcast', '--sky clear --sun 60,35', '--environment image.pfm']
FIXED = [('`fixed` 64', ['--shadow-rays', '64']), ('`fixed` 256', ['--shadow-rays', '256']),
         *((f'`fixed` {spp} × {rays}', ['--spp', spp, '--shadow-rays', rays])
           for spp, rays in (('16', '16'), ('64', '4'), ('1024', '4')))]
PATH_SPP = [64, 1024]


def luminances(path):
    with open(path, 'rb') as f:
        channels = 3 if f.readline().strip() == b'PF' else 1
        f.readline(), f.readline()
        v = array.array('f', f.read())
    if channels == 1:
        return list(v)
    return [.2126 * v[i] + .7152 * v[i + 1] + .0722 * v[i + 2] for i in range(0, len(v), 3)]


class Bench:
    """Runs of one scene under one light."""

    def __init__(self, troffer, folder, seeds):
        self.troffer, self.folder, self.seeds = troffer, folder, seeds

    def run(self, scene, light, options):
        """Returns seconds, the error of all pixels, and the error of the median lit pixel."""
        pictures, seconds = [], 0
        for seed in range(1, self.seeds + 1):
            out, stats = self.folder / f'{seed}.pfm', self.folder / 'stats.json'
            subprocess.run([self.troffer, 'render', self.folder / f'{scene}.pbrt', '--quiet',
                            '--indirect', 'none', '--seed', str(seed), '-o', out, '--stats', stats,
                            *SIZE, *light.split(), *options], check=True, cwd=self.folder)
            pictures.append(luminances(out))
            seconds += json.loads(stats.read_text())['seconds']['render_cpu'] / self.seeds
        pixels = list(zip(*pictures))
        mean = [sum(p) / len(p) for p in pixels]
        variance = [sum((v - m) ** 2 for v in p) / (len(p) - 1) for p, m in zip(pixels, mean)]
        middle = sorted(mean)[len(mean) // 2]
        overall = math.sqrt(sum(variance) / len(variance)) / (sum(mean) / len(mean))
        relative = sorted(math.sqrt(v) / (m + .05 * middle + 1e-9)
                          for v, m in zip(variance, mean) if m > 0)
        return seconds, overall, relative[len(relative) // 2] / median_of_spread(self.seeds)


def median_of_spread(n):
    """Returns the median spread of n values from a normal distribution with deviation 1."""
    return .6745 if n == 2 else (1 - 2 / (9 * (n - 1))) ** 1.5  # Wilson & Hilferty


def times_longer(run, ours, error):
    return run[0] / ours[0] * (run[error] / ours[error]) ** 2


def times_by_law(few, many, ours):
    """Returns the times by the power law of the median pixel; none if more rays did not help."""
    gain = math.log(few[2] / many[2]) if many[2] < .9 * few[2] else math.nan
    return many[0] * (many[2] / ours[2]) ** (math.log(many[0] / few[0]) / gain) / ours[0]


def runs_of(bench, scene, light):
    """Returns the runs by name, the default's first."""
    runs = {'default': bench.run(scene, light, [])}
    for name, options in FIXED:
        runs[name] = bench.run(scene, light, ['--method', 'fixed', *options])

    def path(spp):
        return bench.run(scene, light, ['--method', 'path', '--depth', '1', '--spp', str(spp)])
    for spp in PATH_SPP:
        runs[f'`path` {spp}'] = path(spp)
    a_ray = runs[f'`path` {PATH_SPP[-1]}'][0] / PATH_SPP[-1]
    as_long = 2 ** max(round(math.log2(runs['default'][0] / a_ray)), 2)
    runs['`path` as long'] = path(as_long)
    return runs, as_long


def summary(runs):
    ours = runs['default']
    fixed, path = ([runs[name] for name in runs if name.startswith(f'`{method}`')]
                   for method in ('fixed', 'path'))
    by_law = times_by_law(fixed[0], fixed[1], ours)
    by_root = min(times_longer(r, ours, 2) for r in fixed)
    return (by_root if math.isnan(by_law) else min(by_law, by_root),
            min(times_longer(r, ours, 1) for r in fixed[2:]),
            min(times_longer(r, ours, 2) for r in path), min(times_longer(r, ours, 1) for r in path))


def table(heads, rows):
    return '\n'.join('| ' + ' | '.join(r) + ' |' for r in [heads, ['---'] * len(heads), *rows]) + '\n'


def write(output, done):
    """Writes both tables. done: (scene, light, runs, spp of the last run of `path`)."""
    names = list(done[0][2])
    times = [[scene, f'`{light}`',
              *(f'{s:.2f} s, {e:.3f} / {m:.4f}' + (f' (spp {spp})' if name.endswith('as long') else '')
                for name, (s, e, m) in runs.items())] for scene, light, runs, spp in done]
    longer = [[scene, f'`{light}`', *(f'{t:.1f}' for t in summary(runs))]
              for scene, light, runs, _ in done]
    text = (table(['scene', 'light', *names], times) + '\nTimes longer for the error of the default:\n\n' +
            table(['scene', 'light', '`fixed`: median', 'all', '`path`: median', 'all'], longer))
    if output is None:
        return text
    output.write_text(text)
    with open(output.with_suffix('.csv'), 'w', newline='') as f:
        out = csv.writer(f)
        out.writerow(['scene', 'light', 'run', 'seconds', 'error_all', 'error_median',
                      'times_longer_all', 'times_longer_median'])
        for scene, light, runs, spp in done:
            for name, run in runs.items():
                ours = runs['default']
                out.writerow([scene, light, name.replace('`', '').replace('as long', str(spp)),
                              *(f'{v:.6g}' for v in run),
                              *(f'{times_longer(run, ours, k):.4g}' for k in (1, 2))])
    return text


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('troffer', type=pathlib.Path)
    parser.add_argument('--output', type=pathlib.Path)
    parser.add_argument('--lights', nargs='+', default=LIGHTS)
    parser.add_argument('--scenes', nargs='+', default=list(rooms.SCENES), choices=rooms.SCENES)
    parser.add_argument('--seeds', type=int, default=4)
    args = parser.parse_args()
    done = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        rooms.write(folder)
        bench = Bench(args.troffer.resolve(), folder, max(args.seeds, 2))
        for light in args.lights:
            for scene in args.scenes:
                runs, as_long = runs_of(bench, scene, light)
                done.append((scene, light, runs, as_long))
                text = write(args.output, done)
                print(f'{scene}, {light}: times longer for `fixed` (median, all), `path` (median, all): '
                      + ', '.join(f'{t:.1f}' for t in summary(runs)), flush=True)
    print('\n' + text)


if __name__ == '__main__':
    main()
