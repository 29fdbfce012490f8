# Shared by cornell/run, tests/run and .ci/run: the packages a build needs, and the build itself.
# To be sourced by bash, with the repository root as the working directory.

preset=release
build_dir=build/$preset
export CCACHE_BASEDIR="$PWD"  # what was compiled in one clone is not compiled again in the next
# ccache keeps sources with precompiled headers only under these two: it does not ask which macros the headers defined, or whether
# they hold the time. The compiler's own list of what a source read spares the preprocessing.
export CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_DEPEND=1

# Everything the program, its viewer and its tests are compiled against (Debian's names).
build_packages=(
  build-essential cmake ninja-build
  libeigen3-dev libtbb-dev libfmt-dev libembree-dev libcgal-dev libopenmesh-dev libvtk9-dev
  libtomlplusplus-dev libassimp-dev libdraco-dev libmeshoptimizer-dev libpugixml-dev libmuparser-dev libglpk-dev libjpeg-dev libopenexr-dev libpng-dev zlib1g-dev
  pkgconf libcairo2-dev libpango1.0-dev librsvg2-dev fonts-dejavu-core
  libcli11-dev nlohmann-json3-dev libgtest-dev
)
# What -DLIGHTWELL_MPI=ON needs, and what starts several processes.
mpi_packages=(libopenmpi-dev openmpi-bin)
# What CPack needs besides to find the libraries that a Debian package depends on.
deb_packages=(dpkg-dev file)
# A virtual display and a software OpenGL, for the tests of the viewer.
display_packages=(xvfb xauth libgl1-mesa-dri)
# What checks the format of the sources: the version whose output is the format. Debian 13 has later ones only.
format_packages=(clang-format-14)
# What opens exported pages and reports and checks exported models, in the tests.
browser_packages=(chromium nodejs poppler-utils)
# What tests/run --long needs besides: the language of tests/faults, and a list of the program's system calls.
fault_packages=(python3 strace)
# A second browser (0.3 GB), and hands for the window: without them the tests with them are skipped.
extra_packages=(firefox-esr xdotool)

# Packages for the Python package and its tests: Debian's names, and those of PyPI.
python_packages=(python3-dev python3-venv)
python_modules=(nanobind numpy scipy)
python_requirements=("nanobind>=3.1" "numpy>=1.22" "scipy>=1.8")
# For the tests of notebooks and of IFC models, which are skipped without them.
python_extra_modules=(matplotlib nbclient ipykernel ifcopenshell)
python_extra_requirements=("matplotlib>=3.6" "nbclient>=0.8" "ipykernel>=6.20" "ifcopenshell>=0.8")

# use_preset NAME: builds with another preset of CMakePresets.json, in build/NAME.
use_preset() {
  preset=$1
  build_dir=build/$preset
}

say() { printf '==> %s\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# need_packages NAME...: installs those that are missing; asks for nothing, and for no network, when none is.
need_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    say "This is not Debian, so nothing is installed for you. What is needed: a C++20 compiler, CMake 3.25,"
    say "Ninja, Eigen 3.4, oneTBB, fmt, Embree 3.13 or 4, CGAL 5.5 (or CDT 2), OpenMesh, toml++, for the window VTK 9.1,"
    say "assimp, Draco, meshoptimizer, pugixml, muParser, GLPK, libjpeg, OpenEXR, libpng, zlib, CLI11, nlohmann-json, GoogleTest; for reports in PDF cairo, Pango, librsvg; for several processes MPI"
    say "and the font DejaVu Sans; for the tests Xvfb, Chromium, Firefox, node and poppler-utils."
    return 0
  fi
  local name missing=()
  for name in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0

  local as_root=()
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || die "these Debian packages are missing, and only root can install them:
  apt-get install --no-install-recommends ${missing[*]}
Run that as root (or install sudo), then start this again."
    as_root=(sudo)
  fi
  say "Installing ${#missing[@]} Debian packages and what they need (up to 0.8 GB to download): ${missing[*]}"
  local log=build/install.log
  mkdir -p build
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=600 -o Acquire::Retries=3)
  { "${apt[@]}" update && "${apt[@]}" install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 </dev/null || {
    tail -n 20 "$log" >&2
    die "the packages could not be installed; the lines above (all of them: $log) say why. Is the network up?"
  }
}

# want_packages NAME...: the same, but goes on without them.
want_packages() {
  (need_packages "$@") || say "Going on without $*."
}

# A compilation takes up to 1.2 GB: as many jobs as cores and free memory allow.
# LIGHTWELL_JOBS overrides.
job_count() {
  local cores memory_kb
  cores=$(nproc)
  memory_kb=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo 2>/dev/null || true)
  local jobs=$((${memory_kb:-1200000} / 1200000))
  [ "$jobs" -lt "$cores" ] || jobs=$cores
  [ "$jobs" -ge 1 ] || jobs=1
  echo "${LIGHTWELL_JOBS:-$jobs}"
}

# make_python: makes the environment for the package in build/python, from PyPI, where there is none; sets
# python_options for configure. Fails, and says why, where that cannot be done.
python_options=()
make_python() {
  local python=build/python/bin/python
  python3 -c 'import os, sysconfig; raise SystemExit(not os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")))' || {
    say "Python.h is missing (package python3-dev)."
    return 1
  }
  if ! "$python" -c "import ${python_modules[*]/%/,} sys" 2>/dev/null; then
    mkdir -p build
    say "Making an environment for the Python package in build/python (0.1 GB to download)"
    { python3 -m venv build/python && "$python" -m pip install --retries 1 --timeout 10 "${python_requirements[@]}"; } >build/python.log 2>&1 || {
      tail -n 5 build/python.log >&2
      return 1
    }
  fi
  if ! "$python" -c "import ${python_extra_modules[*]/%/,} sys" 2>/dev/null; then
    say "Adding Matplotlib, nbclient and IfcOpenShell to build/python (0.15 GB to download)"
    "$python" -m pip install --retries 1 --timeout 10 "${python_extra_requirements[@]}" >>build/python.log 2>&1 ||
      say "Going on without them: notebooks and IFC models are not tested (build/python.log)."
  fi
  python_options=(-DLIGHTWELL_PYTHON=ON "-DPython_EXECUTABLE=$PWD/$python")
}

# is_with_python: true if the build folder is configured with the package.
is_with_python() { grep -q '^LIGHTWELL_PYTHON:BOOL=ON' $build_dir/CMakeCache.txt 2>/dev/null; }

# configure [-DNAME=VALUE...]: the first time, or when values are given.
configure() {
  if [ $# -gt 0 ] || [ ! -f $build_dir/build.ninja ]; then
    local launcher=()
    ! command -v ccache >/dev/null || launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    mkdir -p build
    say "Configuring in $build_dir"
    cmake --preset $preset "${launcher[@]}" "$@" >build/configure.log 2>&1 || {
      tail -n 40 build/configure.log >&2
      die "CMake could not configure the build; the lines above (all of them: build/configure.log) say why."
    }
  fi
}

# build [TARGET...]: all by default.
build() {
  local targets=()
  [ $# -eq 0 ] || targets=(--target "$@")
  say "Building in $build_dir with $(job_count) jobs (a few minutes the first time)"
  nice cmake --build $build_dir -j "$(job_count)" "${targets[@]}" || die "the build failed; the compiler's messages are above."
}
