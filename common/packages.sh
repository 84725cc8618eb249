#!/bin/sh
# packages.sh [package ...]: install what is missing, by default everything that the build, the
# tests and the figures need. With nothing missing it does nothing and needs no rights.
set -eu
export LC_ALL=C.UTF-8

# package, the command or header that proves that it is there, and its name elsewhere
needed='g++                    command g++               a C++20 compiler with OpenMP
cmake                  command ctest             CMake 3.16 (for CTest)
gnuplot-nox            command gnuplot           gnuplot 5.4 with pngcairo
libeigen3-dev          header  Eigen/Dense       Eigen 3.4
libgsl-dev             header  gsl/gsl_version.h GSL, the GNU Scientific Library
libtomlplusplus-dev    header  toml++/toml.h     toml++ 3
nlohmann-json3-dev     header  nlohmann/json.hpp JSON for Modern C++
librandom123-dev       header  Random123/philox.h Random123
doctest-dev            header  doctest/doctest.h doctest 2.4
libmuparser-dev        header  muParser.h        muParser 2
libxxhash-dev          header  xxhash.h          xxHash 0.8
emscripten             command em++              Emscripten 3.1
chromium               command chromium          Chromium
clang-format           command clang-format      clang-format 14
locales                command localedef         sources of locales (glibc)
clang                  command clang++           clang 14, with libFuzzer and its sanitizers
libclang-rt-dev        header  clang_rt          the sanitizers of clang and libFuzzer
libomp-dev             header  omp-tools.h       the OpenMP of clang, with archer
llvm                   command llvm-symbolizer   llvm, which names the lines of a report
strace                 command strace            strace 5, which can inject errors'

CXX=${CXX:-g++}
EIGEN=${EIGEN:-/usr/include/eigen3}
wanted=${*:-$(echo "$needed" | sed -e '/^emscripten/,$d' -e 's/ .*//')}

installed() {  # is the package with this name, proof and kind there?
    if [ "$2" = command ]; then
        command -v "$3" >/dev/null
    elif command -v dpkg-query >/dev/null; then
        dpkg-query -W -f='${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed
    else
        echo "#include <$3>" | $CXX -std=c++20 -isystem "$EIGEN" -E -x c++ - >/dev/null 2>&1
    fi
}

find_missing() {  # sets missing (packages) and elsewhere (what they are called in words)
    missing= elsewhere=
    for package in $wanted; do
        line=$(echo "$needed" | grep "^$package ")
        # shellcheck disable=SC2086
        set -- $line
        kind=$2 proof=$3
        shift 3
        installed "$package" "$kind" "$proof" && continue
        missing="$missing $package"
        elsewhere="$elsewhere
    $*"
    done
}

find_missing
[ -z "$missing" ] && exit 0

if ! command -v apt-get >/dev/null; then
    echo "Please install these with the package manager of this machine:$elsewhere" >&2
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
