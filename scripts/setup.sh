#!/usr/bin/env bash
# setup.sh [PART...]: installs what Alvor needs on Debian 12, only what is missing, and quietly. Parts: `compile`, `page` for building it, `test`,
# which shows too, and `containers`. All but the last if none is named.
set -euo pipefail

compile=(
  g++ cmake ninja-build ccache mold pkg-config
  libabsl-dev libgrpc++-dev libprotobuf-dev protobuf-compiler protobuf-compiler-grpc
  libopenmesh-dev libembree-dev libtbb-dev libspdlog-dev
  libzstd-dev libssl-dev libsqlitecpp-dev libsqlite3-dev prometheus-cpp-dev libboost-dev
  libassimp-dev libtinygltf-dev libtinyobjloader-dev libstb-dev libcli11-dev libpng-dev libwebp-dev libopenexr-dev libcairo2-dev
  nlohmann-json3-dev libseccomp-dev libopenmpi-dev
)
page=(protobuf-compiler libprotobuf-dev)
# Node.js may come from elsewhere, with npm inside.
command -v node > /dev/null || page+=(nodejs)
command -v npm > /dev/null || page+=(npm)
test=(
  libgtest-dev libgmock-dev libcpp-httplib-dev clang libclang-rt-14-dev
  gnuplot-nox curl chromium
  python3-grpcio python3-zstandard python3-protobuf
  nginx-light python3-hpack openssl openmpi-bin
)
containers=(
  podman podman-compose buildah runc netavark aardvark-dns iptables iproute2 catatonit debootstrap
  curl openssl faketime python3-pytest
)

[ $# -gt 0 ] || set -- compile page test
missing=()
for part; do
  declare -n packages=$part
  for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null)" = installed ] || missing+=("$package")
  done
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo > /dev/null || { echo "setup: needs root or sudo to install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
install() {
  "${as_root[@]}" apt-get update -qq &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}
install > "$log" 2>&1 || { cat "$log" >&2; exit 1; }
