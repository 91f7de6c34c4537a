#!/usr/bin/env python3
"""Error against processor time of the sky's direct light: run.py TROFFER [--lights "ARGS" ...]
image.pfm in ARGS is an image of the surroundings that is written beside the rooms. SIZE=WxH in the
environment: of the pictures, for a quick look.

Renders the rooms of rooms.py by the default and by `fixed`, each with two seeds, and prints as a
table: processor seconds of a picture, its error, and how many times longer `fixed` would take for
the same error, by the power law between its two runs. Errors come from the difference of the two
pictures: the relative RMSE of all pixels, most of which is made by edges where the sky itself is
seen, and the median pixel's relative error (as a standard deviation). Times are compared by the
median pixel with 4 viewing rays a pixel; and by all pixels with the best one of 16 viewing rays of
16 shadow rays, 64 of 4 and 1024 of 4, since 4 viewing rays leave edges an error that no shadow rays
take away (errors fall with the root of the time, as they do for noise; the last of the three takes
about as long as the default does, so that little hangs on it).
"""
import array
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import rooms


SIZE = ['--size', os.environ['SIZE']] if 'SIZE' in os.environ else []
LIGHTS = ['--sky overcast', '--sky clear --sun 60,35', '--environment image.pfm']


def luminances(path):
    with open(path, 'rb') as f:
        channels = 3 if f.readline().strip() == b'PF' else 1
        f.readline(), f.readline()
        v = array.array('f', f.read())
    if channels == 1:
        return list(v)
    return [.2126 * v[i] + .7152 * v[i + 1] + .0722 * v[i + 2] for i in range(0, len(v), 3)]


def measure(troffer, scene, options, folder):
    """Seconds, error of all pixels, of the median one among those that get light."""
    pictures, seconds = [], 0
    for seed in ('1', '2'):
        out, stats = folder / f'{seed}.pfm', folder / 'stats.json'
        subprocess.run([troffer, 'render', scene, '--quiet', '--indirect', 'none', '--seed', seed,
                        '-o', out, '--stats', stats, *SIZE, *options], check=True, cwd=folder)
        pictures.append(luminances(out))
        seconds += json.loads(stats.read_text())['seconds']['render_cpu'] / 2
    a, b = pictures
    mean = [(x + y) / 2 for x, y in zip(a, b)]
    middle = sorted(mean)[len(mean) // 2]
    differences = [abs(x - y) / math.sqrt(2) for x, y in zip(a, b)]
    overall = math.sqrt(sum(d * d for d in differences) / len(a)) / (sum(mean) / len(mean))
    relative = sorted(d / (m + .05 * middle + 1e-9) for d, m in zip(differences, mean) if m > 0)
    return seconds, overall, relative[len(relative) // 2] / .6745


def main():
    troffer, lights = pathlib.Path(sys.argv[1]).resolve(), sys.argv[3:] or LIGHTS
    print('| scene | light | default, s | error | `fixed` 64, s | error | `fixed` 256, s | error '
          '| `fixed` 16 × 16, s | error | `fixed` 64 × 4, s | error | `fixed` 1024 × 4, s | error | times longer: median | all |\n' +
          '|---' * 16 + '|')
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        rooms.write(folder)
        for light in lights:
            for scene in rooms.SCENES:
                path = folder / f'{scene}.pbrt'
                ours = measure(troffer, path, light.split(), folder)
                few, many = (measure(troffer, path,
                                     [*light.split(), '--method', 'fixed', '--shadow-rays', n], folder)
                             for n in ('64', '256'))
                # No law where more rays did not help.
                gain = math.log(few[2] / many[2]) if many[2] < .9 * few[2] else math.nan
                needed = many[0] * (many[2] / ours[2]) ** (math.log(many[0] / few[0]) / gain)
                even = [measure(troffer, path, [*light.split(), '--method', 'fixed', '--spp', spp,
                                                '--shadow-rays', rays], folder)
                        for spp, rays in (('16', '16'), ('64', '4'), ('1024', '4'))]
                cells = [f'{s:.2f} | {e:.3f} / {b:.4f}' for s, e, b in (ours, few, many, *even)]
                by_all = min(s / ours[0] * (e / ours[1]) ** 2 for s, e, _ in even)
                print(f'| {scene} | `{light}` | {" | ".join(cells)} | {needed / ours[0]:.1f} '
                      f'| {by_all:.1f} |', flush=True)


if __name__ == '__main__':
    main()
