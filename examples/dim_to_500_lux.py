#!/usr/bin/env python3
"""Dims the luminaires of a room until its desk has 500 lx, with as little light as that takes.

    PYTHONPATH=build/release/python /usr/bin/python3 examples/dim_to_500_lux.py

Light is linear: what all luminaires give together is the sum of what each gives alone. So each is
measured alone, once; what dimmers do is then arithmetic, and the last measurement only confirms it.
"""
import pathlib
import sys

import numpy as np
import troffer

WANTED_LX = 500

# ---- The room, and a grid of points on its desk, 0.76 m above the floor.

here = pathlib.Path(__file__).resolve().parents[1]
scene = troffer.load(sys.argv[1] if len(sys.argv) > 1 else
                     str(here / 'scenes/kj92room/kj92room_full.pbrt'))
rows = np.loadtxt(here / 'scenes/kj92room/desk-and-floor.csv', delimiter=',', skiprows=1,
                  dtype=str)
desk = rows[np.char.startswith(rows[:, -1], 'desk')][:, :6].astype(float)
print(f'{scene}: {len(scene.lights)} luminaires, {len(desk)} points on the desk')

# ---- Each luminaire alone.

gives = {}
for light in scene.lights:
    for other in scene.lights:
        other.dimmer = 1 if other.name == light.name else 0
    gives[light.name] = scene.measure(desk).illuminance.copy()
    print(f'  {light.name:12} gives the desk {gives[light.name].mean():7.1f} lx')

# ---- Dimmers d, 0 to 1, for which the mean of all points is what is wanted and the points differ
# little: minimise |A d - wanted|^2 by projected gradients, the mean being one more row that counts
# for much.

a = np.column_stack(list(gives.values()))
a = np.vstack([a, 30 * a.mean(axis=0)])
wanted = np.append(np.full(len(desk), WANTED_LX), 30 * WANTED_LX)
d = np.ones(a.shape[1])
step = 1 / np.linalg.norm(a.T @ a, 2)
for _ in range(20000):
    d = np.clip(d - step * (a.T @ (a @ d - wanted)), 0, 1)
for (name, alone), dimmer in zip(gives.items(), d):
    scene.light(name).dimmer = dimmer
    print(f'  {name:12} {100 * dimmer:5.1f} %')

# ---- What that comes to.

found = scene.measure(desk)
mean = found.illuminance.mean()
error = np.sqrt((found.standard_error**2).sum()) / len(found)
print(f'desk: {mean:.1f} +- {error:.1f} lx, uniformity {found.illuminance.min() / mean:.2f}')
picture = scene.render(width=320, height=240, error=.03)
picture.save('dimmed.png')
print('dimmed.png shows the room')
