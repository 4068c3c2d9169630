#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin export from outside: which files it writes, that they are what their readers expect, and how it refuses.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
examples=${MERLIN_SOURCE_DIR:?}/examples
cd "$scratch" || exit 1
export_maps() { "$MERLIN" export "$@"; }
files_of() { (cd "$1" && echo *); }

succeeds cup.merlin "$MERLIN" estimate "$examples/demo.png" --size 256 -o cup.merlin

echo "the usual maps"
succeeds '^cup.merlin: cup.merlin/export, 512 x 512, relief 0[.].* 7 files, ' export_maps cup.merlin
[ "$(files_of cup.merlin/export)" = "albedo.png alpha.png ao.png export.json height.png normal.png roughness.png" ] ||
    complain "other files: $(files_of cup.merlin/export)"
cmp -s cup.merlin/export/albedo.png cup.merlin/albedo.png && complain "beside the object there is no colour"
succeeds '"side":512' export_maps cup.merlin/maps.exr --json -q
lists_its_files cup.merlin/export albedo.png alpha.png ao.png export.json height.png normal.png roughness.png

echo "those that are asked for, by the way that is asked for"
succeeds . export_maps cup.merlin --maps normal,orm --normal-y down --size 256 -o unreal
[ "$(files_of unreal)" = "export.json normal.png orm.png" ] || complain "other files: $(files_of unreal)"
grep -q '"normal_y":[[:space:]]*"down"' unreal/export.json && grep -q '"side":[[:space:]]*256' unreal/export.json ||
    complain "export.json says otherwise: $(cat unreal/export.json)"
succeeds . export_maps cup.merlin --maps all --size 128 -o all
[ "$(files_of all)" = "albedo.png alpha.png ao.png export.json height.exr height.png material.mtlx normal.png orm.png roughness.png smoothness.png" ] ||
    complain "other files: $(files_of all)"
if command -v xmllint >/dev/null; then
    xmllint --noout all/material.mtlx || complain "material.mtlx is no XML"
fi
for file in albedo normal roughness; do
    grep -q "value=\"$file.png\"" all/material.mtlx || complain "material.mtlx does not name $file.png"
done
export_maps cup.merlin -q -o quiet >said && [ ! -s said ] || complain "-q says something"

echo "a captured surface"
succeeds dome "$MERLIN" relight cup.merlin --dome 8 --lp --matte -o dome
succeeds surface "$MERLIN" stereo dome -o surface
succeeds '^surface: surface/export, 128 x 128, ' export_maps surface --size 128 --maps materialx
grep -q 'name="specular" type="float" value="0"' surface/export/material.mtlx || complain "a captured surface has gloss"
grep -q 'name="specular" type="float" value="1"' all/material.mtlx || complain "a photograph has no gloss"
grep -q '"f0":[[:space:]]*0,' surface/export/export.json || complain "export.json has gloss: $(cat surface/export/export.json)"
grep -q '"f0":[[:space:]]*0.05,' all/export.json || complain "export.json has no gloss: $(cat all/export.json)"
grep -aq '"KHR_materials_specular":{"specularFactor":0}' surface/mesh.glb || complain "a captured surface's mesh has gloss"
succeeds . "$MERLIN" stereo dome --mesh dome.usda -o surface
grep -q 'inputs:ior = 1.0000' dome.usda || complain "a captured surface has gloss in USD"
succeeds '"code":"materialx_left_out"' export_maps cup.merlin --maps all --normal-y down --size 128 -o all_down --json
grep -q 'cup.merlin: material.mtlx is left out' stderr || complain "no word: $(cat stderr)"
[ "$(files_of all_down)" = "albedo.png alpha.png ao.png export.json height.exr height.png normal.png orm.png roughness.png smoothness.png" ] ||
    complain "other files: $(files_of all_down)"

echo "bad input gets one line, and nothing is half-written"
refuses 2 'no folder of maps given' export_maps
refuses 2 'one folder at a time' export_maps cup.merlin cup.merlin
refuses 2 'knows no "gloss", but albedo' export_maps cup.merlin --maps albedo,gloss
refuses 2 'knows no ""' export_maps cup.merlin --maps albedo,
refuses 2 'is up or down, not "left"' export_maps cup.merlin --normal-y left
refuses 2 'green is down' export_maps cup.merlin --maps materialx --normal-y down -o none
refuses 2 '--size' export_maps cup.merlin --size 63
refuses 1 'there is no folder nowhere' export_maps nowhere
refuses 1 'is no folder of maps: merlin estimate' export_maps "$examples/demo.png"
refuses 1 'choose another folder' export_maps cup.merlin -o cup.merlin
mkdir mine && echo mine >mine/normal.png
refuses 1 'cannot write into mine: its normal.png is no earlier export' export_maps cup.merlin --size 128 -o mine
[ "$(ls mine)" = normal.png ] && [ "$(cat mine/normal.png)" = mine ] || complain "mine has $(ls mine)"
succeeds . export_maps cup.merlin --maps orm --size 128 -o mine # which replaces nothing
succeeds . export_maps cup.merlin --maps orm --size 64 -o mine
mkdir empty
refuses 1 'no maps.exr in empty' export_maps empty
: >taken
refuses 1 'taken' export_maps cup.merlin -o taken
"$MERLIN" export cup.merlin --maps all --size 4096 -o stopped >out 2>err &
pid=$!
sleep 0.3
kill -INT $pid
wait $pid && complain "an interrupted export exits with 0"
[ "$(<err)" = "merlin export: interrupted; nothing was written to stopped" ] || complain "after an interrupt: $(<err)"
absent stopped
[ ! -e none ] && [ "$(ls -A empty)" = "" ] || complain "left behind: $(ls -A none empty)"
finish
