#!/bin/sh
# packages.sh [package ...]: install what is missing, by default everything that the build, the
# tests and the figures need. With nothing missing it does nothing and needs no rights.
set -eu
export LC_ALL=C.UTF-8

# package (Debian), what proves that it is there, its names in Fedora and in Homebrew (- for none), and what it is
needed='g++                    command g++               gcc-c++            llvm           a C++20 compiler with OpenMP
cmake                  command ctest             cmake              cmake          CMake 3.16 (for CTest)
gnuplot-nox            command gnuplot           gnuplot            gnuplot        gnuplot 5.4 with pngcairo
libeigen3-dev          header  Eigen/Dense       eigen3-devel       eigen          Eigen 3.4
libgsl-dev             header  gsl/gsl_version.h gsl-devel          gsl            GSL, the GNU Scientific Library
libfftw3-dev           header  fftw3.h           fftw-devel         fftw           FFTW 3, in both precisions
libtomlplusplus-dev    header  toml++/toml.h     tomlplusplus-devel tomlplusplus   toml++ 3
nlohmann-json3-dev     header  nlohmann/json.hpp json-devel         nlohmann-json  JSON for Modern C++
librandom123-dev       header  Random123/philox.h Random123-devel   -              Random123
doctest-dev            header  doctest/doctest.h doctest-devel      doctest        doctest 2.4
libmuparser-dev        header  muParser.h        muParser-devel     muparser       muParser 2
libxxhash-dev          header  xxhash.h          xxhash-devel       xxhash         xxHash 0.8
clang-format           command clang-format      clang-tools-extra  clang-format   clang-format 14
locales                command localedef         glibc-locale-source -             sources of locales (glibc)
clang                  command clang++           clang              llvm           clang 14, with libFuzzer and its sanitizers
libclang-rt-dev        header  clang_rt          compiler-rt        -              the sanitizers of clang and libFuzzer
libomp-dev             header  omp-tools.h       libomp-devel       libomp         the OpenMP of clang, with archer
llvm                   command llvm-symbolizer   llvm               llvm           llvm, which names the lines of a report
strace                 command strace            strace             -              strace 5, which can inject errors
libhdf5-dev            header  hdf5.h            hdf5-devel         hdf5           HDF5 1.10, for output.openpmd
hdf5-tools             command h5dump            hdf5               hdf5           h5dump, which reads such files
libopenmpi-dev         header  mpi.h             openmpi-devel      open-mpi       Open MPI 4, for make MPI=1 (MPICH does as well)
openmpi-bin            command mpirun            openmpi            open-mpi       mpirun
parallel               command parallel          parallel           parallel       GNU parallel, for make sweep
ffmpeg                 command ffmpeg            ffmpeg             ffmpeg         ffmpeg, for make movie
pandoc                 command pandoc            pandoc             pandoc         pandoc 2.17, for the book
nodejs                 command node              nodejs             node           Node 18, which renders the formulas of the book
libjs-katex            header  katex             -                  -              KaTeX 0.16, with its fonts
chromium               command chromium          chromium           chromium       Chromium, which prints the book and tests the pages
emscripten             command em++              emscripten         emscripten     Emscripten 3.1, for the pages'

CXX=${CXX:-g++}
EIGEN=${EIGEN:-/usr/include/eigen3}
wanted=${*:-$(echo "$needed" | sed -e '/^clang-format/,$d' -e 's/ .*//')}

installed() {  # is the package with this name, proof and kind there?
    if [ "$2" = command ]; then
        command -v "$3" >/dev/null
    elif command -v dpkg-query >/dev/null; then
        dpkg-query -W -f='${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed
    else
        echo "#include <$3>" | $CXX -std=c++20 -isystem "$EIGEN" -E -x c++ - >/dev/null 2>&1
    fi
}

find_missing() {  # sets missing (packages), what Fedora and Homebrew call them, and elsewhere (what they are, in words)
    missing= fedora= homebrew= elsewhere=
    for package in $wanted; do
        line=$(echo "$needed" | grep "^$package ")
        # shellcheck disable=SC2086
        set -- $line
        kind=$2 proof=$3
        installed "$package" "$kind" "$proof" && continue
        missing="$missing $package"
        [ "$4" = - ] || fedora="$fedora $4"
        [ "$5" = - ] || homebrew="$homebrew $5"
        shift 5
        elsewhere="$elsewhere
    $*"
    done
}

find_missing
[ -z "$missing" ] && exit 0

if ! command -v apt-get >/dev/null; then
    echo "Please install these with the package manager of this machine:$elsewhere" >&2
    ! command -v dnf >/dev/null || echo "Here most of them come with:  dnf install$fedora" >&2
    ! command -v brew >/dev/null || echo "Here most of them come with:  brew install$homebrew
and then:  make CXX=\$(brew --prefix llvm)/bin/clang++ EIGEN=\$(brew --prefix)/include/eigen3 CPPFLAGS=-I\$(brew --prefix)/include LDLIBS=-L\$(brew --prefix)/lib all" >&2
    exit 2
fi
if [ "$(id -u)" = 0 ]; then
    as_root=
elif command -v sudo >/dev/null; then
    as_root=sudo
else
    echo "Please ask an administrator to run: apt-get install$missing" >&2
    exit 2
fi

echo "installing:$missing"
apt="$as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=120 -o Acquire::Retries=3"
$apt update || echo "apt-get update did not succeed; trying to install all the same" >&2
# shellcheck disable=SC2086
$apt install -y --no-install-recommends $missing

find_missing
[ -z "$missing" ] && exit 0
echo "still missing after apt-get install:$missing" >&2
exit 2
