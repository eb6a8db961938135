#!/usr/bin/env python3
"""Measures solves on several ranks of this machine and writes docs/ranks.md: for scripts/ranks.sh."""

import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build/release/bin"
OUT = ROOT / "out/ranks"
BANDWIDTH, LATENCY_S = 25e9 / 8, 10e-6  # of the modelled network: bytes a second, and of one message
REPEATS = 3
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def solve(ranks, threads, scene, *options):
  launcher = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
  line = [*launcher, BIN / "ranks_bench", scene, "--threads", str(threads), *options]
  print(*line[-6:], f"on {ranks} ranks", file=sys.stderr, flush=True)
  return json.loads(subprocess.run(line, check=True, capture_output=True, text=True, env=os.environ | AS_ROOT).stdout)


def median(runs):
  """The run of the median wall time."""
  return sorted(runs, key=lambda run: run["wall_s"])[len(runs) // 2]


def largest(run):
  return max(share["largest_mb"] for share in run["shares"])


def received(run):
  return statistics.mean(share["bytes_received"] for share in run["shares"])


def office(faces):
  file = OUT / f"office_{faces}.obj"
  if not file.exists():
    subprocess.run([BIN / "office_block", "--faces", str(faces), "-o", file], check=True, capture_output=True)
  return file


def table(head, rows):
  return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(row) + " |" for row in rows)])


def verdict(is_met):
  return "met" if is_met else "**missed**"


class Model:
  """The time of a solve on n ranks of one thread, from a solve on two: work that is dealt falls to 1/n, the rest stays, and what ranks tell
  each other comes by rings (bytes) and trees (messages)."""

  def __init__(self, two):
    work = [share["work_s"] for share in two["shares"]]
    self.work = sum(work)
    # The rank that waited least was the last: what it spent in collectives is what they cost.
    self.replicated = two["wall_s"] - max(work) - min(share["collectives_s"] for share in two["shares"])
    self.bytes = 2 * received(two)
    self.collectives = two["shares"][0]["collectives"]

  def network(self, n):
    return self.bytes * (n - 1) / n / BANDWIDTH + self.collectives * LATENCY_S * math.ceil(math.log2(n))

  def time(self, n):
    return self.replicated + self.work / n + self.network(n)

  def efficiency(self, n):
    return (self.replicated + self.work) / (n * self.time(n))


def compare(name, scene, *options):
  """One process with two threads, and one to four ranks of one thread."""
  threads = median([solve(1, 2, scene, *options) for _ in range(REPEATS)])
  one = solve(1, 1, scene, *options)
  two = median([solve(2, 1, scene, *options) for _ in range(REPEATS)])
  more = [solve(n, 1, scene, *options) for n in (3, 4)]
  for run in (one, two, *more):
    assert run["solution"] == threads["solution"], f"{name}: {run['ranks']} ranks found another solution"
  return name, threads, [one, two, *more]


def comparison(name, threads, runs):
  rows = []
  for label, run in [("1, two threads", threads), *((str(run["ranks"]), run) for run in runs)]:
    mb = received(run) / 1e6
    rows.append([label, f"{run['wall_s']:.2f}", f"{run['cpu_s']:.2f}", f"{largest(run):.0f}", f"{mb:.0f}" if mb else "-",
                 f"{received(run) / run['leaves']:.0f}" if mb else "-", str(run["shares"][0]["collectives"] or "-")])
  ratio = runs[1]["wall_s"] / threads["wall_s"]
  return (f"### {name}\n\n{threads['faces']} faces, {threads['leaves']} leaves, {threads['rays'] / 1e6:.0f} M rays; "
          f"estimated error {100 * threads['estimated_error']:.1f} %, {threads['ended']}. All runs found the same bytes. Two ranks of one thread take "
          f"**{ratio:.2f}** times the wall time of one process with two threads: {verdict(ratio <= 1.1)} (at most 1.1).\n\n" +
          table(["ranks", "wall s", "CPU s", "largest memory of a rank, MB", "received by a rank, MB", "bytes a leaf", "collectives"], rows))


def cluster(title, two):
  model = Model(two)
  rows = [[str(n), f"{model.time(n):.1f}", f"{model.work / n:.2f}", f"{model.network(n):.2f}", f"{100 * model.efficiency(n):.0f} %"]
          for n in (1, 2, 8, 32, 128)]
  share = model.replicated / (model.replicated + model.work)
  return (f"### {title}\n\n{two['faces']} faces, {two['leaves']} leaves, {two['rays'] / 1e6:.0f} M rays. Work that every rank does itself takes "
          f"{model.replicated:.1f} s, {100 * share:.0f} % of a solve on one rank.\n\n" +
          table(["ranks", "time, s", "of it dealt work", "of it network", "efficiency"], rows)), model


def first_light_of(faces, ranks):
  return solve(ranks, 1, office(faces), "--tolerance", "0.5", "--max-depth", "0", "--max-elements", "5000000")


def many_faces(run, model):
  """A solve of more faces than one process would like to hold, and what ten million would take on four machines."""
  largest_gb = [share["largest_mb"] / 1e3 for share in run["shares"]]
  times = 1e7 / 1e6  # the model is of a million faces
  machine_gb = max(largest_gb) * 1e7 / run["faces"]
  return (f"{run['faces'] / 1e6:.1f} million faces, each one leaf, solved to first light and gathered once on {run['ranks']} ranks of this machine: "
          f"{run['wall_s']:.0f} s, {run['rays'] / 1e6:.0f} M rays, {sum(largest_gb):.1f} GB in all ranks together (at most {max(largest_gb):.1f} in "
          f"one): {verdict(sum(largest_gb) <= 24)} (24 GB).\n\nTen million on four machines with one rank each would take {machine_gb:.0f} GB a machine, "
          f"{model.work * times / 4:.0f} s of dealt and {model.replicated * times:.0f} s of repeated work on one thread; threads divide the first and "
          f"some of the second. A rank would receive {received(run) * 1e7 / run['faces'] / 1e9:.0f} GB, which take "
          f"{received(run) * 1e7 / run['faces'] / BANDWIDTH:.0f} s.")


def main():
  OUT.mkdir(parents=True, exist_ok=True)
  furnished = compare("Furnished room at 3 %", ROOT / "scenes/furnished_room.obj", "--tolerance", "0.03")
  middle = compare("Office block of 50 000 faces at 10 %", office(50_000), "--tolerance", "0.1")
  first_light = first_light_of(1_000_000, 2)
  huge = first_light_of(2_500_000, 4)
  small, _ = cluster("Office block of 50 000 faces at 10 %", middle[2][1])
  large, model_large = cluster("Office block of a million faces, each face one leaf", first_light)
  print(f"""# Solving on several ranks

A solve can run as several processes, which MPI starts on one machine or many and numbers from 0: ranks ([cluster.md](cluster.md)). This page
shows what that costs and brings. `scripts/ranks.sh` measures it and writes this page. This run was on two cores of one server, with all ranks
on it.

## Beside threads

A rank of one thread does what a thread does, and has to tell the others what it found. The hits of rows are divided among the ranks; all else
of the scene and the solution is on each.

{comparison(*furnished)}

{comparison(*middle)}

With more ranks than cores, ranks take turns, so three and four take longer here than two.

## Many faces

{many_faces(huge, model_large)}

## A simulated cluster

Times of n ranks with one thread each, as far as two ranks tell: work that is dealt falls to 1/n, work that every rank does itself stays, and the
network brings {BANDWIDTH * 8 / 1e9:.0f} Gbit/s, and {LATENCY_S * 1e6:.0f} us a message. Efficiency is the time of one rank over n times that
of n ranks. The aim is 70 % with 32 ranks: {verdict(model_large.efficiency(32) >= 0.7)}.

{small}

{large}

What limits it is not the network but what every rank does itself: the plan, the two forests and their neighbours, the vectors of the exchange
(conjugate residuals over all patches), the field's samples, marking and splitting. A finer solution has a smaller share of it than first light,
and ranks with several threads do part of it in parallel. To get to 70 % at 32 ranks it would have to be below
{100 / 32 * (1 / 0.7 - 1) * 32 / 31:.1f} % of a solve: the vectors of the exchange and the forests would have to be divided among the ranks, too.
""", file=open(ROOT / "docs/ranks.md", "w"), end="")


main()
