"""What an attack is, and the bystander who must not notice it."""

import dataclasses
import threading
import time

from calls import Caller, health, outcome, room, scenes

ATTACKS = []


@dataclasses.dataclass
class Attack:
  family: str
  name: str
  promise: str
  run: object  # (target, seconds) -> what was seen, in words; raises AssertionError where the promise is not held
  options: tuple
  descriptors: tuple
  prepare: object


def attack(family, options=(), descriptors=None, prepare=None):
  """Registers a function whose documentation is the promise. `options` are alvord's; {folder} in them is the attack's own directory.
  `descriptors` is alvord's (soft, hard) limit. prepare(folder) is called before alvord is started."""
  def register(function):
    promise = " ".join(function.__doc__.split())
    ATTACKS.append(Attack(family, function.__name__, promise, function, options, descriptors, prepare))
    return function
  return register


class Bystander:
  """A tenant with a solve that runs, for as long as a `with` lasts. Calls, asks for health and looks at alvord's memory five times a second; at
  the end of the `with` it asserts that nothing of an attack was noticed. `seen` says so in words."""

  SLOWEST = 2.0  # seconds for health and for a call, on a machine whose processors the attack takes too
  # MB of alvord: bare, and behind nginx, which lets through 300 requests of three addresses, of 60 KB each, or bursts of 600 that are short.
  MOST_GROWTH = {False: 64, True: 32}

  def __init__(self, target, growth=None):
    self.target, self.caller = target, Caller(target, "ali")
    self.most_growth = growth or self.MOST_GROWTH[target.has_front]
    self.scene = self.caller.create_scene(room()).name
    self.solve = self.caller.create_solve(self.scene, pause=60, tolerance=1e-9, max_elements=2000).name
    self.slowest_call = self.slowest_health = 0.0
    self.troubles = []
    self.has_left = threading.Event()

  def __enter__(self):
    self.look()
    time.sleep(0.3)
    self.before = self.most = self.target.alvord.rss()
    self.thread = threading.Thread(target=self.look_on, daemon=True)
    self.thread.start()
    return self

  def look_on(self):
    while not self.has_left.wait(0.2):
      self.look()
      self.most = max(self.most, self.target.alvord.rss())

  def look(self):
    begin = time.monotonic()
    status, said = self.call_patiently(begin + self.SLOWEST)
    self.slowest_call = max(self.slowest_call, time.monotonic() - begin)
    is_serving, seconds = health(self.target)
    self.slowest_health = max(self.slowest_health, seconds)
    if status != "OK":
      self.troubles.append(f"its call: {status} {said}")
    if not is_serving:
      self.troubles.append("health does not say SERVING")

  def call_patiently(self, end):
    """Calls as `alvor` does: where the answer is UNAVAILABLE, which means "try again", once more until the monotonic time `end`."""
    while True:
      status, said = outcome(self.caller.GetScene, scenes.GetSceneRequest(name=self.scene))
      if status != "UNAVAILABLE" or time.monotonic() >= end:
        return status, said
      time.sleep(0.1)

  def __exit__(self, kind, *_):
    self.has_left.set()
    self.thread.join()
    if kind is None:
      self.judge()

  def judge(self):
    assert self.target.alvord.is_running(), f"alvord ended with status {self.target.alvord.exit_status()}"
    state = outcome(self.caller.state_of, self.solve)
    growth = self.most - self.before
    self.seen = (f"alvord grew by {growth:.1f} MB, slowest call {1000 * self.slowest_call:.0f} ms, "
                 f"health {1000 * self.slowest_health:.0f} ms")
    assert not self.troubles, f"{self.troubles[0]}; {self.seen}"
    assert state == ("OK", "RUNNING"), f"its solve: {state[1]}; {self.seen}"
    assert growth < self.most_growth, self.seen
    assert max(self.slowest_call, self.slowest_health) < self.SLOWEST, self.seen


def is_working(target, seconds=5):
  """Whether a new connection gets an answer."""
  caller = Caller(target, "bob")
  try:
    return outcome(caller.ListScenes, scenes.ListScenesRequest(), seconds)[0] == "OK"
  finally:
    caller.close()
