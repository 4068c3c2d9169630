# SPDX-License-Identifier: MIT
# For tests/cli/cases/*.sh: inputs that go wrong, kept outside of the project, each with what is right. Where they are missing
# the test says so and is skipped.
#
#     source "$(dirname "$0")/../support/cases.bash"
#     case_begin 04-png16-srgb-chunk        # a copy of the case in $scratch, which is the current folder then
#     succeeds ... ; finish

# shellcheck source=tests/cli/support/check.bash
source "$(dirname "${BASH_SOURCE[0]}")/check.bash"

# case_begin NAME: copies the case, for results are written beside inputs, and enters it.
case_begin() {
    local from=${MERLIN_SOURCE_DIR:?}/../shared/cases/$1
    if [[ ! -d $from ]]; then
        echo "skipped: ../shared/cases/$1 is not here"
        exit 77
    fi
    cp -r "$from" "$scratch/$1"
    chmod -R u+w "$scratch/$1"
    cd "$scratch/$1" || exit 1
}

# normals_within LIMIT A B: the normals of two result folders differ by at most so many degrees in the mean.
normals_within() {
    local degrees
    degrees=$("${NORMALS_DIFFER:?}" "$2" "$3") || complain "$2 and $3 cannot be compared"
    awk -v d="${degrees:-180}" -v most="$1" 'BEGIN { exit !(d <= most) }' ||
        complain "normals of $2 and $3 differ by $degrees degrees, more than $1"
}

# bounded COMMAND...: with at most 10 s and, but under sanitizers, which map terabytes, 1.5 GB of addresses.
bounded() (
    sanitized || ulimit -v 1500000
    timeout 10 "$@"
)
