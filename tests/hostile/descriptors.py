"""Idle connections until no descriptor is left, with limits that are as low as login shells give."""

import time

from attack import attack, is_working
from calls import Caller, health, outcome, room, scenes
from machine import until
from slowness import fetch_page
from strangers import Stranger

FAMILY = "descriptors"
LOW = (1024, 1024)
SOFT = (1024, 20000)


def crowd(target, to, number):
  """Idle connections from ten addresses, until one is not let in for two seconds, or ten seconds are over."""
  strangers, end = [], time.monotonic() + 10
  while len(strangers) < number and (not strangers or strangers[-1].is_open) and time.monotonic() < end:
    strangers.append(Stranger(target, to, None, f"127.0.0.{60 + len(strangers) % 10}"))
  return strangers


def go_through(target, to, number):
  """What a crowd does to those who have a connection, to those who come, and to those who come later."""
  caller = Caller(target)
  scene = caller.create_scene(room()).name
  get = lambda: outcome(caller.GetScene, scenes.GetSceneRequest(name=scene), 5)[0]
  strangers = crowd(target, to, number)
  time.sleep(1)
  during = {"held connection": get(), "new connection": is_working(target, 3), "health": health(target)[0],
            "keeps scenes": outcome(caller.create_scene, room(0.1))[0]}
  for each in strangers:
    each.close()
  recovered = until(lambda: is_working(target, 2), 20, f"a new caller is answered after they have gone; during: {during}")
  assert target.alvord.is_running() and health(target)[0], "health after they have gone"
  assert during["held connection"] == during["keeps scenes"] == "OK", during
  assert during["new connection"] or not during["health"], f"health says SERVING, but a new connection is not served: {during}"
  descriptors = target.alvord.descriptors()
  return f"during: new connection {'served' if during['new connection'] else 'refused'}, health " \
         f"{'SERVING' if during['health'] else 'NOT_SERVING'}; served again {recovered:.1f} s after they left, {descriptors} descriptors"


@attack(FAMILY, descriptors=LOW)
def idle_crowd_of_calls(target, seconds):
  """1 060 idle connections to gRPC's port, with 1 024 descriptors: who is connected is served, health is true, and all are served soon after."""
  return go_through(target, target.calls, 1060)


@attack(FAMILY, descriptors=LOW)
def idle_crowd_of_the_page(target, seconds):
  """The same at the page's port; the page is served soon after, too."""
  seen = go_through(target, target.web, 1060)
  until(lambda: page_is_served(target), 20, "the page is served again")
  return seen


def page_is_served(target):
  try:
    return fetch_page(target, 2) < 2
  except AssertionError:
    return False


@attack(FAMILY, descriptors=SOFT)
def soft_limit(target, seconds):
  """A soft limit of 1 024 is raised to the hard one, and said."""
  if target.has_front:
    return "alvord's own matter: not asked behind nginx"
  soft = open(f"/proc/{target.alvord.child.pid}/limits").read().split("Max open files")[1].split()[0]
  assert int(soft) == SOFT[1], f"the soft limit is {soft}"
  return f"{soft} descriptors"


@attack(FAMILY)
def many_connections(target, seconds):
  """Connections that come and go by the hundred leave no descriptor behind."""
  assert is_working(target)
  before = target.alvord.descriptors()
  end = time.monotonic() + seconds
  number = 0
  while time.monotonic() < end:
    for each in crowd(target, target.calls, 50):
      each.close()
    number += 50
  until(lambda: target.alvord.descriptors() <= before + 20, 15, f"descriptors as before ({before}), now {target.alvord.descriptors()}")
  assert is_working(target), "a new caller is not answered"
  return f"{number} connections; descriptors {before} before, {target.alvord.descriptors()} after"
