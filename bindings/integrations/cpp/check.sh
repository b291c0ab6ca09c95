#!/usr/bin/env bash
# Builds and tests the programs against the static library, the shared library and, with the static
# one, under the sanitizers; then against what is installed of both, found by CMake and by
# pkg-config. Needs cmake, pkg-config, a C++17 compiler and cargo; takes ninja if it is there, and
# valgrind for the first. Arguments go to cmake, as -DTEM00_PROFILE=dev.
set -euo pipefail
cd "$(dirname "$0")"

generator=()
if command -v ninja >/dev/null; then generator=(-G Ninja); fi

check() {
    local name="$1"
    shift
    echo "--- $name"
    cmake -S . -B "build/$name" "${generator[@]}" "$@" >/dev/null
    cmake --build "build/$name"
    (cd "build/$name" && ctest --output-on-failure)
}

check static "$@"
check shared -DTEM00_SHARED=ON "$@"
check sanitized -DTEM00_SANITIZE=ON "$@"

# Installed, then moved: nothing in it may name the place where it was built.
check_installed() {
    local name="installed_$1" there="$PWD/build/prefix_$1"
    shift
    cmake -S ../../c -B "build/$name" "${generator[@]}" "$@" >/dev/null
    cmake --build "build/$name"
    rm -rf "$there"
    cmake --install "build/$name" --prefix "$there.first" >/dev/null
    mv "$there.first" "$there"
    check "find_package_$name" -DTEM00_INSTALLED=ON -DCMAKE_PREFIX_PATH="$there"
    echo "--- pkg-config, $name"
    export PKG_CONFIG_PATH="$there/lib/pkgconfig"
    cc -std=c99 plain.c $(pkg-config --cflags --libs --static tem00) -o "build/$name/plain"
    LD_LIBRARY_PATH="$there/lib" "build/$name/plain"
}

check_installed static "$@"
check_installed shared -DTEM00_SHARED=ON "$@"
