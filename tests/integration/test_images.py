"""The images as they ship."""

import contextlib
import pathlib
import subprocess

from hosts import podman, run, until


def test_images(world, observed):
  """Images: are small, run as nobody in particular on a read-only root, tell their health and stop when asked."""
  sizes = {}
  for image in ("alvor-server", "alvor-client"):
    sizes[image] = int(podman("image", "inspect", "--format", "{{.Size}}", image)) / 1e6
    assert podman("image", "inspect", "--format", "{{.User}}", image) == "10001:10001"
  assert sizes["alvor-server"] <= 250
  for tool in ("g++", "cmake", "npm"):
    found = podman("run", "--rm", "--entrypoint", "sh", "alvor-server", "-c", f"command -v {tool} || echo none")
    assert found == "none", f"{tool} is in the image"
  server = world.server("--insecure")
  writing = subprocess.run(["podman", "exec", server.name, "touch", "/x"], capture_output=True, text=True)
  assert "Read-only" in writing.stderr
  assert server.is_healthy()
  assert server.stop() == 0
  assert not server.is_healthy()
  observed.append(f"server {sizes['alvor-server']:.0f} MB, client {sizes['alvor-client']:.0f} MB; SIGTERM: exit status 0")


def test_refuses_to_be_open_by_accident(world, observed):
  """Image without options: does not take calls of others without TLS."""
  said = subprocess.run(["podman", "run", "--rm", "alvor-server"], capture_output=True, text=True, timeout=60)
  assert said.returncode == 2 and "--insecure" in said.stderr
  observed.append("exit status 2, and says what to do")


@contextlib.contextmanager
def composed(file):
  """Services of a file of docker/, up to the end of their client. Returns the folder of what that wrote."""
  compose = ["podman-compose", "--project-name", "alvor-compose", "--file", f"docker/{file}"]
  try:
    run(*compose, "up", "--detach", "--no-build", timeout=120)
    client = podman("ps", "--all", "--filter", "name=alvor-compose_client", "--format", "{{.Names}}")
    until(lambda: podman("inspect", "--format", "{{.State.Status}}", client) == "exited", 60, "the client ends")
    assert podman("inspect", "--format", "{{.State.ExitCode}}", client) == "0", podman("logs", client)
    yield pathlib.Path(podman("volume", "inspect", "--format", "{{.Mountpoint}}", "alvor-compose_pictures"))
  finally:
    run(*compose, "down", "--volumes", timeout=120, check=False)


def metrics():
  return run("curl", "--silent", "--fail", "http://127.0.0.1:9464/metrics")


def test_compose(observed):
  """docker/compose.yaml: server, page, metrics, and a client that writes pictures, as it stands."""
  with composed("compose.yaml") as out:
    pictures = list(out.glob("film/*.png"))
    assert len(pictures) > 5 and (out / "cornell_box.glb").exists()
    assert "<title>" in run("curl", "--silent", "--fail", "http://127.0.0.1:8080/")
    assert "alvor_scenes 1" in metrics()
    observed.append(f"{len(pictures)} pictures and a GLB; page and metrics answer")


def test_compose_of_ranks(observed):
  """docker/compose.ranks.yaml: a server of two ranks on two hosts, and a client that solves there, as it stands."""
  run("docker/ranks/key.sh", "docker/secrets/ssh")
  with composed("compose.ranks.yaml") as out:
    assert (out / "cornell_box.glb").exists()
    busy = [line for line in metrics().splitlines() if line.startswith("alvor_rank_cpu_seconds_total{")]
    assert len(busy) == 2, busy
    observed.append("a GLB; metrics of two ranks")
