# SPDX-License-Identifier: MIT
"""Builds the wheel: CMake makes libmerlin.so, for all x86-64 processors and again for those with AVX2 and with AVX-512, and all go
into the package with the weights. MERLIN_LIBRARY names a library that is taken instead of building any."""
import glob
import os
import platform
import re
import shutil
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # setuptools before 70.1
    from wheel.bdist_wheel import bdist_wheel

HERE = os.path.dirname(os.path.abspath(__file__))
CHECKOUT = os.path.dirname(HERE)
# Folder in merlin/lib: what CMake's MERLIN_ARCH is; _library.py chooses among them.
VARIANTS = {"": "", "x86-64-v3": "x86-64-v3", "x86-64-v4": "x86-64-v4"} if platform.machine() == "x86_64" else {"": ""}


def project_version():
    """The version of CMakeLists.txt, which is beside this folder in a checkout alone."""
    try:
        with open(os.path.join(CHECKOUT, "CMakeLists.txt"), encoding="utf-8") as file:
            return re.search(r"project\(merlin VERSION (\S+)", file.read()).group(1)
    except OSError:
        sys.exit("merlin: the wheel is built in a checkout of merlin (pip install ./python): there is no CMakeLists.txt "
                 f"in {CHECKOUT}")


def run(*command):
    """Runs a command whose output pip shows if it fails."""
    try:
        subprocess.run(command, check=True)
    except FileNotFoundError:
        sys.exit(f"merlin: {command[0]} builds the library: install the build packages of packages.txt "
                 "(tools/install-packages build)")
    except subprocess.CalledProcessError:
        sys.exit(f"merlin: the library was not built ({' '.join(command)}); the build packages are in packages.txt "
                 "(tools/install-packages build)")


def build_library(variant, arch):
    """Builds the library for a kind of processors; returns its path."""
    folder = os.path.join(CHECKOUT, "build", "wheel", variant or "portable")
    ninja = ["-G", "Ninja"] if shutil.which("ninja") else []
    run("cmake", "-S", CHECKOUT, "-B", folder, *ninja, "-DCMAKE_BUILD_TYPE=Release", f"-DMERLIN_ARCH={arch}",
        "-DMERLIN_LAB=OFF", "-DBUILD_TESTING=OFF")
    run("cmake", "--build", folder, "--target", "libmerlin", "--parallel", str(os.cpu_count() or 1))
    return os.path.join(folder, "libmerlin.so")


def needed_packages(library):
    """Lines of `soname package`: the libraries that this one needs, and the packages of this system that have them."""
    if not (shutil.which("ldd") and shutil.which("readelf") and shutil.which("dpkg-query")):
        return ""
    dynamic = subprocess.run(["readelf", "-d", library], capture_output=True, text=True, check=False).stdout
    paths = dict(re.findall(r"(\S+) => (/\S+)",
                            subprocess.run(["ldd", library], capture_output=True, text=True, check=False).stdout))
    lines = []
    for soname in re.findall(r"NEEDED.*\[(.*)\]", dynamic):
        for path in {paths.get(soname, ""), os.path.realpath(paths.get(soname, ""))}:
            found = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True, check=False).stdout
            if found and "diversion" not in found:
                lines.append(f"{soname} {found.split(':')[0].split(',')[0]}\n")
                break
    return "".join(sorted(lines))


class BuildWithLibrary(build_py):
    """Puts the library and the weights beside the modules."""

    def run(self):
        """Builds the package, without what an earlier build has left."""
        shutil.rmtree(os.path.join(self.build_lib, "merlin"), ignore_errors=True)
        super().run()
        if not self.editable_mode:
            self._add(os.path.join(self.build_lib, "merlin"))

    editable_mode = False

    def _add(self, package):
        named = os.environ.get("MERLIN_LIBRARY")
        libraries = {"": named} if named else {name: build_library(name, arch) for name, arch in VARIANTS.items()}
        for name, path in libraries.items():
            folder = os.path.join(package, "lib", name)
            os.makedirs(folder, exist_ok=True)
            shutil.copyfile(path, os.path.join(folder, "libmerlin.so"))
        with open(os.path.join(package, "lib", "needs.txt"), "w", encoding="utf-8") as file:
            file.write(needed_packages(libraries[""]))
        os.makedirs(os.path.join(package, "models"), exist_ok=True)
        for path in glob.glob(os.path.join(CHECKOUT, "models", "*.safetensors")):
            shutil.copyfile(path, os.path.join(package, "models", os.path.basename(path)))
        shutil.copyfile(os.path.join(CHECKOUT, "LICENSE"), os.path.join(package, "LICENSE"))


class WithLibrary(Distribution):
    """Of one kind of machine."""

    def has_ext_modules(self):
        """Says so."""
        return True


class PlatformWheel(bdist_wheel):
    """Of any Python 3, as nothing is compiled against it."""

    def get_tag(self):
        """py3-none-linux_x86_64."""
        return ("py3", "none", super().get_tag()[2])


setup(version=project_version(), distclass=WithLibrary,
      cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": PlatformWheel})
