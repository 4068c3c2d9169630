#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What make install puts under a prefix is all that another program needs, wherever that prefix is.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
build=$(dirname "$MERLIN")
examples=$MERLIN_SOURCE_DIR/examples
if sanitized; then
    echo "a sanitized library wants a sanitized program: not tested"
    exit 0
fi
make_tiny_model
cd "$scratch" || exit 1
radiance disc.hdr 64 22
cmake --install "$build" --prefix "$scratch/first" >install.log || complain "it does not install: $(cat install.log)"
mv first prefix # nothing may remember the place

echo "make install takes a prefix with a blank in it for one"
make -n -C "$MERLIN_SOURCE_DIR" install PREFIX="$scratch/my programs" >make.log 2>&1
grep -q -e "--prefix [\"']$scratch/my programs[\"']\$" make.log || complain "it would run: $(grep -e --prefix make.log)"

echo "the installed command finds its weights and its manual lies where man looks"
succeeds merlin-point prefix/bin/merlin info merlin-point
present prefix/share/man/man1/merlin.1 prefix/share/bash-completion/completions/merlin \
    prefix/share/zsh/site-functions/_merlin prefix/share/fish/vendor_completions.d/merlin.fish

echo "a program that was built with one minor version before 1.0 finds no other"
version=$(prefix/bin/merlin --version | cut -d ' ' -f 2)
[[ $version == 0.* ]] && readelf -d prefix/lib*/libmerlin.so | grep -qF "[libmerlin.so.${version%.*}]" ||
    complain "the library's soname is not of $version: $(readelf -d prefix/lib*/libmerlin.so | grep SONAME)"

makes() {
    LD_LIBRARY_PATH=$(dirname prefix/lib*/libmerlin.so) "$1" weights.safetensors disc.hdr "$2" || complain "$1 fails"
    present "$2"
}

echo "the examples are built by pkg-config"
description=$(dirname prefix/lib*/pkgconfig/merlin.pc)
export PKG_CONFIG_PATH=$scratch/$description
for name in relight_photo photo_to_mesh capture_to_surface; do
    # shellcheck disable=SC2046
    cc "$examples/$name.c" $(pkg-config --cflags --libs merlin) -lm -o $name ||
        complain "pkg-config's answer does not build $name"
done
makes ./relight_photo pkg-config.png
makes ./photo_to_mesh mesh.glb
"$MERLIN" relight disc.hdr --model weights.safetensors --dome 12 --lp -o capture -q || complain "no pictures of the disc"
LD_LIBRARY_PATH=$(dirname prefix/lib*/libmerlin.so) ./capture_to_surface weights.safetensors capture captured 2>stderr ||
    complain "./capture_to_surface fails: $(cat stderr)"
present captured/{maps.exr,report.json,mesh.glb,relit.png}
present "$(pkg-config --variable=models merlin)/merlin-point.safetensors"
[[ $(pkg-config --modversion merlin) == "$version" ]] || complain "pkg-config's version is not the command's"

echo "an example is built by CMake's find_package"
cat >CMakeLists.txt <<CMAKE
cmake_minimum_required(VERSION 3.13)
project(other LANGUAGES C)
find_package(merlin 0.1 REQUIRED)
add_executable(by-cmake $examples/relight_photo.c)
target_link_libraries(by-cmake PRIVATE merlin::merlin)
message("models: \${merlin_MODELS}")
CMAKE
cmake -S . -B other -DCMAKE_PREFIX_PATH="$scratch/prefix" >cmake.log 2>&1 || complain "$(cat cmake.log)"
present "$(sed -n 's/^models: //p' cmake.log)/merlin-point.safetensors"
cmake --build other >cmake.log 2>&1 || complain "$(cat cmake.log)"
makes other/by-cmake cmake.png

finish
