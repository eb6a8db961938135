"""Whose call it is: five tenants over one connection, every RPC, by gRPC and by gRPC-Web; and tokens and headers that claim what is not so."""

import concurrent.futures
import random
import time

from attack import attack
from calls import Caller, WebCaller, open_channel, outcome, room, scenes, solves
from target import TENANTS, token_of

FAMILY = "tenants"
ALL_RUN = ("--max-solves", "8")


class Belongings:
  """A tenant's scene, solve, watch and waiting upload."""

  def __init__(self, target, channel, tenant, number):
    self.tenant = tenant
    self.caller = Caller(target, tenant, channel)
    self.scene = self.caller.create_scene(room(0.1 * number)).name
    self.spare_scene = self.caller.create_scene(room(0.1 * number + 0.05)).name
    self.solve = self.caller.create_solve(self.scene, pause=60, tolerance=1e-9, max_elements=500).name
    self.watch = self.caller.WatchSolve(solves.WatchSolveRequest(name=self.solve), 60)  # longer than an attack lasts
    self.frame = next(self.watch)


def requests_for(owner):
  """What one may ask about the owner's belongings without changing them, and what would."""
  scene, solve = owner.scene, owner.solve
  reading = [
      ("GetScene", scenes.GetSceneRequest(name=scene)), ("ReadScene", scenes.ReadSceneRequest(name=scene)),
      ("ReadMesh", scenes.ReadMeshRequest(name=solve)), ("ReadImages", scenes.ReadImagesRequest(name=scene)),
      ("GetSolve", solves.GetSolveRequest(name=solve)),
      ("ListSolves", solves.ListSolvesRequest(parent=scene)),
      ("AcknowledgeFrame", solves.AcknowledgeFrameRequest(watch_id=owner.frame.watch_id, revision=owner.frame.to_revision, frame_count=1))]
  changing = [
      ("DeleteScene", scenes.DeleteSceneRequest(name=owner.spare_scene)), ("CreateSolve", solves.CreateSolveRequest(parent=scene)),
      ("CancelSolve", solves.CancelSolveRequest(name=solve)), ("PauseSolve", solves.PauseSolveRequest(name=solve)),
      ("ResumeSolve", solves.ResumeSolveRequest(name=solve)), ("EditSolve", solves.EditSolveRequest(name=solve)), ("DeleteSolve", solves.DeleteSolveRequest(name=solve)),
      ("WatchSolve", solves.WatchSolveRequest(name=solve))]
  return reading, changing


def ask(caller, owner, turn):
  """One call of `caller` about `owner`. Returns a complaint, or None."""
  is_own = caller.tenant == owner.tenant
  reading, changing = requests_for(owner)
  name, request = turn.choice(reading if is_own else reading + changing)
  status, said = outcome(getattr(caller.caller, name), request)
  if status != ("OK" if is_own else "NOT_FOUND"):
    return f"{caller.tenant} on {owner.tenant}'s: {name} said {status} {str(said)[:80]}"
  status, said = outcome(caller.caller.ListScenes, scenes.ListScenesRequest())
  if status != "OK" or {each.name for each in said.scenes} != {caller.scene, caller.spare_scene}:
    return f"{caller.tenant} listed {status} {str(said)[:80]}"
  return None


def work_through(everyone, number, end):
  """Calls of all tenants about all tenants, until the time is over. Returns (calls, the first complaint or None)."""
  turn, count = random.Random(number), 0
  while time.monotonic() < end:
    count += 2
    time.sleep(0.1)  # ten threads, two calls each: below the rate that nginx allows an address
    complaint = ask(turn.choice(everyone), turn.choice(everyone), turn)
    if complaint:
      return count, complaint
  return count, None


@attack(FAMILY, ALL_RUN)
def five_over_one_connection(target, seconds):
  """Calls of five tenants that share a connection, from 10 threads at a time: each sees and changes its own, and nobody else's."""
  channel = open_channel(target)
  everyone = [Belongings(target, channel, tenant, number) for number, tenant in enumerate(TENANTS)]
  end = time.monotonic() + max(seconds, 2)
  with concurrent.futures.ThreadPoolExecutor(10) as threads:
    done = list(threads.map(lambda number: work_through(everyone, number, end), range(10)))
  complaints = [complaint for _, complaint in done if complaint]
  assert target.alvord.is_running(), f"alvord ended with status {target.alvord.exit_status()}"
  assert not complaints, f"{len(complaints)} of 10: {complaints[0]}"
  for each in everyone:
    assert outcome(each.caller.state_of, each.solve) == ("OK", "RUNNING"), f"{each.tenant}'s solve does not run"
    each.watch.cancel()
  return f"{sum(count for count, _ in done)} calls"


@attack(FAMILY, ALL_RUN)
def five_over_one_web_connection(target, seconds):
  """Calls of gRPC-Web by five tenants over one connection, one after the other: the same."""
  channel = open_channel(target)
  everyone = [Belongings(target, channel, tenant, number) for number, tenant in enumerate(TENANTS)]
  web, calls = WebCaller(target), 0
  for caller in everyone:
    for owner in everyone:
      reading, changing = requests_for(owner)
      for name, request in reading if caller is owner else reading + changing:
        status, _ = web.call(name, request, caller.tenant)
        assert status == ("OK" if caller is owner else "NOT_FOUND"), f"{caller.tenant} on {owner.tenant}'s: {name} said {status}"
        calls += 1
  for each in everyone:
    each.watch.cancel()
  return f"{calls} calls"


@attack(FAMILY)
def uploads_of_others(target, seconds):
  """A request id is its tenant's own: others neither see what waits under it nor get what it made."""
  channel = open_channel(target)
  ali, bob = Caller(target, "ali", channel), Caller(target, "bob", channel)
  made = ali.create_scene(room(), request_id="made").name
  assert ali.create_scene(room(), request_id="made").name == made
  assert bob.create_scene(room(), request_id="made").name != made, "bob got ali's scene by its request id"
  assert outcome(bob.GetUpload, scenes.GetUploadRequest(request_id="made"))[0] == "NOT_FOUND"
  assert [each.name for each in ali.ListScenes(scenes.ListScenesRequest()).scenes] == [made]
  return "ids of two tenants are apart"


CLAIMS = (("tenant", "ali"), ("x-alvor-tenant", "ali"), ("x_alvor_tenant", "ali"), ("alvor-tenant", "ali"), ("alvor-tenant-bin", b"ali"))


@attack(FAMILY)
def claimed_identity(target, seconds):
  """Headers that claim to be somebody change nothing: with bob's token it is bob's call, and without a token it is refused."""
  channel = open_channel(target)
  secret = Caller(target, "ali", channel).create_scene(room()).name
  bob, nobody = Caller(target, "bob", channel), Caller(target, None, channel)
  for claim in CLAIMS:
    for caller, expected in ((bob, "NOT_FOUND"), (nobody, "UNAUTHENTICATED")):
      metadata, caller.metadata = caller.metadata, caller.metadata + (claim,)
      status, _ = outcome(caller.GetScene, scenes.GetSceneRequest(name=secret))
      caller.metadata = metadata
      assert status == expected, f"{claim[0]}: {status}"
  return f"{len(CLAIMS)} headers"


@attack(FAMILY)
def odd_tokens(target, seconds):
  """Tokens that are nearly right, doubled or very long let nobody in."""
  caller = Caller(target, None)
  for value in (token_of("ali"), f"Basic {token_of('ali')}", "Bearer", "Bearer ", f"Bearer {token_of('ali')}x", f"Bearer {token_of('ali')[:-1]}",
                "Bearer " + "x" * 7000, f"Bearer {token_of('ali')}, Bearer {token_of('bob')}"):
    caller.metadata = (("authorization", value),)
    status, _ = outcome(caller.ListScenes, scenes.ListScenesRequest())
    assert status == "UNAUTHENTICATED", f"{value[:30]}: {status}"
  return "8 of them refused"


@attack(FAMILY)
def calls_from_many_threads(target, seconds):
  """Ordinary calls from 32 threads over one connection end nothing and leave no memory behind."""
  caller = Caller(target)
  scene = caller.create_scene(room()).name
  get = lambda: outcome(caller.GetScene, scenes.GetSceneRequest(name=scene))[0]
  for _ in range(300):
    get()
  before, end = target.alvord.rss(), time.monotonic() + max(seconds, 2)

  def go_on(_):
    count = 0
    while time.monotonic() < end and target.alvord.is_running():
      get()
      count += 1
    return count
  with concurrent.futures.ThreadPoolExecutor(32) as threads:
    calls = sum(threads.map(go_on, range(32)))
  assert target.alvord.is_running(), f"alvord ended with status {target.alvord.exit_status()}"
  growth = target.alvord.rss() - before
  assert growth < 16, f"{calls} calls, alvord grew by {growth:.1f} MB"
  return f"{calls} calls, alvord grew by {growth:.1f} MB"
