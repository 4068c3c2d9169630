# SPDX-License-Identifier: MIT
# For the scripts about photographs, beside check.bash: input made from nothing, what must or must not lie in a folder, and
# what stands in the way of writing there.

# absent PATH...: nothing may be there.
absent() {
    for path in "$@"; do [ -e "$path" ] && complain "$path was left behind: $(ls -A "$path" | tr '\n' ' ')"; done
}

present() {
    for path in "$@"; do [ -s "$path" ] || complain "$path is missing or empty"; done
}

# await PATH: until it is there, for a minute at most.
await() {
    for _ in {1..600}; do
        [ -e "$1" ] && break
        sleep 0.1
    done
}

# limited BLOCKS COMMAND...: no file may be longer.
limited() { (ulimit -f "$1" && shift && "$@"); }

# radiance FILE SIDE RADIUS [WIDTH]: a Radiance HDR picture of a bright disc before black, SIDE high and as wide or WIDTH.
radiance() {
    local file=$1 side=$2 radius=$3 width=${4:-$2} x y row
    printf '#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n' "$side" "$width" >"$file"
    for ((y = 0; y < side; y++)); do
        row=
        for ((x = 0; x < width; x++)); do
            if (((2 * x - width) ** 2 + (2 * y - side) ** 2 < 4 * radius ** 2)); then
                row+='\240\200\140\200'
            else
                row+='\003\003\003\170'
            fi
        done
        printf "$row" >>"$file"
    done
}

# burn_out FROM TO: radiance's picture with a disc of radiance 1 in all channels, where photographs end, instead of 0.6, 0.5
# and 0.4.
burn_out() { LC_ALL=C sed 's/\xa0\x80\x60\x80/\x80\x80\x80\x81/g' "$1" >"$2"; }

# openexr FILE BYTES: 16×16 float pixels, uncompressed, every value the four bytes given as printf escapes.
openexr() {
    local file=$1 value=$2 one='\0\0\200\77' four='\4\0\0\0' y offset line=
    local box='box2i\0\20\0\0\0\0\0\0\0\0\0\0\0\17\0\0\0\17\0\0\0' kind='\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0'
    {
        printf 'v/1\1\2\0\0\0channels\0chlist\0\67\0\0\0B'"$kind"'G'"$kind"'R'"$kind"'\0'
        printf 'compression\0compression\0\1\0\0\0\0dataWindow\0'"$box"'displayWindow\0'"$box"
        printf 'lineOrder\0lineOrder\0\1\0\0\0\0pixelAspectRatio\0float\0'"$four$one"
        printf 'screenWindowCenter\0v2f\0\10\0\0\0\0\0\0\0\0\0\0\0screenWindowWidth\0float\0'"$four$one"'\0'
    } >"$file"
    offset=$(($(stat -c %s "$file") + 128))
    for ((y = 0; y < 16; y++)); do
        printf "$(printf '\\x%02x\\x%02x' $((offset % 256)) $((offset / 256)))"'\0\0\0\0\0\0' >>"$file"
        offset=$((offset + 200))
    done
    for ((y = 0; y < 48; y++)); do line+=$value; done
    for ((y = 0; y < 16; y++)); do printf "$(printf '\\x%02x' $y)"'\0\0\0\300\0\0\0'"$line" >>"$file"; done
}
