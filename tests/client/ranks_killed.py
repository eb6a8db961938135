#!/usr/bin/env python3
"""ranks_killed.py PROGRAMS SCENES: kills ranks of a server at random moments and starts it again on other numbers of ranks. The client that
watches must end with the file of an undisturbed solve, and the launcher must name the rank that was lost."""

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
  def __init__(self, folder, ranks):
    self.socket = f"unix:{folder}/sock"
    self.said = open(folder / "said", "w+")
    self.launcher = subprocess.Popen(
        ["mpirun", "--oversubscribe", "-n", str(ranks), PROGRAMS / "alvord", "--listen", self.socket, "--data", folder / "data",
         "--checkpoint-interval", "0.3"], env=os.environ | AS_ROOT, stdout=self.said, stderr=subprocess.STDOUT)
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


def main():
  seed = int(os.environ.get("SEED", "1"))
  chance = random.Random(seed)
  with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    subprocess.run([*SOLVE, "-o", folder / "undisturbed.glb"], check=True)
    server = Server(folder, 2)
    client = subprocess.Popen([*SOLVE, "-o", folder / "watched.glb", "--server", server.socket])
    for ranks in (3, 1, 2):
      seen = until("the solve goes on", lambda: max(server.rays(), default=0))
      until("it found more", lambda: client.poll() is not None or max(server.rays(), default=0) > seen)
      time.sleep(chance.uniform(0, 0.5))
      if client.poll() is not None:
        break
      server.lose_a_rank(chance.randrange(len(server.ranks())))
      server = Server(folder, ranks)
    assert client.wait(MOST_SECONDS) == 0
    server.stop()
    assert (folder / "watched.glb").read_bytes() == (folder / "undisturbed.glb").read_bytes(), f"the file differs (seed {seed})"
    print("the watcher's file is that of an undisturbed solve")


main()
