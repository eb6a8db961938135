"""SIGTERM ends alvord within the promised seconds, whatever strangers do meanwhile."""

import threading
import time

from attack import attack
from calls import Caller, nearly_collinear_polygons, outcome, room, solves
from http2 import Http2Stranger, resets
from slowness import dripping
from strangers import Stranger, flood
from target import token_of

FAMILY = "SIGTERM"
PROMISED = 12  # seconds: draining takes up to ten


def end(target, what):
  """Terminates alvord, and tells how long it took."""
  seconds = target.alvord.terminate(PROMISED)
  assert seconds is not None, f"not ended {PROMISED} s after SIGTERM"
  status = target.alvord.exit_status()
  assert status == 0, f"exit status {status}"
  return f"{what}: ended after {seconds:.1f} s"


@attack(FAMILY)
def under_dripping_headers(target, seconds):
  """While 20 connections drip header lines."""
  with dripping(target, 20, b"GET / HTTP/1.1\r\n", b"X-a: b\r\n"):
    time.sleep(1)
    return end(target, "20 dripping connections")


@attack(FAMILY)
def under_dripping_bodies(target, seconds):
  """While 20 connections drip bodies of gRPC-Web."""
  head = (b"POST /alvor.v1.SceneService/ListScenes HTTP/1.1\r\nHost: localhost:%d\r\nContent-Type: application/grpc-web+proto\r\n"
          b"Authorization: Bearer %s\r\nContent-Length: 9000\r\n\r\n" % (target.web[1], token_of("bob").encode()))
  with dripping(target, 20, head + b"\0\0\0\3\xe8", b"a"):
    time.sleep(1)
    return end(target, "20 dripping connections")


@attack(FAMILY)
def under_silence(target, seconds):
  """While connections that said nothing, or nothing but a preface, stay."""
  silent = [Stranger(target, to, protocol) for to in (target.calls, target.web) for protocol in (None, "h2") for _ in range(5)]
  silent += [Http2Stranger(target) for _ in range(5)]
  seen = end(target, f"{len(silent)} silent connections")
  return seen


@attack(FAMILY)
def under_rapid_resets(target, seconds):
  """While streams are opened and reset."""
  attacker = threading.Thread(target=flood, args=[lambda: Http2Stranger(target), 5, resets(token_of("bob"))], daemon=True)
  attacker.start()
  time.sleep(0.5)
  return end(target, "rapid resets")


@attack(FAMILY)
def under_watches(target, seconds):
  """While 50 watches wait for a solve that pauses."""
  caller = Caller(target)
  solve = caller.create_solve(caller.create_scene(room()).name, pause=60, tolerance=1e-9, max_elements=2000).name
  watches = [caller.WatchSolve(solves.WatchSolveRequest(name=solve), 30) for _ in range(50)]
  for each in watches:
    next(each)
  return end(target, "50 watches")


@attack(FAMILY)
def under_long_building(target, seconds):
  """While a scene is built that takes long."""
  caller = Caller(target)
  builder = threading.Thread(target=outcome, args=[caller.create_scene, nearly_collinear_polygons(60, 5000), 60], daemon=True)
  builder.start()
  time.sleep(2)
  return end(target, "building")
