"""Work that one caller imposes on all: a scene that takes long to build."""

import threading
import time

from attack import attack
from calls import Caller, health, nearly_collinear_polygons, outcome, room, scenes
from target import Target

FAMILY = "long work"
POLYGONS, CORNERS = 20, 5000


def slowest_of(calls, end, is_over):
  """The longest seconds of each call by its name, again and again until is_over() or the time is over."""
  slowest = dict.fromkeys(calls, 0.0)
  while time.monotonic() < end and not is_over():
    for name, call in calls.items():
      begin = time.monotonic()
      status = call()
      slowest[name] = max(slowest[name], time.monotonic() - begin)
      assert status in ("OK", True), f"{name}: {status}"
    time.sleep(0.05)
  return slowest


def disturb(target, works):
  """Does works, each in a thread, and meanwhile what others do. Returns what was seen."""
  other = Caller(target, "cleo")
  scene = other.create_scene(room()).name
  shifts = iter(range(1, 10000))
  threads = [threading.Thread(target=work, daemon=True) for work in works]
  begin = time.monotonic()
  for each in threads:
    each.start()
  time.sleep(0.2)
  slowest = slowest_of({
      "health": lambda: health(target)[0],
      "GetScene": lambda: outcome(other.GetScene, scenes.GetSceneRequest(name=scene))[0],
      "CreateScene": lambda: outcome(other.create_scene, room(0.001 * next(shifts)))[0],
  }, begin + 20, lambda: not any(each.is_alive() for each in threads))
  seen = f"{time.monotonic() - begin:.1f} s of work; slowest " + ", ".join(f"{name} {1000 * s:.0f} ms" for name, s in slowest.items())
  assert slowest["health"] < 0.5 and slowest["GetScene"] < 1 and slowest["CreateScene"] < 5, seen
  return seen


@attack(FAMILY)
def polygons_of_many_corners(target, seconds):
  """While 20 polygons of 5 000 nearly collinear corners are built, health answers at once, and others' calls within seconds."""
  caller, chunks = Caller(target), nearly_collinear_polygons(POLYGONS, CORNERS)
  return disturb(target, [lambda: outcome(caller.create_scene, chunks, 60)])


def stored_scene(folder):
  """Puts a data directory into the folder with a scene of eight such polygons, which the next server must load."""
  target = Target(folder, options=("--data", folder / "data"))
  try:
    outcome(Caller(target, "ali").create_scene, nearly_collinear_polygons(8, CORNERS), 25)
    target.alvord.terminate()
  finally:
    target.close()


@attack(FAMILY, ("--data", "{folder}/data"), prepare=stored_scene)
def meshes_of_many_corners(target, seconds):
  """Nor do four readers of such a scene's mesh, which is loaded from the disk, keep others waiting."""
  callers = [Caller(target) for _ in range(4)]
  stored = callers[0].ListScenes(scenes.ListScenesRequest()).scenes
  if not stored:
    return "such a scene is refused"
  read = lambda caller: outcome(caller.ReadMesh, scenes.ReadMeshRequest(name=stored[0].name), 60)
  return disturb(target, [lambda caller=caller: read(caller) for caller in callers])
