# For scripts/test-containers.sh: podman with settings and a storage of its own in $work, so that nothing else on the machine is touched.

# Debian's podman asks for systemd, for crun and for limits that a container around us may not allow.
configure_podman() {
  mkdir -p "$work/networks"
  local files processes
  files=$(ulimit -Hn) processes=$(ulimit -Hu)
  [ "$files" != unlimited ] && [ "$files" -lt 4096 ] || files=4096
  [ "$processes" != unlimited ] && [ "$processes" -lt 4096 ] || processes=4096
  cat > "$work/containers.conf" <<CONF
[containers]
default_ulimits = ["nofile=$files:$files", "nproc=$processes:$processes"]
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
events_logger = "file"
tmp_dir = "$work/tmp"
[network]
network_backend = "netavark"
network_config_dir = "$work/networks"
CONF
  cat > "$work/storage.conf" <<CONF
[storage]
driver = "overlay"
graphroot = "$work/storage"
runroot = "$work/run"
CONF
  export CONTAINERS_CONF=$work/containers.conf CONTAINERS_STORAGE_CONF=$work/storage.conf
}

# What netavark leaves behind on a host that did not use it. Noted in a file, so that what a killed run left is undone by the next.
note_network() {
  [ -e "$work/network" ] && return
  iptables-save 2> /dev/null | grep -q NETAVARK || cat /proc/sys/net/ipv4/ip_forward > "$work/network"
}
restore_network() {
  local tables others
  [ -e "$work/network" ] || return 0
  others=$(env -u CONTAINERS_CONF -u CONTAINERS_STORAGE_CONF podman ps --quiet 2> /dev/null || true)
  if [ -z "$others" ]; then # who came meanwhile needs them
    for tables in iptables ip6tables; do
      $tables-save 2> /dev/null | grep -v NETAVARK | $tables-restore 2> /dev/null || true
    done
    cat "$work/network" > /proc/sys/net/ipv4/ip_forward
  fi
  rm "$work/network"
}

# remove_containers KEEP: and networks; images too, unless KEEP is 1.
remove_containers() {
  podman rm --all --force --time 0 > /dev/null 2>&1 || true
  podman network prune --force > /dev/null 2>&1 || true
  podman volume rm --all --force > /dev/null 2>&1 || true
  [ "$1" = 1 ] && return
  podman rmi --all --force > /dev/null 2>&1 || true
  podman unmount --all > /dev/null 2>&1 || true
  findmnt -rno TARGET | grep -F "$work/" | sort -r | xargs -r umount -l 2> /dev/null || true
  rm -rf "$work/storage" "$work/run" "$work/networks" "$work/tmp" "$work/base"
}

# The base image: from a registry, or, where none answers, made of the packages that this machine's apt is set up for.
base_image=docker.io/library/debian:bookworm-slim
provide_base_image() {
  podman image exists "$base_image" && return
  timeout 60 podman pull -q "$base_image" > /dev/null 2>&1 && return
  local root=$work/base sources mirror
  sources=$(apt-get indextargets --format 'deb $(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' | sort -u)
  mirror=$(awk '$3 == "bookworm" { print $2; exit }' <<< "$sources")
  [ -n "$mirror" ] || { echo "no registry answers, and apt knows no mirror of bookworm" >&2; return 1; }
  rm -rf "$root"
  debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "$mirror" > "$work/debootstrap.log" 2>&1 ||
    { tail -5 "$work/debootstrap.log" >&2; return 1; }
  echo "$sources" > "$root/etc/apt/sources.list"
  apt-config dump Acquire::http::Proxy > "$root/etc/apt/apt.conf.d/proxy"
  # As small as the published one: without what nobody reads there.
  local unread=(usr/share/doc usr/share/man usr/share/info usr/share/locale)
  printf 'path-exclude /%s/*\n' "${unread[@]}" > "$root/etc/dpkg/dpkg.cfg.d/slim"
  (cd "$root" && rm -rf "${unread[@]}" var/cache/* var/log/* var/lib/apt/lists/* && mkdir -p var/cache/apt/archives/partial var/log/apt)
  tar -C "$root" -c . | podman import - "$base_image" > /dev/null 2>> "$work/debootstrap.log"
  rm -rf "$root"
}

# build_image NAME [TARGET]: alvor-NAME, or alvor-TARGET, from docker/NAME.Dockerfile, with the certificates, npm's registry and the compiler's cache of this machine.
build_image() {
  local image=${2:-$1} ccache=${CCACHE_DIR:-$HOME/.cache/ccache}
  mkdir -p "$ccache"
  printf 'registry=%s\ncafile=/etc/ssl/certs/ca-certificates.crt\n' "$(npm config get registry 2> /dev/null || echo https://registry.npmjs.org/)" > "$work/npmrc"
  podman build --quiet --jobs 2 --network host --format docker --pull=never --volume /etc/ssl/certs:/etc/ssl/certs:ro \
    --volume "$work/npmrc:/root/.npmrc:ro" --volume "$ccache:/root/.cache/ccache" \
    -f "docker/$1.Dockerfile" ${2:+--target "$2"} -t "alvor-$image" . > "$work/build-$image.log" 2>&1 ||
    { tail -30 "$work/build-$image.log" >&2; return 1; }
}
