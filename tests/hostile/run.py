#!/usr/bin/python3
"""run.py [--seconds N] [--front none|nginx] [--table FILE] [NAME...]: attacks alvord, each attack on a server of its own, and says which promises
were held. NAMEs are those of attacks or of families' files; all if none is given. Fails where a promise was not held that is not in BARE_LACKS."""

import argparse
import pathlib
import sys
import tempfile
import time

from bare_lacks import BARE_LACKS
from machine import allow_many_descriptors
from target import Target, make_secrets, make_stubs

FAMILIES = ("floods", "slowness", "http_requests", "descriptors", "tenants", "identity", "memory", "long_work", "ending")


def parse_arguments():
  parser = argparse.ArgumentParser(description=__doc__)
  parser.add_argument("--seconds", type=float, default=1.5, help="how long each flood lasts, at most 30 (1.5)")
  parser.add_argument("--front", choices=("none", "nginx"), default="none")
  parser.add_argument("--table", help="where to write what was seen, as Markdown")
  parser.add_argument("names", nargs="*", metavar="NAME")
  arguments = parser.parse_args()
  arguments.seconds = min(arguments.seconds, 30)
  return arguments


def chosen_attacks(names):
  """Families are imported here, because they need the stubs."""
  families = {family: __import__(family) for family in FAMILIES}
  from attack import ATTACKS
  unknown = set(names) - set(families) - {each.name for each in ATTACKS}
  if unknown:
    sys.exit(f"run.py: no attack or family is called {', '.join(sorted(unknown))}")
  return [each for each in ATTACKS if not names or each.name in names or each.run.__module__ in names]


def try_out(attack, folder, arguments):
  """Returns (whether the promise was held, what was seen, the seconds that it took)."""
  begin, target = time.monotonic(), None
  try:
    if attack.prepare:
      attack.prepare(folder)
    options = [option.format(folder=folder) for option in attack.options]
    target = Target(folder, arguments.front, options, attack.descriptors)
    held, seen = True, attack.run(target, arguments.seconds)
  except Exception as failure:  # whatever an attack meets, the next one is tried
    held, seen = False, " ".join(f"{type(failure).__name__ + ': ' if not isinstance(failure, AssertionError) else ''}{failure}".split())
  finally:
    if target:
      target.close()
  return held, seen[:300], time.monotonic() - begin


def verdict(attack, held, front):
  if front == "none" and attack.name in BARE_LACKS:
    return "held this time" if held else "not held, as is known"
  return "held" if held else "NOT HELD"


def main():
  arguments = parse_arguments()
  allow_many_descriptors()
  rows, failures = [], []
  with tempfile.TemporaryDirectory(prefix="alvor-hostile-") as work:
    work = pathlib.Path(work)
    make_stubs(work)
    for number, attack in enumerate(chosen_attacks(arguments.names)):
      folder = work / str(number)
      folder.mkdir()
      make_secrets(folder)
      held, seen, seconds = try_out(attack, folder, arguments)
      word = verdict(attack, held, arguments.front)
      failures += [attack.name] if word == "NOT HELD" else []
      rows.append(f"| {attack.family} | `{attack.name}` | {attack.promise} | {word} | {seen} | {seconds:.0f} |")
      print(f"{word:12} {attack.name} ({seconds:.1f} s): {seen}", flush=True)
  if arguments.table:
    head = "| family | attack | promise | verdict | seen | s |\n|---|---|---|---|---|---|\n"
    pathlib.Path(arguments.table).write_text("\n" + head + "\n".join(rows) + "\n\n")
  print(f"{len(rows) - len(failures)} of {len(rows)} as they should be" + (f"; NOT HELD: {', '.join(failures)}" if failures else ""))
  sys.exit(1 if failures else 0)


if __name__ == "__main__":
  main()
