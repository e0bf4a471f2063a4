#!/usr/bin/env python3
"""Tests of python/doppel.py with the program $DOPPEL (build/release/doppel): python3 tests/python/doppel_test.py"""
import contextlib
import gc
import io
import math
import os
import pathlib
import pickle
import re
import sys
import tempfile
import unittest
import warnings
import xml.dom.minidom

top = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(top / "python"))
sys.dont_write_bytecode = True
import doppel  # noqa: E402

os.environ.setdefault("DOPPEL", str(top / "build/release/doppel"))
short = {"scene": {"duration_s": 0.5}}


class Columns(unittest.TestCase):
    def test_are_those_of_the_csv(self):
        run = doppel.run("butterfly", **short)
        names, *rows = [line.split(",") for line in run.path(".csv").read_text().splitlines()]
        self.assertEqual(list(run.columns), names)
        self.assertEqual(len(run["time_s"]), 61)
        for index, name in enumerate(names):
            self.assertEqual(list(run[name]), [float(row[index]) for row in rows], name)

    def test_are_arrays_or_lists(self):
        if doppel.numpy is not None:
            self.assertAlmostEqual(doppel.run("butterfly", **short)["time_s"].max(), 0.5)
        numpy, doppel.numpy = doppel.numpy, None
        try:
            self.assertEqual(doppel.run("butterfly", **short)["sample"], list(range(61)))
        finally:
            doppel.numpy = numpy

    def test_have_nan_where_a_field_is_empty(self):
        same = doppel.run("butterfly", b={"angle_deg": [90, 90]}, **short)  # ln(d/0)
        self.assertTrue(all(map(math.isnan, same["log_ratio"])))
        self.assertRaises(KeyError, lambda: same["speed"])

    def test_take_options_of_the_program(self):
        run = doppel.run("butterfly", "--columns", "time_s,distance", **short)
        self.assertEqual(list(run.columns), ["time_s", "distance"])


class Keys(unittest.TestCase):
    def test_reach_the_preset(self):
        title = 'A "title" of µ and \\ more'
        run = doppel.run("butterfly", title=title, video={"theme": "light"}, scene={"duration_s": 0.1, "energy_columns": True},
                         system={"links": 3, "mass_kg": [1, 2.5, 1e-3], "length_m": (1, 1, 1), "angle_deg": [90, 90, 90],
                                 "omega_deg_per_s": [0, 0, 0], "integrator": "rk4", "step_s": "1/2400"},
                         b={"angle_deg": [90.003, 90, 90]}, **{"a.mass_kg[1]": 3})
        preset = run.manifest["resolved_preset"]
        self.assertEqual(preset["title"], title)
        self.assertEqual((preset["scene"]["energy_columns"], preset["video"]["theme"]), (True, "light"))
        self.assertEqual((preset["a"]["mass_kg"], preset["b"]["mass_kg"]), ([1, 3, 1e-3], [1, 2.5, 1e-3]))
        self.assertEqual(preset["b"]["angle_deg"], [90.003, 90, 90])
        self.assertEqual(preset["a"]["integrator"], "rk4")

    def test_take_numpy(self):
        if doppel.numpy is None:
            self.skipTest("there is no NumPy")
        run = doppel.run("butterfly", b={"angle_deg": doppel.numpy.array([91, 90.5])}, scene={"duration_s": doppel.numpy.float64(0.1)})
        self.assertEqual(run.manifest["resolved_preset"]["b"]["angle_deg"], [91, 90.5])

    def test_of_another_type_are_errors(self):
        self.assertRaises(TypeError, doppel.run, "butterfly", scene={"duration_s": None})
        self.assertRaises(ValueError, doppel.run, "butterfly", out="-")  # a result has files
        self.assertRaises(ValueError, doppel.run, "butterfly", "--list-outputs")
        self.assertRaises(ValueError, doppel.run, "butterfly", "--out=x")
        self.assertRaises(ValueError, doppel.run, "butterfly", "--progress", "none")


class Pictures(unittest.TestCase):
    def test_of_a_film(self):
        still = doppel.still("butterfly", 0.5, "--size", "64x64")
        self.assertEqual(still._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertIsNone(still._repr_svg_() or still._repr_html_() or still._repr_pdf_())
        self.assertEqual(still.files[0].name, "butterfly.0.5s.png")

    def test_of_a_figure_with_its_numbers(self):
        scene = {"duration_s": 0.5}
        figure = doppel.figure("fig6", "--size", "480x270", format="svg", scene=scene)
        self.assertEqual(xml.dom.minidom.parseString(figure._repr_svg_()).documentElement.tagName, "svg")
        self.assertEqual(list(figure.columns)[:2], ["sample", "time_s"])
        self.assertIn("doppel", figure.manifest)
        page = doppel.figure("fig6", "--size", "480x270", format="html", scene=scene)._repr_html_()
        frame = xml.dom.minidom.parseString(page).documentElement
        self.assertIn("<html", frame.getAttribute("srcdoc"))

    def test_of_a_film_as_a_page(self):
        film = doppel.film("butterfly", "--size", "64x64", **short)
        self.assertIn("srcdoc", film._repr_html_())
        self.assertEqual(len(film["time_s"]), 61)


class Files(unittest.TestCase):
    def test_exist_as_long_as_the_result(self):
        run = doppel.run("butterfly", **short)
        folder = run.files[0].parent
        self.assertTrue(folder.exists())
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            del run
            gc.collect()
        self.assertFalse(folder.parent.exists())

    def test_remain_in_out(self):
        with tempfile.TemporaryDirectory() as out:
            doppel.run("butterfly", out=pathlib.Path(out), **short)
            self.assertEqual({file.name for file in pathlib.Path(out, "butterfly").iterdir()}, {"butterfly.csv", "butterfly.json"})


class Errors(unittest.TestCase):
    def error(self, *arguments, **keys):
        with self.assertRaises(doppel.DoppelError) as caught:
            doppel.run(*arguments, **keys)
        return caught.exception

    def test_have_the_message_and_the_code(self):
        error = self.error("buterfly")
        self.assertEqual((str(error), error.code, error.retry), ('there is no preset "buterfly"; did you mean "butterfly"?', 2, False))
        error = self.error("butterfly", a={"lenth_m": 1}, b={"mass_kg": -1})
        self.assertIn('--set a.lenth_m: [a] has no "lenth_m"; did you mean "length_m"?\n', str(error))
        self.assertEqual(pickle.loads(pickle.dumps(error)).code, 2)
        self.assertEqual(self.error("-x").code, 2)  # not an option

    def test_of_programs_and_signals(self):
        kept = os.environ["DOPPEL"]
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "program")
            try:
                os.environ["DOPPEL"] = str(program)
                self.assertEqual(self.error("calm").code, 127)
                for ending, code in (("exit 75", 75), ("kill -9 $$", -9), ("kill -2 $$", -2)):
                    program.write_text(f"#!/bin/sh\necho 'doppel: no space' >&2\n{ending}\n")
                    program.chmod(0o755)
                    error = self.error("calm")
                    self.assertEqual((error.code, error.retry, str(error)), (code, code == 75, "no space"))
                program.write_text("#!/bin/sh\nexit 130\n")
                self.assertRaises(KeyboardInterrupt, doppel.run, "calm")
            finally:
                os.environ["DOPPEL"] = kept

    def test_warnings_are_warnings(self):
        with self.assertWarnsRegex(doppel.DoppelWarning, "butterfly: the energy of side a changed by .* too coarse"):
            doppel.run("butterfly", system={"integrator": "euler", "step_s": "1/120"})


class Page(unittest.TestCase):
    def test_examples_run(self):
        blocks = re.findall(r"```python\n(.*?)```", (top / "docs/python.md").read_text(), flags=re.S)
        self.assertEqual(len(blocks), 3)
        with contextlib.redirect_stdout(io.StringIO()) as printed, warnings.catch_warnings():
            warnings.simplefilter("ignore", doppel.DoppelWarning)
            exec("\n".join(blocks), {})
        lines = printed.getvalue().splitlines()
        self.assertEqual(lines[2:5], ['--set b.lenth_m: [b] has no "lenth_m"; did you mean "length_m"?', "2", "False"])
        self.assertRegex(lines[5], r"\[[0-9., ]+\]|None")


class Module(unittest.TestCase):
    def test_is_small_and_finds_its_checkout(self):
        self.assertLessEqual(len((top / "python/doppel.py").read_text().splitlines()), 200)
        kept = os.environ.pop("DOPPEL")
        try:
            self.assertEqual(doppel._program(), str(top / "doppel"))
        finally:
            os.environ["DOPPEL"] = kept


if __name__ == "__main__":
    unittest.main()
