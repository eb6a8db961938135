#!/usr/bin/env bash
# Installs what Alvor is built, tested and shown with on Debian 12: only what is missing, and quietly.
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache mold pkg-config
  libgrpc++-dev libprotobuf-dev protobuf-compiler protobuf-compiler-grpc
  libopenmesh-dev libembree-dev libtbb-dev libspdlog-dev
  libzstd-dev libssl-dev libsqlitecpp-dev libsqlite3-dev prometheus-cpp-dev libcpp-httplib-dev
  libassimp-dev libtinygltf-dev libtinyobjloader-dev libstb-dev libcli11-dev libpng-dev nlohmann-json3-dev
  libgtest-dev libgmock-dev clang libclang-rt-14-dev
  gnuplot-nox curl chromium
  python3-grpcio python3-zstandard python3-protobuf
)
# Node.js may come from elsewhere, with npm inside.
command -v node > /dev/null || packages+=(nodejs)
command -v npm > /dev/null || packages+=(npm)

missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null)" = installed ] || missing+=("$package")
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
