#!/usr/bin/env bash
# Runs a command on a machine that may have no graphics card: with the Vulkan drivers of the system
# if there are any, else with Mesa's software adapter from Debian's packages, unpacked below target/
# without being installed.
set -euo pipefail
package=mesa-vulkan-drivers
if ! compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null &&
    ! compgen -G '/etc/vulkan/icd.d/*.json' >/dev/null; then
    folder="$(cd "$(dirname "$0")/../.." && pwd)/target/$package"
    icd="$folder/lvp_icd.json"
    if [ ! -e "$icd" ]; then
        mkdir -p "$folder"
        # The package and what it needs that is not here yet.
        wanted() {
            apt-get install --simulate --no-install-recommends "$package" |
                sed -n 's/^Inst \([^ ]*\) .*/\1/p'
        }
        (
            cd "$folder"
            wanted >names || { apt-get update >&2 && wanted >names; }
            xargs apt-get download <names >&2 ||
                { apt-get update >&2 && xargs apt-get download <names >&2; }
            for file in *.deb; do dpkg-deb --extract "$file" "$folder"; done
        ) || { echo "install a Vulkan driver: on Debian the package $package" >&2; exit 1; }
        # Where it lies now.
        driver="$(dirname "$(find "$folder" -name libvulkan_lvp.so)")"
        sed "s|\"library_path\": *\"[^\"]*/|\"library_path\": \"$driver/|" \
            "$folder"/usr/share/vulkan/icd.d/lvp_icd*.json >"$icd"
    fi
    libraries="$(find "$folder/usr/lib" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)"
    export VK_DRIVER_FILES="$icd" LD_LIBRARY_PATH="$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
fi
exec "$@"
