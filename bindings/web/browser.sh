# To be sourced in the root of the repository: CHROMIUM is a browser, found or installed, and
# target/browser/browser.mjs drives it, beside three.js.
for name in "${CHROMIUM:-}" chromium-headless-shell chromium google-chrome; do
    CHROMIUM="$(command -v "$name" || true)"
    [ -z "$CHROMIUM" ] || break
done
if [ -z "$CHROMIUM" ]; then
    package=chromium-headless-shell
    root="$([ "$(id -u)" = 0 ] || echo sudo)"
    $root apt-get install --yes --quiet "$package" >/dev/null ||
        { $root apt-get update --quiet &&
            $root apt-get install --yes --quiet "$package" >/dev/null; } ||
        { echo "set CHROMIUM to the program of Chromium or Chrome" >&2; exit 1; }
    CHROMIUM="$(command -v "$package")"
fi
export CHROMIUM
# The software adapter that comes with it, which the loader of Vulkan does not find by itself
# everywhere.
for folder in "$(dirname "$(readlink -f "$CHROMIUM")")" /usr/lib/chromium; do
    if [ -e "$folder/vk_swiftshader_icd.json" ]; then
        export VK_DRIVER_FILES="$folder/vk_swiftshader_icd.json"
    fi
done
mkdir -p target/browser
[ -d target/browser/node_modules/three ] ||
    npm install --prefix target/browser --no-save --no-audit --no-fund --silent \
        puppeteer-core@25.16.0 three@0.187.0
cp bindings/web/browser.mjs target/browser
