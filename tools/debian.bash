# SPDX-License-Identifier: MIT
# For scripts that try things in a Debian or Ubuntu of its own, a folder that debootstrap fills:
#
#     source tools/debian.bash
#     debian_make bookworm /var/tmp/merlin-bookworm     fills the folder, unless an earlier run did
#     debian_run "$folder" 'make demo'                  as root in it, with mounts and processes that end with it

refuse() {
    echo "merlin: $*" >&2
    exit 1
}

debian_make() {
    local suite=$1 folder=$2 components=main mirror
    case $suite in
    jammy | noble | questing | resolute) components=main,universe mirror=${MIRROR:-http://archive.ubuntu.com/ubuntu} ;;
    *) mirror=${MIRROR:-http://deb.debian.org/debian} ;;
    esac
    [ "$(id -u)" = 0 ] || refuse "a system of its own needs root: sudo $0 $*"
    for command in debootstrap git unshare; do
        command -v "$command" >/dev/null || refuse "$command is needed: apt-get install debootstrap git util-linux"
    done
    if [ ! -e "$folder/etc/merlin-suite" ]; then
        [ ! -e "$folder" ] || [ -z "$(ls -A "$folder")" ] || refuse "$folder is not empty and was not made by a whole run: remove it"
        echo "a new $suite from $mirror in $folder"
        debootstrap --variant=minbase --components="$components" "$suite" "$folder" "$mirror" >"$folder.log" 2>&1 ||
            refuse "debootstrap has failed: $(tail -1 "$folder.log") (all it said: $folder.log; remove $folder)"
        rm "$folder.log"
        echo "$suite" >"$folder/etc/merlin-suite"
    fi
    [ "$(cat "$folder/etc/merlin-suite")" = "$suite" ] || refuse "$folder holds another suite: $(cat "$folder/etc/merlin-suite")"
}

debian_run() {
    unshare --mount --propagation private --pid --fork bash -euc '
        mount -t proc proc "$0/proc"
        mount -t sysfs -o ro sysfs "$0/sys"
        mount --rbind /dev "$0/dev"
        mount -t tmpfs tmpfs "$0/dev/shm"
        cp /etc/resolv.conf "$0/etc/resolv.conf"
        exec env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
            DEBIAN_FRONTEND=noninteractive ${CI:+CI="$CI"} chroot "$0" sh -ec "$1"
    ' "$1" "$2"
}
