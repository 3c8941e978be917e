#!/bin/sh
# next_blender.sh ARGUMENT...    runs the next Debian's Blender in the root that test_platforms.sh makes. The project and /tmp
# have the same paths inside as outside, and the only network is the machine itself. The mounts belong to the process and end
# with it.
set -eu

project=$(cd "$(dirname "$0")/.." && pwd)
sudo=
[ "$(id -u)" -eq 0 ] || sudo="sudo -E"
# Keep mounts private where the system allows it; inside another root, existing mounts may refuse to become private.
inside=private
$sudo unshare --mount true 2>/dev/null || inside=unchanged
# shellcheck disable=SC2016 # the inner shell's own arguments
exec $sudo unshare --mount --propagation $inside --net sh -euc '
  root=$1 project=$2 folder=$3 owner=$4
  shift 4
  ip link set lo up
  mount --rbind /dev "$root/dev"
  mount -t proc proc "$root/proc"
  mount --bind /tmp "$root/tmp"
  mkdir -p "$root$project"
  mount --bind "$project" "$root$project"
  exec chroot --userspec="$owner" "$root" /usr/bin/env -C "$folder" LANG=C.UTF-8 /usr/bin/blender "$@"
' sh "$project/build/platforms/roots/trixie" "$project" "$PWD" "$(id -u):$(id -g)" "$@"
