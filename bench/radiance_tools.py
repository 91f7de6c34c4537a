"""Runs Radiance's rfluxmtx and gendaymtx for comparisons of annual daylight.

Radiance is not part of this project. The programs oconv, rfluxmtx, rcontrib and gendaymtx are
expected in one folder, with reinhartb.cal and rayinit.cal beside them or in RAYPATH.
"""
import os
import pathlib
import resource
import subprocess

import numpy as np

LUMENS_PER_WATT = 179  # Radiance's constant
LUMINANCE = np.array([0.265, 0.670, 0.065])  # of its primaries


def polygon_with_holes(outline, holes):
    """Returns one ring of corners that joins each hole to a corner of its own by a seam."""
    ring, used = list(outline), set()
    for hole in holes:
        hole = list(reversed(hole))
        _, corner, start = min(
            (np.linalg.norm(np.subtract(a, b)), i, k) for i, a in enumerate(outline)
            if i not in used for k, b in enumerate(hole))
        used.add(corner)
        at = ring.index(outline[corner])
        around = hole[start:] + hole[:start + 1]
        ring[at + 1:at + 1] = around + [outline[corner]]
    return ring


def polygon(material, name, corners):
    numbers = ' '.join('%.9g' % c for p in corners for c in p)
    return f'{material} polygon {name} 0 0 {3 * len(corners)} {numbers}\n'


class Radiance:
    """The programs in one folder, and a folder for their files."""

    def __init__(self, programs, folder, subdivision=1):
        self.programs = pathlib.Path(programs).resolve()
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.subdivision = subdivision
        self.environment = dict(os.environ)
        self.environment['PATH'] = f'{self.programs}:{os.environ["PATH"]}'
        self.environment['RAYPATH'] = f'.:{self.programs}:{os.environ.get("RAYPATH", "")}'
        (self.folder / 'sky.rad').write_text(
            '#@rfluxmtx u=+Y h=u\nvoid glow ground_glow 0 0 4 1 1 1 0\n'
            'ground_glow source ground 0 0 4 0 0 -1 180\n'
            f'#@rfluxmtx u=+Y h=r{subdivision}\nvoid glow sky_glow 0 0 4 1 1 1 0\n'
            'sky_glow source sky 0 0 4 0 0 1 180\n')

    def run(self, command, stdin=None):
        """Runs a command and returns its output and processor time."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(command, cwd=self.folder, env=self.environment, input=stdin,
                              stdout=subprocess.PIPE, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return done.stdout, (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)

    def coefficients(self, scene, points, options):
        """Returns lx per (W/m2 sr) of each patch, ground first, and seconds.

        points: rows of position and normal. Options are those of rfluxmtx.
        """
        (self.folder / 'scene.rad').write_text(scene)
        octree, first = self.run(['oconv', 'scene.rad'])
        (self.folder / 'scene.oct').write_bytes(octree)
        text = ''.join(' '.join('%.9g' % c for c in p) + '\n' for p in points).encode()
        out, second = self.run(['rfluxmtx', '-h', '-I+', '-faf', '-y', str(len(points)),
                                *options.split(), '-', 'sky.rad', '-i', 'scene.oct'], text)
        values = np.frombuffer(out, np.float32).reshape(len(points), -1, 3)
        return LUMENS_PER_WATT * values.astype(float) @ LUMINANCE, first + second

    def skies(self, weather):
        """Returns radiances of patches by rows of the weather file, the sun in its patches."""
        out, _ = self.run(['gendaymtx', '-m', str(self.subdivision), '-O0', '-of', '-h',
                           str(pathlib.Path(weather).resolve())])
        hours = sum(row[:1].isdigit() for row in open(weather))
        values = np.frombuffer(out, np.float32).reshape(-1, hours, 3)
        return values.astype(float) @ LUMINANCE
