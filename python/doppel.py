"""Calls the program Doppel and reads what it writes; docs/python.md has examples.

    import doppel
    run = doppel.run("butterfly", scene={"duration_s": 5}, b={"angle_deg": [90.1, 90]})
    run["distance"].max()                          # a column of the CSV
    doppel.still("butterfly", at=14)               # a picture: notebooks show it
    doppel.figure("fig2-right", grid={"right": "exponent"})

Keyword arguments are tables and keys of the preset, as in its TOML file: a dict is a table. Strings after the preset are options of
the program: run("calm", "--columns", "time_s,a"). The module needs Python 3.9 and no other module; with NumPy, columns are arrays.

The program is $DOPPEL, else ./doppel of the checkout that this file is in, else doppel on the PATH.
"""
import csv
import functools
import html
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import warnings
import weakref

try:
    import numpy
except ImportError:  # columns are lists
    numpy = None

__all__ = ["run", "figure", "still", "film", "Result", "DoppelError", "DoppelWarning"]


class DoppelError(Exception):
    """The program failed: its message, and its exit code in `code` (see docs/files.md). `retry`: trying again may help."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code
        self.retry = code == 75

    def __reduce__(self):  # an error of a worker process reaches its parent
        return DoppelError, (str(self), self.code)


class DoppelWarning(UserWarning):
    """What the program warns of, such as a step that is too coarse."""


class Result:
    """The files of a run. Without `out` they are in a temporary folder that exists as long as the result does."""

    files = ()

    def __init__(self, folder=None):
        if folder is not None:
            weakref.finalize(self, folder.cleanup)

    def path(self, suffix):
        """The file whose name ends with `suffix`, such as ".csv"."""
        for file in self.files:
            if file.name.endswith(suffix):
                return file
        raise KeyError(f"there is no {suffix} file; there are {', '.join(file.name for file in self.files)}")

    @functools.cached_property
    def columns(self):
        """Name → values of the CSV: arrays of NumPy, or lists. An empty field is nan; columns of words stay text."""
        with open(self.path(".csv"), newline="", encoding="utf-8") as file:
            names, *rows = csv.reader(file)
        return dict(zip(names, map(_values, zip(*rows) if rows else [()] * len(names))))

    def __getitem__(self, column):
        return self.columns[column]

    @functools.cached_property
    def manifest(self):
        """The manifest (JSON): the preset as it was understood (resolved_preset), versions, times, errors, warnings."""
        return json.loads(self.path(".json").read_text(encoding="utf-8"))

    @property
    def data(self):
        """The bytes of the picture, page or table: of the first file."""
        return self.files[0].read_bytes()

    def _shown(self, suffix):
        return self.data if self.files[0].suffix == suffix else None

    def _repr_png_(self):
        return self._shown(".png")

    def _repr_pdf_(self):
        return self._shown(".pdf")

    def _repr_svg_(self):
        return self._shown(".svg") and self.data.decode()

    def _repr_html_(self):
        page = self._shown(".html")
        return page and '<iframe width="100%" height="600" style="border: 0" srcdoc="{}"></iframe>'.format(html.escape(page.decode()))

    def __repr__(self):
        return f"<doppel: {', '.join(file.name for file in self.files)}>"


def run(preset, *options, out=None, **keys):
    """Simulates a preset (a name or a path): a Result with columns and manifest. out: a folder that keeps the files."""
    return _call("simulate", preset, options, out, keys)


def figure(preset, *options, format="png", out=None, **keys):
    """Draws a figure: a Result with picture, columns and manifest. format: png, svg, pdf or html."""
    return _call("figure", preset, (*options, *(() if "--tiles" in options else ("--format", format))), out, keys)


def still(preset, at, *options, format="png", out=None, **keys):
    """Draws one picture of a film, at a time in seconds: a Result with a picture. format: png, svg or pdf."""
    return _call("still", preset, ("--at", at if isinstance(at, str) else _toml(at), "--format", format, *options), out, keys)


def film(preset, *options, format="html", out=None, **keys):
    """Renders a film: a Result with columns and manifest. A notebook shows the format html; others: mp4, webm, gif, apng, png."""
    return _call("render", preset, ("--format", format, *options), out, keys)


def _call(command, preset, options, out, keys):
    given = {os.fspath(option).split("=")[0] for option in options}
    if given & {"-o", "--out", "--progress"}:
        raise ValueError("give the folder as out=...; --out and --progress are for the command line")
    if out == "-" or given & {"-h", "--help", "--list-outputs"}:
        raise ValueError("a Result has files: out must be a folder, and --help and --list-outputs are for the command line")
    folder = None if out is not None else tempfile.TemporaryDirectory(prefix="doppel-")
    result = Result(folder)
    words = [_program(), command, *options, "--progress", "json", "--out", out if folder is None else folder.name]
    for key, value in _flat(keys):
        words += ["--set", f"{key}={_toml(value)}"]
    done = subprocess.run([os.fspath(word) for word in [*words, "--", preset]], capture_output=True, text=True, encoding="utf-8")
    if done.returncode == 130:
        raise KeyboardInterrupt
    if done.returncode != 0:
        lines = [line[len("doppel: "):] if line.startswith("doppel: ") else line for line in done.stderr.splitlines()]
        text = "\n".join(lines) or f"{words[0]} ended by signal {-done.returncode}"
        if folder is not None and folder.name in text:
            text += "; this folder is removed, give out= to keep one"
        raise DoppelError(text, done.returncode)
    events = [json.loads(line) for line in done.stdout.splitlines()]
    for event in events:
        if event["event"] == "note":
            warnings.warn(f"{preset}: {event['text']}", DoppelWarning, stacklevel=3)
    result.files = [pathlib.Path(file) for event in events for file in event.get("files", ())]
    return result


def _program():
    checkout = pathlib.Path(__file__).resolve().parent.parent / "doppel"
    found = os.environ.get("DOPPEL") or (str(checkout) if checkout.is_file() else shutil.which("doppel"))
    if not found or not shutil.which(found):
        raise DoppelError(f"the program {found or 'doppel'} was not found; install it, or set DOPPEL to its path", 127)
    return found


def _flat(table, before=""):
    """Pairs of a dotted key and its value: {"system": {"links": 3}} is system.links and 3."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{before}{key}.")
        else:
            yield before + key, value


def _toml(value):
    """The value in TOML, also of NumPy."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)  # 0.1, 1e-12, inf, nan
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_toml, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_toml(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    raise TypeError(f"a key of a preset is a number, a text, a truth value, a list or a dict; it is {value!r}")


def _values(column):
    try:
        numbers = [float(field) if field else math.nan for field in column]
    except ValueError:  # words
        return list(column)
    return numbers if numpy is None else numpy.array(numbers)
