"""Submitting, watching, and what networks and machines do to it."""

import hashlib
import time

import pytest

from conftest import SCENES, alvor, solve, solves, the_solve
from hosts import until


def digest(world, name):
  return hashlib.sha256((world.folder / name).read_bytes()).hexdigest()


def start_watching(world, name, out, **more):
  return world.client("watch", name, "--server", "server:50051", "-o", out, **more)


def start_slow_solve(world, seconds, *options):
  """Of the Cornell box, with a pause after each of its steps, of which there are about twenty."""
  return world.client("solve", f"{SCENES}/cornell_box.obj", "--server", "server:50051", "--tolerance", "0.01", "--pace",
                      seconds / 20, "-o", "own.glb", *options)


def test_remote_solve(world, observed):
  """Remote submission: a scene solved on another host gives the same bytes as at home."""
  world.server("--insecure")
  desk = world.desk()
  alvor(desk, "solve", f"{SCENES}/enfilade.obj", "--tolerance", "0.05", "-o", "remote.glb")
  local = world.client("solve", f"{SCENES}/enfilade.obj", "--tolerance", "0.05", "-o", "local.glb")
  assert local.wait(60) == 0
  assert digest(world, "remote.glb") == digest(world, "local.glb")
  observed.append(f"equal, {(world.folder / 'local.glb').stat().st_size} bytes; {solves(desk)[0]['leaves']} leaves")


def test_three_watchers(world, observed):
  """Three watchers, one joining late: all have the same bytes at the end."""
  world.server("--insecure")
  own = start_slow_solve(world, 12)
  desk = world.desk()
  name = the_solve(desk)
  early = [start_watching(world, name, f"early{n}.glb") for n in range(2)]
  until(lambda: solve(desk, name)["elapsed_s"] > 0.1, 30, "half of it is done")
  late = start_watching(world, name, "late.glb")
  assert solve(desk, name)["state"] == "RUNNING"
  assert [host.wait(60) for host in (own, *early, late)] == [0, 0, 0, 0]
  digests = {digest(world, f"{file}.glb") for file in ("own", "early0", "early1", "late")}
  assert len(digests) == 1
  observed.append("four equal files")


def test_killed_server(world, observed):
  """Server killed (-9) mid-solve and started again: the solve goes on, watchers come back by themselves, nothing acknowledged is lost."""
  server = world.server("--insecure", "--checkpoint-interval", "0.5")
  own = start_slow_solve(world, 20)
  desk = world.desk()
  name = the_solve(desk)
  watcher = start_watching(world, name, "watched.glb")
  before = alvor(desk, "scenes", "list", "--json")[1]
  until(lambda: server.metric("alvor_checkpoints_total") >= 2, 20, "there are checkpoints")
  server.kill()
  time.sleep(8)
  server.start()
  assert alvor(desk, "scenes", "list", "--json")[1] == before
  assert own.wait(60) == 0 and watcher.wait(60) == 0
  after = solve(desk, name)
  assert after["restarts"] == 1 and after["resumed_from_revision"] > 0
  alvor(desk, "solve", f"{SCENES}/cornell_box.obj", "--tolerance", "0.01", "-o", "undisturbed.glb")
  assert digest(world, "own.glb") == digest(world, "watched.glb") == digest(world, "undisturbed.glb")
  observed.append(f"down for 8 s; went on from revision {after['resumed_from_revision']}, {after['work_lost_s']:.1f} s of work lost; "
                  "watchers' files equal that of an undisturbed solve")


def lag_is_gone(server, watchers):
  """No watcher is behind, and as many as should be are there."""
  return server.metric("alvor_watchers") == watchers and server.metric("alvor_watcher_lag_revisions") <= 1


@pytest.mark.parametrize("seconds,limit", [(5, 10), (60, 10)])
def test_cut_cable(world, observed, seconds, limit):
  """Network cut for {seconds} s: the watcher has caught up within 10 s, and the solver did not wait for it."""
  server = world.server("--insecure")
  own = start_slow_solve(world, seconds + 30)
  desk = world.desk()
  name = the_solve(desk)
  watcher = start_watching(world, name, "watched.glb")
  until(lambda: lag_is_gone(server, 2), 10, "both watch")
  revision_before = solve(desk, name)["shots"]
  with watcher.cable_pulled():
    time.sleep(seconds)
    assert solve(desk, name)["shots"] > revision_before, "the solve goes on"
  caught_up = until(lambda: lag_is_gone(server, 2), limit, "the watcher has caught up")
  assert solve(desk, name)["state"] == "RUNNING"
  assert own.wait(60) == 0 and watcher.wait(30) == 0
  assert digest(world, "own.glb") == digest(world, "watched.glb")
  alvor(desk, "solve", f"{SCENES}/cornell_box.obj", "--tolerance", "0.01", "--pace", "0.01")
  cut, alone = (each["elapsed_s"] for each in reversed(solves(desk)))
  assert cut < 1.5 * alone, "the solver's own time, pauses not counted"
  observed.append(f"caught up after {caught_up:.1f} s; equal files; solver's time {cut / alone:.2f} of one without watchers that are cut")


def test_paused_client(world, observed):
  """Client container paused for 30 s: it goes on from where it was, and others do not notice."""
  server = world.server("--insecure")
  own = start_slow_solve(world, 60)
  desk = world.desk()
  name = the_solve(desk)
  watcher = start_watching(world, name, "watched.glb")
  until(lambda: lag_is_gone(server, 2), 10, "both watch")
  with watcher.paused():
    time.sleep(30)
    assert server.metric("alvor_watchers") == 1, "the server has given it up"
  caught_up = until(lambda: lag_is_gone(server, 2), 10, "the watcher has caught up")
  assert own.wait(60) == 0 and watcher.wait(30) == 0
  assert digest(world, "own.glb") == digest(world, "watched.glb")
  observed.append(f"given up by the server after 15 s, back {caught_up:.1f} s after it woke; equal files")


def test_poor_link(world, observed):
  """Link of 1 MB/s that loses 5 %: the watcher ends with the same bytes, and the solver does not slow."""
  world.server("--insecure")
  desk = world.desk()
  command = ["solve", f"{SCENES}/enfilade.obj", "--tolerance", "0.02"]
  alvor(desk, *command)
  poor = world.client("infinity", options=["--entrypoint", "sleep"])
  poor.slow_down(1, 0.05)
  alvor(poor, *command, "-o", "poor.glb")
  at_home = world.client(*command, "-o", "home.glb")
  assert at_home.wait(60) == 0
  slow, free = (each["elapsed_s"] for each in solves(desk))
  assert slow < 1.5 * free
  assert digest(world, "poor.glb") == digest(world, "home.glb")
  observed.append(f"equal files; solver's time {slow / free:.2f} of that with a good link ({slow:.1f} s)")
