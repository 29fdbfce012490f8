"""Radiant exchange against closed forms, and its laws."""

import os
import unittest

import numpy as np

import lightwell as lw
from scenes import FLOAT, box, run_program, scratch

SIGMA = 5.670374419e-8

# Relative error of a few products and of a small system of equations in doubles.
ROUNDING = 1e-13


class Shortwave(unittest.TestCase):
    def setUp(self):
        vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [0, 1, 1]]
        faces = [[0, 1, 2, 3], [0, 3, 5, 4]]  # ground, and a wall at x = 0
        scene = lw.Scene.from_arrays(vertices, faces, names=["ground", "wall"])
        self.factors = lw.form_factors(scene)

    def test_a_wall_and_its_ground(self):
        found = lw.shortwave(
            self.factors, albedo={"ground": 0.2, "wall": 0.5}, sun=[2, 0, 2], direct=800, diffuse=100
        )
        F = 0.20004377607540316  # squares with a common edge: Howell's catalogue, C-14
        self.assertAlmostEqual(found.sky_view_factor[0], 1 - F, delta=FLOAT)
        np.testing.assert_allclose(found.direct, 800 * 0.5**0.5, rtol=1e-12)
        np.testing.assert_allclose(found.diffuse, 100 * found.sky_view_factor, rtol=1e-15)
        first = found.direct + found.diffuse
        ground = (first[0] + F * 0.5 * first[1]) / (1 - F * F * 0.2 * 0.5)
        # The factor's rounding times less than 1000 W/m^2.
        self.assertAlmostEqual(found.net[0], 0.8 * ground, delta=1000 * FLOAT)
        total = found.absorbed + found.escaped
        self.assertAlmostEqual(total, found.arriving, delta=1e-6 * found.arriving)

    def test_points_have_their_own_sky_and_sun(self):
        # On the ground half a metre before the middle of the wall, and above it in the open.
        points = [[0.5, 0.5, 0], [0.5, 0.5, 3]]
        found = lw.shortwave(
            self.factors, albedo=0.5, sun=[1, 0, 1], direct=800, diffuse=100, points=points, normals=[0, 0, 1]
        )
        at = found.points
        # View factor of a point to a rectangle at a right angle, from below its middle: Howell's
        # catalogue, B-3, for two halves of width 1/2, height 1 and distance 1/2.
        X, Y = 0.5 / 0.5, 1 / 0.5
        wall = 2 / (2 * np.pi) * (np.arctan(X) - np.arctan(X / np.hypot(1, Y)) / np.hypot(1, Y))
        # Four standard errors of 16384 independent rays; stratified ones err less.
        noise = 4 * np.sqrt(wall * (1 - wall) / 16384)
        self.assertAlmostEqual(at.sky_view_factor[0], 1 - wall, delta=noise)
        self.assertEqual(at.sky_view_factor[1], 1.0)
        np.testing.assert_allclose(at.direct, 800 * 0.5**0.5, rtol=1e-12)
        lit = found.direct + found.diffuse + found.reflected
        self.assertAlmostEqual(at.reflected[0], wall * 0.5 * lit[1], delta=noise * 0.5 * lit[1])
        self.assertEqual(at.reflected[1], 0.0)
        np.testing.assert_allclose(at.total, at.direct + at.diffuse + at.reflected, rtol=1e-15)

    def test_instants_are_those_alone(self):
        suns = np.array([[1, 0, 1], [1, 1, 2], [0, 0, 1.0]])
        direct, diffuse = np.array([800, 0, 500.0]), np.array([100, 50, 0.0])
        where = {"points": [[0.5, 0.5, 0]], "normals": [0, 0, 1]}
        many = lw.shortwave(self.factors, albedo=0.3, sun=suns, direct=direct, diffuse=diffuse, **where)
        self.assertEqual(many.net.shape, (3, 2))
        self.assertIn("3 instants", repr(many))
        for h in range(3):
            one = lw.shortwave(
                self.factors, albedo=0.3, sun=suns[h], direct=direct[h], diffuse=diffuse[h], rays=64, **where
            )
            np.testing.assert_array_equal(many.net[h], one.net)
            np.testing.assert_array_equal(many.points.total[h], one.points.total)
            self.assertEqual(many.arriving[h], one.arriving)
        # Under Perez' sky too: the sum over instants is that of single ones, to the last bit.
        perez = {"sky": "perez", "day": [80, 172, 355]}
        many = lw.shortwave(self.factors, albedo=0.3, sun=suns, direct=direct, diffuse=diffuse, **perez, **where)
        nets = []
        for h in range(3):
            light = {"sun": suns[h], "direct": direct[h], "diffuse": diffuse[h], "sky": "perez", "day": perez["day"][h]}
            nets.append(lw.shortwave(self.factors, albedo=0.3, rays=64, **light, **where).net)
        np.testing.assert_array_equal(many.net.sum(axis=0), np.sum(nets, axis=0))
        # One value holds for all instants.
        same = lw.shortwave(self.factors, albedo=0.3, diffuse=[1.0, 2.0])
        np.testing.assert_allclose(same.net[1], 2 * same.net[0], rtol=1e-9)

    def test_a_wall_under_a_clear_sky_is_bright_towards_the_sun(self):
        light = {"albedo": 0.3, "direct": 800, "diffuse": 100}
        east, west = ([1, 0, 1], [-1, 0, 1])
        even = lw.shortwave(self.factors, sun=east, **light)
        before, behind = (lw.shortwave(self.factors, sun=sun, **light, sky="perez", day=80) for sun in (east, west))
        np.testing.assert_array_equal(even.sky_view_factor, before.sky_view_factor)
        self.assertGreater(before.diffuse[1], even.diffuse[1])
        self.assertLess(behind.diffuse[1], before.diffuse[1])

    def test_progress_stops_the_work(self):
        phases = []

        def stop(phase, share):
            phases.append(phase)
            return False

        with self.assertRaises(lw.Interrupted):
            # Many more instants than are computed in the twentieth of a second between two reports.
            lw.shortwave(
                self.factors, albedo=0.3, sun=np.tile([1.0, 0, 1], (50000, 1)), direct=1.0, progress=stop
            )
        self.assertTrue(phases)

    def test_the_program_has_the_same_numbers(self):
        folder = scratch(self)
        model, points, rows, at = (os.path.join(folder, name) for name in ("m.obj", "p.csv", "k.csv", "q.csv"))
        with open(model, "w", encoding="utf-8") as file:
            file.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n")
            file.write("o ground\nf 1 2 3 4\no wall\nf 1 4 6 5\n")
        with open(points, "w", encoding="utf-8") as file:
            file.write("0.5,0.5,0,0,0,1\n")
        for arguments, options in (
            ([], {}),
            (["--sky", "perez", "--date", "03-21"], {"sky": "perez", "day": 80}),
        ):
            run_program(
                "shortwave", model, "--albedo", "0.3", "--sun", "45,90", "--direct", "800", "--diffuse", "100", "--up", "z",
                "--points", points, "--points-output", at, "-o", rows, *arguments,
            )
            found = lw.shortwave(
                lw.form_factors(lw.read(model)), albedo=0.3, sun=[1, 0, 1], direct=800, diffuse=100,
                points=[[0.5, 0.5, 0]], normals=[0, 0, 1], **options,
            )
            table = np.genfromtxt(rows, delimiter=",", skip_header=1)[:, 5:]
            # Nine digits.
            ours = np.column_stack([found.sky_view_factor, found.direct, found.diffuse, found.reflected, found.net])
            np.testing.assert_allclose(table, ours, rtol=1e-8)
            read = np.genfromtxt(at, delimiter=",", skip_header=1)[6:]
            np.testing.assert_allclose(read, np.ravel(found.points), rtol=1e-8)

    def test_wrong_points_and_instants_are_refused(self):
        for change, sentence in (
            ({"points": [[0, 0, 1]]}, "give points and normals"),
            ({"normals": [0, 0, 1]}, "give points and normals"),
            ({"points": [[0, 0]], "normals": [0, 0, 1]}, "points has the shape"),
            ({"diffuse": [1.0, 2.0], "direct": [0.0, 0.0, 0.0]}, "instants where others have 3"),
            ({"diffuse": [[1.0]]}, "diffuse has the shape"),
            ({"diffuse": []}, "has 0 instants"),
            ({"sun": [[0, 0, 1], [0, 0, -1]], "direct": 1.0}, "below the horizon at instant 1"),
            ({"rays": 100}, "power of two"),
            ({"sky": "blue"}, "no sky 'blue'"),
            ({"sky": "perez", "diffuse": 1.0}, "give sun and day"),
            ({"sky": "perez", "sun": [0, 0, 1], "day": 0}, "day is 0"),
            ({"sky": "perez", "sun": [0, 0, 1], "day": 1.5}, "integers are needed"),
            ({"day": 80}, "sky='perez'; leave it out"),
            ({"rays": 2048}, "rays is 2048"),
        ):
            with self.subTest(change), self.assertRaisesRegex(lw.InputError, sentence):
                lw.shortwave(self.factors, **{"albedo": 0.2, **change})

    def test_wrong_light_is_refused(self):
        for change in (
            {"albedo": 1.0},
            {"albedo": {"ground": 0.2}},
            {"direct": 1.0},
            {"direct": 1.0, "sun": [0, 0, -1]},
            {"direct": 1.0, "sun": [0, 0, 0]},
            {"diffuse": -1.0},
            {"up": [0, 0]},
        ):
            with self.assertRaises(lw.InputError, msg=change):
                lw.shortwave(self.factors, **{"albedo": 0.2, **change})


class Weather(unittest.TestCase):
    def test_hours_have_the_sun_of_their_place(self):
        path = os.path.join(scratch(self), "june.wea")
        with open(path, "w", encoding="utf-8") as file:
            file.write("place Test\nlatitude 48\nlongitude 0\ntime_zone 0\nsite_elevation 0\nweather_data_file_units 1\n")
            for hour in range(24):
                file.write(f"6 21 {hour}.5 500 100\n")
        weather = lw.read_weather(path)
        self.assertEqual((weather.latitude, weather.longitude, weather.place), (48.0, 0.0, "Test"))
        self.assertEqual(list(weather.hour), list(range(4, 20)))
        self.assertTrue((weather.direct == 500).all() and (weather.diffuse == 100).all())
        sun = weather.sun()
        np.testing.assert_allclose(np.linalg.norm(sun, axis=1), 1.0, rtol=1e-14)
        np.testing.assert_allclose(np.degrees(np.arcsin(sun[:, 2])), weather.altitude, rtol=1e-12)
        # At noon by the sun the altitude is 90 - 48 + 23.44 degrees; the hour from 11 to 12 ends two
        # minutes before, so that its middle is half an hour and two minutes, 8 degrees, off.
        noon = np.sin(np.radians(48)) * np.sin(np.radians(23.44))
        noon += np.cos(np.radians(48)) * np.cos(np.radians(23.44)) * np.cos(np.radians(7.5 + 0.45))
        # The equation of time is known to 0.1 minutes here, 0.025 degrees.
        self.assertAlmostEqual(sun[7, 2], noon, delta=np.radians(0.05))
        self.assertGreater(sun[0, 0], 0.5)  # the morning's sun is in the east
        turned = weather.sun(up=(0, 1, 0), north=(0, 0, -1))
        np.testing.assert_allclose(turned, np.column_stack([sun[:, 0], sun[:, 2], -sun[:, 1]]), atol=1e-14)
        with self.assertRaisesRegex(lw.InputError, "north points up"):
            weather.sun(north=(0, 0, 1))
        with self.assertRaises(lw.InputError):
            lw.read_weather(path + ".none")


class ClosedForms(unittest.TestCase):
    def test_infinite_parallel_plates(self):
        found = lw.radiation(
            [[0, 1], [1, 0]], areas=[1, 1], emissivity=[0.8, 0.3], temperature=[600, 300]
        )
        expected = 1 / (1 / 0.8 + 1 / 0.3 - 1)
        self.assertAlmostEqual(found.script_f[0, 1], expected, delta=ROUNDING)
        heat = SIGMA * (600**4 - 300**4) * expected
        self.assertAlmostEqual(found.heat[0], heat, delta=ROUNDING * heat)
        self.assertAlmostEqual(found.exchange[0, 1], heat, delta=ROUNDING * heat)

    def test_concentric_spheres(self):
        # A sphere of 1 m^2 in one of 4 m^2, whose rest of light it sees itself.
        found = lw.radiation(
            [[0, 1], [0.25, 0.75]], areas=[1, 4], emissivity=[0.6, 0.2], temperature=[400, 300]
        )
        self.assertAlmostEqual(
            found.script_f[0, 1], 1 / (1 / 0.6 + 0.25 * (1 / 0.2 - 1)), delta=ROUNDING
        )

    def test_a_box_with_adiabatic_walls(self):
        # Floor and ceiling of a cube, and walls that give off nothing: by symmetry the walls are one
        # surface, and the network of three surfaces gives the heat.
        factors = lw.form_factors(lw.Scene.from_arrays(*box(), names=list("wxyzfc")))
        found = lw.radiation(
            factors, emissivity={**dict.fromkeys("wxyz", 0.5), "f": 0.9, "c": 0.4}, temperature={"f": 350, "c": 290}
        )
        F = 0.199824895698387  # of opposite faces of a cube
        between = F + 1 / (2 / (1 - F))
        heat = SIGMA * (350**4 - 290**4) / (0.1 / 0.9 + 1 / between + 0.6 / 0.4)
        # View factors are float32, rounded twice; four walls of one factor each.
        self.assertAlmostEqual(found.heat[4], heat, delta=10 * FLOAT * heat)
        self.assertAlmostEqual(found.heat_by_surface["c"], -heat, delta=10 * FLOAT * heat)
        self.assertLess(abs(found.heat.sum()), 1e-9 * heat)
        # Adiabatic to the rounding of doubles, since each is an equation of its own.
        self.assertLess(abs(found.heat[:4]).max(), 1e-9 * heat)


class Laws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        vertices, faces = box(high=(3, 2, 1))
        cls.closed = lw.form_factors(lw.Scene.from_arrays(vertices, faces))
        cls.open = lw.form_factors(lw.Scene.from_arrays(vertices, faces[:5]))
        cls.eps = np.array([0.1, 0.3, 0.5, 0.7, 0.9, 1.0])

    def test_heats_add_up_to_zero(self):
        T = [300, 320, 340, 360, 380, np.nan]
        found = lw.radiation(self.closed, emissivity=self.eps, temperature=T, heat=[0] * 5 + [200])
        self.assertAlmostEqual(found.heat[5], 200, delta=1e-9)
        scale = abs(found.heat).sum()
        # No opening: what the rounding of view factors lets out is all that is lost.
        self.assertAlmostEqual(found.heat.sum(), found.to_surroundings, delta=1e-12 * scale)
        self.assertGreater(found.temperature[5], 300)
        np.testing.assert_allclose(found.exchange.sum(axis=1), found.heat, atol=1e-11 * scale)
        np.testing.assert_allclose(found.gebhart.sum(axis=1), 1, atol=ROUNDING)

    def test_a_row_whose_temperature_nothing_decides_exchanges_nothing(self):
        found = lw.radiation(
            (np.ones((3, 3)) - np.eye(3)) / 2,
            areas=[1, 1, 1],
            emissivity=[0.5, 0, 0.8],
            temperature=[400, np.nan, 300],
        )
        self.assertTrue(np.isnan(found.temperature[1]))
        np.testing.assert_array_equal(found.exchange[1], 0)
        scale = abs(found.heat).sum()
        np.testing.assert_allclose(found.exchange.sum(axis=1), found.heat, atol=ROUNDING * scale)

    def test_arrays_are_read_only(self):
        eps = self.eps.copy()
        found = lw.radiation(self.closed, emissivity=eps, temperature=300)
        for name in ("emissivity", "temperature", "heat", "gebhart", "script_f", "exchange"):
            with self.subTest(name), self.assertRaises(ValueError):
                getattr(found, name)[0] = 0
        eps[0] = 0  # that of the caller stays writable
        self.assertEqual(found.emissivity[0], self.eps[0])

    def test_openings_lead_to_the_surroundings(self):
        found = lw.radiation(self.open, emissivity=self.eps[:5], temperature=400, surroundings=300)
        self.assertGreater(found.to_surroundings, 0)
        self.assertAlmostEqual(found.heat.sum(), found.to_surroundings, delta=1e-12 * found.heat.sum())
        # Black surfaces at one temperature: all of the opening, 6 m^2, shines at 400 K.
        black = lw.radiation(self.open, emissivity=1.0, temperature=400, surroundings=300)
        expected = 6 * SIGMA * (400**4 - 300**4)
        # Shares of five rows, float32.
        self.assertAlmostEqual(black.to_surroundings, expected, delta=10 * FLOAT * expected)
        self.assertIn("to surroundings of 300 K", repr(black))


class BadInput(unittest.TestCase):
    def test_is_refused_with_a_sentence(self):
        F = [[0, 1], [1, 0]]
        sound = {"areas": [1, 1], "emissivity": 0.5, "temperature": 300}
        for change, pattern in (
            ({"areas": None}, "need areas"),
            ({"areas": [1, 2]}, "not reciprocal"),
            ({"areas": [1, 1, 1]}, r"\(2,\), is needed"),
            ({"emissivity": 2}, "surface 0: its emittance is 2"),
            ({"emissivity": [0.5, np.nan]}, "surface 1: its emittance is nan"),
            ({"emissivity": "black"}, "elements of type"),
            ({"emissivity": {"floor": 1}}, "by names"),
            ({"temperature": -3}, "-3 K"),
            ({"temperature": None}, "nothing decides"),
            ({"heat": 5}, "give one of the two"),
            ({"temperature": [300, np.nan], "heat": [0, -1e6]}, "colder than 0 K"),
            ({"surroundings": np.inf}, "finite number"),
            ({"open": [0.5, 0]}, "add up to 1.5"),
        ):
            with self.subTest(change), self.assertRaisesRegex(lw.InputError, pattern):
                lw.radiation(F, **{**sound, **change})
        for bad, pattern in (
            ([[0, 1]], r"\(n, n\)"),
            ([[0, 2], [2, 0]], "add up to 2"),
            (np.zeros((0, 0)), "no surfaces"),
            ("F.mtx", "elements of type"),
        ):
            with self.subTest(bad), self.assertRaisesRegex(lw.InputError, pattern):
                lw.radiation(bad, **{**sound, "areas": [1] * len(bad) if len(bad) < 3 else 1})
        factors = lw.form_factors(lw.Scene.from_arrays(*box(), names=list("abcdef")))
        for options, pattern in (
            ({"emissivity": {"a": 1}}, "surface 1: its emittance is nan"),
            ({"emissivity": {"g": 1}}, "no surface 'g'"),
            ({"emissivity": 1, "areas": [1] * 6}, "belong to factors in an array"),
        ):
            with self.subTest(options), self.assertRaisesRegex(lw.InputError, pattern):
                lw.radiation(factors, temperature=300, **options)


if __name__ == "__main__":
    unittest.main()
