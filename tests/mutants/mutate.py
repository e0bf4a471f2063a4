#!/usr/bin/env python3
"""Mutation testing: plants small errors at random places, and measures the share that a test detects.

    git clone . /tmp/doppel-mutants
    tests/mutants/mutate.py plant /tmp/doppel-mutants physics integrate analysis output scene
    tests/mutants/mutate.py build /tmp/doppel-mutants
    tests/mutants/mutate.py cover /tmp/doppel-mutants     # which test reaches which mutant
    tests/mutants/mutate.py run /tmp/doppel-mutants       # resumes an interrupted run
    tests/mutants/mutate.py report /tmp/doppel-mutants

After adding tests there: build, cover, and run --again, which runs the new tests on the survivors.

One program contains all mutants and selects one at run time (mutants.hpp), so that one build is enough. A mutant is
an exchanged operator (+ -, * /, a comparison), a negated condition, a changed number, or a removed statement. A test
that reaches a mutant detects it by failing, by a signal, or by running, alone, for more than ten times its usual time
and a minute. Tests of its own module run first, then those of dependent modules. Requires root: each test writes to
its own mount.
"""
import argparse, collections, concurrent.futures, json, os, pathlib, random, re, signal, subprocess, sys, time

HERE = pathlib.Path(__file__).resolve().parent
ROOMS = ["base", "numeric", "physics", "integrate", "analysis", "image", "render", "plot", "output", "scene", "film", "figure",
         "cli"]
HEADER = f'#include "{HERE}/mutants.hpp"\n#line 1\n'  # not with -include: a precompiled header must come first


# ---- planting -----------------------------------------------------------------------------------------------------

def masked(text):
    """The text with comments, strings and characters replaced by blanks of the same length, line by line."""
    def blank(match):
        return re.sub(r"[^\n]", "\x01", match.group(0))
    return re.sub(r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-zA-Z])\'(?:\\.|[^\'\\\n])\'', blank, text,
                  flags=re.S)


SKIP = re.compile(r"^\s*#|static_assert|\btemplate\b|\brequires\b|\bconcept\b|\busing\b|\boperator\b|\bcase\b|\benum\b|"
                  r"DOPPEL_|\.reserve\(|\balignas\b|^\s+(?!return)(?:[\w:]+ )+\w+\[|\bif constexpr\b|\bdecltype\b|\bnoexcept\b|\bextern\b|std::array<")
STATEMENT = re.compile(r"^(\s+)([\w.\->\[\]()*:]+ (?:=|\+=|-=|\*=|/=) \S.*;|(?!return|throw|delete|co_)[a-zA-Z_][\w.:\->]*\([^{}]*\);)$")


def in_angles(line, position):
    """Whether the position is inside template arguments."""
    depth = 0
    for i in range(position):
        if line[i] == "<" and i > 0 and re.match(r"[\w]", line[i - 1]):
            depth += 1
        elif line[i] == ">" and depth and line[i - 1] not in " -=":
            depth -= 1
    return depth > 0


def candidates(path):
    """(line, start, end, text with @ for the number, kind) of all possible mutants in a file."""
    text = path.read_text()
    lines, plain = text.split("\n"), masked(text).split("\n")
    found = []
    before = ";"
    in_table = None  # constants over several lines, used only at compile time
    for number, (line, code) in enumerate(zip(lines, plain)):
        stripped = code.replace("\x01", "").rstrip()
        if not stripped.strip():
            continue
        ends, before = before, stripped[-1]
        was_in_table = in_table
        if "constexpr" in stripped and (before not in ";{" or re.search(r"\w\{$", stripped)):
            in_table = r";$|\) (const |noexcept )*\{$"  # where it ends
        if re.search(r"constexpr .* = \[\] \{$", stripped):
            in_table = r"\}\(\);$"
        if in_table and re.search(in_table, stripped):
            in_table = None
        if was_in_table or in_table or SKIP.search(stripped):
            continue
        constant = re.match(r"^\s*(static |inline )*constexpr [\w:]+ \w+ = ", stripped)
        if "constexpr" in stripped and not constant:
            continue

        def add(start, end, new, what):
            found.append((number, start, end, new, what, bool(constant)))

        for m in re.finditer(r"(?<=[\w)\]]) ([+\-*/]|==|!=|<=|>=|<|>) (?=[^=\s])", code):
            op = m.group(1)
            add(m.start(), m.end(), f" {op}::mutant::M<@>{{}}{op} ", f"{op} exchanged")
        for m in re.finditer(r" (&&|\|\|) (?=[^=\s])", code):
            add(m.end(), m.end(), "::mutant::Not<@>{} ^ ", "condition after it turned round")
        for m in re.finditer(r"(?<=[( ])!(?=[\w(])", code):
            add(m.start(), m.end(), "::mutant::Not<@>{} ^ !", "! left out")
        for m in re.finditer(r"(?<![\w.\"'])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+|\d+)(?![\w.'])", code):
            if not in_angles(code, m.start()):
                add(m.start(), m.end(), f"::mutant::number<@>({m.group(0)})", "number changed")
        for m in re.finditer(r"\b(true|false)\b", code):
            add(m.start(), m.end(), f"(::mutant::Not<@>{{}} ^ {m.group(0)})", "bool turned round")
        m = STATEMENT.match(code)
        if m and ends in ";{})" and "\x01" not in code and not constant:
            add(m.start(2), m.end(2), "{ if (!::mutant::chosen(@)) " + m.group(2) + " }", "left out")
    return found


def plant(tree, modules, count, seed):
    lot = random.Random(seed)
    mutants = []
    for module in modules:
        places = []
        for path in sorted((tree / "src" / module).glob("*.[ch]pp")):
            places += [(path, *place) for place in candidates(path)]
        lot.shuffle(places)
        taken, chosen = set(), []
        for path, line, start, end, new, what, constant in places:
            if (path, line) not in taken and len(chosen) < count:
                taken.add((path, line))
                chosen.append((path, line, start, end, new, what, constant))
        print(f"{module}: {len(chosen)} of {len(places)} places")
        for path, line, start, end, new, what, constant in chosen:
            original = path.read_text().split("\n")[line]
            mutants.append(dict(id=len(mutants) + 1, module=module, file=str(path.relative_to(tree)), line=line + 1, start=start,
                                end=end, new=new, what=what, constant=constant, original=original, state="planted"))
    save(tree, mutants)
    for mutant in mutants:
        write(tree, mutant)


def write(tree, mutant):
    """Writes a mutant into its file, or the original line if the mutant was dropped."""
    path = tree / mutant["file"]
    lines = path.read_text().removeprefix(HEADER).split("\n")
    line = mutant["original"]
    if mutant["state"] != "dropped":
        line = line[:mutant["start"]] + mutant["new"].replace("@", str(mutant["id"])) + line[mutant["end"]:]
        if mutant["constant"]:
            line = line.replace("constexpr", "const", 1)
            if line.lstrip().startswith("static const "):
                line = line.replace("static const ", "static inline const " if path_is_class(lines, mutant) else "static const ", 1)
    lines[mutant["line"] - 1] = line
    path.write_text(HEADER + "\n".join(lines))


def path_is_class(lines, mutant):
    return mutant["file"].endswith(".hpp") and mutant["original"].startswith("    static")


def load(tree):
    return json.loads((tree / "mutants.json").read_text())


def save(tree, mutants):
    (tree / "mutants.json").write_text(json.dumps(mutants, indent=1))


def build(tree, jobs):
    folder = tree / "build" / "mutants"
    subprocess.run(["cmake", "-S", tree, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=RelWithDebInfo",
                    "-DCMAKE_CXX_FLAGS=-O1 -w", "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-DNDEBUG"], check=True, stdout=subprocess.DEVNULL)
    while True:
        log = subprocess.run(["ninja", "-C", folder, "-k0", f"-j{jobs}"], capture_output=True, text=True)
        (tree / "build.log").write_text(log.stdout + log.stderr)
        if log.returncode == 0:
            return
        mutants = load(tree)
        at = {(m["file"], m["line"]): m for m in mutants if m["state"] != "dropped"}
        named = re.findall(r"(src/[\w/]+\.[ch]pp):(\d+):\d+:", log.stdout)
        faulty = [at[file, int(line)] for file, line in set(named) if (file, int(line)) in at]
        if not faulty:  # code for another processor has no mutants
            faulty = [m for m in at.values() if m["file"] in {file for file, _ in named}]
        for mutant in faulty:
            mutant["state"] = "dropped"
            write(tree, mutant)
        dropped = len(faulty)
        save(tree, mutants)
        print(f"{dropped} mutants that do not compile are dropped", flush=True)
        if not dropped:
            sys.exit(f"the build fails, see {tree}/build.log")


# ---- running ------------------------------------------------------------------------------------------------------

def program(tree, module):
    return tree / "build" / "mutants" / "tests" / f"test_{module}"


def run_tests(tree, worker, module, names, mutant, seconds, reached=None):
    """(exit code or None after a timeout, output) of these tests with this mutant, in a folder of the worker."""
    own = tree / "workers" / str(worker)
    (own / "output").mkdir(parents=True, exist_ok=True)
    (own / "tmp").mkdir(parents=True, exist_ok=True)
    output = tree / "build" / "mutants" / "test-output"
    output.mkdir(parents=True, exist_ok=True)
    flags = own / "flags"
    flags.write_text("--gtest_filter=" + ":".join(names) + "\n--gtest_fail_fast\n")
    environment = dict(os.environ, DOPPEL_MUTANT=str(mutant), TMPDIR=str(own / "tmp"), GTEST_FLAGFILE=str(flags))
    if reached:
        environment["DOPPEL_MUTANTS_REACHED"] = str(reached)
    command = ["unshare", "-m", "sh", "-c", f"mount --bind {own}/output {output} && exec {program(tree, module)} --gtest_flagfile={flags}"]
    environment.pop("GTEST_FLAGFILE")
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               stdin=subprocess.DEVNULL, start_new_session=True)
    try:
        out, _ = process.communicate(timeout=seconds)
        code = process.returncode
    except subprocess.TimeoutExpired:
        code = None
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    if code is None:
        out, _ = process.communicate()
    return code, out.decode(errors="replace")


def fault(tree, worker, module, tests, mutant):
    """The test that detects the mutant, or None. A test that times out runs once more alone."""
    seconds = sum(test["seconds"] for test in tests)
    code, out = run_tests(tree, worker, module, [test["name"] for test in tests], mutant, 5 * seconds + 20)
    if code == 0:
        return None
    failed = re.search(r"\[  FAILED  \] (\S+?),? ", out)
    if failed:
        return failed.group(1)
    begun = re.findall(r"\[ RUN      \] (\S+)", out)
    if code is not None or not begun:
        return (begun[-1] if begun else "?") + f" (exit {code})"
    slow = next(test for test in tests if test["name"] == begun[-1])
    code, out = run_tests(tree, worker, module, [slow["name"]], mutant, 10 * slow["seconds"] + 60)
    if code is None:
        return slow["name"] + " (time)"
    if code != 0:
        return slow["name"]
    left = [test for test in tests if test["name"] not in begun]
    return fault(tree, worker, module, left, mutant) if left else None


def tests_of(tree, module):
    listing = subprocess.run([program(tree, module), "--gtest_list_tests"], capture_output=True, text=True).stdout
    suite, names = "", []
    for line in listing.splitlines():
        if line.startswith("  "):
            names.append(suite + line.split("#")[0].strip())
        elif line.strip().endswith(".") or "#" in line:
            suite = line.split("#")[0].strip()
    return names


def cover(tree, modules, jobs):
    """Runs every test (of these modules) once alone, for its duration and the mutants it reaches. Omits tests that
    fail, and does not measure a test again."""
    path = tree / "tests.json"
    known = json.loads(path.read_text()) if path.exists() else []
    there = {(test["module"], test["name"]) for test in known}
    work = [(module, name) for module in modules or ROOMS if program(tree, module).exists() for name in tests_of(tree, module)
            if (module, name) not in there]
    (tree / "reached").mkdir(exist_ok=True)

    def one(numbered):
        index, (module, name) = numbered
        file = tree / "reached" / str(index)
        file.write_bytes(bytes(4096))
        start = time.monotonic()
        code, out = run_tests(tree, f"cover-{index % jobs}" if jobs == 1 else f"cover-{index}", module, [name], -1, 600, file)
        seconds = time.monotonic() - start
        bytes_ = file.read_bytes()
        file.unlink()
        subprocess.run(["rm", "-rf", tree / "workers" / f"cover-{index}"])
        if code != 0:
            print(f"left out: {module}:{name} ({code})", flush=True)
        return dict(module=module, name=name, seconds=seconds, passes=code == 0,
                    reaches=[i for i, b in enumerate(bytes_) if b & 1], void=[i for i, b in enumerate(bytes_) if b == 2])

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        tests = list(pool.map(one, enumerate(work)))
    tests = (json.loads(path.read_text()) if path.exists() else []) + tests
    path.write_text(json.dumps(tests))
    void = {i for t in tests for i in t["void"]} - {i for t in tests for i in t["reaches"]}
    mutants = load(tree)
    reached = {i for t in tests for i in t["reaches"]}
    for mutant in mutants:
        if mutant["state"] in ("planted", "void"):  # no other operator compiles, or it is computed at compile time
            nothing = mutant["id"] in void or mutant["constant"] and mutant["id"] not in reached
            mutant["state"] = "void" if nothing else "planted"
    save(tree, mutants)


def order_of(module):
    at = ROOMS.index(module)
    return [module] + ROOMS[at + 1:] + ROOMS[:at]


def run(tree, modules, jobs, count, most_seconds, again):
    mutants, tests = load(tree), json.loads((tree / "tests.json").read_text())
    results = tree / "results.jsonl"
    lines = results.read_text().splitlines() if results.exists() else []
    shown = {}  # tests that do not run again on survivors
    if again:
        shown = {r["id"]: set(r["shown"]) for r in map(json.loads, lines) if not r["caught"]}
        lines = [line for line in lines if json.loads(line)["caught"]]
    known = {json.loads(line)["id"] for line in lines}
    left = collections.Counter()
    work = []
    for mutant in mutants:
        if mutant["state"] == "planted" and left[mutant["module"]] < count:
            left[mutant["module"]] += 1
            if mutant["id"] not in known and (not modules or mutant["module"] in modules):
                work.append(mutant)

    def one(mutant):
        worker = f"run-{mutant['id']}"
        result = dict(id=mutant["id"], caught=None, complete=True, shown=sorted(shown.get(mutant["id"], ())))
        spent = 0
        for module in order_of(mutant["module"]):
            reaching = sorted((t for t in tests if t["module"] == module and t["passes"] and mutant["id"] in t["reaches"]
                               and f"{module}:{t['name']}" not in shown.get(mutant["id"], ())), key=lambda t: t["seconds"])
            while reaching and not result["caught"]:
                if spent > most_seconds:
                    result["complete"] = False
                    break
                several, seconds = [], 0  # the shortest first, several at a time
                while reaching and (not several or seconds + reaching[0]["seconds"] < 5):
                    several.append(reaching.pop(0))
                    seconds += several[-1]["seconds"]
                spent += seconds
                result["shown"] += [f"{module}:{test['name']}" for test in several]
                caught = fault(tree, worker, module, several, mutant["id"])
                result["caught"] = caught and f"{module}:{caught}"
            if result["caught"]:
                break
        subprocess.run(["rm", "-rf", tree / "workers" / worker])
        with open(results, "a") as file:
            file.write(json.dumps(result) + "\n")

    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, work))
    report(tree)


def report(tree):
    mutants = {m["id"]: m for m in load(tree)}
    lines = (tree / "results.jsonl").read_text().splitlines()
    results = list({r["id"]: r for r in map(json.loads, lines)}.values())  # the last of each
    results = [r for r in results if mutants[r["id"]]["state"] == "planted"]
    for module in ROOMS:
        of_module = [r for r in results if mutants[r["id"]]["module"] == module]
        if not of_module:
            continue
        caught = [r for r in of_module if r["caught"]]
        own = [r for r in caught if r["caught"].startswith(module + ":")]
        print(f"{module}: {len(caught)} of {len(of_module)} caught, {len(own)} by the module's own tests")
    for r in sorted(results, key=lambda r: (mutants[r["id"]]["file"], mutants[r["id"]]["line"])):
        m = mutants[r["id"]]
        if not r["caught"]:
            line = m["original"]
            print(f"{m['file']}:{m['line']}: mutant {m['id']}, {m['what']}, {len(r['shown'])} tests"
                  + ("" if r["complete"] else " (not all)"))
            print("    " + line[:m["start"]].lstrip() + "⟦" + line[m["start"]:m["end"]] + "⟧" + line[m["end"]:])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("step", choices=["plant", "build", "cover", "run", "report"])
    parser.add_argument("tree", type=pathlib.Path)
    parser.add_argument("modules", nargs="*", help="to plant in, or whose tests cover runs or whose mutants run shows (all)")
    parser.add_argument("--count", type=int, default=100, help="mutants a module")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=60, help="of tests that run shows a mutant at most, by what they take without")
    parser.add_argument("--again", action="store_true", help="run: show survivors the tests that they have not been shown")
    options = parser.parse_args()
    tree = options.tree.resolve()
    match options.step:
        case "plant": plant(tree, options.modules, options.count * 3 // 2, options.seed)
        case "build": build(tree, options.jobs)
        case "cover": cover(tree, options.modules, options.jobs)
        case "run": run(tree, options.modules, options.jobs, options.count, options.seconds, options.again)
        case "report": report(tree)


main()
