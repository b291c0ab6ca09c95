#!/usr/bin/env bash
# Builds and tests the programs against the static library, the shared library and, with the static
# one, under the sanitizers. Needs cmake, a C++17 compiler and cargo; takes ninja if it is there, and
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
