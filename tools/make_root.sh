#!/bin/bash
# Builds and tests Tenebra on another system: makes a root of that system in a folder, copies this checkout into it,
# and runs ./demo.sh and ./test.sh there.
# Usage: tools/make_root.sh [options] debian12|debian13|ubuntu24.04
#   --root FOLDER      where the root is, or is made [$TMPDIR/tenebra-roots/NAME]; an existing one is used again
#   --mirror URL       the archive [the one that this machine's apt uses, if it is of that system; else the public one]
#   --keyring FILE     the archive's keys [those in /usr/share/keyrings]
#   --only-make        makes the root and copies the checkout, runs nothing
#   --run COMMAND      runs COMMAND in the copy instead of ./demo.sh && ./test.sh
# Needs mmdebstrap or debootstrap, and to be root.
set -euo pipefail
checkout=$(cd "$(dirname "$0")/.." && pwd)

stop() {
  echo "tools/make_root.sh: $*" >&2
  exit 2
}

read_options() {
  name='' root='' mirror='' keyring='' command='./demo.sh && ./test.sh'
  while (($#)); do
    case $1 in
      --root | --mirror | --keyring | --run) (($# > 1)) || stop "$1 needs a value" ;;&
      --root) root=$2 && shift ;;
      --mirror) mirror=$2 && shift ;;
      --keyring) keyring=$2 && shift ;;
      --run) command=$2 && shift ;;
      --only-make) command='' ;;
      -*) stop "found the option $1, which is none of its own" ;;
      *) name=$1 ;;
    esac
    shift
  done
  case $name in
    debian12) suite=bookworm vendor=Debian ;;
    debian13) suite=trixie vendor=Debian ;;
    ubuntu24.04) suite=noble vendor=Ubuntu ;;
    *) stop "found '$name', expected debian12, debian13 or ubuntu24.04" ;;
  esac
  if [[ $vendor == Debian ]]; then
    components=main
    : "${keyring:=/usr/share/keyrings/debian-archive-keyring.gpg}"
    : "${mirror:=$(own_mirror)}" "${mirror:=http://deb.debian.org/debian}"
  else
    components=main,universe
    : "${keyring:=/usr/share/keyrings/ubuntu-archive-keyring.gpg}"
    : "${mirror:=$(own_mirror)}" "${mirror:=http://archive.ubuntu.com/ubuntu}"
  fi
  : "${root:=${TMPDIR:-/tmp}/tenebra-roots/$name}"
}

# The first archive of $vendor among the sources of this machine's apt, leaving out those of security updates alone.
own_mirror() {
  apt-get indextargets --format '$(ORIGIN)/$(LABEL) $(REPO_URI)' 'Created-By: Packages' 2> /dev/null |
    awk -v wanted="$vendor/$vendor" '$1 == wanted && !found { print $2; found = 1 }'
}

make_root() {
  [[ -e $keyring ]] || stop "$keyring is missing: install $vendor's keyring package, or name the keys with --keyring"
  mkdir -p "$root"
  if command -v mmdebstrap > /dev/null; then
    mmdebstrap --variant=apt --components="$components" --keyring="$keyring" "$suite" "$root" "$mirror"
  elif command -v debootstrap > /dev/null; then
    debootstrap --variant=minbase --components="$components" --keyring="$keyring" "$suite" "$root" "$mirror"
  else
    stop "found neither mmdebstrap nor debootstrap; a package of that name has it"
  fi
  apt-config dump 2> /dev/null | grep -i '^Acquire::[a-z]*::Proxy' > "$root/etc/apt/apt.conf.d/99proxy" || true
}

# What git tracks or would track; what was built in the root before stays there.
copy_checkout() {
  mkdir -p "$root/tenebra"
  find "$root/tenebra" -mindepth 1 -maxdepth 1 ! -name 'build*' -exec rm -rf {} +
  git -C "$checkout" ls-files -z --cached --others --exclude-standard |
    tar -C "$checkout" --null --files-from - --ignore-failed-read -c | tar -C "$root/tenebra" --no-same-owner -x
}

# In a mount and process space of its own, so that nothing is left mounted and nothing left running. unshare itself ignores
# SIGTERM; its end is the end of all within.
run_in_root() {
  local within
  cp --remove-destination -L /etc/resolv.conf /etc/hosts "$root/etc/"
  unshare --mount --pid --fork --kill-child bash -euc '
    mount -t proc proc "$0/proc"
    mount --rbind /dev "$0/dev"
    exec chroot "$0" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
      ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
      bash -c "cd /tenebra && $1"' "$root" "$1" <&0 &
  within=$!
  trap 'kill -KILL "$within"; exit 130' INT
  trap 'kill -KILL "$within"; exit 143' TERM
  wait "$within"
  trap - INT TERM
}

read_options "$@"
((EUID == 0)) || stop "needs to be root: a root is entered by chroot"
[[ -e $root/etc/os-release ]] || make_root
copy_checkout
[[ -z $command ]] || run_in_root "$command"
