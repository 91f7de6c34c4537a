"""A year of daylight in Python: closed forms in the open, and equality with the program."""
import datetime
import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np
import troffer

LATITUDE = 48


def weather(folder, direct=600):
    """Writes hours of one day per month; half past twelve is the only one with sun."""
    lines = [f'place Test\nlatitude {LATITUDE}\nlongitude 0\ntime_zone 0\nsite_elevation 0\n'
             'weather_data_file_units 1']
    for month in range(1, 13):
        for hour in (10.5, 12.5, 15.5):
            lines.append(f'{month} 21 {hour:.3f} {direct if hour == 12.5 else 0} 150')
    path = pathlib.Path(folder) / 'test.wea'
    path.write_text('\n'.join(lines) + '\n')
    return path


def open_air():
    """A scene with nothing in it but a speck far away."""
    scene = troffer.Scene()
    scene.add_mesh([[500, 500, 0], [500.01, 500, 0], [500, 500.01, 0]], [[0, 1, 2]], name='speck')
    return scene


class OpenAir(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.year = open_air().annual(
                weather(folder),
                {'up': [[0, 0, 1]], 'others': [[0, 0, 1, 0, 0, -1], [0, 0, 1, 0, -1, 0]]},
                gather_rays=64, threshold=20000)
        cls.up, cls.others = cls.year['up'], cls.year['others']

    def test_shapes(self):
        self.assertTrue(self.year.is_complete)
        self.assertEqual([g.name for g in self.year.grids], ['up', 'others'])
        self.assertEqual(self.year.hours.shape, (36,))
        self.assertEqual(self.others.total.shape, (2, 36))
        self.assertEqual(self.others.total.dtype, np.float32)
        self.assertEqual(len(self.others), 2)
        self.assertEqual(self.others.direct.shape, self.others.standard_error.shape)
        self.assertTrue(self.year.occupied.all())
        self.assertEqual(self.year.states, {})
        with self.assertRaises(KeyError):
            self.year['of no name']

    # The ground's luminance is its reflectance times the global illuminance over pi.
    def test_ground(self):
        np.testing.assert_allclose(self.others.total[0], 0.2 * self.up.total[0], rtol=0.02)

    # In local solar time, the sun stands in the south at noon. The equation of time moves it by a
    # quarter of an hour at most, and half past twelve is half an hour after noon.
    def test_sunlight_goes_with_the_cosine(self):
        noon = 3 * np.arange(12) + 1
        sun = self.up.direct[0, noon]
        self.assertTrue((sun > 0).all())
        self.assertTrue((np.delete(self.up.direct[0], noon) == 0).all())
        # A wall to the south and the ground share the sun as cos(azimuth) and tan(altitude).
        ratio = self.others.direct[1, noon] / sun
        for month, found in zip(range(1, 13), ratio):
            day = datetime.date(2015, month, 21).timetuple().tm_yday
            declination = math.asin(0.3978 * math.sin(math.radians(
                278.97 + 0.9856 * day
                + 1.9165 * math.sin(math.radians(356.6 + 0.9856 * day)))))
            equation = 229.2 * (0.000075 + 0.001868 * math.cos(math.radians(360 / 365 * day))
                                - 0.032077 * math.sin(math.radians(360 / 365 * day))
                                - 0.014615 * math.cos(math.radians(720 / 365 * day))
                                - 0.04089 * math.sin(math.radians(720 / 365 * day)))
            turn = math.radians(15 * (0.5 + equation / 60))
            phi = math.radians(LATITUDE)
            up = (math.sin(phi) * math.sin(declination)
                  + math.cos(phi) * math.cos(declination) * math.cos(turn))
            south = (math.sin(phi) * math.cos(declination) * math.cos(turn)
                     - math.cos(phi) * math.sin(declination))
            self.assertAlmostEqual(found, south / up, delta=0.02 * (south / up))

    def test_metrics_follow_from_the_hours(self):
        lux = self.up.total[0]
        self.assertAlmostEqual(self.up.metrics['mean_lx'][0], lux.mean(), delta=1e-4 * lux.mean())
        self.assertAlmostEqual(self.up.metrics['da'][0], 100 * (lux >= 20000).mean())
        self.assertAlmostEqual(self.up.metrics['sun_hours'][0], 12)
        self.assertEqual(self.up.metric_errors['sun_hours'][0], 0)
        self.assertAlmostEqual(self.up.figures['da'][0], self.up.metrics['da'][0])
        titles = [r['title'] for r in self.up.requirements]
        self.assertTrue(any('LEED' in t for t in titles) and any('EN 17037' in t for t in titles))
        self.assertTrue({r['verdict'] for r in self.up.requirements}
                        <= {'met', 'not met', 'undecided'})


ROOM = '''{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 800}]}}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
  "nodes": [{"name": "Floor", "mesh": 0}, {"name": "Pane", "mesh": 1},
            LAMPS],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 2}]},
             {"primitives": [{"attributes": {"POSITION": 1}, "indices": 2, "material": 0}]}],
  "materials": [{"name": "glass", "pbrMetallicRoughness": {"roughnessFactor": 0,
    "metallicFactor": 0}, "extensions": {"KHR_materials_transmission":
    {"transmissionFactor": 0.8}}}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
     "min": [0, 0, 0], "max": [4, 0, 4]},
    {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3",
     "min": [0, 3, 0], "max": [4, 3, 4]},
    {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
  "bufferViews": [{"buffer": 0, "byteLength": 48},
                  {"buffer": 0, "byteOffset": 48, "byteLength": 48},
                  {"buffer": 0, "byteOffset": 96, "byteLength": 12}],
  "buffers": [{"byteLength": 108, "uri": "room.bin"}]}'''
ROOM = ROOM.replace('LAMPS', ', '.join(
    '{"name": "Panel %d", "translation": [%d, 2.5, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}'
    % (k, k) for k in (1, 2, 3)))


def write_room(folder):
    """Writes a floor, a pane above it in two states, and three lamps between them."""
    corners = np.array([[0, 0, 0], [0, 0, 4], [4, 0, 4], [4, 0, 0]], '<f4')
    (folder / 'room.bin').write_bytes(
        corners.tobytes() + (corners + np.float32([0, 3, 0])).tobytes()
        + np.array([0, 1, 2, 0, 2, 3], '<u2').tobytes())
    room, groups, points = (folder / n for n in ('room.gltf', 'groups.json', 'desk.csv'))
    room.write_text(ROOM)
    groups.write_text('{"groups": [{"name": "Roof", "windows": ["Pane"], "states": '
                      '[{"name": "clear"}, {"name": "dim", "transmittance": 0.1}]}]}')
    points.write_text('x,y,z,nx,ny,nz\n1,1,1,0,1,0\n2,1,3,0,1,0\n')
    return room, groups, points


class Program(unittest.TestCase):
    # Two states of the pane above a floor, by the same file of groups.
    def test_equals_the_program(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            room, groups, points = write_room(folder)
            epw = weather(folder)
            subprocess.run([os.environ['TROFFER'], 'annual', room, '--weather', epw, '--points',
                            points, '--groups', groups, '-o', folder / 'year', '--gather-rays',
                            '64', '--quiet', '--seed', '3'], check=True)
            year = troffer.load(room).annual(epw, {'desk': [[1, 1, 1], [2, 1, 3]]}, groups=groups,
                                             gather_rays=64, seed=3, threads=1)
            names, shown = year.states['Roof']
            self.assertEqual(names, ['clear', 'dim'])
            self.assertIn(1, shown)  # the sun of noon closes it
            arrays = [np.load(folder / f'year/honeybee/Roof/{s}_Roof/total/desk.npy')
                      for s in (0, 1)]
            beside = np.load(folder / 'year/honeybee/__static_apertures__/default/total/desk.npy')
            np.testing.assert_allclose(year['desk'].total, beside + np.where(shown == 0, *arrays),
                                       rtol=1e-6)
            np.testing.assert_array_equal(
                year['desk'].standard_error,
                np.load(folder / 'year/honeybee/standard_error/desk.npy'))


class Extras(unittest.TestCase):
    """Glare, sunlight and electric light, as the program finds them."""
    EYES = [[1, 1, 1, 1, 0.5, 0], [3, 1, 3, 0, 1, 0]]
    WINDOW = [[2, 2.9, 2, 0, -1, 0]]

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as name:
            folder, epw = pathlib.Path(name), weather(name)
            room, groups, points = write_room(folder)
            for name, rows in (('eyes.csv', cls.EYES), ('window.csv', cls.WINDOW)):
                np.savetxt(folder / name, rows, delimiter=',', header='x,y,z,nx,ny,nz', comments='')
            subprocess.run(
                [os.environ['TROFFER'], 'annual', room, '--weather', epw, '--points', points,
                 '--groups', groups, '-o', folder / 'year', '--eyes', folder / 'eyes.csv',
                 '--sunlight', folder / 'window.csv', '--sunlight-day', '03-21,11', '--electric',
                 'Panel 1', '--electric', 'Panel 2,Panel 3', '--electric-target', '300',
                 '--gather-rays', '64', '--quiet'], check=True)
            cls.scene = troffer.load(room)
            cls.year = cls.scene.annual(
                epw, {'desk': [[1, 1, 1]], 'far': [[2, 1, 3]]}, groups=groups, eyes=cls.EYES,
                sunlight=cls.WINDOW, sunlight_day='03-21,11',
                electric=['Panel 1', 'Panel 2,Panel 3'], electric_target=300, gather_rays=64)
            cls.json = json.loads((folder / 'year/annual.json').read_text())
            cls.glare = np.loadtxt(folder / 'year/glare.csv', delimiter=',', skiprows=1)
            cls.table = np.loadtxt(folder / 'year/electric.csv', delimiter=',', skiprows=1,
                                   usecols=range(4, 8))

    def test_glare(self):
        self.assertEqual(len(self.year.eyes), len(self.EYES))
        for k, (eye, found) in enumerate(zip(self.year.eyes, self.json['eyes'])):
            self.assertEqual(eye.dgp.shape, self.year.hours.shape)
            self.assertEqual(eye.dgp.dtype, np.float32)
            np.testing.assert_allclose(eye.vertical, self.glare[:, 2 * k + 1], rtol=1e-4)
            np.testing.assert_allclose(eye.dgp, self.glare[:, 2 * k + 2], atol=6e-5)
            self.assertEqual(list(eye.shares), [0.35, 0.4, 0.45])
            shares = found['share_of_occupied_hours']
            self.assertEqual(eye.shares[0.45], shares['dgp_above_0.45'])
            self.assertAlmostEqual(eye.shares[0.35],
                                   (eye.dgp[self.year.occupied] > np.float32(0.35)).mean())
            self.assertEqual(eye.level, found['protection_from_glare'])

    def test_sunlight(self):
        self.assertEqual([(s['hours'], s['level']) for s in self.json['sunlight']],
                         self.year.sunlight)
        self.assertGreater(self.year.sunlight[0][0], 0)

    def test_electric(self):
        self.assertEqual(list(self.year.electric), ['Panel 1', 'Panel 2,Panel 3'])
        for k, found in enumerate(self.json['electric']):
            use = self.year.electric[found['group']]
            for key in ('sensors', 'mean_lx', 'occupied_hours', 'full_load_hours'):
                self.assertEqual(use[key], found[key])
            for sensor, grid in enumerate(('desk', 'far')):
                lx, error = self.year[grid].electric[found['group']]
                self.assertEqual(lx.shape, (1,))
                np.testing.assert_allclose(lx[0], self.table[sensor, 2 * k], rtol=1e-5)
                np.testing.assert_allclose(error[0], self.table[sensor, 2 * k + 1], rtol=1e-2)

    def test_mistakes(self):
        points = [[1, 0.8, 1]]
        with tempfile.TemporaryDirectory() as folder:
            epw = weather(folder)
            for wrong in ({'eyes': [[0, 0, 1]]}, {'eyes': [[0, 0, 1, 0, 0, 0]]},
                          {'sunlight': [0, 0, 1, 0, 0, 1]}, {'sunlight_day': 'spring'},
                          {'electric': 'Lamp'}, {'electric': ['Panel 1', 'Panel*']},
                          {'electric': 'Panel*', 'electric_target': 0}):
                with self.assertRaises(ValueError) as raised:
                    self.scene.annual(epw, points, **wrong)
                self.assertNotIn('--', str(raised.exception))
            for wrong in ({'electric': 3}, {'electric': [1]}, {'sunlight_day': 3}):
                with self.assertRaises(TypeError):
                    self.scene.annual(epw, points, **wrong)
            plain = self.scene.annual(epw, points, gather_rays=8)
        self.assertEqual((plain.eyes, plain.sunlight, plain.electric, plain['points'].electric),
                         ([], [], {}, {}))


class Mistakes(unittest.TestCase):
    def test_messages(self):
        with tempfile.TemporaryDirectory() as folder:
            epw, scene = weather(folder), open_air()
            for wrong in (lambda: scene.annual(epw), lambda: scene.annual(epw, {}),
                          lambda: scene.annual(epw, [[0, 0]]),
                          lambda: scene.annual(epw, [[0, 0, 1]], subdivision=9),
                          lambda: scene.annual(epw, [[0, 0, 1]], occupancy='8'),
                          lambda: scene.annual(epw, [[0, 0, 1]], groups=folder + '/none.json'),
                          lambda: scene.annual(folder + '/none.epw', [[0, 0, 1]])):
                with self.assertRaises(ValueError):
                    wrong()
            with self.assertRaises(TypeError):
                scene.annual(epw, [[0, 0, 1]], spp=4)

    def test_stop(self):
        with tempfile.TemporaryDirectory() as folder:
            year = open_air().annual(weather(folder), [[0, 0, 1]], progress=lambda f: False,
                                     gather_rays=1 << 20)
        self.assertFalse(year.is_complete)
        self.assertEqual(year.grids, [])


if __name__ == '__main__':
    unittest.main()
