"""The Python module: loading, rendering, measuring, changing, and running in threads."""
import gc
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import numpy as np
import troffer

ROOM = pathlib.Path(__file__).parents[2] / 'scenes/kj92room/kj92room.gltf'
FAST = dict(width=48, height=36, method='path', spp=4)


def load():
    return troffer.load(str(ROOM))


class Loading(unittest.TestCase):
    def test_facts(self):
        scene = load()
        self.assertTrue(scene.is_photometric)
        self.assertGreater(scene.triangles, 50)
        self.assertEqual(len(scene.bounds), 2)
        self.assertGreater(len(scene.lights), 1)
        self.assertEqual(scene.file, str(ROOM))

    def test_errors(self):
        with tempfile.TemporaryDirectory() as folder:
            bad = pathlib.Path(folder) / 'bad.gltf'
            bad.write_text('{"asset": ')
            with self.assertRaises(troffer.InputError) as caught:
                troffer.load(str(bad))
            self.assertIn('bad.gltf:1:', str(caught.exception))
        with self.assertRaises(ValueError):
            troffer.load('scene.of-no-kind')
        scene = load()
        for wrong in (lambda: scene.light('none of this name'), lambda: scene.material('nor this'),
                      lambda: scene.render(camera='nor this'), lambda: scene.render(method='magic'),
                      lambda: scene.render(aovs=['magic']), lambda: scene.render(error=0),
                      lambda: scene.measure([[0, 0]]), lambda: scene.measure(np.zeros((1, 6))),
                      lambda: scene.measure(np.full((1, 3), np.nan))):
            with self.assertRaises(ValueError):
                wrong()
        with self.assertRaises(TypeError):
            scene.measure('points')


class Arguments(unittest.TestCase):
    def test_one_side_keeps_the_proportions(self):
        scene = load()
        own = scene.render(method='path', spp=1, width=0).pixels.shape
        wide = scene.render(method='path', spp=1, width=16).pixels.shape
        high = scene.render(method='path', spp=1, height=np.int64(30)).pixels.shape
        self.assertEqual(wide[:2], (round(16 * own[0] / own[1]), 16))
        self.assertEqual(high[:2], (30, round(30 * own[1] / own[0])))
        seen = scene.look_at((1, 1, 1), (2, 1.5, 2))
        self.assertEqual(scene.render(seen, method='path', spp=1, width=16).pixels.shape,
                         (12, 16, 3))

    def test_paths_of_any_kind(self):
        class Named:
            def __init__(self, path):
                self.path = path

            def __fspath__(self):
                return str(self.path)

        picture = troffer.load(ROOM).render(**FAST)
        with tempfile.TemporaryDirectory() as folder:
            for i, kind in enumerate((str, pathlib.Path, os.fsencode, Named)):
                a, b = (pathlib.Path(folder) / f'{name}{i}.pfm' for name in 'ab')
                picture.save(kind(a))
                troffer.write_image(kind(b), picture.pixels)
                np.testing.assert_array_equal(troffer.read_image(kind(a)),
                                              troffer.read_image(kind(b)))
            with self.assertRaises(ValueError):
                picture.save(pathlib.Path(folder))
        for wrong in (None, 3, object()):
            with self.assertRaises(TypeError):
                troffer.load(wrong)

    def test_odd_values(self):
        scene = load()
        picture = scene.render(**FAST)
        for wrong in (dict(seed=-1), dict(seed=1.5), dict(seed=1 << 64), dict(width='16'),
                      dict(width=16.5), dict(width=None), dict(spp=True + 0.5), dict(aovs='normal'),
                      dict(camera=3), dict(camera=ROOM), dict(witdh=16), dict(method=None),
                      dict(threads=1 << 40)):
            with self.assertRaises(TypeError, msg=str(wrong)):
                scene.render(**wrong)
        for wrong in (dict(width=-1), dict(width=65537), dict(width=65536, height=65536),
                      dict(error=np.nan), dict(error=np.float32(2)), dict(spp=-1),
                      dict(threads=-1), dict(threads=5000), dict(depth=-2), dict(max_spp=-1)):
            with self.assertRaises(ValueError, msg=str(wrong)):
                scene.render(**wrong)
        with self.assertRaises(TypeError):
            scene.render(None, 16)  # sizes are keyword arguments
        for wrong in (np.nan, np.inf, 1e9):
            with self.assertRaises(ValueError):
                picture.save('never.png', exposure=wrong)
            with self.assertRaises(ValueError):
                troffer.write_image('never.png', picture.pixels, exposure=wrong)
        same = dict(FAST, width=np.int32(48), spp=np.uint8(4), seed=np.int64(0))
        np.testing.assert_array_equal(scene.render(error=np.float32(.01), **same).pixels,
                                      scene.render(error=float(np.float32(.01)), **FAST).pixels)


class Pictures(unittest.TestCase):
    def test_is_that_of_any_number_of_threads(self):
        scene = load()
        a = scene.render(width=48, height=36, error=.1, threads=1)
        b = scene.render(width=48, height=36, error=.1, threads=2)
        self.assertEqual(a.pixels.shape, (36, 48, 3))
        self.assertEqual(a.pixels.dtype, np.float32)
        np.testing.assert_array_equal(a.pixels, b.pixels)
        self.assertGreater(a.error, 0)
        self.assertTrue(a.is_complete)

    def test_layers_add_up_and_are_views(self):
        picture = load().render(aovs=['direct', 'indirect', 'depth'], **FAST)
        self.assertEqual(picture.layers, ['direct', 'indirect', 'depth'])
        np.testing.assert_allclose(picture['direct'] + picture['indirect'], picture.pixels,
                                   rtol=1e-5, atol=1e-6)
        self.assertEqual(picture['depth'].shape, (36, 48))
        with self.assertRaises(KeyError):
            picture['albedo']
        pixels = picture.pixels
        self.assertIs(pixels.base, picture)
        copy = pixels.copy()
        del picture
        gc.collect()
        np.testing.assert_array_equal(pixels, copy)

    def test_files(self):
        picture = load().render(**FAST)
        with tempfile.TemporaryDirectory() as folder:
            exr, png = folder + '/a.exr', folder + '/a.png'
            picture.save(exr)
            picture.save(png)
            np.testing.assert_array_equal(troffer.read_image(exr), picture.pixels)
            troffer.write_image(exr, picture.pixels * 2)
            d = troffer.compare(troffer.read_image(exr), picture.pixels)
            self.assertAlmostEqual(d['mean_image'], 2 * d['mean_reference'], places=4)
            self.assertGreater(os.path.getsize(png), 100)
            with self.assertRaises(OSError):
                picture.save(folder + '/no/such/folder/a.exr')
            with self.assertRaises(ValueError):
                picture.save(folder + '/a.txt')

    @unittest.skipUnless('TROFFER' in os.environ, 'the program is not told')
    def test_is_that_of_the_program(self):
        scene = load()
        for method, options in (('certified', dict(error=.1)), ('path', dict(spp=4)),
                                ('kj92', dict(spp=1))):
            picture = scene.render(width=48, height=36, method=method, aovs=['direct'], **options)
            with tempfile.TemporaryDirectory() as folder:
                ours, theirs = folder + '/ours.exr', folder + '/theirs.exr'
                picture.save(ours)
                words = [w for k, v in options.items() for w in ('--' + k, str(v))]
                subprocess.run([os.environ['TROFFER'], 'render', str(ROOM), '-o', theirs, '--size',
                                '48x36', '--method', method, '--aov', 'direct', *words],
                               check=True, capture_output=True)
                np.testing.assert_array_equal(troffer.read_image(ours), troffer.read_image(theirs))

    def test_cameras(self):
        scene = load()
        (x0, y0, z0), (x1, y1, z1) = scene.bounds
        eye = ((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2)
        one = scene.look_at(eye, (eye[0] + 1, eye[1], eye[2]), fov=80)
        other = scene.look_at(eye, (eye[0] - 1, eye[1], eye[2]), fov=80)
        a, b = (scene.render(c, aovs=['position'], **FAST)['position'] for c in (one, other))
        self.assertGreater(np.median(a[..., 0]), eye[0])
        self.assertLess(np.median(b[..., 0]), eye[0])


class Changes(unittest.TestCase):
    def test_dimmers_are_linear(self):
        scene = load()
        whole = scene.render(**FAST).pixels
        parts = np.zeros_like(whole)
        names = [e.name for e in scene.lights]
        for name in names:
            for e in scene.lights:
                e.dimmer = 1 if e.name == name else 0
            self.assertEqual(scene.light(name).dimmer, 1)
            parts += scene.render(width=48, height=36, method='path', spp=256).pixels
        mean = float(whole.mean())
        self.assertAlmostEqual(float(parts.mean()) / mean, 1, delta=.1)
        for e in scene.lights:
            e.dimmer = 1
        np.testing.assert_array_equal(scene.render(**FAST).pixels, whole)
        with self.assertRaises(ValueError):
            scene.light(names[0]).dimmer = -1
        with self.assertRaises(ValueError):
            scene.light(names[0]).radiance = (1, float('nan'), 1)

    def test_materials(self):
        scene = load()
        before = scene.render(**FAST).pixels.mean()
        for m in scene.materials:
            m.base_color = (0, 0, 0)
        after = scene.render(**FAST).pixels.mean()
        self.assertLess(after, .9 * before)
        with self.assertRaises(ValueError):
            scene.materials[0].base_color = (2, 0, 0)

    def test_sky(self):
        scene = load()
        point = [[2, 100, -2, 0, 1, 0]]  # above the roof
        for e in scene.lights:
            e.dimmer = 0
        scene.add_sky('overcast', lux=10000)
        lux = scene.measure(point, method='path', spp=4096)
        self.assertAlmostEqual(lux.illuminance[0], 10000, delta=4 * lux.standard_error[0] + 20)
        with self.assertRaises(ValueError):
            scene.add_sky('clear')  # needs a sun


class Measuring(unittest.TestCase):
    def test_methods_agree(self):
        scene = load()
        points = np.array([[1.5, 2.1, .77, 0, 0, 1], [2, 1, .01, 0, 0, 1]])
        a = scene.measure(points)
        b = scene.measure(points, method='path', spp=4096)
        self.assertEqual(len(a), 2)
        self.assertEqual(a.irradiance.shape, (2, 3))
        self.assertTrue((a.illuminance > 0).all())
        allowed = 5 * np.hypot(a.standard_error, b.standard_error)
        self.assertTrue((abs(a.illuminance - b.illuminance) < allowed).all())
        luminance = a.irradiance @ np.array([.2126, .7152, .0722])
        np.testing.assert_allclose(luminance, a.illuminance, rtol=1e-4)
        up = scene.measure(points[:, :3]).illuminance  # y is up in glTF
        points[:, 3:] = 0, 1, 0
        np.testing.assert_array_equal(up, scene.measure(points).illuminance)
        self.assertEqual(len(scene.measure(np.zeros((0, 6)))), 0)


class Working(unittest.TestCase):
    def test_progress_and_other_threads(self):
        told, ticks, done = [], [], threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(1)
                time.sleep(.005)

        other = threading.Thread(target=tick)
        other.start()
        load().render(width=160, height=120, method='path', spp=64, progress=told.append)
        done.set()
        other.join()
        self.assertEqual(told, sorted(told))
        self.assertGreaterEqual(told[0], 0)
        self.assertLessEqual(told[-1], 1)
        self.assertGreater(len(ticks), 3)

    def test_what_progress_raises_ends_the_work(self):
        def stop(fraction):
            raise RuntimeError('enough')

        begin = time.monotonic()
        with self.assertRaisesRegex(RuntimeError, 'enough'):
            load().render(method='path', spp=1 << 16, progress=stop)
        self.assertLess(time.monotonic() - begin, 60)

    def test_interrupt(self):
        scene = load()
        threading.Timer(.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        begun = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            scene.render(method='path', spp=1 << 16)
        self.assertLess(time.monotonic() - begun, 10)  # without the interrupt it would take hours
        scene.render(**FAST)  # the scene still works


if __name__ == '__main__':
    unittest.main()
