"""nginx before a server that listens on Unix sockets alone, and what strangers can do to it there."""

import json
import pathlib
import ssl
import sys

import pytest

from conftest import SCENES, alvor
from hosts import Host, address_of, podman, run, until
from test_callers import as_tenant, tokens

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "hostile"))
from http2 import HEADERS, Http2Stranger, call_headers, frame, resets, small_headers
from strangers import flood

SOCKETS = "alvor-test-sockets"
ON_SOCKETS = ["--listen", "unix:/run/alvor/grpc.sock", "--web", "unix:/run/alvor/web.sock"]


class Front(Host):
  """nginx as it ships. What a Stranger asks of a target is here, too."""

  def __init__(self, folder):
    self.certificate = folder / "server.pem"
    mounts = [f"--volume={SOCKETS}:/run/alvor", f"--volume={self.certificate}:/etc/alvor/tls/tls.crt:ro",
              f"--volume={folder}/server.key:/etc/alvor/tls/tls.key:ro", "--tmpfs=/tmp"]
    super().__init__("front", "alvor-front", options=mounts)
    self.calls = self.web = (address_of("front"), 8443)

  def tls(self, *protocols):
    context = ssl.create_default_context(cafile=self.certificate)
    context.check_hostname = False
    context.set_alpn_protocols(list(protocols))
    return context

  def page(self, *options):
    return run("curl", "--silent", "--fail", "--cacert", self.certificate, "--resolve", f"front:8443:{self.calls[0]}", *options,
               "https://front:8443/")


@pytest.fixture
def front(world):
  """A server behind nginx, with the tenants ann and bob."""
  run("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", 7, "-subj", "/CN=front",
      "-addext", "subjectAltName=DNS:front", "-keyout", "server.key", "-out", "server.pem", cwd=world.folder)
  (world.folder / "server.key").chmod(0o644)
  tokens(world.folder, "ann", "bob")
  world.alvord = world.server(*ON_SOCKETS, "--tokens", "/tls/tokens",
                              options=[f"--volume={world.folder}:/tls:ro", f"--volume={SOCKETS}:/run/alvor"])
  made = Front(world.folder)
  world.hosts.append(made)
  yield made
  world.remove()
  podman("volume", "rm", "--force", SOCKETS)


def rss(host):
  """Megabytes of anonymous memory of a container's program."""
  status = pathlib.Path(f"/proc/{host.inspect('.State.Pid')}/status").read_text()
  return next(int(line.split()[1]) for line in status.splitlines() if line.startswith("RssAnon")) / 1024


def test_front(world, front, observed):
  """nginx before the server: page, calls, an upload of 250 000 faces and a watch come through by TLS on one port, for tenants with tokens only."""
  desk = world.desk()
  through = lambda who, *words, **more: alvor(desk, *words, *as_tenant(who), at="front:8443", **more)
  versions = [front.page(f"--http{version}", "--write-out", "%{http_version}", "--output", "/dev/null") for version in ("1.1", "2")]
  assert versions == ["1.1", "2"] and "<title>" in front.page()
  through("ann", "solve", f"{SCENES}/enfilade.obj", "--tolerance", "0.05", "-o", "through.glb")
  local = world.client("solve", f"{SCENES}/enfilade.obj", "--tolerance", "0.05", "-o", "local.glb")
  assert local.wait(60) == 0 and world.digest("through.glb") == world.digest("local.glb")
  through("bob", "solve", world.scene(500), "--max-depth", 0, "--time-limit", 5)
  names = {who: {each["name"] for each in json.loads(through(who, "scenes", "list", "--json")[1])} for who in ("ann", "bob")}
  assert len(names["ann"]) == len(names["bob"]) == 1 and not names["ann"] & names["bob"]
  (world.folder / "wrong.token").write_text("secret of nobody\n")
  assert through("wrong", "scenes", "list", check=False)[0] == 5
  assert alvor(desk, "scenes", "list", "--tls-ca", "/out/server.pem", at="front:8443", check=False)[0] == 5
  observed.append("HTTP/1.1 and HTTP/2; equal files; no scene seen by both tenants; wrong token, none: 5")


def test_floods_at_the_front(world, front, observed):
  """Floods of HTTP/2 at nginx: a CONTINUATION flood and rapid resets are not noticed by the server, nor by a solve that runs there."""
  desk = world.desk()
  through = lambda *words: json.loads(alvor(desk, *words, "--json", *as_tenant("ann"), at="front:8443")[1])
  solving = world.client("solve", f"{SCENES}/cornell_box.obj", "--tolerance", "0.01", "--pace", "1", "--server", "front:8443",
                         *as_tenant("ann"), "-o", "own.glb")
  until(lambda: through("solves", "list"), 20, "there is a solve")
  before = rss(world.alvord)
  connect = lambda: Http2Stranger(front, None)
  sent = [flood(connect, 5, small_headers(), frame(HEADERS, 0, 1, call_headers())), flood(connect, 5, resets(None))]
  growth = rss(world.alvord) - before
  assert world.alvord.is_healthy() and through("solves", "list")[0]["state"] == "RUNNING"
  assert solving.wait(90) == 0
  assert growth < 64, f"{growth:.0f} MB"  # the solve grows too
  observed.append(f"{sent[0]}; {sent[1]}; the server, which solved, grew by {growth:.0f} MB")


def test_compose_front(observed):
  """docker/compose.front.yaml: server behind nginx, page by HTTPS, and a client that solves with a token, as it stands."""
  compose = ["podman-compose", "--project-name", "alvor-compose", "--file", "docker/compose.front.yaml"]
  run("docker/secrets.sh", "docker/secrets", "localhost", "ann")
  try:
    run(*compose, "up", "--detach", "--no-build", timeout=120)
    client = podman("ps", "--all", "--filter", "name=alvor-compose_client", "--format", "{{.Names}}")
    until(lambda: podman("inspect", "--format", "{{.State.Status}}", client) == "exited", 60, "the client ends")
    assert podman("inspect", "--format", "{{.State.ExitCode}}", client) == "0", podman("logs", client)
    assert "<title>" in run("curl", "--silent", "--fail", "--cacert", "docker/secrets/tls.crt", "https://localhost:8443/")
    observed.append("page by HTTPS; the client's solve ends with exit status 0")
  finally:
    run(*compose, "down", "--volumes", timeout=120, check=False)
