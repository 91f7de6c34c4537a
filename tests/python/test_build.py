"""Scenes that scripts build from arrays, options of methods, and the module's stub."""
import ast
import inspect
import pathlib
import tempfile
import unittest

import numpy as np
import troffer

ROOT = pathlib.Path(__file__).parents[2]
ROOM = ROOT / 'scenes/kj92room/kj92room.gltf'
QUAD = [[0, 1, 2], [0, 2, 3]]


def floor(size=5., z=0.):
    return [[-size, -size, z], [size, -size, z], [size, size, z], [-size, size, z]]


def square_over_point(a, h):
    """Returns irradiance over radiance below the middle of a square of side 2a at height h."""
    s = np.hypot(a, h)
    return 4 * a / s * np.arctan(a / s)


class Building(unittest.TestCase):
    def test_room_of_arrays_in_the_furnace(self):
        """In a closed box of equal, emitting walls the radiance is L / (1 - rho) everywhere."""
        scene = troffer.Scene()
        scene.add_material('wall', base_color=.5)
        corners = np.array([[x, y, z] for x in (0, 3) for y in (0, 4) for z in (0, 2.5)], float)
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        for a, b, c, d in faces:
            normal = np.cross(corners[b] - corners[a], corners[c] - corners[a])
            inward = np.dot(normal, corners.mean(0) - corners[a]) > 0
            order = [a, b, c, d] if inward else [a, d, c, b]
            scene.add_mesh(corners[order], QUAD, material='wall', emission=(10, 20, 30),
                           name='walls')
        self.assertEqual(scene.triangles, 12)
        self.assertEqual([e.name for e in scene.lights], ['walls'])
        self.assertEqual(scene.light('walls').count, 6)
        view = scene.look_at((1, 1, 1), (2, 3, 1.2))
        seen = scene.render(view, width=24, height=18, method='path', spp=64).pixels.mean((0, 1))
        np.testing.assert_allclose(seen, [20, 40, 60], rtol=.02)
        found = scene.measure([[1.5, 2, 1.2, 0, 0, 1]], error=.01)
        np.testing.assert_allclose(found.irradiance[0], np.pi * np.array([20, 40, 60]), rtol=.03)

    def test_square_lamp_by_the_closed_form(self):
        scene = troffer.Scene(photometric=False)
        self.assertFalse(scene.is_photometric)
        down = np.array(floor(1, 2.))[::-1]
        scene.add_mesh(down, np.array(QUAD, np.uint32), emission=7, name='lamp')
        found = scene.measure([[0, 0, 0]])
        np.testing.assert_allclose(found.irradiance, 7 * square_over_point(1, 2), rtol=1e-3)
        scene.dim('la*', .5)
        found = scene.measure([[0, 0, 0]])
        np.testing.assert_allclose(found.irradiance, 3.5 * square_over_point(1, 2), rtol=1e-3)
        moved = np.eye(4)
        moved[:3, 3] = 0, 0, 1
        other = troffer.Scene(photometric=False)
        other.add_mesh(down - [0, 0, 1], QUAD, normals=[[0, 0, -1]] * 4, emission=(7, 7, 7),
                       transform=moved)
        np.testing.assert_allclose(other.measure([[0, 0, 0]]).irradiance,
                                   7 * square_over_point(1, 2), rtol=1e-3)

    def test_lamps(self):
        scene = troffer.Scene()
        scene.add_mesh(floor(), QUAD)
        scene.add_point_light('p', (0, 0, 2), 80)
        scene.add_spot_light('s', (0, 0, 2), (0, 0, -1), (40, 40, 40), inner=10, outer=20)
        scene.add_distant_light('d', (0, 0, -1), 7)
        for name, lux in (('p', 20), ('s', 10), ('d', 7)):
            for e in scene.lights:
                e.dimmer = float(e.name == name)
            found = scene.measure([[0, 0, 1e-4, 0, 0, 1]]).illuminance[0]
            self.assertAlmostEqual(found / lux, 1, delta=3e-3, msg=name)

    def test_luminaire_of_a_file(self):
        """A point with cosine intensity sends lumens / pi straight down."""
        angles = np.arange(0, 91)
        candela = ' '.join(f'{v:.6f}' for v in np.cos(np.radians(angles)) * 300 / np.pi)
        text = (f'IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 91 1 1 2 0 0 0\n1 1 25\n'
                f'{" ".join(str(a) for a in angles)}\n0\n{candela}\n')
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / 'cosine.ies'
            file.write_text(text)
            for options, factor in (({}, 1), (dict(dimming=.5), .5), (dict(lumens=600), 2),
                                    (dict(nadir=(0, 1, -1)), .5 ** .5)):
                scene = troffer.Scene()
                scene.add_mesh(floor(), QUAD)
                scene.add_luminaire('lamp', file, (0, 0, 2), **options)
                found = scene.measure([[0, 0, 1e-4, 0, 0, 1]]).illuminance[0]
                self.assertAlmostEqual(found / (300 / np.pi / 4 * factor), 1, delta=.02,
                                       msg=str(options))

    def test_surroundings(self):
        scene = troffer.Scene()
        scene.add_environment(np.full((4, 8, 3), 2.), scale=2)
        found = scene.measure([[0, 0, 0, 0, 0, 1]]).illuminance[0]
        self.assertAlmostEqual(found / (4 * np.pi), 1, delta=5e-3)
        with self.assertRaises(ValueError):
            scene.add_environment(np.full((4, 8, 3), np.nan))

    def test_materials_and_images(self):
        scene = troffer.Scene()
        image = np.zeros((2, 2, 3), np.uint8)
        image[0] = 255
        texture = scene.add_image(image, filtered=False)
        wall = scene.add_material('wall', 'principled', base_color=(1, 1, 1), roughness=.8,
                                  base_color_texture=texture, coat=.2)
        self.assertEqual(wall.name, 'wall')
        self.assertAlmostEqual(wall.coat, .2, places=6)
        wall.roughness = .6
        self.assertAlmostEqual(scene.material('wall').roughness, .6, places=6)
        uvs = [[0, 1], [1, 1], [1, 0], [0, 0]]
        scene.add_mesh([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], QUAD, uvs=uvs,
                       material=wall)
        view = scene.look_at((0, -2, 0), (0, 0, 0), fov=30)
        albedo = scene.render(view, width=16, height=16, method='path', spp=4,
                              aovs=['albedo'])['albedo']
        self.assertGreater(albedo[3, 8].min(), .7)
        self.assertLess(albedo[12, 8].max(), .3)
        for model in ('matte', 'plastic', 'metal', 'mirror', 'glass', 'thin_glass'):
            scene.add_material(model, model)
            scene.add_sphere((0, 0, 0), .2, material=model)

    def test_cameras(self):
        scene = troffer.Scene()
        scene.add_mesh(floor(), QUAD)
        scene.add_camera('above', (0, 0, 3), (0, 0, 0), up=(0, 1, 0), fov=40)
        self.assertEqual(scene.cameras, ['above'])
        self.assertEqual(scene.camera().name, 'above')
        depth = scene.render('above', width=8, height=8, method='path', spp=1,
                             aovs=['depth'])['depth']
        np.testing.assert_allclose(depth, 3, rtol=1e-3)
        with self.assertRaises(ValueError):
            scene.add_camera('above', (0, 0, 3), (0, 0, 0), up=(0, 1, 0))

    def test_what_cannot_be(self):
        scene = troffer.Scene()
        for wrong, error in (
                (lambda: scene.add_mesh(floor(), [[0, 1, 4]]), ValueError),
                (lambda: scene.add_mesh(floor(), [[0, 1, -1]]), ValueError),
                (lambda: scene.add_mesh(floor(), [[0., 1., 2.]]), TypeError),
                (lambda: scene.add_mesh('floor', QUAD), (TypeError, ValueError)),
                (lambda: scene.add_mesh(np.zeros((4, 2)), QUAD), ValueError),
                (lambda: scene.add_mesh(np.full((4, 3), np.inf), QUAD), ValueError),
                (lambda: scene.add_mesh(floor(), QUAD, normals=[[0, 0, 1]]), ValueError),
                (lambda: scene.add_mesh(floor(), QUAD, material='nobody'), ValueError),
                (lambda: scene.add_mesh(floor(), QUAD, transform=np.eye(3)), ValueError),
                (lambda: scene.add_mesh(floor(), QUAD, emission='bright'), TypeError),
                (lambda: scene.add_material('m', 'magic'), ValueError),
                (lambda: scene.add_material('m', colour=1), TypeError),
                (lambda: scene.add_material('m', roughness=2), ValueError),
                (lambda: scene.add_image(np.zeros(3)), ValueError),
                (lambda: scene.add_point_light('p', (0, 0, 0), -1), ValueError),
                (lambda: scene.add_luminaire('l', 'none.ies', (0, 0, 0)), troffer.InputError),
                (lambda: scene.render(), ValueError)):
            with self.assertRaises(error, msg=inspect.getsource(wrong)):
                wrong()
        self.assertEqual(scene.triangles, 0)


class Options(unittest.TestCase):
    def test_of_every_method(self):
        scene = troffer.load(ROOM)
        small = dict(width=16, height=12, spp=1, error=.3)
        for options in (dict(method='path', depth=2), dict(method='fixed', shadow_rays=4),
                        dict(method='certified', indirect='none', max_spp=2),
                        dict(method='kj92', variance=.1, most_rays=16, mean_change=.1,
                             level_difference=2, probe_rays=2, coherence=False, ratio=True,
                             selection=False, shadow_rays=2),
                        dict(method='kj92', select=[scene.lights[0].name]),
                        dict(method='path', crop=(4, 2, 12, 8), time_limit=60, error_limit=5)):
            picture = scene.render(**small, **options)
            self.assertTrue(np.isfinite(picture.pixels).all())
            self.assertGreater(picture.stats['viewing_rays'], 0)
        self.assertEqual(picture.pixels.shape, (6, 8, 3))
        for wrong in (dict(coherence=3), dict(variance='x'), dict(crop=(1, 2, 3))):
            with self.assertRaises(TypeError, msg=str(wrong)):
                scene.render(**small, **wrong)
        for wrong in (dict(method='kj92', variance=-1), dict(method='kj92', select=['nobody']),
                      dict(crop=(0, 0, 99, 99)), dict(time_limit=-1)):
            with self.assertRaises(ValueError, msg=str(wrong)):
                scene.render(**small, **wrong)

    def test_false_stops(self):
        picture = troffer.load(ROOM).render(method='path', spp=1 << 16, progress=lambda f: False)
        self.assertFalse(picture.is_complete)
        self.assertEqual(picture.stats['end'], 'stopped')

    def test_emission_scale(self):
        point = [[1.5, 2.1, .77, 0, 0, 1]]
        options = dict(method='path', spp=256, depth=1)
        one = troffer.load(ROOM).measure(point, **options).illuminance
        two = troffer.load(ROOM, emission_scale=2).measure(point, **options).illuminance
        np.testing.assert_allclose(two, 2 * one, rtol=1e-5)


class Pictures(unittest.TestCase):
    def test_as_array_and_png(self):
        picture = troffer.load(ROOM).render(width=16, height=12, method='path', spp=1)
        np.testing.assert_array_equal(np.asarray(picture), picture.pixels)
        self.assertEqual(np.asarray(picture, dtype=np.float64).dtype, np.float64)
        png = picture._repr_png_()
        self.assertEqual(png[:8], b'\x89PNG\r\n\x1a\n')


class Stub(unittest.TestCase):
    def test_has_the_names_of_the_module(self):
        tree = ast.parse((ROOT / 'src/python/troffer.pyi').read_text())
        own = [n for n in tree.body if isinstance(n, (ast.ClassDef, ast.FunctionDef))
               and not n.name.startswith('_')]
        names = {n.name for n in own}
        self.assertEqual(names, {n for n in dir(troffer) if not n.startswith('_')})
        usual = set(dir(type('Any', (), {}))) | {'__init__', '__module__'}
        for n in own:
            if not isinstance(n, ast.ClassDef) or n.name == 'InputError':
                continue
            stub = {m.name for m in n.body if isinstance(m, ast.FunctionDef)}
            stub |= {m.target.id for m in n.body if isinstance(m, ast.AnnAssign)}
            real = {m for m in vars(getattr(troffer, n.name)) if m not in usual}
            real -= {'_pybind11_conduit_v1_'}
            self.assertEqual(stub - {'__init__'}, real, n.name)

    def test_has_the_arguments_of_functions(self):
        tree = ast.parse((ROOT / 'src/python/troffer.pyi').read_text())
        scene = next(n for n in tree.body if getattr(n, 'name', '') == 'Scene')
        for f in scene.body:
            if not isinstance(f, ast.FunctionDef) or f.decorator_list or f.name == '__init__':
                continue
            told = getattr(troffer.Scene, f.name).__doc__.split('\n')[0]
            for a in f.args.args[1:] + f.args.kwonlyargs:
                self.assertIn(a.arg + ':', told, f.name)


    def test_has_the_keywords(self):
        tree = ast.parse((ROOT / 'src/python/troffer.pyi').read_text())
        classes = {n.name: n for n in tree.body if isinstance(n, ast.ClassDef)}
        scene = troffer.Scene()
        for name, call in (('_RenderOptions', scene.render),
                           ('_LightOptions', lambda **k: scene.render(**k)),
                           ('_LightOptions', lambda **k: scene.measure([[0, 0, 0]], **k)),
                           ('_MaterialOptions', lambda **k: scene.add_material('m', **k))):
            for member in classes[name].body:
                key = member.target.id
                if key == 'progress':
                    continue
                with self.assertRaises(TypeError, msg=key) as caught:
                    call(**{key: object()})
                self.assertNotIn('no argument', str(caught.exception))
                self.assertIn(key, call.__doc__ or key)


if __name__ == '__main__':
    unittest.main()
