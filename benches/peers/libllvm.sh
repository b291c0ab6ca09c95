#!/bin/sh
# Prints the path of an LLVM library for Dr.Jit. That of DRJIT_LIBLLVM_PATH if it is set, else one
# of the system's, else that of Debian's package, unpacked below target/ without being installed.
set -eu
cd "$(dirname "$0")/../.."
if [ -n "${DRJIT_LIBLLVM_PATH:-}" ]; then
    echo "$DRJIT_LIBLLVM_PATH"
    exit
fi
# 15 and 16 abort on processors with AVX-512, and older ones are refused.
system="$(find /usr/lib /usr/local/lib -name 'libLLVM*.so*' 2>/dev/null |
    grep -E 'libLLVM(-|\.so\.)(19|2[0-9])' | sort | tail -n 1)"
if [ -n "$system" ]; then
    echo "$system"
    exit
fi
package=libllvm19
folder="$PWD/target/$package"
if [ ! -e "$folder/usr" ]; then
    mkdir -p "$folder"
    cd "$folder"
    apt-get download "$package" >&2 ||
        { apt-get update >&2 && apt-get download "$package" >&2; } ||
        { echo "set DRJIT_LIBLLVM_PATH to an LLVM library of version 19 or newer" >&2; exit 1; }
    dpkg-deb --extract "$package"_*.deb "$folder"
fi
find "$folder" -name 'libLLVM.so.*' -type f
