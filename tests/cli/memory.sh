#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# How much memory estimate holds for photographs of many megapixels: what docs/performance.md says.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
if sanitized; then
    echo "skipped: sanitizers hold more"
    exit 77
fi

# ball WIDTH HEIGHT: a grey PGM of a shaded ball that nearly fills the frame.
ball() {
    perl -e '
        my ($w, $h) = @ARGV;
        my $r = 0.42 * $h;
        print "P5\n$w $h\n255\n";
        for my $y (0 .. $h - 1) {
            my $v = ($y - $h / 2) / $r;
            my $s = $v * $v < 1 ? sqrt(1 - $v * $v) : 0;
            my $row = "\2" x int($w / 2 - $s * $r);
            for my $k (0 .. 63) {
                my $z = $s * sqrt(1 - (($k + .5) / 32 - 1) ** 2);
                $row .= chr(40 + 150 * $z) x (int($s * $r * ($k + 1) / 32) - int($s * $r * $k / 32));
            }
            print $row, "\2" x ($w - length $row);
        }' "$1" "$2"
}

# holds_at_most MEGABYTES WIDTH HEIGHT [OPTION]: of such a picture.
holds_at_most() {
    local peak
    ball "$2" "$3" >"$scratch/ball.pgm"
    peak=$("$PEAK_MEMORY" "$MERLIN" estimate "$scratch/ball.pgm" -o "$scratch/maps" --quiet "${@:4}") || complain "$2x$3 is refused"
    echo "$2x$3 ${*:4}: $peak MB"
    ((peak <= $1)) || complain "a picture of $2x$3 needs $peak MB, more than $1"
}

# In float32, too, which needs more than bfloat16.
for isa in "" AVX512_CORE; do
    export ONEDNN_MAX_CPU_ISA=${isa:-ALL}
    holds_at_most 150 256 256
    holds_at_most 250 512 512
    holds_at_most 250 512 512 --flash
done
holds_at_most 660 4000 3000
holds_at_most 1080 12000 8500 # read at half of its size
finish
