#!/usr/bin/env python3
"""Measures what happens when a constant of the solver is halved or doubled, and writes docs/design/constants.md.

Run it in a clean checkout whose release build exists: it changes one constant in its source file, builds `alvor`, solves a
few scenes, compares them with a path-traced truth, and changes the constant back. It takes one to two hours on one core. `--page` only writes the page from the results.
"""

import argparse
import csv
import json
import math
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
ALVOR = ROOT / "build/release/bin/alvor"
# Name of the run, scene, and the options of `alvor solve`. The last runs take the code paths that the default strategy does not.
RUNS = [
    ("Cornell box", "scenes/cornell_box.obj", ["--tolerance", "0.015"]),
    ("furnished room", "scenes/furnished_room.obj", ["--tolerance", "0.05"]),
    ("enfilade", "scenes/enfilade.obj", ["--tolerance", "0.04"]),
    ("slats", "scenes/slats_and_boxes.obj", ["--tolerance", "0.05"]),
    ("office, 40 lamps", "{out}/office.obj", ["--tolerance", "0.1", "--max-elements", "40000"]),
    ("analytic", "scenes/cornell_box.obj", ["--form-factors", "analytic", "--max-depth", "2"]),
    ("overshoot", "scenes/cornell_box.obj", ["--strategy", "overshoot", "--tolerance", "0.03"]),
]
SEEDS = (1, 2, 3, 4, 5)
DECLARATION = re.compile(r"\b(\w+) = ([^,;]+)(?=[,;])")
# Constants that are a distance from 1: this distance is halved and doubled.
NEAR_ONE = {"short_of_face", "same_direction", "same_surface", "worth_going_on", "marked_share", "publish_when"}


def constants():
    """Yields (file, name, value) of constants whose comment, or own line, names constants.md."""
    for path in sorted((ROOT / "radiosity").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        is_marked = False
        for line in path.read_text().splitlines():
            is_marked |= "constants.md" in line
            if is_marked and "constexpr" in line:
                for name, value in DECLARATION.findall(line.split("//")[0]):
                    yield path, name, value.strip()
                is_marked = False


def changed(name, value, factor):
    if name in NEAR_ONE:
        return f"(1 - {factor} * (1 - ({value})))"
    if re.fullmatch(r"[\d']+", value):
        return str(max(1, math.ceil(int(value.replace("'", "")) * factor)))
    kind = ".0f" if value.endswith("f") and factor == 2 else "f" if value.endswith("f") else ""
    return f"({value} * {factor}{kind})" if "rays_per_row" not in value else f"({value} * {int(factor * 4)} / 4)"


def truths(out):
    """The truth at 1500 points of each scene: lines of `alvor verify --csv`."""
    found = {}
    for _, scene, options in RUNS:
        scene = scene.format(out=out)
        if scene in found:
            continue
        table = out / (pathlib.Path(scene).stem + ".csv")
        if not table.exists():
            solution = out / "first.glb"
            run([ALVOR, "solve", scene, "-q", "--tolerance", "0.2", "-o", solution])
            run([ALVOR, "verify", scene, solution, "-q", "--points", "1500", "--paths", "4000", "--csv", table])
        found[scene] = list(csv.DictReader(table.open()))
        points = [",".join(row[k] for k in ("x", "y", "z", "nx", "ny", "nz")) for row in found[scene]]
        (out / (pathlib.Path(scene).stem + ".points.csv")).write_text("\n".join(points) + "\n")
    return found


def run(words):
    return subprocess.run([str(word) for word in words], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def measure(out, truth, scene, options, seed):
    """nRMSE against the truth, and rays, of one solve."""
    scene = scene.format(out=out)
    solution, found = out / "solution.glb", out / "found.csv"
    told = json.loads(run([ALVOR, "solve", scene, "-q", "--json", "--threads", "1", "--seed", str(seed), "-o", solution, *options]))
    run([ALVOR, "probe", solution, "--points", out / (pathlib.Path(scene).stem + ".points.csv"), "-o", found, "-q"])
    squares = total = count = 0
    for row, true in zip(csv.DictReader(found.open()), truth[scene]):
        h = sum(float(row["irradiance_" + band]) for band in "rgb") / 3
        t = sum(float(true["truth_" + band]) for band in "rgb") / 3
        noise = sum(float(true["standard_error_" + band]) for band in "rgb") / 3
        if not math.isfinite(h) or t == 0:  # no light comes under or into solids
            continue
        squares += (h - t) ** 2 - noise**2
        total += t
        count += 1
    return {"error": math.sqrt(max(squares, 0) / count) / (total / count), "rays": told["rays"]}


def all_runs(out, truth, seed):
    return {name: measure(out, truth, scene, options, seed) for name, scene, options in RUNS}


def build(*targets):
    subprocess.run(["cmake", "--build", "--preset", "release", "--target", *targets], cwd=ROOT, check=True, capture_output=True)


def ratios(one, base):
    """Geometric means over the runs of error and rays, each over those of `base`."""
    return [math.exp(sum(math.log(one[r][what] / base[r][what]) for r in base) / len(base)) for what in ("error", "rays")]


def percent(ratio):
    return "same" if abs(ratio - 1) < 0.005 else f"{100 * (ratio - 1):+.0f} %"


def effects(known):
    """(file, name, value) -> {factor: (error ratio, rays ratio), or None where not a bit changed}, and the spread of single seeds."""
    seeds = [known[f"seed {seed}"] for seed in SEEDS]
    mean = {r: {what: sum(s[r][what] for s in seeds) / len(seeds) for what in ("error", "rays")} for r in seeds[0]}
    spread = [math.sqrt(sum((ratios(s, mean)[k] - 1) ** 2 for s in seeds) / (len(seeds) - 1)) for k in (0, 1)]
    found = {}
    for key, one in known.items():
        if key.startswith("seed"):
            continue
        path, name, factor = key.split()
        same = all(one[r][what] == seeds[0][r][what] for r in seeds[0] for what in ("error", "rays"))
        found.setdefault((path, name, one["value"]), {})[factor] = None if same else ratios(one, seeds[0])
    return found, spread


def page(known):
    found, spread = effects(known)
    lines = ["# Constants, halved and doubled", "",
             "`bench/constants/measure.py` writes this page. It halves and doubles each constant of `radiosity` that was chosen and not",
             "derived (for numbers near 1: their distance from 1), solves seven cases again, and compares them with path-traced truths: "
             + ", ".join(f"{name} (`{' '.join(options)}`)" for name, _, options in RUNS) + ".",
             "Columns are the true error and the rays, each a geometric mean over the seven cases, relative to the unchanged constant with the same seed.",
             f"Other seeds differ from each other by {100 * spread[0]:.0f} % in error and {100 * spread[1]:.0f} % in rays (standard deviation), so "
             "changes of that size mean nothing.", "",
             "| constant | file | value | halved: error, rays | doubled: error, rays |", "|---|---|---|---|---|"]
    quiet = []
    for (path, name, value), by in sorted(found.items()):
        if all(effect is None for effect in by.values()):
            quiet.append(f"`{name}` ({path})")
            continue
        cells = ["same" if by.get(f) is None else f"{percent(by[f][0])}, {percent(by[f][1])}" for f in ("0.5", "2")]
        lines.append(f"| `{name}` | `{path}` | {value} | {cells[0]} | {cells[1]} |")
    lines += ["", "## Without any effect", "",
              "Halved or doubled, these change not one bit of the seven solutions, because they only bound work, group work for threads, pace what is",
              "shown, or guard against rounding that does not occur there:", "", ", ".join(quiet) + "."]
    (ROOT / "docs/design/constants.md").write_text("\n".join(lines) + "\n")


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--out", type=pathlib.Path, default=ROOT / "out/constants")
    options.add_argument("--only", help="regular expression of names")
    options.add_argument("--list", action="store_true", help="print the constants and the changes")
    options.add_argument("--page", action="store_true", help="write the page from the results in --out")
    asked = options.parse_args()
    found = [c for c in constants() if not asked.only or re.search(asked.only, c[1])]
    if asked.list:
        for path, name, value in found:
            print(path.relative_to(ROOT), name, value, changed(name, value, 0.5), changed(name, value, 2))
        return
    if asked.page:
        return page(json.loads((asked.out / "results.json").read_text()))
    out = asked.out
    out.mkdir(parents=True, exist_ok=True)
    build("alvor", "office_block")
    run([ROOT / "build/release/bin/office_block", "--faces", "3000", "--lamps-per-1000-faces", "14", "-o", out / "office.obj"])
    truth = truths(out)
    results = out / "results.json"
    known = json.loads(results.read_text()) if results.exists() else {}
    for seed in SEEDS:
        if f"seed {seed}" not in known:
            known[f"seed {seed}"] = all_runs(out, truth, seed)
            results.write_text(json.dumps(known, indent=1))
    for path, name, value in found:
        for factor in (0.5, 2):
            key = f"{path.relative_to(ROOT)} {name} {factor}"
            if key in known:
                continue
            text = path.read_text()
            pattern = re.compile(rf"(constexpr[^;]*\b{name} = ){re.escape(value)}")
            new, times = pattern.subn(lambda m: m.group(1) + changed(name, value, factor), text, count=1)
            if times != 1:
                print("not found:", key)
                continue
            path.write_text(new)
            try:
                build("alvor")
                known[key] = {"value": value, **all_runs(out, truth, 1)}
            except subprocess.CalledProcessError as fault:
                sys.exit(f"{key}: {fault}")
            finally:
                path.write_text(text)
            results.write_text(json.dumps(known, indent=1))
            print(key, "done", flush=True)
    build("alvor")
    page(known)


if __name__ == "__main__":
    main()
