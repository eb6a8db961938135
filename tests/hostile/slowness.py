"""Strangers who say little: half a request, a byte now and then, or nothing; and readers who do not read."""

import contextlib
import threading
import time

from attack import Bystander, attack, is_working
from calls import Caller, outcome, path_of, room, scenes, solves, web_message
from http2 import DATA, END_HEADERS, END_STREAM, HEADERS, Http2Stranger, call_headers, frame
from machine import LONGEST_WAIT, until
from strangers import Stranger
from target import token_of

FAMILY = "slow strangers"


def fetch_page(target, seconds=5):
  """The seconds that a stranger at the next address waits for a file of the page; AssertionError beyond `seconds`."""
  begin = time.monotonic()
  visitor = Stranger(target, target.web, "http/1.1", "127.0.0.77")
  visitor.send(b"GET /icon.svg HTTP/1.1\r\nHost: localhost:%d\r\nConnection: close\r\n\r\n" % target.web[1])
  answer = visitor.receive(seconds, 12)
  visitor.close()
  assert answer.startswith(b"HTTP/1.1 200"), f"the page says {answer[:40]!r} after {time.monotonic() - begin:.1f} s"
  return time.monotonic() - begin


@contextlib.contextmanager
def dripping(target, number, first, piece):
  """Connections from three addresses to the page's port, which send `first`, and then `piece` every half second, while this lasts."""
  strangers, is_over = [], threading.Event()

  def drip():
    while not is_over.wait(0.5):
      for each in list(strangers):
        each.send(piece)
  dripper = threading.Thread(target=drip, daemon=True)
  dripper.start()
  try:
    for k in range(number):
      stranger = Stranger(target, target.web, "http/1.1", f"127.0.0.{100 + k % 3}")
      stranger.send(first)
      strangers.append(stranger)
      if not stranger.is_open:
        break  # no more are let in
    yield
  finally:
    is_over.set()
    dripper.join()
    for each in strangers:
      each.close()


@attack(FAMILY)
def dripping_headers(target, seconds):
  """A page is served while 280 connections from three addresses drip header lines."""
  with Bystander(target) as bystander, dripping(target, 280, b"GET / HTTP/1.1\r\n", b"X-a: b\r\n"):
    time.sleep(seconds)
    waited = fetch_page(target)
  return f"the page came after {1000 * waited:.0f} ms; {bystander.seen}"


@attack(FAMILY)
def dripping_headers_end(target, seconds):
  """Headers have ten seconds in all: a connection that drips them is closed within 15 s."""
  stranger = Stranger(target, target.web, "http/1.1")
  stranger.send(b"GET / HTTP/1.1\r\n")
  begin = time.monotonic()
  while time.monotonic() < begin + 15 and stranger.send(b"X-a: b\r\n"):
    stranger.skip_answers()
    time.sleep(0.25)
  assert not stranger.is_open, "still open after 15 s"
  return f"closed after {time.monotonic() - begin:.1f} s"


@attack(FAMILY)
def no_preface(target, seconds):
  """A connection to the port of gRPC that says nothing is closed within 15 s, and others get in meanwhile."""
  strangers = [Stranger(target, target.calls, "h2") for _ in range(20)] + [Stranger(target, target.calls) for _ in range(20)]
  assert is_working(target), "a new caller is not answered"
  begin = time.monotonic()
  for each in strangers:
    assert each.is_closed_by_the_other(max(0, begin + 15 - time.monotonic())), "still open after 15 s"
  return f"all 40 closed after {time.monotonic() - begin:.1f} s"


@attack(FAMILY)
def half_a_message(target, seconds):
  """A page is served while 280 connections from three addresses drip bodies of gRPC-Web."""
  head = (f"POST {path_of('ListScenes')} HTTP/1.1\r\nHost: localhost:{target.web[1]}\r\nContent-Type: application/grpc-web+proto\r\n"
          "Content-Length: 1000\r\n\r\n").encode()
  with Bystander(target) as bystander, dripping(target, 280, head + b"\0\0\0\3", b"\xe7"):
    time.sleep(seconds)
    waited = fetch_page(target)
  return f"the page came after {1000 * waited:.0f} ms; {bystander.seen}"


@attack(FAMILY)
def closed_watches(target, seconds):
  """256 watches by gRPC-Web whose connections were closed at once do not keep the page from others."""
  caller = Caller(target, "bob")
  solve = caller.create_solve(caller.create_scene(room(0.5)).name, pause=60, tolerance=1e-9, max_elements=2000).name
  body = web_message(solves.WatchSolveRequest(name=solve)) * 3
  head = (f"POST {path_of('WatchSolve')} HTTP/1.1\r\nHost: localhost:{target.web[1]}\r\nContent-Type: application/grpc-web+proto\r\n"
          f"Authorization: Bearer {token_of('bob')}\r\nContent-Length: {len(body)}\r\n\r\n").encode()
  with Bystander(target) as bystander:
    for number in range(256):
      stranger = Stranger(target, target.web, "http/1.1", f"127.0.0.{100 + number % 100}")
      stranger.send(head + body)
      stranger.close()
    waited = fetch_page(target)
  return f"the page came after {1000 * waited:.0f} ms; {bystander.seen}"


@attack(FAMILY)
def watchers_who_do_not_read(target, seconds):
  """90 watches whose windows are shut take little memory and keep nobody from anything."""
  caller = Caller(target, "bob")
  solve = caller.create_solve(caller.create_scene(room(0.5)).name, tolerance=1e-9, max_elements=8000).name
  until(lambda: caller.state_of(solve) == "SUCCEEDED", LONGEST_WAIT, "the solve ends")
  headers = call_headers(token_of("bob"), path_of("WatchSolve").encode())
  message = web_message(solves.WatchSolveRequest(name=solve))
  with Bystander(target) as bystander:
    for _ in range(10):
      stranger = Http2Stranger(target)
      stranger.send(b"".join(frame(HEADERS, END_HEADERS, 2 * k + 1, headers) + frame(DATA, END_STREAM, 2 * k + 1, message) for k in range(9)))
    time.sleep(seconds)
    status, _ = outcome(caller.ListScenes, scenes.ListScenesRequest())
    assert status == "OK", status
  return f"90 watches on 10 connections; {bystander.seen}"
