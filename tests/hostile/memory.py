"""Memory of what has ended: solves that nobody watches any more, and scenes that were deleted."""

import time

from attack import attack
from calls import Caller, outcome, room, solves
from machine import LONGEST_WAIT, until

FAMILY = "memory"
NUMBER = 12
LEAVES = 60000  # 32 bytes of log a leaf: 1.9 MB each
LIMITED = ("--memory-limit", "400M", "--max-solves", "2")


def ended_solves(caller, number):
  scene = caller.create_scene(room()).name
  made = [caller.create_solve(scene, tolerance=1e-9, max_elements=LEAVES, seed=seed).name for seed in range(number)]
  until(lambda: all(caller.state_of(each) == "SUCCEEDED" for each in made), LONGEST_WAIT, "the solves end")
  return made


def look_at(caller, solve):
  """Watches it from the beginning to the end."""
  count = 0
  for frame in caller.WatchSolve(solves.WatchSolveRequest(name=solve, detail=solves.DETAIL_DISPLAY), LONGEST_WAIT):
    count += 1
    if not frame.ended:
      caller.AcknowledgeFrame(solves.AcknowledgeFrameRequest(watch_id=frame.watch_id, revision=frame.to_revision, frame_count=count))


def settled_rss(target):
  """What it comes down to within five seconds."""
  least, end = target.alvord.rss(), time.monotonic() + 5
  while time.monotonic() < end:
    time.sleep(0.25)
    least = min(least, target.alvord.rss())
  return least


@attack(FAMILY, LIMITED)
def deleted_solves(target, seconds):
  """Memory of solves that ended comes back when they are deleted."""
  caller = Caller(target)
  caller.create_scene(room(0.1))
  before = target.alvord.rss()
  made = ended_solves(caller, NUMBER)
  for each in made:
    look_at(caller, each)
  most = target.alvord.rss()
  for each in made:
    caller.DeleteSolve(solves.DeleteSolveRequest(name=each))
  after = settled_rss(target)
  assert after - before < 16, f"{before:.0f} MB before, {most:.0f} MB with {NUMBER} ended solves, {after:.0f} MB after they were deleted"
  assert outcome(caller.create_solve, caller.create_scene(room(0.2)).name)[0] == "OK", "a new solve is refused"
  return f"{before:.0f} MB before, {most:.0f} MB with {NUMBER} ended solves, {after:.0f} MB after they were deleted"


def kept(folder_option="--data"):
  return (folder_option, "{folder}/data", *LIMITED)


@attack(FAMILY, kept())
def looked_at_solves(target, seconds):
  """Solves that ended and are kept on disk take no memory once nobody watches them."""
  caller = Caller(target)
  made = ended_solves(caller, 2 * NUMBER)
  settled = settled_rss(target)
  for each in made:
    look_at(caller, each)
  after = settled_rss(target)
  expected = 2 * NUMBER * LEAVES * 32 / 1e6
  begin = 40  # MB of a server with one scene and nothing to do
  assert after < begin + expected / 2, f"{settled:.0f} MB when {2 * NUMBER} solves had ended, {after:.0f} MB after all were looked at"
  return f"{settled:.0f} MB when {2 * NUMBER} solves had ended, {after:.0f} MB after all were looked at"
