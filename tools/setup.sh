# Sourced by ./demo and ./check: makes sure that the Debian packages for building troffer are
# installed. As root, or with sudo without a password, it installs missing ones; otherwise it prints
# the command and exits.

troffer_packages="
  g++ cmake ninja-build
  libembree-dev libtbb-dev libopenexr-dev libpng-dev libjpeg-dev libwebp-dev liblcms2-dev zlib1g-dev
  libfmt-dev libcli11-dev nlohmann-json3-dev libpugixml-dev libmicrohttpd-dev
  libdraco-dev libmeshoptimizer-dev
  pybind11-dev python3-dev python3-numpy
  doctest-dev doxygen
"

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

setup() {
  missing=""
  for package in $troffer_packages; do
    is_installed "$package" || missing="$missing $package"
  done
  [ -z "$missing" ] && return 0
  if [ "$(id -u)" = 0 ]; then
    as_root=""
  elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    as_root="sudo"
  else
    echo "These Debian packages are missing:$missing" >&2
    echo "Install them with:  apt-get install$missing" >&2
    return 1
  fi
  echo "Installing:$missing"
  $as_root apt-get update -qq
  DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null
}
