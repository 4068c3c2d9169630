#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The Python package: its own tests (python/tests) with the library that was built, and the wheel, built offline, in an
# environment of its own.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
python=/usr/bin/python3        # Debian's, with Debian's packages, whatever python3 is first
library=$(dirname "$MERLIN")/libmerlin.so
export PYTHONDONTWRITEBYTECODE=1
unset MERLIN_MODEL PYTHONPATH
if ! "$python" -c 'import setuptools, wheel, pip, numpy, pytest' 2>/dev/null; then
    echo "skipped: the Python package is tested with python3-pytest, -numpy, -pip, -setuptools and -wheel"
    exit 77
fi
if sanitized; then
    echo "its own tests of arrays and refusals, under sanitizers"
    sanitizers=$(gcc -print-file-name=libasan.so):$(gcc -print-file-name=libubsan.so)
    LD_PRELOAD=$sanitizers ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 MERLIN_LIBRARY=$library \
        "$python" -m pytest -q "$MERLIN_SOURCE_DIR"/python/tests/test_{arrays,refusals,stereo}.py ||
        complain "pytest exited with $?"
    finish
fi

echo "its own tests"
MERLIN_LIBRARY=$library "$python" -m pytest -q "$MERLIN_SOURCE_DIR/python" || complain "pytest exited with $?"

echo "the wheel is built without a network and is of this machine and of any Python 3"
mkdir "$scratch/checkout" && cd "$scratch/checkout" || exit 1
cp -r "$MERLIN_SOURCE_DIR"/{python,models,CMakeLists.txt,LICENSE} . # building writes beside the sources
mkdir -p python/build/lib.linux-x86_64-cpython-311/merlin/lib && touch "$_/stale"
MERLIN_LIBRARY=$library "$python" -m pip wheel -q --no-index --no-deps --no-build-isolation --disable-pip-version-check \
    -w "$scratch" ./python >wheel.log 2>&1 || complain "no wheel: $(cat wheel.log)"
wheel=("$scratch"/libmerlin-*-py3-none-linux_"$(uname -m)".whl)
present "${wheel[0]}"
"$python" -m zipfile -l "${wheel[0]}" >listed
for name in lib/libmerlin.so lib/needs.txt models/merlin-{any,point,env}.safetensors py.typed; do
    grep -q "^merlin/$name " listed || complain "there is no $name in it"
done
grep -q stale listed && complain "it holds what an earlier build has left"

echo "installed into an environment it needs nothing of the checkout"
"$python" -m venv --without-pip --system-site-packages "$scratch/env"
"$scratch/env/bin/python" -m pip install -q --no-index --no-deps --disable-pip-version-check "${wheel[0]}" >pip.log 2>&1 ||
    complain "it does not install: $(cat pip.log)"
cd "$scratch" && rm -rf checkout
succeeds 'merlin-any (128, 128, 3)' "$scratch/env/bin/python" -W ignore -c "
import merlin
photo, mask = merlin.read_image('$MERLIN_SOURCE_DIR/examples/demo.png')
maps = merlin.Model('merlin-any').estimate(photo[::4, ::4], mask[::4, ::4], size=64, views=1)
assert '$scratch/env' in merlin._call.library_path
print(maps.model_name, maps.albedo.shape)"

echo "a library that is missing is named with the command that installs it"
site=$(dirname "$("$scratch/env/bin/python" -c 'import merlin; print(merlin.__file__)')")
echo 'int merlin_gone;' | cc -shared -x c - -Wl,-soname,libgone.so.1 -o libgone.so
echo 'extern int merlin_gone; int *merlin_here = &merlin_gone;' |
    cc -shared -fPIC -x c - -x none libgone.so -o "$site/lib/libmerlin.so"
rm libgone.so
echo 'libgone.so.1 libgone1' >>"$site/lib/needs.txt"
"$scratch/env/bin/python" -c 'import merlin' 2>stderr && complain "it is imported"
[[ $(tail -n 1 stderr) == "ImportError: merlin needs libraries that are not there: sudo apt-get install libgone1" ]] ||
    complain "it says $(tail -n 1 stderr)"

finish
