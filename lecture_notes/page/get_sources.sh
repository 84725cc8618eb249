#!/bin/sh
# get_sources.sh FOLDER PACKAGE ...: sources of Debian packages in FOLDER/PACKAGE, from where this machine gets its packages.
# Nothing is installed, and the machine's own lists stay as they are.
set -eu
export LC_ALL=C.UTF-8

folder=$1
shift
mkdir -p "$folder/apt/parts" "$folder/apt/lists/partial"
cd "$folder"
for list in /etc/apt/sources.list.d/debian*.sources /etc/apt/sources.list.d/ubuntu*.sources; do
    [ ! -e "$list" ] || sed 's/^Types: .*/Types: deb-src/' "$list" > "apt/parts/${list##*/}"
done
[ ! -e /etc/apt/sources.list ] || sed -n 's/^deb /deb-src /p' /etc/apt/sources.list > apt/parts/main.list
apt="apt-get -q -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts=$PWD/apt/parts \
    -o Dir::State::Lists=$PWD/apt/lists -o APT::Sandbox::User=$(id -un)"
$apt update
for package in "$@"; do
    (cd apt && $apt source --download-only "$package")
    mkdir -p "$package"
    tar xf "apt/${package}"_*.orig.tar.* -C "$package" --strip-components=1
done
rm -r apt
