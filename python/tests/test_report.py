"""Lighting reports: the figures of the command line."""

import json
import os
import unittest

import lightwell as lw
from scenes import ROOM, run_program, scratch


class Report(unittest.TestCase):
    def test_has_the_figures_of_the_command_line(self):
        folder = scratch(self)
        vtp, theirs, csv = (os.path.join(folder, name) for name in ("r.vtp", "r.json", "r.csv"))
        scene = lw.read(ROOM)
        solution = lw.solve(scene, refine="off", gather_rays=64)
        solution.save(vtp)
        run_program(
            "report", ROOM, vtp, "--plane", "floor@0.75", "--surface", "chest", "--observer", "door",
            "--watts", "panel=40", "--maintenance", "0.8", "--rays", "64", "-o", theirs, "-o", csv,
        )
        ours = [os.path.join(folder, name) for name in ("o.json", "o.csv", "o.html")]
        figures = solution.report(
            *ours, planes={"floor": 0.75}, surfaces=["chest"], observers=["door"], watts={"panel": 40},
            maintenance=0.8, rays=64,
        )
        with open(theirs, encoding="utf-8") as file:
            self.assertEqual(figures, json.load(file))
        for one, other in ((theirs, ours[0]), (csv, ours[1])):
            with open(one, "rb") as a, open(other, "rb") as b:
                self.assertEqual(a.read(), b.read())
        self.assertGreater(os.path.getsize(ours[2]), 10000)

    def test_areas_are_held_to_their_limits(self):
        folder = scratch(self)
        room, areas, vtp, theirs = (os.path.join(folder, name) for name in ("r.toml", "areas.toml", "r.vtp", "r.json"))
        with open(room, "w", encoding="utf-8") as file:
            file.write("materials.white = { reflectance = 0.5 }\nmaterials.panel = { lumens = 4000 }\n[[surfaces]]\n")
            file.write('name = "floor"\nmaterial = "white"\npolygon = [[0,0,0], [3,0,0], [3,3,0], [0,3,0]]\n[[surfaces]]\n')
            file.write('name = "panel"\nmaterial = "panel"\npolygon = [[1,1,2.5], [1,2,2.5], [2,2,2.5], [2,1,2.5]]\n')
        with open(areas, "w", encoding="utf-8") as file:
            file.write('[maintenance]\nlamp_flux = 0.7\n')
            file.write('[[grids]]\nname = "work"\nsurface = "floor"\nheight = 0.75\nspacing = 1\n')
            file.write('[[areas]]\nname = "desk"\nactivity = "writing"\ngrid = "work"\n')
        solution = lw.solve(lw.read(room), refine="off", gather_rays=16)
        solution.save(vtp)
        run_program("report", room, vtp, "--areas", areas, "--rays", "16", "-o", theirs)
        figures = solution.report(areas=areas, rays=16)
        with open(theirs, encoding="utf-8") as file:
            self.assertEqual(figures, json.load(file))
        self.assertEqual(figures["maintenance_factor"], 0.7)
        self.assertEqual({limit["area"] for limit in figures["requirements"]}, {"desk"})
        self.assertEqual(solution.report(areas=areas, rays=16, maintenance=1)["maintenance_factor"], 1.0)
        corridor = solution.report(planes={"floor": 0.1}, spacing=1, activity="corridor", rays=16)
        self.assertIn(corridor["verdict"], ("met", "missed", "too close to tell"))
        for wrong, sentence in (
            ({"activity": "sleeping"}, "sleeping"),
            ({"areas": os.path.join(folder, "none.toml")}, "none.toml"),
            ({"activities": vtp, "activity": "corridor"}, "r.vtp"),
            ({"areas": areas, "maintenance": 0}, "maintenance is 0"),
        ):
            with self.subTest(wrong), self.assertRaisesRegex(lw.InputError, sentence):
                solution.report(surfaces=["floor"], rays=16, **wrong)

    def test_is_written_as_pdf_in_a_language(self):
        folder = scratch(self)
        pdf, page = (os.path.join(folder, name) for name in ("r.pdf", "r.html"))
        solution = lw.solve(lw.read(ROOM), refine="off", gather_rays=16)
        solution.report(page, surfaces=["floor"], rays=64, language="fr")
        with open(page, encoding="utf-8") as file:
            self.assertIn("surface de calcul", file.read())
        try:
            solution.report(pdf, surfaces=["floor"], rays=64)
        except lw.InputError as error:
            self.assertRegex(str(error), "built without PDF")
        else:
            with open(pdf, "rb") as file:
                self.assertEqual(file.read(5), b"%PDF-")
        with self.assertRaisesRegex(lw.InputError, "the language is 'it'"):
            solution.report(page, surfaces=["floor"], language="it")

    def test_refuses_what_is_not_there(self):
        solution = lw.solve(lw.read(ROOM), refine="off", gather_rays=16)
        for options, pattern in (
            ({}, "nothing to report"),
            ({"surfaces": ["flor"]}, "Did you mean 'floor'"),
            ({"planes": {"floor": -1}}, "height above floor is -1"),
            ({"observers": ["window"]}, "no camera 'window'"),
            ({"surfaces": ["floor"], "watts": {"sun": 5}}, "no luminaire 'sun'"),
            ({"surfaces": ["floor"], "watts": {"panel": 0}}, "watts is 0"),
            ({"surfaces": ["floor"], "maintenance": 2}, "maintenance is 2"),
            ({"surfaces": ["floor"], "rays": 3}, "power of two"),
            ({"surfaces": ["floor"], "spacing": 0}, "spacing is 0"),
            ({"surfaces": ["floor"], "margin": -1}, "margin is -1"),
        ):
            with self.subTest(options), self.assertRaisesRegex(lw.InputError, pattern):
                solution.report(**options)
        with self.assertRaisesRegex(lw.InputError, "must end in .html"):
            solution.report("r.doc", surfaces=["floor"])


if __name__ == "__main__":
    unittest.main()
