"""Measures what alvord takes by gRPC: calls next to a solve, 1 000 connections, 500 watches, 100 000 stored scenes. Prints a table in Markdown. Run by
scripts/load.sh; callers share the machine with alvord."""

import json
import pathlib
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import types

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/hostile"))

from machine import allow_many_descriptors, until
from target import Target, make_secrets, make_stubs

SECONDS = 5
PROCESSES, THREADS = 2, 8
CONNECTIONS, WATCHES, SCENES = 1000, 500, 100_000
stubs = None  # the folder of Python's messages of the API
BUSY = dict(tolerance=1e-9, max_elements=2_000_000)  # a solve that does not end meanwhile


def rows():
  """Yields (what, figure)."""
  from calls import Caller, outcome, room, scenes, solves
  with tempfile.TemporaryDirectory(prefix="alvor-load-") as name:
    folder = pathlib.Path(name)
    make_secrets(folder)
    with Served(folder) as target:
      caller = Caller(target)
      scene = caller.create_scene(room()).name
      yield "GetScene, nothing else running", spoken(calls_of_processes(target, scene))
      caller.create_solve(scene, **BUSY)
      yield "GetScene next to a solve of all cores", spoken(calls_of_processes(target, scene))
    with Served(folder, "--max-connections", str(2 * CONNECTIONS)) as target:
      caller = Caller(target)
      scene = caller.create_scene(room()).name
      before, begin = target.alvord.rss(), time.monotonic()
      crowd = [Caller(target) for _ in range(CONNECTIONS)]
      assert all(outcome(each.GetScene, scenes.GetSceneRequest(name=scene))[0] == "OK" for each in crowd)
      took = time.monotonic() - begin
      yield (f"{CONNECTIONS} connections with TLS",
             f"{took:.1f} s to open and call once, {(target.alvord.rss() - before) * 1024 / CONNECTIONS:.0f} KB each; "
             f"meanwhile {spoken(calls_of_processes(target, scene))}")
      for each in crowd:
        each.close()
    with Served(folder) as target:
      yield f"{WATCHES} watches of one solve over 25 connections, display detail", watched(target, Caller, room, solves)
    yield from stored(folder, Caller, room, scenes)


class Served:
  """An alvord with a data directory of its own, in a with statement."""

  def __init__(self, folder, *options):
    self.target = Target(folder, options=("--data", folder / f"data{time.monotonic_ns()}", *options))

  def __enter__(self):
    return self.target

  def __exit__(self, *_):
    self.target.close()


def calls_of_processes(target, scene):
  """Returns the seconds of each call, by PROCESSES of THREADS, a connection each process, for SECONDS."""
  command = [sys.executable, "-B", __file__, str(stubs), str(target.calls[1]), str(target.certificate), scene]
  running = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(PROCESSES)]
  return sum((json.loads(each.communicate()[0]) for each in running), [])


def calls_of_threads(target, scene):
  """Returns the seconds of each call, of this process."""
  from calls import Caller, scenes
  caller, times, end = Caller(target), [], time.monotonic() + SECONDS

  def call():
    while time.monotonic() < end:
      begin = time.monotonic()
      caller.GetScene(scenes.GetSceneRequest(name=scene), 30)
      times.append(time.monotonic() - begin)

  threads = [threading.Thread(target=call) for _ in range(THREADS)]
  for thread in threads:
    thread.start()
  for thread in threads:
    thread.join()
  return times


def be_one_process(folder, port, certificate, scene):
  sys.path.insert(0, folder)
  target = types.SimpleNamespace(calls=("localhost", int(port)), certificate=pathlib.Path(certificate))
  print(json.dumps(calls_of_threads(target, scene)))


def spoken(times):
  times = sorted(times)
  return f"{len(times) / SECONDS:.0f} calls/s, half within {1e3 * times[len(times) // 2]:.1f} ms, 99 % within {1e3 * times[int(0.99 * len(times))]:.1f} ms"


def watched(target, Caller, room, solves):
  caller = Caller(target)
  solve = caller.create_solve(caller.create_scene(room()).name, **{**BUSY, "max_elements": 20000}, threads=1).name
  before, frames, watches = target.alvord.rss(), [0] * WATCHES, []

  def read(number, watch):
    for _ in watch:
      frames[number] += 1

  callers = [Caller(target) for _ in range(25)]
  for number in range(WATCHES):
    watch = callers[number % 25].WatchSolve(solves.WatchSolveRequest(name=solve, detail=solves.DETAIL_DISPLAY), 60)
    watches.append(watch)
    threading.Thread(target=lambda n=number, w=watch: attempt(lambda: read(n, w)), daemon=True).start()
  begin = time.monotonic()
  until(lambda: min(frames) > 0, 60, "each watch has a frame")
  return f"each had its first frame after {time.monotonic() - begin:.1f} s, {(target.alvord.rss() - before) * 1024 / WATCHES:.0f} KB each"


def attempt(call):
  import grpc
  try:
    call()
  except grpc.RpcError:
    pass


def stored(folder, Caller, room, scenes):
  data = ("--data", folder / "many", "--quota-scenes", str(2 * SCENES))
  target = Target(folder, options=data)
  Caller(target).create_scene(room())
  target.alvord.terminate()
  target.close()
  copy_scene(folder / "many/alvor.db", scenes)
  begin = time.monotonic()
  target = Target(folder, options=data)
  try:
    caller = Caller(target)
    names = caller.ListScenes(scenes.ListScenesRequest(page_size=10))
    yield f"{SCENES} stored scenes: start", f"{time.monotonic() - begin:.1f} s until the first page of a list, {target.alvord.rss():.0f} MB"
    yield f"{SCENES} stored scenes: GetScene", spoken(calls_of_processes(target, names.scenes[-1].name))
    yield f"{SCENES} stored scenes: a page of 1 000", slowest(lambda: caller.ListScenes(scenes.ListScenesRequest(page_size=1000)))
    yield f"{SCENES} stored scenes: CreateScene", slowest(lambda: caller.create_scene(room(time.monotonic() % 1)))
  finally:
    target.close()


def slowest(call):
  times = []
  for _ in range(20):
    begin = time.monotonic()
    call()
    times.append(time.monotonic() - begin)
  return f"half within {1e3 * sorted(times)[10]:.0f} ms, slowest {1e3 * max(times):.0f} ms"


def copy_scene(file, scenes):
  with sqlite3.connect(file) as database:
    number, tenant, sha256, facts = database.execute("SELECT number, tenant, sha256, facts FROM scenes").fetchone()
    version, facts = facts[:2], facts[2:]  # server/archive/versioned.h
    scene = scenes.Scene.FromString(facts)
    for copy in range(number + 1, number + SCENES):
      scene.name = f"scenes/s{copy:016x}"
      database.execute("INSERT INTO scenes VALUES (?, ?, '', ?, ?)", (copy, tenant, sha256, version + scene.SerializeToString()))
  database.close()


def main():
  global stubs
  allow_many_descriptors()
  with tempfile.TemporaryDirectory(prefix="alvor-stubs-") as stubs:
    make_stubs(pathlib.Path(stubs))
    print("| load | measured |\n|---|---|")
    for what, figure in rows():
      print(f"| {what} | {figure} |", flush=True)


if __name__ == "__main__":
  be_one_process(*sys.argv[1:]) if len(sys.argv) > 1 else main()
