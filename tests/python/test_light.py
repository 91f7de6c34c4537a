"""Skies, weather and luminaires that scripts add give the same light as the program's options."""
import csv
import datetime
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import troffer

ROOT = pathlib.Path(__file__).parents[2]
ROOM = ROOT / 'scenes/daylight-room/daylight-room.gltf'
LIST = ROOT / 'scenes/office/luminaires.csv'
PROGRAM = os.environ['TROFFER']
FLOOR = """v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -.3 2.4 -.3\nv .3 2.4 -.3\nv .3 2.4 .3
v -.3 2.4 .3\nmtllib m.mtl\no floor\nusemtl grey\nf 1 2 3 4\no lamp\nusemtl lamp\nf 5 6 7 8\n"""
MATERIALS = 'newmtl grey\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 5 5 5\n'
POINTS = np.array([[.2, .001, .3, 0, 1, 0], [-1, .001, 1, 0, 1, 0], [1.5, 1, 0, 1, 0, 0]])
VIENNA = (48.2, 16.4, '2026-06-21T09:00+02:00')


def epw():
    rows = ['LOCATION,Wien,-,AUT,none,110350,48.2,16.4,1.0,203.0', 'DATA PERIODS,1,1,Data,Sunday']
    for hour in range(1, 25):
        sun = '600,150' if 5 < hour < 20 else '0,0'
        rows.append(f'2005,6,21,{hour},60,?9,20,10,50,99000,900,1300,350,500,{sun},0,0')
    return '\n'.join(rows) + '\n'


def even_ies(lumens):
    """Returns the IES file of a panel whose intensity is proportional to the cosine."""
    angles = np.arange(0, 91, 1)
    cosines = ' '.join(f'{v:.6f}' for v in np.cos(np.radians(angles)) * lumens / np.pi)
    return (f'IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 91 1 1 2 .6 .6 0\n1 1 25\n'
            f'{" ".join(str(a) for a in angles)}\n0\n{cosines}\n')


class AddedLight(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write('floor.obj', FLOOR)
        self.write('m.mtl', MATERIALS)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def by_program(self, scene, *options):
        """Returns irradiance (r, g, b) at POINTS, measured by the program."""
        rows = [['x', 'y', 'z', 'nx', 'ny', 'nz'], *POINTS.tolist()]
        with open(self.folder / 'p.csv', 'w', newline='') as f:
            csv.writer(f).writerows(rows)
        out = self.folder / 'out.csv'
        subprocess.run([PROGRAM, 'measure', scene, '--points', self.folder / 'p.csv', '-o', out,
                        '--method', 'path', '--spp', '64', '--quiet', *options], check=True,
                       stderr=subprocess.DEVNULL)
        with open(out) as f:
            return np.array([[float(row['irradiance_' + c]) for c in 'rgb']
                             for row in csv.DictReader(f)])

    def check(self, scene, options, **asked):
        s = troffer.load(str(scene))
        s.add_light(**asked)
        expected = self.by_program(scene, *options)
        measured = s.measure(POINTS, method='path', spp=64).irradiance
        self.assertGreater(expected.max(), 0)
        np.testing.assert_allclose(measured, expected, rtol=1e-6)  # digits of the printed table
        return s

    def test_skies_are_those_of_the_program(self):
        self.check(ROOM, ['--sky', 'overcast,8000'], sky='overcast,8000')
        self.check(ROOM, ['--sun', '200.1,35.7'], sun=(200.1, 35.7))
        self.check(ROOM, ['--sky', 'cie:5', '--sun', '190,40,30000', '--north', '20', '--ground',
                          '.5'], sky='cie:5', sun=[190, 40, 30000], north=20, ground=.5)
        s = self.check(ROOM, ['--sky', 'perez:500,120', '--at', '48.2,16.4,' + VIENNA[2]],
                       sky='perez:500,120', at=VIENNA)
        zone = datetime.timezone(datetime.timedelta(hours=2))
        moment = datetime.datetime(2026, 6, 21, 9, 0, 0, 1, tzinfo=zone)
        t = troffer.load(str(ROOM))
        t.add_light(sky='perez:500,120', at=(48.2, 16.4, moment))
        a, b = (x.measure(POINTS, method='path', spp=16).irradiance for x in (s, t))
        np.testing.assert_array_equal(a, b)
        self.check(ROOM, ['--sky', 'clear', '--at', '48.2,16.4,' + VIENNA[2], '--turbidity', '5'],
                   sky='clear', at=VIENNA, turbidity=5)

    def test_weather(self):
        file = self.write('wien.epw', epw())
        options = ['--weather', file, '--date', '06-21T11:30']
        self.check(ROOM, options, weather=file, date='06-21T11:30')
        self.check(ROOM, options, weather=str(file), date=datetime.datetime(2001, 6, 21, 11, 30))
        self.check(ROOM, ['--weather', file, '--at', '48.2,16.4,' + VIENNA[2]], weather=file,
                   at=VIENNA)
        night = troffer.load(str(ROOM))
        night.add_light(weather=file, date='06-21T02:00')
        self.assertEqual(night.lights, [])
        self.assertTrue(any("below the horizon" in w for w in night.warnings))

    def test_surroundings_and_portals(self):
        image = self.folder / 'a,1.pfm'
        values = np.random.default_rng(1).uniform(.1, 2, (8, 16, 3)).astype('<f4')
        image.write_bytes(b'PF\n16 8\n-1\n' + values.tobytes())
        self.check(ROOM, ['--environment', f'{image},3', '--environment-rotation', '30'],
                   environment=(image, 3), environment_rotation=30)
        corners = [(-2, 3, -2), (2, 3, -2), (2, 3, 2), (-2, 3, 2)]
        text = ','.join(str(v) for corner in corners for v in corner)
        obj = self.folder / 'floor.obj'
        self.check(obj, ['--sky', 'even', '--portal', text], sky='even', portal=corners)
        other = [(x + 9, y, z) for x, y, z in corners]
        more = ','.join(str(v) for corner in other for v in corner)
        self.check(obj, ['--sky', 'even', '--portal', text, '--portal', more], sky='even',
                   portal=[corners, other])

    def test_luminaires(self):
        file, obj = self.write('even.ies', even_ies(1000)), self.folder / 'floor.obj'
        self.check(obj, ['--luminaire', f'lamp={file}'], luminaires={'lamp': file})
        self.check(obj, ['--luminaire', f'lamp={file},1500'], luminaires={'lamp': (file, 1500)})
        warm = self.check(obj, ['--luminaire', f'lamp={file},,2700'],
                          luminaires={'lamp': (file, None, 2700)})
        r, _, b = warm.measure(POINTS, method='path', spp=64).irradiance[0]
        self.assertGreater(r, 1.5 * b)
        self.check(obj, ['--luminaires', LIST, '--light-radius', '.05', '--up', '0,1,0'],
                   luminaire_list=LIST, light_radius=.05, up=(0, 1, 0))

    def test_added_lights_are_dimmed_like_others(self):
        scene = troffer.load(str(self.folder / 'floor.obj'))
        name = scene.lights[0].name
        scene.light(name).dimmer = .5
        before = scene.measure(POINTS, method='path', spp=64).irradiance
        scene.add_light(sky='even', portal=None)
        scene.light('sky').dimmer = 0
        np.testing.assert_array_equal(scene.measure(POINTS, method='path', spp=64).irradiance,
                                      before)
        self.assertEqual(scene.light(name).dimmer, .5)
        scene.light('sky').dimmer = 1
        self.assertGreater(scene.measure(POINTS, method='path', spp=64).irradiance.min(),
                           before.min())

    def test_nothing_is_changed_by_what_cannot_be(self):
        scene = troffer.load(str(self.folder / 'floor.obj'))
        bad = self.write('bad.ies', 'TILT=NONE\n1 2\n')
        good = self.write('good.ies', even_ies(10))
        kinds = [e.kind for e in scene.lights]
        for wrong, error in (({'sky': 'purple'}, ValueError), ({'sun': (0, 100)}, ValueError),
                             ({'sun': 'noon'}, TypeError), ({'sky': 3}, TypeError),
                             ({'luminaires': {'lamp': good, 'nobody': good}}, ValueError),
                             ({'luminaires': {'lamp': bad}}, troffer.InputError),
                             ({'luminaires': 'lamp'}, TypeError), ({'moon': 1}, TypeError),
                             ({'sun': (float('nan'), 3)}, ValueError),
                             ({'weather': bad, 'date': '06-21T11:30'}, troffer.InputError),
                             ({'date': '06-21T11:30'}, ValueError),
                             ({'at': (48, 16, datetime.datetime(2026, 6, 21, 12))}, ValueError),
                             ({'sky': 'even', 'portal': 'nobody'}, ValueError),
                             ({'ground': 2}, ValueError), ({'luminaire_list': bad},
                                                           troffer.InputError)):
            with self.subTest(wrong=wrong), self.assertRaises(error) as caught:
                scene.add_light(**wrong)
            self.assertNotIn('--', str(caught.exception))
        self.assertEqual([e.kind for e in scene.lights], kinds)


if __name__ == '__main__':
    unittest.main()
