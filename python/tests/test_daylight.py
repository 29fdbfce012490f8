"""A year of daylight, and instants of it."""

import datetime
import json
import os
import threading
import unittest

import numpy as np

import lightwell as lw
from scenes import FLOAT, WEATHER, run_program, scratch

WINDOWS = {
    "name": "skylight",
    "surfaces": "roof",
    "states": [{"name": "open"}, {"name": "blind", "material": "fabric"}],
}


def court(windows=None, roof=True):
    """A court of 4 m x 4 m x 2 m under a roof of clear glass, with a grid of sensors above its floor."""
    walls = {
        "floor": [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]],
        "south": [[0, 0, 0], [0, 0, 2], [4, 0, 2], [4, 0, 0]],
        "north": [[0, 4, 0], [4, 4, 0], [4, 4, 2], [0, 4, 2]],
        "west": [[0, 0, 0], [0, 4, 0], [0, 4, 2], [0, 0, 2]],
        "east": [[4, 0, 0], [4, 0, 2], [4, 4, 2], [4, 4, 0]],
    }
    surfaces = [{"name": name, "material": "grey", "polygon": polygon} for name, polygon in walls.items()]
    if roof:
        surfaces.append({"name": "roof", "material": "clear", "polygon": [[0, 0, 2], [0, 4, 2], [4, 4, 2], [4, 0, 2]]})
    return {
        "unit": "m",
        "materials": {
            "grey": {"reflectance": 0.5},
            "clear": {"glass": {"ior": 1.5, "thin": True}},
            "fabric": {"translucent": 0.05, "reflectance": 0.5},
        },
        "surfaces": surfaces,
        "sky": {"kind": "cie-overcast", "illuminance": 1, "up": [0, 0, 1], "north": [0, 1, 0]},
        "cameras": [{"name": "desk", "position": [1, 1, 1.2], "look_at": [3, 3, 1.2], "up": [0, 0, 1]}],
        "grids": [{"name": "desks", "surface": "floor", "height": 0.8, "spacing": 1}],
        **({} if windows is None else {"windows": [windows]}),
    }


class Daylight(unittest.TestCase):
    QUICK = {"max_patch_size": 1.0, "rays": 64, "sky": 1}
    SAME = ["--max-patch-size", "1", "--rays", "64", "--sky", "1"]

    def setUp(self):
        self.folder = scratch(self)
        self.weather = os.path.join(self.folder, "year.wea")
        with open(self.weather, "w") as file:
            file.write(WEATHER)

    def scene(self, **options):
        return lw.Scene.from_tables(court(**options), folder=self.folder)

    def assert_same_files(self, theirs, ours):
        names = sorted(os.listdir(theirs))
        self.assertEqual(names, sorted(os.listdir(ours)))
        for name in names:
            with open(os.path.join(theirs, name), "rb") as one, open(os.path.join(ours, name), "rb") as other:
                self.assertEqual(one.read(), other.read(), name)

    def test_files_have_the_bits_of_the_command_line(self):
        theirs, ours, again = (os.path.join(self.folder, name) for name in ("theirs", "ours/of/python", "again"))
        points = [[2.0, 2.0, 0.5], [2.0, 2.0, 5.0]]
        with open(os.path.join(self.folder, "points"), "w") as file:
            file.write("x,y,z,nx,ny,nz\n2,2,0.5,0,0,1\n2,2,5,0,0,1\n")
        with open(os.path.join(self.folder, "rooms.toml"), "w") as file:
            file.write('[[rooms]]\nsensors = "*"\narea = 16\nlighting = { lux = 500, control = "dimmed", watts = 100 }\n')
        made = self.scene(windows=WINDOWS)
        path = os.path.join(self.folder, "court.toml")
        made.save(path)
        run_program(
            "daylight", path, "--weather", self.weather, "-o", theirs, *self.SAME, "--hourly",
            "--points", os.path.join(self.folder, "points"), "--observer", "desk", "--rating", "leed",
            "--rating", "breeam-office", "--rooms", os.path.join(self.folder, "rooms.toml"), "--ground", "0.3",
            "--occupied", "7-17", "--north", "30",
        )  # fmt: skip
        options = {
            "points": points, "observers": "desk", "ratings": ["leed", "breeam-office"],
            "rooms": os.path.join(self.folder, "rooms.toml"), "ground": 0.3, "occupied": (7, 17), "north": 30.0,
        }  # fmt: skip
        year = lw.daylight(lw.read(path), self.weather, **self.QUICK, **options)
        year.save(ours, hourly=True)
        self.assert_same_files(theirs, ours)
        self.assertIn("rooms.csv", os.listdir(ours))
        self.assertIn("glare.csv", os.listdir(ours))
        lux = np.load(os.path.join(theirs, "illuminance.npy"))
        self.assertEqual(year.lux.tobytes(), lux.tobytes())
        self.assertEqual(year.sun_lux.tobytes(), np.load(os.path.join(theirs, "sunlight.npy")).tobytes())
        # The scene's tables give the same year as its file, but for the file's name as the title.
        with lw.thread_limit(1):
            of_tables = lw.daylight(made, lw.read_weather(self.weather), **self.QUICK, **options)
        self.assertEqual(of_tables.lux.tobytes(), year.lux.tobytes())
        self.assertEqual({**of_tables.figures, "title": ""}, {**year.figures, "title": ""})
        of_tables.save(again)
        self.assertEqual(len(os.listdir(again)), len(os.listdir(ours)) - 2)

    def test_measures_follow_from_the_hours(self):
        year = lw.daylight(self.scene(), self.weather, observers=lw.Camera((1, 1, 1.2), (3, 3, 1.2)), **self.QUICK)
        self.assertEqual(year.lux.shape, (3, len(year.points)))
        self.assertEqual(year.lux.dtype, np.float32)
        self.assertEqual(list(zip(year.month, year.day, year.hour)), [(6, 21, 9), (6, 21, 12), (12, 21, 12)])
        self.assertTrue((year.sun_lux <= year.lux).all())
        occupied_hours = 3650
        measures = year.metrics
        reached = (year.lux >= 300.0).sum(axis=0)
        # Shares are one division and one product of doubles.
        np.testing.assert_allclose(measures.autonomy, 100.0 * reached / occupied_hours, rtol=2.0**-51)
        self.assertEqual(measures.sun_hours.tolist(), (year.sun_lux >= 1000.0).sum(axis=0).tolist())
        bins = measures.below_100 + measures.from_100_to_300 + measures.from_300_to_3000 + measures.above_3000
        # Four shares that add up to 100: each rounds twice, and three sums once each.
        np.testing.assert_allclose(bins, 100.0, rtol=11 * 2.0**-53)
        # Three floats are added and divided by the hours of the year.
        np.testing.assert_allclose(measures.mean_lux, year.lux.sum(axis=0) / 8760, rtol=6 * FLOAT)
        for least, value, most in zip(year.least, year.metrics, year.most):
            self.assertEqual(len(value), len(year.points))
            self.assertFalse(value.flags.writeable)
        self.assertTrue((year.least.mean_lux < measures.mean_lux).all())
        self.assertTrue((measures.mean_lux < year.most.mean_lux).all())
        self.assertTrue(((0.0 < year.daylight_factor) & (year.daylight_factor < 100.0)).all())
        (room,) = year.rooms
        self.assertEqual(room.name, "desks")
        self.assertAlmostEqual(room.figures["mean_daylight_factor"], year.daylight_factor.mean(), delta=100 * 8 * FLOAT)
        (glare,) = year.glare
        self.assertEqual(glare.dgp.shape, (3,))
        self.assertTrue(((0.0 <= glare.dgp) & (glare.dgp <= 1.0)).all())
        # Light on open level ground is that of sun and dome.
        self.assertTrue((year.outdoor_dome_lux > 0.0).all())
        self.assertIn("Testville", repr(year))
        self.assertIn("desks: 9 sensors", str(year))

    def test_pictures_of_a_grid_and_of_the_year(self):
        year = lw.daylight(self.scene(), self.weather, points=[[2, 2, 5]], **self.QUICK)
        grid, points = year.rooms
        picture = grid.image(year.metrics.mean_lux)
        self.assertEqual(picture.shape, grid.shape)
        rows, columns = grid.shape
        step = np.array(grid.extent)[[1, 3]] / (columns, rows)
        for row in range(rows):
            for column in range(columns):
                # Sensors stand in the middle of cells, 0.8 m above the corner's plane; sums of numbers up to
                # 4, each rounded once.
                along = grid.corner + grid.axes.T @ (step * (column + 0.5, row + 0.5))
                number = int(np.argmin(np.linalg.norm(grid.points - along, axis=1)))
                self.assertLess(np.linalg.norm((grid.points[number] - along)[:2]), 16 * 2.0**-53 * 4)
                self.assertEqual(picture[row, column], year.metrics.mean_lux[grid.sensors][number])
        self.assertEqual(grid.image(year.lux).shape, (3, rows, columns))
        self.assertEqual(points.shape, None)
        calendar = year.calendar(year.lux[:, 0])
        self.assertEqual(calendar.shape, (24, 365))
        self.assertEqual(np.isfinite(calendar).sum(), 3)
        self.assertEqual(calendar[9, 31 + 28 + 31 + 30 + 31 + 20], year.lux[0, 0])
        for wrong in (lambda: points.image(year.metrics.mean_lux), lambda: grid.image([1.0, 2.0]),
                      lambda: grid.image("lux"), lambda: year.calendar(year.lux), lambda: year.calendar([1.0])):  # fmt: skip
            with self.assertRaises(lw.InputError):
                wrong()

    def test_instants_have_the_bits_of_the_command_line(self):
        scene = self.scene(windows=WINDOWS)
        path = os.path.join(self.folder, "court.toml")
        scene.save(path)
        theirs, ours = (os.path.join(self.folder, name) for name in ("theirs", "ours"))
        run_program("daylight", path, "--weather", self.weather, "--at", "2024-06-21 12:10", "-o", theirs, *self.SAME)
        noon, winter = lw.daylight_at(
            lw.read(path), self.weather, [datetime.datetime(2024, 6, 21, 12, 10), "2024-12-21T12:30"], **self.QUICK
        )
        noon.save(ours)
        self.assert_same_files(theirs, ours)
        self.assertEqual(noon.when, "2024-06-21 12:10")
        self.assertTrue((winter.sun_lux == 0.0).all())
        self.assertIn("2024-06-21", repr(noon))
        self.assertEqual(noon.rooms[0].image(noon.lux).shape, noon.rooms[0].shape)
        # An observer is a sensor of the year, and none of an instant.
        year = lw.daylight(lw.read(path), self.weather, observers=["desk"], **self.QUICK)
        self.assertEqual(year.at("2024-06-21 12:10").lux.tobytes(), noon.lux.tobytes())

    def test_windows_change_their_states(self):
        year = lw.daylight(self.scene(windows=WINDOWS), self.weather, **self.QUICK)
        # The sun of a clear noon in June comes through the roof with more than 1000 lx.
        self.assertEqual(year.window_states.shape, (3, 1))
        self.assertEqual(year.window_states[1, 0], 1)
        self.assertEqual(year.window_states[2, 0], 0)
        (group,) = year.figures["windows"]
        self.assertEqual(group["states"][1]["hours_with_light"], int(year.window_states.sum()))
        path = os.path.join(self.folder, "windows.toml")
        with open(path, "w") as file:
            file.write('[[windows]]\nname = "sky"\nsurfaces = "roof"\noperation = "always"\nstate = "open"\n'
                       'states = [{ name = "open" }, { name = "shut", material = "fabric" }]\n')  # fmt: skip
        other = lw.daylight(self.scene(windows=WINDOWS), self.weather, windows=path, **self.QUICK)
        self.assertTrue((other.window_states == 0).all())

    def test_hours_of_sun(self):
        year = lw.daylight(
            self.scene(roof=False), self.weather, sun_points=[[2, 2, 5]], sun_day="03-01", least_sun=10, **self.QUICK
        )
        exposure = year.figures["exposure_to_sunlight"]
        self.assertEqual((exposure["month"], exposure["day"], exposure["least_sun_altitude"]), (3, 1, 10.0))
        # The sun of 1 March, of declination -7.7 degrees, is above 10 degrees at 50 degrees north for
        # 2 acos((sin 10 - sin 50 sin d) / (cos 50 cos d)) / 15 hours; the declination changes by 0.4 degrees within a
        # day, which is 0.06 h, and minutes count as a whole.
        d, site = np.radians(-7.7), np.radians(50.0)
        cosine = (np.sin(np.radians(10.0)) - np.sin(site) * np.sin(d)) / (np.cos(site) * np.cos(d))
        expected = 2.0 * np.degrees(np.arccos(cosine)) / 15.0
        self.assertAlmostEqual(exposure["points"][0]["hours"], expected, delta=0.06 + 2.0 / 60.0)

    def test_progress_stops_the_year(self):
        phases = []

        def stop(phase, share):
            phases.append(phase)
            return False

        with self.assertRaises(lw.Interrupted):
            lw.daylight(self.scene(), self.weather, progress=stop, max_patch_size=0.1)
        self.assertEqual(len(phases), 1)

        def fail(phase, share):
            raise ZeroDivisionError(phase)

        with self.assertRaises(ZeroDivisionError):
            lw.daylight(self.scene(), self.weather, progress=fail, max_patch_size=0.1)

    def test_two_years_at_once(self):
        scene, found = self.scene(), {}

        def work(north):
            found[north] = lw.daylight(scene, self.weather, north=north, **self.QUICK)

        threads = [threading.Thread(target=work, args=(north,)) for north in (0.0, 90.0)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for north, year in found.items():
            alone = lw.daylight(scene, self.weather, north=north, **self.QUICK)
            self.assertEqual(alone.lux.tobytes(), year.lux.tobytes())
        self.assertNotEqual(found[0.0].lux.tobytes(), found[90.0].lux.tobytes())

    def test_views_outlive_the_year(self):
        lux = lw.daylight(self.scene(), self.weather, **self.QUICK).lux
        self.assertFalse(lux.flags.owndata)
        with self.assertRaises(ValueError):
            lux[0] = 1.0
        self.assertTrue((lux > 0.0).all())

    def test_wrong_input_is_a_sentence(self):
        scene = self.scene()
        bare = lw.Scene.from_arrays([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], names=["floor"])
        sentences = {
            "there are no sensors": (bare, {}),
            "wall": (scene, {"planes": {"wall": 0.8}}),
            "the height above floor is -1": (scene, {"planes": {"floor": -1}}),
            "planes is": (scene, {"planes": ["floor@0.8"]}),
            "points has the shape": (scene, {"points": [1.0, 2.0]}),
            "row 0 has a coordinate": (scene, {"points": [[np.nan, 0, 0]]}),
            "a direction is zero": (scene, {"points": [[0, 0, 1]], "normals": [0, 0, 0]}),
            "normals are given without points": (scene, {"normals": [0, 0, 1]}),
            "sky is 9": (scene, {"sky": 9}),
            "rays is 100": (scene, {"rays": 100}),
            "max_patch_size is": (scene, {"max_patch_size": float("inf")}),
            "ground is 1.5": (scene, {"ground": 1.5}),
            "north is 1e+300": (scene, {"north": 1e300}),
            "no span of hours": (scene, {"occupied": (18, 8)}),
            "occupied is 8": (scene, {"occupied": 8}),
            "none of the days of EN 17037": (scene, {"sun_day": "06-21"}),
            "least_sun is 90": (scene, {"least_sun": 90}),
            "ratings": (scene, {"ratings": "leeed"}),
            "an observer is 3": (scene, {"observers": [3]}),
            "no camera": (scene, {"observers": "chair"}),
            "rooms.toml": (scene, {"rooms": os.path.join(self.folder, "rooms.toml")}),
            "windows.toml": (scene, {"windows": os.path.join(self.folder, "windows.toml")}),
            "surfaces is": (scene, {"surfaces": [1]}),
        }
        for sentence, (of, options) in sentences.items():
            with self.subTest(sentence), self.assertRaises(lw.InputError) as caught:
                lw.daylight(of, self.weather, **options)
            self.assertIn(sentence, str(caught.exception))
        with self.assertRaises(lw.InputError):
            lw.daylight(scene, os.path.join(self.folder, "missing.epw"))
        with self.assertRaises(lw.InputError):
            lw.daylight(scene, 3)
        with self.assertRaises(lw.InputError):
            lw.daylight("court.toml", self.weather)
        with self.assertRaises(TypeError):
            lw.daylight(scene, self.weather, plane={"floor": 0.8})

    def test_wrong_instants_and_folders_are_sentences(self):
        scene = self.scene()
        noon = datetime.datetime(2024, 6, 21, 12, 10)
        for when, sentence in (
            ("2024-06-21", "no instant"),
            ("2024-02-30 12:00", "no instant"),
            ("2024-06-21 23:00", "below the horizon"),
            (noon.replace(tzinfo=datetime.timezone.utc), "time zone"),
            (noon.replace(second=1), "seconds"),
            (3, "the instant is 3"),
            ([noon, None], "the instant is None"),
        ):
            with self.subTest(when), self.assertRaises(lw.InputError) as caught:
                lw.daylight_at(scene, self.weather, when, **self.QUICK)
            self.assertIn(sentence, str(caught.exception))
        self.assertEqual(lw.daylight_at(scene, self.weather, [], **self.QUICK), [])
        year = lw.daylight(scene, self.weather, **self.QUICK)
        with self.assertRaises(lw.Error) as caught:
            year.save(self.weather)
        self.assertIn("year.wea", str(caught.exception))
        year.save(os.path.join(self.folder, "good"))
        with open(os.path.join(self.folder, "good", "year.json")) as file:
            self.assertEqual(json.load(file), year.figures)


if __name__ == "__main__":
    unittest.main()
