"""What scenarios have in common, and the table of what was seen of them."""

import hashlib
import itertools
import json
import pathlib
import subprocess
import time
import urllib.request

import pytest

from hosts import NETWORK, Host, address_of, podman, until

SCENES = "/usr/local/share/alvor/scenes"


def pytest_addoption(parser):
  parser.addoption("--table", help="where to write what was seen of each scenario, as Markdown")


class Server(Host):
  """alvord, on a volume that a later one finds as it was left."""
  VOLUME = "alvor-test-data"

  def __init__(self, *command, options=(), image="alvor-server"):
    storage = ["--volume", f"{self.VOLUME}:/var/lib/alvor"]
    super().__init__("server", image, command, [*storage, "--env=ALVORD_METRICS=0.0.0.0:9464", *options])
    self.await_health()

  def await_health(self):
    return until(self.is_healthy, 20, f"{self.name} serves; it says: {self.log()[-1000:]}")

  def is_healthy(self):
    return subprocess.run(["podman", "healthcheck", "run", self.name], capture_output=True).returncode == 0

  def start(self):
    super().start()
    self.await_health()

  def metrics(self):
    with urllib.request.urlopen(f"http://{address_of('server')}:9464/metrics", timeout=5) as page:
      return page.read().decode()

  def metric(self, name):
    for line in self.metrics().splitlines():
      if line.startswith(name + " "):
        return float(line.split()[-1])
    raise AssertionError(f"no metric {name}")


class Client(Host):
  """alvor. What it writes to /out is in `out`."""

  def __init__(self, name, out, *command, options=()):
    super().__init__(name, "alvor-client", command, ["--volume", f"{out}:/out", *options])


class World:
  """All hosts of a scenario."""

  def __init__(self, folder):
    self.folder = folder
    self.folder.chmod(0o777)
    self.hosts = []
    self.numbers = itertools.count(1)

  def server(self, *command, **more):
    """There is one at a time."""
    made = Server(*command, **more)
    self.hosts.append(made)
    return made

  def add(self, host):
    self.hosts.append(host)
    return host

  def client(self, *command, **more):
    made = Client(f"client{next(self.numbers)}", self.folder, *command, **more)
    self.hosts.append(made)
    return made

  def desk(self):
    """A host whose user types commands."""
    return self.client("infinity", options=["--entrypoint", "sleep"])

  def digest(self, file):
    return hashlib.sha256((self.folder / file).read_bytes()).hexdigest()

  def scene(self, side):
    """A file with a lamp over a floor of side x side quads."""
    lines = ["mtllib grid.mtl", "v 0 0 9", "v 0 1 9", "v 1 1 9", "v 1 0 9", "usemtl lamp", "f 1 2 3 4", "usemtl grey"]
    lines += [f"v {x} {y} 0" for y in range(side + 1) for x in range(side + 1)]
    for y in range(side):
      for x in range(side):
        a = 5 + y * (side + 1) + x
        lines.append(f"f {a} {a + 1} {a + side + 2} {a + side + 1}")
    (self.folder / "grid.mtl").write_text("newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n")
    (self.folder / "grid.obj").write_text("\n".join(lines) + "\n")
    return "/out/grid.obj"

  def show_logs(self):
    for host in self.hosts:
      print(f"---- {host.name}\n{host.log()[-3000:]}")

  def remove(self):
    for host in reversed(self.hosts):
      host.remove()
    podman("volume", "rm", "--force", Server.VOLUME)


def alvor(desk, *words, check=True, at="server:50051"):
  """Types a command at a desk. Returns its exit status, and what it printed and complained."""
  done = subprocess.run(["podman", "exec", desk.name, "alvor", *map(str, words), "--server", at],
                        capture_output=True, text=True, timeout=120)
  assert not check or done.returncode == 0, f"alvor {' '.join(map(str, words))}: {done.returncode}\n{done.stderr}"
  return done.returncode, done.stdout, done.stderr


def reason(said):
  """The last line of what a command complained."""
  return said.strip().splitlines()[-1]


def solves(desk, *options):
  """Newest first."""
  return json.loads(alvor(desk, "solves", "list", "--json", *options)[1])


def scenes(desk, *options):
  """Newest first."""
  return json.loads(alvor(desk, "scenes", "list", "--json", *options)[1])


def the_solve(desk):
  """The name of the only one, once it is there."""
  until(lambda: solves(desk), 20, "there is a solve")
  return solves(desk)[0]["name"]


def solve(desk, name):
  return json.loads(alvor(desk, "solves", "get", name, "--json")[1])


def until_refined_is_kept(server, desk, name):
  """Waits for a checkpoint of the server's only solve, of the Cornell box, after its first split; that mesh begins with 1040 leaves."""
  until(lambda: solve(desk, name)["leaves"] > 1040, 30, "it has been refined")
  earlier = server.metric("alvor_checkpoints_total")
  until(lambda: server.metric("alvor_checkpoints_total") > earlier, 20, "there is a checkpoint of the refined mesh")


@pytest.fixture(scope="session", autouse=True)
def network():
  podman("network", "create", "--disable-dns", NETWORK)
  yield
  podman("network", "rm", "--force", NETWORK)


@pytest.fixture
def world(tmp_path, request):
  made = World(tmp_path)
  yield made
  if not request.node.passed:
    made.show_logs()
  made.remove()


ROWS = []


class Observed(list):
  """Texts, and how long it took if not as long as the test."""
  seconds = None


@pytest.fixture
def observed(request):
  """Say here what was observed."""
  seen = Observed()
  begin = time.monotonic()
  yield seen
  scenario, promise = " ".join(request.node.function.__doc__.split()).split(": ", 1)
  ROWS.append((scenario, promise, "; ".join(seen) if request.node.passed else "NOT HELD",
               round(seen.seconds or time.monotonic() - begin)))


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
  report = (yield).get_result()
  if report.when == "call":
    item.passed = report.passed


def pytest_sessionfinish(session):
  path = session.config.getoption("--table")
  if not path or not ROWS:
    return
  lines = ["| scenario | promise | observed | s |", "|---|---|---|---|"]
  lines += [f"| {scenario} | {promise} | {seen} | {seconds} |" for scenario, promise, seen, seconds in ROWS]
  pathlib.Path(path).write_text("\n" + "\n".join(lines) + "\n\n")
