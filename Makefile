# merlin: make demo and make test do everything from a clone on a bare Debian 12 or 13; CMake (CMakePresets.json) works underneath.

MERLIN = build/release/merlin
OUT = out/demo

.PHONY: all build demo install wheel deb test-deb arm64 test-arm64 blender web test test-debian product asan debug check format fuzz setup-build setup-test setup-check setup-web clean

all: build

setup-build setup-test setup-check setup-web: setup-%:
	@tools/install-packages $*

build: setup-build
	@test -f build/release/build.ninja || cmake --preset release -DBUILD_TESTING=OFF >build-release.log 2>&1 || { cat build-release.log; exit 1; }
	@rm -f build-release.log
	@cmake --build --preset release --target merlin merlin-lab

# One photograph taken apart and lit again.
demo: build
	$(MERLIN) estimate examples/demo.png --mesh -o $(OUT)
	$(MERLIN) relight $(OUT) --orbit 24 -o $(OUT)/orbit
	@echo
	@echo "maps, reconstruction and report: $(OUT)/"
	@echo "the light going round:           $(OUT)/orbit/orbit.webp"
	@echo "overview:                        $(OUT)/overview.png"

# The commands, libmerlin.so, its headers, the weights and the manual, under PREFIX. In /usr/local the loader finds a new
# library by its cache alone.
PREFIX = /usr/local
install: build
	cmake --build --preset release --target libmerlin
	cmake --install build/release --prefix "$(PREFIX)"
	@if [ "$$(id -u)" = 0 ]; then ldconfig || true; fi

# The Python package with the library and the weights, for pip, by Debian's setuptools alone.
wheel: setup-test
	@mkdir -p build/wheel
	/usr/bin/python3 -m pip wheel -q --no-index --no-deps --no-build-isolation --disable-pip-version-check -w build/wheel ./python
	@ls build/wheel/*.whl

# A package for this Debian or Ubuntu: build/merlin_VERSION_ARCH.deb.
deb: setup-build
	@tools/make-deb

# That package in a bare system of its own, as root.
test-deb: deb
	@tools/test-deb

# The product and its tests for arm64, cross-built with what tools/install-arm64 installs.
arm64:
	@command -v aarch64-linux-gnu-gcc >/dev/null || { echo "merlin: there is no cross compiler for arm64: make test-arm64 makes a Debian with one" >&2; exit 1; }
	cmake --preset arm64
	cmake --build --preset arm64

# The same in a bare system of its own, as root, and tried there.
test-arm64: build
	@tools/test-arm64

# The Blender add-on as a zip, the same wherever it is made.
blender:
	@command -v python3 >/dev/null || { echo "merlin: python3 packs the add-on: apt-get install python3" >&2; exit 1; }
	@mkdir -p build
	@tools/pack-blender build/merlin-blender.zip
	@echo "build/merlin-blender.zip"

# The page that estimates photographs in the browser, as a folder for any web server; npm (apt-get install npm) fetches ONNX Runtime.
WEB = build/web
web: setup-web build
	@tools/make-web build/release "$(WEB)"
	@echo "$(WEB): for any web server, such as python3 -m http.server -d $(WEB)"

test: setup-test
	cmake --preset release -DBUILD_TESTING=ON
	cmake --build --preset release
	ctest --preset release

# make demo and make test of the last commit in a Debian (bookworm, trixie) or Ubuntu (noble) of its own in FOLDER, as root.
SUITE = trixie
FOLDER = /var/tmp/merlin-$(SUITE)
test-debian:
	@tools/test-in-debian $(SUITE) "$(FOLDER)"

# merlin and libmerlin without merlin-lab, which want neither Embree nor assimp, and the tests that are theirs (PRODUCT_TESTS).
PRODUCT_TESTS = .
product: setup-test
	cmake --preset product
	cmake --build --preset product
	ctest --preset product -R '$(PRODUCT_TESTS)'

debug: setup-test
	cmake --preset debug
	cmake --build --preset debug
	ctest --preset debug

# The whole suite under AddressSanitizer and UndefinedBehaviourSanitizer.
asan: setup-test
	cmake --preset asan
	cmake --build --preset asan
	ctest --preset asan

check: setup-check
	cmake --preset release -DBUILD_TESTING=ON >/dev/null
	tools/check

format:
	git ls-files '*.c' '*.h' | xargs clang-format-14 -i

# Every fuzz target for FUZZ_SECONDS, two at a time.
FUZZ_SECONDS = 60
fuzz: setup-check
	cmake --preset fuzz
	cmake --build --preset fuzz
	tools/run-fuzzers build/fuzz/fuzz $(FUZZ_SECONDS)

clean:
	rm -rf build out
