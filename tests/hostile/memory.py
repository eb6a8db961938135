"""Memory of solves that have ended: looked at once, or deleted."""

import shutil
import sqlite3
import time

from attack import attack
from calls import Caller, outcome, room, solves
from machine import LONGEST_WAIT, until
from target import Target

FAMILY = "memory"
COPIES = 200
LEAVES = 25000
PER_SOLVE = 0.8  # MB: 32 bytes a leaf
LITTLE = COPIES * PER_SOLVE / 4  # MB that may remain
KEPT = ("--data", "{folder}/data", "--memory-limit", "250M")
prepared = None  # a data directory with the solves


def many_ended_solves(folder):
  """Puts a data directory with one scene and COPIES + 1 ended solves into the folder. It is made once: one is solved, the rest are copies of its
  rows."""
  global prepared
  if prepared is None:
    target = Target(folder, options=("--data", folder / "data"))
    try:
      caller = Caller(target)
      scene = caller.create_scene(room()).name
      solve = caller.create_solve(scene, tolerance=1e-9, max_elements=LEAVES).name
      until(lambda: caller.state_of(solve) == "SUCCEEDED", LONGEST_WAIT, "the solve ends")
      target.alvord.terminate()
    finally:
      target.close()
    copy_solve(folder / "data/alvor.db")
    prepared = folder.parent / "ended_solves"
    shutil.copytree(folder / "data", prepared)
  else:
    shutil.copytree(prepared, folder / "data")


def copy_solve(file):
  with sqlite3.connect(file) as database:
    number, scene, tenant, facts = database.execute("SELECT number, scene, tenant, facts FROM solves").fetchone()
    version, facts = facts[:2], facts[2:]  # server/archive/versioned.h
    solve = solves.Solve.FromString(facts)
    parent = solve.name.split("/solves/")[0]
    for copy in range(number + 1, number + 1 + COPIES):
      solve.name = f"{parent}/solves/s{copy:016x}"
      database.execute("INSERT INTO solves(number, scene, tenant, request_id, facts) VALUES (?, ?, ?, '', ?)",
                       (copy, scene, tenant, version + solve.SerializeToString()))
      database.execute("INSERT INTO checkpoint_pieces SELECT ?, kind, n, bytes FROM checkpoint_pieces WHERE solve = ?", (copy, number))
  database.close()


def look_at_all(target, caller):
  """Opens a watch of each solve and leaves it at its first frame. Returns their names and the MB before."""
  made = [each.name for each in caller.ListSolves(solves.ListSolvesRequest(parent="scenes/-", page_size=1000)).solves]
  assert len(made) == COPIES + 1, f"{len(made)} solves"
  before = target.alvord.rss()
  for name in made:
    watch = caller.WatchSolve(solves.WatchSolveRequest(name=name, detail=solves.DETAIL_DISPLAY), 20)
    next(watch)
    watch.cancel()
  return made, before


def settled_rss(target, before):
  """The MB that alvord comes down to: less than LITTLE more than before, or the least that was seen in LONGEST_WAIT seconds."""
  least, end = target.alvord.rss(), time.monotonic() + LONGEST_WAIT
  while least - before >= LITTLE and time.monotonic() < end:
    time.sleep(0.2)
    least = min(least, target.alvord.rss())
  return least


def new_work(caller):
  """What a new scene and a solve of it are answered."""
  status, scene = outcome(caller.create_scene, room(0.3))
  return outcome(caller.create_solve, scene.name, max_elements=500)[0] if status == "OK" else f"{status} {scene}"


@attack(FAMILY, KEPT, prepare=many_ended_solves)
def looked_at_solves(target, seconds):
  """200 ended solves of 25 000 leaves take no memory once nobody watches them, and new work is taken."""
  caller = Caller(target)
  _, before = look_at_all(target, caller)
  after = settled_rss(target, before)
  seen = f"{before:.0f} MB before, {after:.0f} MB after each was looked at; new work: {new_work(caller)}"
  assert after - before < LITTLE and seen.endswith("OK"), seen
  return seen


@attack(FAMILY, KEPT, prepare=many_ended_solves)
def deleted_solves(target, seconds):
  """After 200 ended solves were looked at and deleted, their memory is free, and new work is taken."""
  caller = Caller(target)
  made, before = look_at_all(target, caller)
  looked_at = target.alvord.rss()
  for name in made:
    caller.DeleteSolve(solves.DeleteSolveRequest(name=name))
  after = settled_rss(target, before)
  seen = f"{before:.0f} MB before, {looked_at:.0f} MB looked at, {after:.0f} MB deleted; new work: {new_work(caller)}"
  assert after - before < LITTLE and seen.endswith("OK"), seen
  return seen
