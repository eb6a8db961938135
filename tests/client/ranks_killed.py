#!/usr/bin/env python3
"""ranks_killed.py PROGRAMS SCENES: kills ranks of a server at random moments and starts it again on other numbers of ranks, with one solve on
all of them and with two on gangs. Clients that watch must end with the files of undisturbed solves, and the launcher must name the rank that
was lost."""

import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

PROGRAMS, SCENES = map(pathlib.Path, sys.argv[1:])
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
SOLVE = [PROGRAMS / "alvor", "solve", SCENES / "furnished_room.obj", "--tolerance", "0.025", "--quiet"]
MOST_SECONDS = 60  # for anything that is waited for


def until(what, condition):
  end = time.monotonic() + MOST_SECONDS
  while time.monotonic() < end:
    found = condition()
    if found:
      return found
    time.sleep(0.02)
  sys.exit(f"{what}: not within {MOST_SECONDS} s")


class Server:
  def __init__(self, folder, ranks, *options):
    self.socket = f"unix:{folder}/sock"
    self.said = open(folder / "said", "w+")
    self.launcher = subprocess.Popen(
        ["mpirun", "--oversubscribe", "-n", str(ranks), PROGRAMS / "alvord", "--listen", self.socket, "--data", folder / "data",
         "--checkpoint-interval", "0.3", *options], env=os.environ | AS_ROOT, stdout=self.said, stderr=subprocess.STDOUT)
    until("the server listens", lambda: "listening on" in self.text())

  def text(self):
    return pathlib.Path(self.said.name).read_text()

  def ranks(self):
    children = subprocess.run(["pgrep", "-P", str(self.launcher.pid)], capture_output=True, text=True).stdout.split()
    return [int(child) for child in children]

  def rays(self):
    listed = subprocess.run([PROGRAMS / "alvor", "solves", "list", "--json", "--server", self.socket], capture_output=True, text=True)
    return [each["rays"] for each in json.loads(listed.stdout)] if listed.returncode == 0 else []

  def lose_a_rank(self, number):
    os.kill(self.ranks()[number], signal.SIGKILL)
    begun = time.monotonic()
    status = self.launcher.wait(MOST_SECONDS)
    took = time.monotonic() - begun
    lines = [line for line in self.text().splitlines() if "noticed that process rank" in line]
    assert status != 0 and took < 15, (status, took)
    assert len(lines) == 1 and "exited on signal 9" in lines[0], self.text()
    print(f"killed: {lines[0].strip()}; the job ended after {took:.1f} s")

  def stop(self):
    os.kill(min(self.ranks()), signal.SIGTERM)
    self.launcher.wait(MOST_SECONDS)


class Watched:
  """A solve of a client's, and the file that it must come to."""

  def __init__(self, folder, server, seed):
    self.undisturbed, self.watched = folder / f"undisturbed{seed}.glb", folder / f"watched{seed}.glb"
    line = [*SOLVE, "--seed", str(seed)]
    subprocess.run([*line, "-o", self.undisturbed], check=True)
    self.client = subprocess.Popen([*line, "-o", self.watched, "--server", server.socket])

  def goes_on(self):
    return self.client.poll() is None

  def check(self):
    assert self.client.wait(MOST_SECONDS) == 0
    assert self.watched.read_bytes() == self.undisturbed.read_bytes(), f"{self.watched.name} differs"


def on_all_ranks(folder, chance):
  server = Server(folder, 2, "--gang", "4")
  solve = Watched(folder, server, 1)
  for ranks in (3, 1, 2):
    seen = until("the solve goes on", lambda: max(server.rays(), default=0))
    until("it found more", lambda: not solve.goes_on() or max(server.rays(), default=0) > seen)
    time.sleep(chance.uniform(0, 0.5))
    if not solve.goes_on():
      break
    server.lose_a_rank(chance.randrange(len(server.ranks())))
    server = Server(folder, ranks, "--gang", "4")
  solve.check()
  server.stop()
  print("the watcher's file is that of an undisturbed solve")


def on_gangs(folder, chance):
  server = Server(folder, 4, "--gang", "2")
  solves = [Watched(folder, server, seed) for seed in (2, 3)]
  until("both solves go on at once", lambda: len([rays for rays in server.rays() if rays > 0]) == 2 or not solves[1].goes_on())
  server.lose_a_rank(chance.randrange(4))
  server = Server(folder, 3, "--gang", "1")
  for solve in solves:
    solve.check()
  server.stop()
  print("the files of two solves on gangs are those of undisturbed solves")


def main():
  seed = int(os.environ.get("SEED", "1"))
  chance = random.Random(seed)
  print(f"seed {seed}")
  for scenario in (on_all_ranks, on_gangs):
    with tempfile.TemporaryDirectory() as name:
      scenario(pathlib.Path(name), chance)


main()
