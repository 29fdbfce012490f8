"""The checks of packaging/wheel refuse what not everyone may use."""

import importlib.machinery
import importlib.util
import os
import pathlib
import tempfile
import unittest

SOURCE = os.environ["LIGHTWELL_SOURCE"]  # the repository


def load_script():
    loader = importlib.machinery.SourceFileLoader("wheel_script", os.path.join(SOURCE, "packaging", "wheel"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("wheel_script", loader))
    loader.exec_module(module)
    return module


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.script = load_script()

    def found(self, packages, table=None):
        """What the check finds in files of these packages: {file: package}."""
        return self.script.licences_of(packages, table or self.script.read_table(), lambda files: packages)

    def test_permissive_libraries_are_named_with_their_licences(self):
        found = self.found(
            {
                "/usr/include/eigen3/Eigen/Core": "libeigen3-dev",
                "/usr/lib/x86_64-linux-gnu/libtbb.so.12": "libtbb12",
                "/usr/include/c++/12/vector": "libstdc++-12-dev",
                "/build/_deps/cdt-src/CDT/CDT/include/CDT.h": "",
            }
        )
        self.assertEqual(found["Eigen"][0], "MPL-2.0")
        self.assertEqual(found["oneTBB"], ("Apache-2.0", {"libtbb12"}))
        self.assertIn("CDT", found)

    def test_a_header_of_cgal_is_refused_by_its_name(self):
        header = "/usr/include/CGAL/Constrained_Delaunay_triangulation_2.h"
        with self.assertRaisesRegex(self.script.Refused, "Constrained_Delaunay_triangulation_2.h.*libcgal-dev"):
            self.found({"/usr/include/fmt/format.h": "libfmt-dev", header: "libcgal-dev"})

    def test_a_header_that_names_the_gpl_is_refused_whatever_its_package(self):
        with tempfile.TemporaryDirectory() as folder:
            header = os.path.join(folder, "a.h")
            for text in (
                "/* the GNU General\n   Public License */\n",
                "/*\n * under the GNU General\n * Public License, version 2\n */\n",
                "// SPDX-License-Identifier: GPL-3.0-or-later OR LicenseRef-Commercial\n",
            ):
                pathlib.Path(header).write_text(text)
                with self.assertRaisesRegex(self.script.Refused, "a.h: its text names the GPL", msg=text):
                    self.found({header: "libeigen3-dev"})

    def test_a_file_of_no_package_is_refused(self):
        with self.assertRaisesRegex(self.script.Refused, "/usr/local/include/new.h: no Debian package"):
            self.found({"/usr/local/include/new.h": ""})

    def test_every_carried_library_has_a_source(self):
        system = {"/lib/x86_64-linux-gnu/libOpenEXR-3_1.so.30", "/lib/x86_64-linux-gnu/libtbb.so.12", "/lib/x86_64-linux-gnu/libz.so.1"}
        carried = ["libOpenEXR-3_1-5f2f8c1e.so.30.5.1", "libtbb-7c1d7b2d.so.12.8"]
        self.assertEqual(self.script.sources_of(carried, system), system - {"/lib/x86_64-linux-gnu/libz.so.1"})
        with self.assertRaisesRegex(self.script.Refused, "libglpk-0a1b2c3d.so.40"):
            self.script.sources_of(["libglpk-0a1b2c3d.so.40.3.1"], system)

    def test_files_of_debian_are_found_under_their_packages(self):
        self.assertTrue(self.script.packages_of({"/usr/bin/env"})["/usr/bin/env"].startswith("coreutils"))

    def test_the_gpl_is_refused_in_the_table_itself(self):
        with self.assertRaisesRegex(self.script.Refused, "GLPK is under GPL-3.0-or-later"):
            self.found({"/usr/include/glpk.h": "libglpk-dev"}, [("libglpk*", "GLPK", "GPL-3.0-or-later")])

    def test_what_is_not_known_as_permissive_is_refused(self):
        for licence in ("LGPL-2.1-or-later", "MIT AND GPL-3.0-only", "CC-BY-NC-4.0", "ask the author"):
            with self.assertRaisesRegex(self.script.Refused, "X is under"):
                self.found({"/usr/include/x.h": "libx-dev"}, [("libx*", "X", licence)])

    def test_the_table_has_licences_that_are_known(self):
        for pattern, library, _ in self.script.read_table():
            self.assertEqual(self.script.library_of(pattern.replace("*", ""), self.script.read_table())[0], library)

    def test_a_wheel_of_more_than_40_megabytes_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            wheel = pathlib.Path(folder, "lightwell.whl")
            for size, is_refused in ((40_000_000, False), (40_000_001, True)):
                with wheel.open("wb") as file:
                    file.truncate(size)
                if is_refused:
                    self.assertRaisesRegex(self.script.Refused, "at most 40", self.script.check_size, wheel)
                else:
                    self.script.check_size(wheel)


if __name__ == "__main__":
    unittest.main()
