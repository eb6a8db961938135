#!/usr/bin/env bash
# Proves, with clang's thread-safety analysis, that the members of the server that a mutex guards are used only where it is held (server/base/mutex.h).
# Needs the release build: its flags and generated files. Arguments: the sources to look at; without any, all of server.
set -euo pipefail
cd "$(dirname "$0")/.."
clang=${CLANG:-clang++-14}

flags_and_sources() {
  python3 - "$@" <<'PYTHON'
import json, os, re, shlex, subprocess, sys
wanted = {os.path.realpath(name) for name in sys.argv[1:]}
server = os.path.realpath("server") + os.sep
units = json.loads(subprocess.check_output(["ninja", "-C", "build/release", "-t", "compdb"]))
lines = []
for unit in units:
    source = os.path.realpath(os.path.join(unit["directory"], unit["file"]))
    together = [os.path.realpath(name) for name in re.findall(r'#include "(.*)"', open(source).read())] if "/together/" in source and source.endswith(".cpp") else [source]
    looked_at = [name for name in together if name.startswith(server) and name.endswith(".cpp")]
    if not looked_at or wanted.isdisjoint(looked_at) and wanted: continue
    words, flags = iter(shlex.split(unit["command"])), []
    for word in words:
        if word in ("-include", "-isystem", "-I"):
            value = next(words)
            if "cmake_pch" not in value: flags += [word, value]
        elif word.startswith(("-D", "-I", "-std=", "-march=")):
            flags.append(word)
    lines.append(" ".join(shlex.quote(word) for word in flags + [source]))
if not lines: sys.exit("no sources to look at")
print("\n".join(lines))
PYTHON
}

listed=$(flags_and_sources "$@")
xargs -d '\n' -P "$(nproc)" -I '{}' sh -c "$clang -fsyntax-only -Wthread-safety -Werror=thread-safety {}" <<< "$listed"
echo "$(wc -l <<< "$listed") compilations of server's sources use what mutexes guard only where they hold them"
