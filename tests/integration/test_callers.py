"""Who may call, and how much they may have."""

import hashlib
import os

from conftest import SCENES, alvor, reason, scenes, solves
from hosts import run, until

FAKETIME = "/usr/lib/x86_64-linux-gnu/faketime"
TLS = ["--tls-cert", "/tls/server.pem", "--tls-key", "/tls/server.key"]


def certificate(folder, name, *, moment="now", days=7):
  """A key and a certificate for the host `server`, its own authority, made at a moment that faketime(1) understands."""
  request = ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", days, "-subj",
             f"/CN={name}", "-addext", "subjectAltName=DNS:server,IP:127.0.0.1", "-keyout", f"{name}.key", "-out", f"{name}.pem"]
  run("faketime", moment, *request, cwd=folder)
  for file in (f"{name}.key", f"{name}.pem"):
    os.chmod(folder / file, 0o644)


def tokens(folder, *names):
  lines = []
  for name in names:
    (folder / f"{name}.token").write_text(f"secret of {name}\n")
    lines.append(f"{name} {hashlib.sha256(f'secret of {name}'.encode()).hexdigest()}")
  (folder / "tokens").write_text("\n".join(lines) + "\n")


def as_tenant(name):
  return ["--tls-ca", "/out/server.pem", "--token-file", f"/out/{name}.token"]


def test_tls_and_tokens(world, observed):
  """TLS and tokens: a wrong or expired certificate, a wrong token or none gets nobody in, and health is told all the same."""
  for name, moment in (("server", "now"), ("other", "now"), ("expired", "30 days ago")):
    certificate(world.folder, name, moment=moment)
  tokens(world.folder, "ann")
  (world.folder / "wrong.token").write_text("secret of nobody\n")
  mount = [f"--volume={world.folder}:/tls:ro"]
  server = world.server(*TLS, "--tokens", "/tls/tokens", options=mount)
  desk = world.desk()
  asked = lambda *options: alvor(desk, "scenes", "list", *options, check=False)
  assert asked(*as_tenant("ann"))[0] == 0
  wrong_token, wrong_certificate = asked(*as_tenant("wrong")), asked("--tls-ca", "/out/other.pem")
  assert wrong_token[0] == 5 and "not a token" in wrong_token[2]
  assert asked("--tls-ca", "/out/server.pem")[0] == 5
  assert wrong_certificate[0] == 4
  assert asked()[0] == 4, "plaintext"
  server.remove()
  world.server("--tls-cert", "/tls/expired.pem", "--tls-key", "/tls/expired.key", options=mount)
  assert asked("--tls-ca", "/out/expired.pem")[0] == 4
  observed.append("wrong token, none: 5; wrong certificate, expired certificate, plaintext: 4; with the right ones: 0")


def test_quotas(world, observed):
  """Two tenants at their quotas: each is refused beyond its own, neither sees nor stops the other."""
  certificate(world.folder, "server")
  tokens(world.folder, "ann", "bob")
  world.server(*TLS, "--tokens", "/tls/tokens", "--quota-scenes", "2", options=[f"--volume={world.folder}:/tls:ro"])
  desk = world.desk()
  submit = lambda who, scene: alvor(desk, "solve", f"{SCENES}/{scene}.obj", "--max-depth", 0, *as_tenant(who), check=False)
  for who in ("ann", "bob"):
    assert submit(who, "cornell_box")[0] == 0 and submit(who, "enfilade")[0] == 0
    status, _, said = submit(who, "vault")
    assert status == 5 and "scenes: 2 exist" in said
  names = {who: {each["name"] for each in scenes(desk, *as_tenant(who))} for who in ("ann", "bob")}
  assert len(names["ann"]) == len(names["bob"]) == 2 and not names["ann"] & names["bob"]
  assert alvor(desk, "scenes", "delete", names["ann"].pop(), *as_tenant("bob"), check=False)[0] == 3, "there is no such scene"
  observed.append(f"the third scene of each: \"{reason(submit('ann', 'vault')[2])}\"; no scene seen by both")


def test_clock_skew(world, observed):
  """Clocks a day apart: solving, watching and TLS work, and after a restart no nonsense is told."""
  certificate(world.folder, "server", moment="3 days ago", days=30)
  skewed = lambda days: [f"--volume={FAKETIME}:/faketime:ro", "--env=LD_PRELOAD=/faketime/libfaketimeMT.so.1", f"--env=FAKETIME={days:+}d",
                         "--env=FAKETIME_DONT_FAKE_MONOTONIC=1"]
  mount = f"--volume={world.folder}:/tls:ro"
  server = world.server(*TLS, options=[mount, *skewed(1)])
  desk = world.desk()
  trusted = ["--tls-ca", "/out/server.pem"]
  command = ["solve", f"{SCENES}/cornell_box.obj", "--tolerance", "0.02"]
  alvor(desk, *command, "-o", "ahead.glb", *trusted)
  slow = world.client(*command, "--pace", "0.5", "--server", "server:50051", *trusted, "-o", "slow.glb", options=skewed(-1))
  until(lambda: len(solves(desk, *trusted)) == 2 and solves(desk, *trusted)[0]["shots"] > 0, 20, "the second solves")
  assert server.stop() == 0
  server.remove()
  world.server(*TLS, options=[mount, *skewed(-1)])
  assert slow.wait(90) == 0
  both = solves(desk, *trusted)
  assert [each["restarts"] for each in both] == [1, 0]
  assert all(0 <= each["work_lost_s"] < 30 and 0 < each["elapsed_s"] < 60 for each in both), both
  assert world.digest("ahead.glb") == world.digest("slow.glb")
  observed.append("server a day ahead, then a day behind, client a day behind; equal files; no time lost or negative")
